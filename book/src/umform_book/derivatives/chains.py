"""Operations one after the other, beside whole runs of all of them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import umform as uf
from umform.processes.air_bending import AirBending
from umform.processes.bend_sequence import Bend, BendSequence
from umform.processes.hemming import Hemming
from umform.processes.hemming.spec import acute
from umform.processes.problems import outcome_of
from umform.studies.derivatives.subjects import OfChain
from umform_book.derivatives.differences import TIGHT, Compared

#: The opening is off 8 thicknesses, where the rule for the elements of a bend has a kink.
SHEET = AirBending(thickness=1.9, opening=16.0, elements_per_thickness=1.0, layers=1, increment=0.025)
PART = BendSequence(70.0, (Bend(20.0, stroke=4.9), Bend(45.0, stroke=4.6, direction="down")), SHEET)
HEM = Hemming(
    form="insert",
    base=13.0,
    increments=24,
    sheet=acute(element="BEND18", elements_per_thickness=1.0, layers=1, increment=0.025, stroke=7.3),
)
OPEN = Hemming(form="open", base=13.0, sheet=acute(elements_per_thickness=3.0, stroke=6.24))
INNER = replace(OPEN, form="inner", gap=1.0, sheet=replace(OPEN.sheet, friction=0.1))


@dataclass(frozen=True)
class Chain:
    """A case of several operations.

    Attributes
    ----------
    case : object
        The case, with strokes.
    by, of : tuple of str
        Parameters, and results.
    limit : float
        Largest error of a derivative relative to that of differences.
    size : float
        Change of a parameter in central differences, relative to its value.
    """

    case: Any
    by: tuple[str, ...]
    of: tuple[str, ...]
    limit: float
    size: float = 1e-4


CHAINS = {
    "part of two bends": Chain(
        PART,
        ("bends.0.stroke", "bends.1.stroke", "sheet.thickness", "sheet.material.hardening.strength"),
        ("bend 1: angle", "bend 2: angle", "bend 1: final_angle", "bend 2: final_angle", "flange 2"),
        1e-3,
    ),
    "hem over an insert": Chain(
        HEM,
        ("sheet.stroke", "gap", "sheet.material.hardening.strength", "sheet.punch_radius"),
        ("largest_force", "height", "springback", "tip_gap", "loop_gap", "angle"),
        3e-3,
    ),
    "roll-in of a hem over an insert, friction in the V-die": Chain(
        replace(HEM, sheet=replace(HEM.sheet, friction=0.1)),
        ("gap", "sheet.punch_radius", "sheet.friction"),
        ("roll_in", "height"),
        0.03,
    ),
    "open hem, gap 2 % more and less": Chain(
        OPEN,
        ("gap",),
        ("largest_force", "height", "loop_gap"),
        0.05,
        0.02,
    ),
    "hem over an inner sheet that deforms": Chain(
        INNER, ("gap",), ("loop_gap", "roll_in", "creep", "outer_strain"), 0.05
    ),
    "rope hem, friction in the V-die": Chain(
        replace(INNER, form="rope", gap=0.0),
        ("sheet.friction",),
        ("height", "loop_gap", "outer_strain"),
        0.15,
    ),
    "hem whose bend snaps off its tools": Chain(
        replace(HEM, sheet=replace(HEM.sheet, stroke=7.2267)),
        ("sheet.material.hardening.strength", "sheet.punch_radius"),
        ("largest_force", "height", "springback", "tip_gap", "angle"),
        3e-3,
    ),
}


def compared_chain(chain: Chain) -> Iterator[Compared]:
    """Largest error of the derivatives of all results with respect to each parameter."""
    found = uf.derivatives(chain.case, chain.by, chain.of, progress=False)
    for one in found.parameters:
        step = chain.size * float(one.value)
        ends = [_whole(chain.case, one.path, float(one.value) + change) for change in (step, -step)]
        worst = 0.0
        for name in chain.of:
            wanted, had = (ends[0][name] - ends[1][name]) / (2.0 * step), found[name, one.path].value
            assert had is not None
            faint = 1e-4 * abs(ends[0][name] / float(one.value))
            worst = max(worst, abs(had - wanted) / max(abs(wanted), faint))
        yield Compared(one.path, 0.0, worst, max(found.runs.kept[one.path].switched))


def _whole(case: Any, path: str, value: float) -> dict[str, float]:
    """Results of whole runs, solved to round-off, whose releases end where the force is zero."""
    thing = OfChain(case).with_({path: value})
    results: list[uf.Result] = []
    for stage in thing.build().stages:
        model, steps = stage.build(results[-1] if results else None)
        steps = [replace(step, tolerance=1e-9) if isinstance(step, uf.Release) else step for step in steps]  # type: ignore[union-attr]
        options = replace(TIGHT, line_search=True, extrapolate=2)
        results.append(uf.solve(model, steps, options=options, frames=1, progress=False))
    return {one.name: one.value or 0.0 for one in outcome_of(thing.case, *results).quantities}
