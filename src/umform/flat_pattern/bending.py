"""A flat part bent by simulation, one bend after the other, and how well its flanges are met."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

from umform.errors import InvalidValue
from umform.flat_pattern.allowance import outside
from umform.flat_pattern.order import Orders
from umform.flat_pattern.pattern import FlatBend, FlatPattern
from umform.processes.air_bending.goal import Goal
from umform.processes.bend_sequence import Part, bend_sequence
from umform.processes.plausible import accepted
from umform.progress import Show
from umform.spec import check_arguments


@dataclass(frozen=True, eq=False)
class BentPart:
    """A part that was bent from its flat pattern by simulation.

    Attributes
    ----------
    pattern : FlatPattern
        The pattern, with the order of the bends.
    part : Part
        The bends, with strokes that correct springback.
    flanges : tuple of float
        Outer lengths of the flanges of the drawing in mm, from left to right, as `part.flanges`.
    """

    pattern: FlatPattern
    part: Part
    flanges: tuple[float, ...]

    @property
    def errors(self) -> list[float]:
        """Flanges of the simulation less those of the drawing, in mm."""
        return [found - wanted for found, wanted in zip(self.part.flanges, self.flanges, strict=True)]


def bend_part(orders: Orders, *, tolerance: float = Goal.tolerance, progress: Show = None) -> BentPart:
    """Bend a prismatic part by simulation, from its flat pattern.

    Parameters
    ----------
    orders : Orders
        The pattern with its order, and the tools.
    tolerance : float
        Largest deviation of an angle in degrees.
    progress : bool or callable, optional
        Show a progress bar; default: only on a terminal.

    Raises
    ------
    InvalidValue
        If the part has no order, or not one section.
    DeckError
        If stresses or lengths are certainly in another unit.
    NoConvergence
        If the strip cannot be bent so far.
    """
    check_arguments(bend_part, orders=orders, tolerance=tolerance)
    pattern = orders.pattern
    if not pattern.order or not orders.is_prismatic:
        raise InvalidValue(
            "only a prismatic part with an order of its bends is bent by simulation",
            where="--bend",
            value=pattern.path.name,
            cause="no order without collision was found"
            if not pattern.order
            else "its bend lines are not parallel, or a cut across them does not meet all bends",
            remedy="other tools, or without --bend: order, strokes and stops of single bends",
        )
    section = orders.longest
    sequence = orders.sequence(section, list(pattern.order))
    accepted(sequence)
    part = bend_sequence(sequence, tolerance=tolerance, progress=progress)
    by_number = {bend.number: bend for bend in pattern.bends}
    placed = [(by_number[number], place) for number, place in section.places]
    ends = [(0.0, 0.0), *((place, 0.5 * deduction(bend, pattern)) for bend, place in placed), (section.length, 0.0)]
    flanges = tuple(b - a + first + second for (a, first), (b, second) in pairwise(ends))
    return BentPart(pattern, part, flanges)


def deduction(bend: FlatBend, pattern: FlatPattern) -> float:
    """Bend deduction of the drawing in mm: 2 (R + t) tan(angle / 2) less the allowance."""
    return 2.0 * outside(bend.angle, bend.radius, pattern.thickness) - bend.allowance.length
