"""Strips with a small imperfection: they neck after the largest force, and some elements hourglass."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.analysis.run import Result
from umform.analysis.steps import Move
from umform.errors import NoConvergence
from umform_book.case import Case
from umform_book.convergence import show, study
from umform_book.page import Page
from umform_book.plastic.bars import maximum_force, maximum_force_plane_strain, narrowed_strip, peak
from umform_book.plastic.curves import lines_figure
from umform_book.plastic.hourglass import alternation
from umform_book.plastic.hourglass_stability import CAUSE, THEORY
from umform_book.plastic.tension import LAWS, MEMBRANE_SETTINGS
from umform_book.printed import about
from umform_book.variants import Variant

Floats = NDArray[np.float64]

LAW = LAWS["Swift"]
LENGTH, WIDTH, THICKNESS, IMPERFECTION = 30.0, 10.0, 0.5, 0.01


@dataclass(frozen=True)
class Strip:
    """Which strip: whether its thickness is held, how far it is pulled, and in how many increments."""

    name: str
    held: bool
    elongation: float
    steps: int


STRIPS = (
    Strip("plane stress", held=False, elongation=0.21, steps=21),
    Strip("plane strain", held=True, elongation=0.3, steps=30),
)


@dataclass(frozen=True)
class Necked:
    """Results of a run.

    Attributes
    ----------
    elongation, force : ndarray
        Elongation and force per nominal area of each increment.
    narrowing : float
        Decrease of the width in the middle over that at the end.
    alternation : float
        See :func:`umform_book.plastic.hourglass.alternation`.
    negative_pivots : int
        Most negative pivots of a tangent in the last increment.
    iterations : int
        Iterations of the run.
    ended : str
        Why the run ended before its time, if it did.
    result : Result
        The run.
    """

    elongation: Floats
    force: Floats
    narrowing: float
    alternation: float
    negative_pivots: int
    iterations: int
    ended: str
    result: Result


def neck(page: Page, strip: Strip, variant: Variant, divisions: int) -> Necked:
    """Pull a strip."""
    across = variant.cells(divisions)
    cells = (3 * across, across)
    model, end = narrowed_strip(
        variant.element,
        LAW,
        cells,
        length=LENGTH,
        width=WIDTH,
        thickness=THICKNESS,
        imperfection=IMPERFECTION,
        held=strip.held,
    )
    ended = ""
    try:
        label = f"{strip.name}, {variant.label}, {divisions} intervals"
        move = Move(end, strip.elongation * LENGTH, steps=strip.steps, cuts=3)
        result = page.solve(label, model, move, frames=strip.steps)
    except NoConvergence as error:
        result, ended = error.result, error.cause.split(" (")[0]  # type: ignore[attr-defined]
    X, u = model.mesh.points, model.u.reshape(-1, 3)
    edge = X[:, 1] > (1.0 - 2.0 * IMPERFECTION) * WIDTH
    middle, far = (u[edge & (np.abs(X[:, 0] - x) < 1e-9), 1].mean() for x in (0.0, LENGTH))
    return Necked(
        result["end"] / LENGTH,
        result["end_force"] / (WIDTH * THICKNESS),
        float(middle / far),
        alternation(model, cells),
        max(record.negative_pivots or 0 for record in result.iterations[-1]),
        int(result["iterations"].sum()),
        ended,
        result,
    )


def run(page: Page) -> None:
    """Fill the page."""
    for strip in STRIPS if not page.short else STRIPS[1:]:
        _one_strip(page, strip)


def _one_strip(page: Page, strip: Strip) -> None:
    straight = (maximum_force_plane_strain(LAW) if strip.held else maximum_force(LAW))[0]
    runs: dict[tuple[Variant, int], Necked] = {}

    def largest(variant: Variant, divisions: int) -> float:
        runs[variant, divisions] = found = neck(page, strip, variant, divisions)
        return peak(found.elongation, found.force)[0] / straight

    variants = page.pick(MEMBRANE_SETTINGS, MEMBRANE_SETTINGS[::2])
    found = study(page, variants, page.pick((4, 8, 16), (4, 8)), largest)
    key = strip.name.replace(" ", "-")
    mesh = "intervals along half of the width"
    show(page, key, f"largest force over that of the straight strip, {strip.name}", found, mesh=mesh)
    _table(page, strip, runs)
    _judge(page, strip, found, runs)
    _pictures(page, strip, runs)
    if strip.held:
        early = [found for (v, _), found in runs.items() if v.name == "EAS3DEAS" and found.ended]
        page.text(
            f"In plane strain {len(early)} of {sum(v.name == 'EAS3DEAS' for v, _ in runs)} runs with enhanced membrane "
            "strains end early, with negative pivots: see the [hourglass stiffness of one "
            "element](plastic-hourglass.md). ANS3DEAS is stable but too stiff in volume, and necks too late; "
            "MI9K3DEAS necks as it should. Do not use EAS3DEAS where membranes flow in plane strain."
        )
    else:
        page.text(
            "In plane stress the enhanced elements and MI9K3DEAS have the same neck on all meshes up to here. Later "
            "the neck becomes a band as narrow as the mesh allows, and each mesh has its own curve. ANS3DEAS necks "
            "late."
        )


def _table(page: Page, strip: Strip, runs: dict[tuple[Variant, int], Necked]) -> None:
    page.table(
        f"After the largest force, {strip.name}",
        (
            "element, intervals",
            "elongation reached",
            "force there",
            "narrowing, middle over end",
            "alternation",
            "negative pivots",
            "iterations, about",
            "ended",
        ),
        [
            (
                f"{v.label}, {n}",
                float(found.elongation[-1]),
                float(found.force[-1]),
                found.narrowing,
                found.alternation,
                found.negative_pivots,
                about(found.iterations),
                found.ended or None,
            )
            for (v, n), found in runs.items()
        ],
    )


def _judge(
    page: Page, strip: Strip, found: dict[Variant, dict[int, float]], runs: dict[tuple[Variant, int], Necked]
) -> None:
    for variant, row in found.items():
        finest = max(row)
        what = f"{strip.name}, {variant.label}, {finest} intervals"
        page.check(f"largest force, {what}", row[finest], 1.0 - 0.5 * IMPERFECTION, within=0.5 * IMPERFECTION + 0.001)
        if not strip.held:
            continue
        enhanced = variant.name == "EAS3DEAS"
        cause = CAUSE if enhanced else ""
        run = runs[variant, finest]
        limit = 25 if enhanced else 0
        theory = THEORY if enhanced else ""
        pivots = run.negative_pivots
        page.at_most(f"negative pivots at the end, {what}", pivots, 0.5, known=limit, cause=cause, theory=theory)
        missing, known = 1.0 - float(run.elongation[-1]) / strip.elongation, 0.35 if enhanced else 0.0
        page.at_most(f"part of the path not reached, {what}", missing, 1e-9, known=known, cause=cause, theory=theory)
        known = 1.0 if enhanced else 0.0
        page.at_most(f"alternation of the cells, {what}", run.alternation, 0.15, known=known, cause=cause)


def _pictures(page: Page, strip: Strip, runs: dict[tuple[Variant, int], Necked]) -> None:
    y = "force per nominal area"
    key = strip.name.replace(" ", "-")
    shown = {
        f"{v.label}, {n}": (run.elongation[run.elongation > 0.12], run.force[run.elongation > 0.12])
        for (v, n), run in runs.items()
        if v.label in ("ANS3DEAS", "EAS3DEAS, 7 modes", "MI9K3DEAS")
    }
    figure = lines_figure("elongation", {y: shown})
    page.figure(f"curve-{key}", figure, f"Force over elongation, {strip.name}, number of intervals in the legend")
    finest = max(n for _, n in runs)
    for variant in (MEMBRANE_SETTINGS[0], MEMBRANE_SETTINGS[2], MEMBRANE_SETTINGS[4]):
        if (variant, finest) in runs:
            name = f"shape-{key}-{variant.name.lower()}"
            caption = f"Plastic strain, {strip.name}, {variant.label}, {finest} intervals"
            page.shape(name, runs[variant, finest].result, caption, values="plastic_strain_max", view=(-90.0, 89.0))


CASE = Case(
    name="plastic-necking",
    title="Necking of strips",
    problem=f"""
Quarter of a strip, half length {LENGTH:g}, half width {WIDTH:g}, {100 * IMPERFECTION:g} % narrower in its middle (a
cosine along the length); E = 210000, nu = 0.3, Swift's hardening 500 (0.01 + e)^0.2. The ends are pulled apart and may
contract. Square cells, three along for one across.

* Plane stress: half thickness {THICKNESS:g}, 3 thickness points, elongation {STRIPS[0].elongation:g}.
* Plane strain: the same mesh with u_z = 0 on both faces, elongation {STRIPS[1].elongation:g}; the membrane must keep
  the volume.
""",
    reference=f"""
The largest force lies between that of the straight strip ([case of tension](plastic-tension.md)) and that of the
narrowest section, {100 * IMPERFECTION:g} % less; half of it is the uncertainty. After the largest force the law has no
length, and the neck depends on the mesh: compare trends only. A sound element shows no negative pivot on the path, and
no pattern from cell to cell.
""",
    run=run,
    picture="plane-strain",
    cost=50.0,
)
