"""Fast import of matplotlib for commands."""

from __future__ import annotations

from types import ModuleType

from umform.cli.importing import Execute, around


def without_help_texts() -> None:
    """Prevent matplotlib from building the help texts of its classes at import, which takes a third of that time.

    These are lists of properties, and the docstrings and signatures of ``set``, which only interactive users need.
    The names of glyphs, for TeX, wait for their first use. For processes of a command only; nothing is imported before
    a picture needs it.
    """
    around("matplotlib.artist", _without)
    around("fontTools.agl")


def _without(execute: Execute, artist: ModuleType) -> None:
    """Take the help texts out of the base class of all that matplotlib draws."""
    execute(artist)
    vars(artist)["kwdoc"] = lambda _: ""
    name = "_update_set_signature_and_docstring"
    if hasattr(artist.Artist, name):
        setattr(artist.Artist, name, classmethod(lambda cls: None))
