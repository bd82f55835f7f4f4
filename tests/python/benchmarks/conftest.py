"""The scripts of benchmarks/, as modules."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import pytest

import umform as uf

FOLDER = Path(__file__).parents[3] / "benchmarks"


@pytest.fixture
def script(monkeypatch):
    """Import a script of the folder, which finds its neighbours as if it had been started there."""
    monkeypatch.syspath_prepend(str(FOLDER))
    threads = uf.threads()

    def loaded(name: str) -> ModuleType:
        specification = importlib.util.spec_from_file_location(f"benchmark_{name}", FOLDER / f"{name}.py")
        module = importlib.util.module_from_spec(specification)
        monkeypatch.setitem(sys.modules, specification.name, module)  # dataclasses look their module up
        specification.loader.exec_module(module)
        return module

    yield loaded
    uf.set_threads(threads)
