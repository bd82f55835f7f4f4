"""Causes of known deviations of this chapter."""

from __future__ import annotations

from typing import TypedDict

#: air-bend-mesh shows it.
ONE_LAYER = (
    "one layer is a shell with straight normals: it lacks the stress through the thickness and the shear under the "
    "punch, which raise the moment there, and its hinge is too sharp (see air-bend-mesh)"
)
#: Shell theory holds if a state changes over a length that is large against the thickness, which a punch does not.
ONE_LAYER_THEORY = "Koiter, Theory of Thin Elastic Shells, IUTAM 1960, 12-33: error of order (h/L)^2 with L about h"

#: air-bend-wide-sheet shows it.
LAYERS = (
    "straight fibres, and one stress through the thickness in each layer; in one layer the two errors nearly cancel, "
    "eq. (2.32); in more layers they do not, and fall with the number of layers"
)


class Known(TypedDict, total=False):
    """Known cause of a check's deviation; nothing where there is none."""

    known: float
    cause: str


def known(limit: float, cause: str, when: bool = True) -> Known:
    """Largest deviation that is known, and its cause, where a condition holds."""
    return {"known": limit, "cause": cause} if when else {}
