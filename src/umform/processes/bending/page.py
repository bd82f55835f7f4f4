"""Figures and page of the example: what is seen, and why."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from umform.plotting import save
from umform.processes.bending import table
from umform.processes.bending.case import Bending
from umform.processes.bending.figure import curves, shapes
from umform.processes.bending.problem import problem_of
from umform.processes.bending.spec import RECONSTRUCTION
from umform.report import parts
from umform.report.live import style
from umform.report.page import balance_parts
from umform.report.repeats import counted
from umform.report.versions import versions

_LEAD = (
    "Solid-shell elements at finite plastic strain, in frictionless contact with the exact geometry of a rigid "
    "cylinder."
)

_READING = (
    "Full lines are the elements of the paper, dashed lines the same elements with a cubic thickness strain that is "
    "tied at the nodes. Thin lines are the release; where they end, the force is zero and the strip has sprung back. "
    "The forces are those of the half strip."
)
_CONTINUUM = (
    "Diamonds and the bar at the end are fine continuum meshes (quadratic bricks); the bar spans what two of them "
    "give, since the plastic hinge localises and the last value depends on the mesh. They bend nearly in plane strain, "
    "as meshes with two elements over the width do; a single bilinear one bends almost in plane stress."
)
_CONTACT = (
    "While the strip slides over the cylinder, the place of contact moves towards the hinge and the lever arm "
    "shortens. With contact checked at the nodes it can only do so by a whole element at a time: the force stays flat "
    "while the strip lies on a node, and climbs a stair when the next one takes over. Contact points inside of the "
    "elements make the stairs smaller and more: n × n Gauss points let the lever arm shorten in n steps an element. "
    "J, the largest |dF|/F within any 0.1 mm, and the rms deviation from a smooth fit (the polynomial of degree 4 of "
    "least squares), both for u > 2 mm, measure it. Finer meshes have smaller stairs with any rule."
)
_LOCKING = (
    "With the elements of the paper the force climbs far above that of the continuum, on the fine meshes to "
    "nearly twice. This is no hardening, since the material has none, but locking. Where the strip is bent "
    "sharply with curvature k, incompressible plastic flow asks for the thickness strain E₃₃ = ((1 + kz)⁻² − "
    "1)/2, and the elements have one that is linear in the thickness coordinate z. The mismatch is a change of "
    "volume, against which the bulk modulus stands; it grows with the curvature, resists the hinge and spreads "
    "it. Refinement in the surface does not cure it, nor do 18 nodes, for it is a matter of the thickness "
    "direction. A cubic thickness strain can meet the condition, and tying it at the nodes takes away the "
    "thinning that tilted directors feign in mid-element: with both, one element through the thickness "
    "comes near to the continuum. (18 nodes need cubic terms that vary in the surface, too.) The hinge localises, "
    "so that other meshes give up to a tenth more or less. This needs two elements or more over the width."
)


def write_page(folder: Path, runs: Sequence[Bending], pictured: Bending) -> list[Path]:
    """Write free_bending.png, .svg and report.html; return their paths."""
    picture = curves(runs)
    files = [save(picture, folder / f"free_bending.{suffix}") for suffix in ("png", "svg")]
    content = [
        *_failures(runs),
        parts.note(RECONSTRUCTION),
        parts.heading("Force over displacement"),
        parts.figure(picture, _caption(runs)),
        parts.heading("What is seen"),
        *map(parts.paragraph, _explanations(runs)),
        parts.heading("Numbers"),
        parts.table(table.header(runs), table.rows(runs)),
        parts.paragraph(" ".join(["Forces in N at displacements in mm.", *table.legend(runs)])),
        *balance_parts({run.case.name: run.balance for run in runs}),
        *_deformed(_compared(runs, pictured)),
        *_moving(pictured),
        parts.heading("Settings"),
        parts.paragraph("Lengths in mm, forces in N, stresses in MPa."),
        parts.pairs(_settings(runs)),
        parts.heading("Deck"),
        parts.folded(f"The input of {pictured.case.name}, for umform run", problem_of(pictured.case).toml()),
        parts.heading("Versions"),
        parts.pairs(versions() | {"solver used": ", ".join(sorted({run.solver for run in runs} - {""}))}),
    ]
    moved = {"style": style(), "scripts": pictured.live.scripts} if pictured.live else {}
    page = parts.write_html(folder / "report.html", "Free bending of a strip over a cylinder", _LEAD, content, **moved)
    return [*files, page]


def _deformed(runs: Sequence[Bending]) -> Iterator[str]:
    if not any(run.shape for run in runs):
        return
    yield parts.heading("Deformed strip")
    yield parts.figure(
        shapes(runs), "The whole strip at the end of the stroke, in true proportion; the second half is a mirror image."
    )


def _moving(run: Bending) -> Iterator[str]:
    """The run in space, its curves with a cursor, and its history."""
    if run.live is None:
        return
    yield parts.heading(f"{run.case.name}, from increment to increment")
    yield run.live.shape
    yield from map(parts.note, run.live.notes)
    yield run.live.curves
    yield run.live.table


def _compared(runs: Sequence[Bending], pictured: Bending) -> list[Bending]:
    """The pictured run, behind its twin with the element of the paper if there is one."""
    case = pictured.case
    twins = [
        run
        for run in runs
        if run is not pictured
        and run.case.is_paper_element
        and (run.case.element, run.case.mesh, run.case.contact) == (case.element, case.mesh, case.contact)
    ]
    return [*twins[:1], pictured]


def _failures(runs: Sequence[Bending]) -> Iterator[str]:
    for run in runs:
        for message in (run.failure, *counted(run.warnings)):
            if message:
                yield parts.note(f"{run.case.name}: {message}", bad=True)


def _caption(runs: Sequence[Bending]) -> str:
    return f"{_READING} {_CONTINUUM}" if runs[0].case.is_example else _READING


def _explanations(runs: Sequence[Bending]) -> Iterator[str]:
    if len({run.case.contact for run in runs}) > 1:
        yield _CONTACT
    if runs[0].case.is_example and any(run.case.is_paper_element for run in runs):
        yield _LOCKING


def _settings(runs: Sequence[Bending]) -> dict[str, object]:
    names = {"tool_x": "x of the axis of the cylinder", "tool_z": "z of the axis of the cylinder"}
    shared: dict[str, object] = {
        names.get(key, key.replace("_", " ")): _plain(value) for key, value in runs[0].case.problem().items()
    }
    points = {f"{run.case.thickness_points} ({run.case.thickness_rule})" for run in runs}
    return shared | {"thickness points": ", ".join(sorted(points))}


def _plain(value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:g}" if isinstance(value, float) else str(value)
