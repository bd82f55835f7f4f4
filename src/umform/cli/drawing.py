"""Fast import of matplotlib for commands."""

from __future__ import annotations


def without_help_texts() -> None:
    """Prevent matplotlib from building the help texts of its classes at import, which takes a third of that time.

    These are lists of properties, and the docstrings and signatures of ``set``, which only interactive users need. For
    processes of a command only, before :mod:`umform.plotting` is imported.
    """
    from matplotlib import artist

    vars(artist)["kwdoc"] = lambda _: ""
    name = "_update_set_signature_and_docstring"
    if hasattr(artist.Artist, name):
        setattr(artist.Artist, name, classmethod(lambda cls: None))
