"""Common part of the pages of this chapter: every element on every mesh along the load, against reference curves."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np
from numpy.typing import NDArray

from umform.errors import NoConvergence
from umform.model import Model
from umform.results.shape import Shape
from umform_book.convergence import Study, normalised, show
from umform_book.nonlinear.curves import curve_figure, distance
from umform_book.nonlinear.tracing import LOAD, Curve, Setup, Solve, trace
from umform_book.page import Page
from umform_book.variants import GOOD, Variant, with_tying

Floats = NDArray[np.float64]

#: What one would take for a curved or bent shell.
TIED = tuple(with_tying(name) for name in ("ANS3DEAS", "EAS3DEAS", "MI9K3DEAS"))
#: Elements that lock in thin shells, for comparison.
LOCKING = tuple(Variant(name) for name in ("DISP3D", "DISP3DEAS", "DISP9K3D", "DISP9K3DEAS"))
#: Default of the relative error that is expected on the finest mesh. It is four times as large on a mesh half as fine,
#: since the elements are of second order.
EXPECTED = 0.02
#: The balance of work of a run without a jump drifts by less, from the length of its increments.
_JUMP = 0.05


Measure = Callable[[Curve], float]


def full_load(names: Mapping[str, str], where: str = "at full load") -> dict[str, Measure]:
    """Displacements at the last point of the curve, from the names of the probes."""
    return {f"{name} {where}": partial(_last, probe=probe) for probe, name in names.items()}


def _last(curve: Curve, probe: str) -> float:
    return float(curve[probe][-1])


@dataclass(frozen=True)
class Problem:
    """A shell under a load.

    Attributes
    ----------
    build : callable
        variant, divisions -> Setup.
    reference : mapping of str to ndarray
        Column load_fraction and a column for each probe.
    names : mapping of str to str
        How the probes are written.
    measures : mapping of str to callable
        What is read off a curve and compared with the same of the reference; the convergence of the first is shown.
    meshes : sequence of int
        Intervals between nodes along an edge, coarse to fine.
    short : int
        The only mesh of the short version.
    expected : float
        Relative error that is expected on the finest mesh.
    follow : callable
        How the load is followed, see :func:`trace`.
    known, cause : float, str
        Known deviation of the curve on the finest mesh from the reference, and its cause.
    known_measures : float
        Known deviation of the measures, for the same cause.
    """

    build: Callable[[Variant, int], Setup]
    reference: Curve
    names: Mapping[str, str]
    measures: Mapping[str, Measure]
    meshes: Sequence[int]
    short: int
    expected: float = EXPECTED
    follow: Callable[[Setup, Floats, Solve], Curve] = trace
    known: float = 0.0
    cause: str = ""
    known_measures: float = 0.0


@dataclass
class Found:
    """Results of the course.

    Attributes
    ----------
    problem : Problem
    curves : dict
        curves[variant][divisions]; None where Newton's method found no equilibrium any more.
    models : dict
        The models of the finest mesh, where the curve ends.
    """

    problem: Problem
    curves: dict[Variant, dict[int, Curve | None]] = field(default_factory=dict)
    models: dict[Variant, Model] = field(default_factory=dict)

    @property
    def finest(self) -> int:
        """Intervals of the finest mesh that was run."""
        return max(number for row in self.curves.values() for number in row)

    def on(self, mesh: int) -> dict[Variant, Curve]:
        """Curves of the tied elements on a mesh."""
        return {v: curve for v, row in self.curves.items() if v in TIED and (curve := row.get(mesh)) is not None}

    def read(self, measure: Measure) -> Study:
        """A measure of all curves; NaN where there is none."""
        return {
            variant: {n: float("nan") if curve is None else measure(curve) for n, curve in row.items()}
            for variant, row in self.curves.items()
        }

    def first_measure(self) -> tuple[str, Study]:
        """The first measure, by name, over the reference."""
        name, measure = next(iter(self.problem.measures.items()))
        return name, normalised(self.read(measure), measure(self.problem.reference))


def run_course(page: Page, problem: Problem) -> Found:
    """Run all elements on all meshes (short: two tied ones on one mesh) and enter tables, plots and checks."""
    found = _follow_all(page, problem)
    _enter_tables(page, found)
    _enter_checks(page, found)
    page.text(needed_text(found))
    if any(curve is None for row in found.curves.values() for curve in row.values()):
        page.text("A dash: above some load Newton's method found no equilibrium nearby.")
    jumps = sum(row.drift > _JUMP for row in page.balances)
    if jumps:
        page.text(
            f"In {jumps} of {len(page.balances)} runs the balance of work drifts by more than {100 * _JUMP:g} %: the "
            "load had a maximum, the shell jumped to another equilibrium, and the work of the jump is not stored."
        )
    if not page.short:
        page.text(locking_text(found))
    return found


def enter_shape(
    page: Page, found: Found, variant: Variant, mirrors: Sequence[int] = (), view: tuple[float, float] = (-115.0, 28.0)
) -> None:
    """Picture of the deformed shape at full load, mirrored at planes of symmetry (axes 0, 1, 2) to the whole shell."""
    model = found.models.get(variant)
    if model is None:
        return
    shape = Shape.displaced(model.mesh, model.u.reshape(-1, 3))
    for axis in mirrors:
        shape = shape.mirrored(axis)
    page.shape("shape", shape, f"Deformed shape at full load, not enlarged: {variant.label}", view=view)


def needed_text(found: Found, enough: float = EXPECTED) -> str:
    """Coarsest mesh from which on each element meets the reference at full load."""
    what, shares = found.first_measure()
    met: dict[str, list[str]] = {}
    for variant, row in shares.items():
        if variant in LOCKING:
            continue
        good = [n for n in row if all(abs(row[finer] - 1.0) <= enough for finer in row if finer >= n)]
        when = f"from {min(good)} intervals on" if good else f"on no mesh up to {max(row)} intervals"
        met.setdefault(when, []).append(variant.label.replace(", E_33 tied", " (tied)"))
    parts = "; ".join(f"{when}: {', '.join(labels)}" for when, labels in sorted(met.items()))
    return f"{what} is within {100 * enough:g} % of the reference {parts}."


def locking_text(found: Found) -> str:
    """Displacements of the elements that lock, over the reference."""
    what, shares = found.first_measure()
    row = {variant.name: numbers[found.finest] for variant, numbers in shares.items() if variant in LOCKING}
    parts = (f"{name} {100 * share:.0f} %" if share == share else f"{name} nothing" for name, share in row.items())
    where = f"with {found.finest} intervals"
    return f"{what} of the elements that lock, {where}, over the reference: {', '.join(parts)}."


def _follow_all(page: Page, problem: Problem) -> Found:
    found = Found(problem)
    meshes = page.pick(problem.meshes, (problem.short,))
    pairs = [(variant, n) for variant in page.pick((*GOOD, *LOCKING), TIED[::2]) for n in meshes]
    for variant, n in page.each(pairs, lambda pair: f"{pair[0].label}, {pair[1]}"):
        setup = problem.build(variant, n)
        try:
            label = f"{variant.label}, {n}"
            curve: Curve | None = problem.follow(setup, problem.reference[LOAD], partial(page.solve, label))
        except NoConvergence:
            curve = None
        found.curves.setdefault(variant, {})[n] = curve
        if curve is not None and n == max(meshes):
            found.models[variant] = setup.model
    return found


def _enter_tables(page: Page, found: Found) -> None:
    problem = found.problem
    name, shares = found.first_measure()
    show(page, "convergence", f"{name} over the reference", shares)
    rows = found.read(partial(distance, reference=problem.reference))
    meshes = sorted({n for row in rows.values() for n in row})
    page.table(
        "Largest distance of a reference point from the curve, %, with both axes scaled to 1 (intervals between nodes "
        "along an edge)",
        ("element", *(str(n) for n in meshes)),
        [(variant.label, *(100 * row[n] if n in row else None for n in meshes)) for variant, row in rows.items()],
    )
    page.figure(
        "curves",
        curve_figure(found.on(max(meshes)), found.on(min(meshes)), problem.reference, problem.names),
        f"Load against displacement with {max(meshes)} intervals; pale: with {min(meshes)}; circles: reference",
    )


def _enter_checks(page: Page, found: Found) -> None:
    problem, finest = found.problem, found.finest
    coarser = (max(problem.meshes) / finest) ** 2
    within = problem.expected * coarser
    for variant in (variant for variant in TIED if variant in found.curves):
        where = f"{variant.label}, {finest} intervals"
        for what, measure in problem.measures.items():
            value, known = found.read(measure)[variant][finest], problem.known_measures * coarser
            page.check(f"{what}, {where}", value, measure(problem.reference), within, known=known, cause=problem.cause)
        off = found.read(partial(distance, reference=problem.reference))[variant][finest]
        page.at_most(
            f"distance from the curve, {where}", off, within, known=problem.known * coarser, cause=problem.cause
        )
