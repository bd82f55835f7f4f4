"""Causes of known deviations of this chapter."""

from __future__ import annotations

from typing import TypedDict

#: air-bend-mesh shows it.
ONE_LAYER = (
    "the straight normals of one layer do not see the stress through the thickness and the shear under the punch, by "
    "which the sheet bears a larger moment there: the hinge is too sharp, see air-bend-mesh"
)

#: air-bend-wide-sheet shows it.
LAYERS = (
    "fibre positions are straight and the stress through the thickness is one number in each layer; in one layer the "
    "two errors nearly cancel, eq. (2.32), in two or more they do not, and fade with their number"
)


class Known(TypedDict, total=False):
    """Known cause of a check's deviation; nothing where there is none."""

    known: float
    cause: str


def known(limit: float, cause: str, when: bool = True) -> Known:
    """Largest deviation that is known, and its cause, where a condition holds."""
    return {"known": limit, "cause": cause} if when else {}
