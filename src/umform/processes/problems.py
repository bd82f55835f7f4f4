"""The deck of a case of any process."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from umform.processes.air_bending import AirBending
    from umform.processes.bending.spec import FreeBending


def deck_of(case: FreeBending | AirBending) -> str:
    """Deck of a case of a ready process, as TOML.

    Parameters
    ----------
    case : FreeBending or AirBending
        The case; a bend needs its stroke.

    Returns
    -------
    str
        It gives the same numbers as :func:`umform.processes.free_bending` and
        :func:`umform.processes.air_bending.air_bending`.
    """
    from umform.processes.air_bending import problem as air_bending
    from umform.processes.air_bending.spec import AirBending
    from umform.processes.bending import problem as free_bending

    return air_bending.deck_of(case) if isinstance(case, AirBending) else free_bending.deck_of(case)
