"""NUMISHEET 93: square cups of aluminium and mild steel, drawn by 15 and 40 mm; draw-in beside the measured one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.analysis.run import Result
from umform.analysis.steps import Close, Move
from umform.errors import NoConvergence
from umform.materials import J2, Hill48, Metal, Swift
from umform.mesh import Mesh, grid
from umform.model import Model
from umform.model.tools.tool_controls import ToolMotion
from umform.results.forming import draw_in, forming_fields
from umform.sheet_metals import get
from umform.surfaces import LedAround, Plane, Profile
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.drawing.cups import NEWTON
from umform_book.drawing.rim import SYMMETRIC
from umform_book.page import Page

Floats = NDArray[np.float64]

#: Side and thickness of the blank (aluminium, steel); punch and opening with the radii of their corners and edges; mm.
BLANK, THICKNESS, STEEL_THICKNESS = 150.0, 0.81, 0.78
PUNCH, PUNCH_CORNER, PUNCH_EDGE = 70.0, 10.0, 8.0
OPENING, DIE_CORNER, DIE_EDGE = 74.0, 12.0, 5.0
HOLDER, FRICTION, STEEL_FRICTION = 19.6e3, 0.162, 0.144
#: Travel of the punch for the meshes and variants, and to the end.
STROKE, DEEP = 15.0, 40.0
#: Allowed elastic slip, mm.
SLIP = 2e-4
HARDENING = Swift(576.79, 0.01658, 0.3593)
ALUMINIUM = J2(71e3, 0.33, hardening=HARDENING)
#: The same with the r-values of the benchmark.
ORTHOTROPIC = Metal(71e3, 0.33, hardening=HARDENING, yield_function=Hill48(0.71, 0.58, 0.70))
STEEL: Metal = get("NUMISHEET93 mild steel").law  # type: ignore[assignment]
#: Mean of the measured draw-in: middle of the sides, corner along the diagonal; and that of the other code, by stroke.
MEASURED = {STROKE: (5.3, 3.3), DEEP: (28.5, 15.0)}
DEFORM = {STROKE: (5.5, 3.3), DEEP: (26.9, 15.5)}


@dataclass(frozen=True)
class Setup:
    """How it is computed: element size where tools bend the sheet, mm, its multiple at the rim, the others."""

    size: float = 3.0
    rim: float = 1.6
    material: J2 | Metal = ALUMINIUM
    thickness: float = THICKNESS
    friction: float = FRICTION
    penalty: float = 1e3
    element: str = "ANS3DEAS"


MESHES = {"3.5 mm": Setup(3.5), "2.5 mm": Setup(2.5), "1.8 mm": Setup(1.8)}
BASE, FINEST = "2.5 mm", "1.8 mm"
VARIED = {
    "r-values": Setup(2.5, material=ORTHOTROPIC),
    "penalty 2e3": Setup(2.5, penalty=2e3),
    "friction 0.144": Setup(2.5, friction=0.144),
}
_STEEL = {"material": STEEL, "thickness": STEEL_THICKNESS, "friction": STEEL_FRICTION, "penalty": 1e4}
COARSE_END, FINE_END = "aluminium, 4.5 mm", "aluminium, 3.5 mm"
#: Runs to the end: the tools are stiffer, for the force on the edge of the die is larger.
TO_THE_END = {
    COARSE_END: Setup(4.5, penalty=1e4),
    FINE_END: Setup(3.5, penalty=1e4),
    "mild steel, 4.5 mm": Setup(4.5, **_STEEL),  # type: ignore[arg-type]
    "mild steel, 3.5 mm": Setup(3.5, **_STEEL),  # type: ignore[arg-type]
}
#: Largest deviation from the measured mean, mm.
WITHIN = 0.5
#: Runs and strokes that are drawn: name of the picture and caption.
PICTURES = {
    (FINEST, STROKE): ("cup", f"Aluminium at {STROKE:g} mm, elements of {FINEST}, a quarter of the cup"),
    (FINE_END, DEEP): ("aluminium", f"Aluminium at {DEEP:g} mm, a quarter of the cup"),
    ("mild steel, 3.5 mm", DEEP): ("steel", f"Mild steel at {DEEP:g} mm, a quarter of the cup"),
}


@dataclass(frozen=True)
class Made:
    """A cup at a stroke.

    Attributes
    ----------
    side, diagonal : float
        Draw-in of the middle of the sides (mean of both) and of the corner along the diagonal, mm.
    x, y : float
        Of the sides across and along the rolling direction, mm.
    force : float
        Of the punch on the whole cup, kN.
    thinning : float
        Largest, in per cent.
    elements : int
        Of the quarter.
    before, after : ndarray, shape (n, 2)
        Outline of the quarter of the blank.
    """

    side: float
    diagonal: float
    x: float
    y: float
    force: float
    thinning: float
    elements: int
    before: Floats
    after: Floats

    def row(self) -> tuple[int, float, float, float, float, float]:
        """Its row in tables."""
        return self.elements, self.x, self.y, self.diagonal, self.force, self.thinning


def lines(size: float, rim: float) -> Floats:
    """Places of nodes along a side of the quarter: finer from the edge of the punch to where the die begins."""
    ends, sizes = (0.0, 25.0, 52.0, 0.5 * BLANK), (2.5 * size, size, rim * size)
    parts = [
        np.linspace(a, b, max(round((b - a) / h), 1) + 1)[1:] for a, b, h in zip(ends, ends[1:], sizes, strict=False)
    ]
    return np.concatenate([[0.0], *parts])


def blank(setup: Setup) -> Mesh:
    """A quarter of the blank."""
    half = 0.5 * setup.thickness
    side = lines(setup.size, setup.rim)
    return grid(side, side, [-half, half])


def press_of(setup: Setup, mesh: Mesh | None = None) -> tuple[Model, Close, ToolMotion]:
    """Quarter of a blank between its tools, the step that closes the holder, and the drive of the punch."""
    half = 0.5 * setup.thickness
    model = Model(mesh or blank(setup), setup.element, material=setup.material, rolling=(1.0, 0.0, 0.0))
    model.symmetry("x0", "x")
    model.symmetry("y0", "y")
    die = Profile.from_corners([(BLANK, -half), (0.0, -half), (0.0, -BLANK)], radii=[0.0, DIE_EDGE, 0.0], closed=False)
    nose = Profile.from_corners(
        [(-PUNCH_CORNER, half), (0.0, half), (0.0, BLANK)], radii=[0.0, PUNCH_EDGE, 0.0], closed=False
    )
    tools = {
        "die": model.tool("die", LedAround(die, (OPENING, OPENING), DIE_CORNER)),
        "holder": model.tool("holder", Plane((0.0, 0.0, half + 0.01), (0.0, 0.0, -1.0))),
        "punch": model.tool("punch", LedAround(nose, (PUNCH, PUNCH), PUNCH_CORNER)),
    }
    for name, tool in tools.items():
        model.contact(
            "lower" if name == "die" else "upper",
            tool,
            penalty=setup.penalty,
            friction=setup.friction,
            slip=SLIP,
            name=f"on_{name}",
        )
    hold, stroke = model.press(tools["holder"], "z", name="hold"), model.drive(tools["punch"], "-z", name="stroke")
    return model, Close(hold, force=-0.25 * HOLDER), stroke


def make(page: Page, label: str, setup: Setup, strokes: tuple[float, ...] = (STROKE,)) -> dict[float, Made]:
    """Close the holder and draw; the cups at the strokes that were reached."""
    model, close, stroke = press_of(setup)
    found: dict[float, Made] = {}
    for way in strokes:
        move = Move(stroke, to=way)
        what = label if len(strokes) == 1 else f"{label}, to {way:g} mm"
        try:
            result = page.solve(what, model, move if found else [close, move], options=NEWTON)
        except NoConvergence as error:
            page.text(f"{what}: the run ends before. {error.where}; {error.cause}.")
            break
        found[way] = _cup(model, result)
        if (label, way) in PICTURES:
            name, caption = PICTURES[label, way]
            page.shape(name, result, caption)
    return found


def _cup(model: Model, result: Result) -> Made:
    mesh, u = model.mesh, model.u.reshape(-1, 3)
    right, top = mesh.nodes("x1"), mesh.nodes("y1")
    x = -float(u[np.intersect1d(right, mesh.nodes("y0")), 0].mean())
    y = -float(u[np.intersect1d(top, mesh.nodes("x0")), 1].mean())
    diagonal = float(np.linalg.norm(u[np.intersect1d(right, top), :2].mean(axis=0)))
    force = 4e-3 * abs(float(result["punch_fz"][-1]))
    thinning = float(forming_fields(mesh, model.u)["thinning"].max())
    outline = draw_in(mesh, model.u, np.union1d(right, top))
    return Made(0.5 * (x + y), diagonal, x, y, force, thinning, len(mesh.connectivity), outline.before, outline.after)


def run(page: Page) -> None:
    """Fill the page."""
    if page.short:
        cup = make(page, "3 mm", Setup(8.0), (3.0,))[3.0]
        page.check("3 mm: draw-in of both sides is the same, mm", cup.x, cup.y, SYMMETRIC, relative=False)
        return
    setups = MESHES | VARIED | TO_THE_END
    made = {
        label: make(page, label, setups[label], (STROKE, DEEP) if label in TO_THE_END else (STROKE,))
        for label in page.each(setups)
    }
    early = {label: made[label][STROKE] for label in made if STROKE in made[label]}
    late = {label: made[label][DEEP] for label in made if DEEP in made[label]}
    for stroke, cups in ((STROKE, early), (DEEP, late)):
        page.table(
            f"At a stroke of {stroke:g} mm: draw-in in mm, force of the punch in kN, largest thinning in per cent",
            ("", "elements", "side, x", "side, y", "corner, along the diagonal", "force", "thinning"),
            [(label, *cup.row()) for label, cup in cups.items()]
            + [
                ("measured mean, aluminium", None, MEASURED[stroke][0], *MEASURED[stroke], None, None),
                ("DEFORM-3D, aluminium", None, DEFORM[stroke][0], *DEFORM[stroke], None, None),
            ],
        )
    _end(page, late)
    _budget(page, {label: early[label] for label in MESHES | VARIED if label in early})
    _outlines(page, early, late)
    _checks(page, early[FINEST])


def _end(page: Page, late: dict[str, Made]) -> None:
    """The aluminium at the last stroke beside the published row, and the effect of its mesh."""
    if not {COARSE_END, FINE_END} <= late.keys():
        return
    coarse, fine = late[COARSE_END], late[FINE_END]

    def beside(published: tuple[float, float]) -> str:
        side, corner = 100.0 * (fine.side / published[0] - 1.0), 100.0 * (fine.diagonal / published[1] - 1.0)
        return f"{side:+.0f} % at the sides and {corner:+.0f} % at the corner"

    page.text(
        f"{FINE_END}, at {DEEP:g} mm: the draw-in deviates from the measured mean by {beside(MEASURED[DEEP])}, from "
        f"DEFORM-3D by {beside(DEFORM[DEEP])}. From elements of 4.5 to those of 3.5 mm the sides draw in by "
        f"{fine.side - coarse.side:.1f} mm more: these meshes are too coarse for a check."
    )


def _budget(page: Page, found: dict[str, Made]) -> None:
    """Effect of mesh, r-values, contact and friction at the first stroke."""
    base = found[BASE]
    rows = [
        (label, cup.side - base.side, cup.diagonal - base.diagonal, 100.0 * (cup.force / base.force - 1.0))
        for label, cup in found.items()
        if label != BASE
    ]
    columns = ("", "sides, mm", "corner, mm", "force, %")
    title = f"Budget at {STROKE:g} mm: effect of each change on the run with elements of {BASE}"
    page.table(title, columns, rows)


def _outlines(page: Page, early: dict[str, Made], late: dict[str, Made]) -> None:
    outlines = [Curve("blank", early[FINEST].before[:, 0], early[FINEST].before[:, 1], "k:")]
    shown = [(f"{label} at {STROKE:g} mm", early[label]) for label in (FINEST, "r-values") if label in early]
    shown += [(f"{label} at {DEEP:g} mm", cup) for label, cup in late.items()]
    outlines += [Curve(label, cup.after[:, 0], cup.after[:, 1]) for label, cup in shown]
    page.figure("outline", plot(outlines, "x, mm", "y, mm"), "Outline of a quarter")


def _checks(page: Page, finest: Made) -> None:
    side, diagonal = MEASURED[STROKE]
    for what, found, measured, other in (
        ("side", finest.side, side, DEFORM[STROKE][0]),
        ("corner", finest.diagonal, diagonal, DEFORM[STROKE][1]),
    ):
        page.compare(f"draw-in of the {what} at {STROKE:g} mm, mm", found, measured, f"another code {other:g}")
    page.check(f"{FINEST}: draw-in of the sides, mm", finest.side, side, WITHIN, relative=False)
    page.check(f"{FINEST}: draw-in of the corner, mm", finest.diagonal, diagonal, WITHIN, relative=False)
    page.check(f"{FINEST}: draw-in of both sides is the same, mm", finest.x, finest.y, SYMMETRIC, relative=False)


CASE = Case(
    name="drawing-square-cup",
    title="NUMISHEET 93: square cups of aluminium and mild steel",
    problem=f"""
A blank of {BLANK:g} x {BLANK:g} mm is drawn by {STROKE:g} mm, in some runs by {DEEP:g} mm. Punch {PUNCH:g} x {PUNCH:g}
mm, corner radius {PUNCH_CORNER:g} mm, edge radius {PUNCH_EDGE:g} mm; opening {OPENING:g} x {OPENING:g} mm, corner
radius {DIE_CORNER:g} mm, edge radius {DIE_EDGE:g} mm; holder {HOLDER / 1e3:g} kN. Aluminium: {THICKNESS:g} mm,
mu = {FRICTION:g} on all tools, E = 71 GPa, nu = 0.33, hardening 576.79 (0.01658 + p)^0.3593 MPa, isotropic; one run has
Hill48 from the r-values 0.71, 0.58, 0.70. Mild steel: {STEEL_THICKNESS:g} mm, mu = {STEEL_FRICTION:g}, the card
"NUMISHEET93 mild steel": E = 206 GPa, nu = 0.3, 565.32 (0.007117 + p)^0.2589 MPa, Hill48 from 1.79, 1.51, 2.27. A
quarter, one layer of ANS3DEAS, 2 x 2 contact points, penalty 1000 MPa/mm (to {DEEP:g} mm: 1e4). The element size is
that over the edges of the tools; elements on the flat of the punch are 2.5 times as large, at the rim 1.6 times.
Draw-in: displacement of the middle of the sides, and of the corner of the blank along the diagonal.
""",
    reference="""
Mean of the measured draw-in, and results of another code with brick elements and isotropic flow: "Sheet Forming in
DEFORM 3D" in the manual of DEFORM, table of the square cup, with one decimal. Thickness, holder force and friction of
the aluminium are from there too. The manual lists both strokes under aluminium. In the benchmark, from memory, the
aluminium was drawn by 15 mm and the steel by 40 mm, so the row at 40 mm may belong to the steel: the table shows it
beside both metals, without a check. No other published draw-in of the steel was found. Tool radii, hardening and
friction of the steel are those widely used for the benchmark; they are not in that source. Single measurements are not
given: the check at 15 mm allows the mean an error of 0.5 mm.
""",
    run=run,
    cost=320.0,
)
