"""The deck of a ready process."""

from __future__ import annotations

from umform.processes.air_bending import AirBending
from umform.processes.air_bending.deck import deck_of as deck_of_air_bending
from umform.processes.bending.deck import deck_of as deck_of_free_bending
from umform.processes.bending.parameters import FreeBending


def deck_of(case: FreeBending | AirBending) -> str:
    """Deck of a case of a ready process, as TOML.

    Parameters
    ----------
    case : FreeBending or AirBending
        The case; a bend needs its stroke.

    Returns
    -------
    str
        What it builds gives the same numbers as :func:`umform.processes.free_bending` and
        :func:`umform.processes.air_bending.air_bending`.
    """
    return deck_of_air_bending(case) if isinstance(case, AirBending) else deck_of_free_bending(case)
