"""Fast import of matplotlib for commands."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from importlib.machinery import ModuleSpec, PathFinder
from types import ModuleType

_ARTIST = "matplotlib.artist"


def without_help_texts() -> None:
    """Prevent matplotlib from building the help texts of its classes at import, which takes a third of that time.

    These are lists of properties, and the docstrings and signatures of ``set``, which only interactive users need. For
    processes of a command only; nothing is imported before a picture needs it.
    """
    sys.meta_path.insert(0, _Finder())


class _Finder:
    """Finds the base class of all that matplotlib draws, once, and takes the help texts out of it."""

    def find_spec(self, name: str, path: Sequence[str] | None = None, target: object = None) -> ModuleSpec | None:
        """The module with a loader that changes it; None for any other."""
        if name != _ARTIST:
            return None
        sys.meta_path.remove(self)
        spec = PathFinder.find_spec(name, path)
        if spec is not None and spec.loader is not None:
            execute = spec.loader.exec_module

            def without(module: ModuleType) -> None:
                execute(module)
                _take_out(module)

            spec.loader.exec_module = without  # type: ignore[method-assign]
        return spec


def _take_out(artist: ModuleType) -> None:
    vars(artist)["kwdoc"] = lambda _: ""
    name = "_update_set_signature_and_docstring"
    if hasattr(artist.Artist, name):
        setattr(artist.Artist, name, classmethod(lambda cls: None))
