"""Packages whose names are imported when they are first used."""

from importlib import import_module
from pathlib import Path

import pytest

LAZY = [
    "umform.problem",
    "umform.io",
    "umform.materials",
    "umform.processes",
    "umform.results.forming",
    "umform.surfaces",
]


@pytest.mark.parametrize("package", LAZY)
def test_each_public_name_has_a_home(package):
    module = import_module(package)
    assert sorted(module._HOME) == sorted(module.__all__)
    for name, home in module._HOME.items():
        assert getattr(module, name) is getattr(import_module(f"{package}.{home}"), name)


@pytest.mark.parametrize("package", LAZY)
def test_no_file_hides_a_name(package):
    module = import_module(package)
    files = {file.stem for file in Path(module.__file__).parent.glob("*.py")}
    assert not files & set(module._HOME)


def test_an_unknown_name_is_refused():
    with pytest.raises(AttributeError, match=r"module 'umform\.surfaces' has no attribute 'Cone'"):
        _ = import_module("umform.surfaces").Cone
