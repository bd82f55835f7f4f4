"""matplotlib as a command needs it: quickly."""

from __future__ import annotations


def without_help_texts() -> None:
    """Keep matplotlib from writing the help text of each of its classes while it is imported, a third of that time.

    These are the docstrings and signatures of ``set``, for people at a prompt: nothing is drawn by them. For processes
    of a command only, before :mod:`umform.plotting` is imported.
    """
    from matplotlib.artist import Artist

    name = "_update_set_signature_and_docstring"
    if hasattr(Artist, name):
        setattr(Artist, name, classmethod(lambda cls: None))
