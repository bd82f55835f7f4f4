"""Cups of this chapter: drawn, released, and their ears."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from umform.analysis.run import Result
from umform.errors import NoConvergence
from umform.materials import J2, Metal, Voce, Yld2004
from umform.materials.j2 import Plastic
from umform.mesh import Mesh
from umform.processes.draw import Cup
from umform.processes.draw.cup import ESAFORM
from umform.processes.draw.drawn import let_go, passage
from umform.processes.solution import drawing_options
from umform.results.forming import EarProfile, LargestForce, ear_profile, forming_fields, largest_force, section
from umform.sheet_metals import get
from umform_book.page import Page

Floats = NDArray[np.float64]


def aa6016(card: str = "", exponent: float | None = None, hardening: str = "") -> Metal:
    """AA6016-T4 with the yield function of a card, perhaps another exponent; hardening of another card, or of NTNU."""
    function = get(f"AA6016-T4 {card}".strip()).law.yield_function  # type: ignore[union-attr]
    if card == "Postech":
        hardening = card
    law = get(f"AA6016-T4 {hardening}".strip()).law
    if exponent is not None and isinstance(function, Yld2004):
        function = replace(function, exponent=exponent)
    return Metal(law.E, law.nu, hardening=law.hardening, yield_function=function)


def isotropic() -> J2:
    """The curve of NTNU with an isotropic yield function."""
    return J2(70e3, 0.33, hardening=Voce(125.95, 314.98, 12.22))


def esaform(material: Plastic | None = None, **changes: object) -> Cup:
    """The cup of the ESAFORM benchmark 2021."""
    given: dict[str, object] = ESAFORM | {
        "penalty": 1e5,  # softer tools leave the rim thicker than the gap that it is ironed in, and the cup low
        "contact_points": 2,  # more make the gap narrower on a coarse mesh, eq. (4.192)
    }
    return Cup(material=aa6016() if material is None else material, **(given | changes))  # type: ignore[arg-type]


@dataclass(frozen=True)
class Made:
    """A cup after release.

    Attributes
    ----------
    ears : EarProfile
        Its rim.
    flange : EarProfile
        Radius of the rim over the angle at the stroke FLANGE or before, while it is on the flange.
    force : LargestForce
        Largest force of the punch on the whole cup over passages of an element, kN.
    after : LargestForce
        The same after the flange has left the holder, while the rim is ironed.
    peak : float
        Largest force of the history, kN.
    thinning : float
        Largest thinning in per cent.
    elements : int
        Of the quarter.
    wall : tuple of float
        Thickness of the wall: its mean, and that at the rim.
    """

    ears: EarProfile
    flange: EarProfile
    force: LargestForce
    after: LargestForce
    peak: float
    thinning: float
    elements: int
    wall: tuple[float, float]

    def row(self) -> tuple[int | float, ...]:
        """Its row in tables."""
        low, high = float(self.ears.height.min()), float(self.ears.height.max())
        forces = self.force.value, self.force.ripple, self.after.value, self.after.ripple, self.peak
        return self.elements, self.ears.mean, low, high, cosine(self.ears), *forces, self.thinning, *self.wall


#: Newton's method of `umform draw`, whose tolerances would leave imbalances above those that a page of the book allows.
NEWTON = replace(drawing_options(), residual=1e-7, increment=1e-4)
#: Stroke in mm at which the rim is still on the flat of the die.
FLANGE = 20.0
#: Columns of such a table.
COLUMNS = (
    *("", "elements", "mean height", "lowest", "highest", "cos 4θ", "punch force, kN", "±", "off the holder, kN", "±"),
    *("largest of all, kN", "thinning, %", "wall, mm", "its rim, mm"),
)
#: Height in mm above the bottom at which the wall begins, above the edge of the punch.
WALL = 8.0


def make(page: Page, label: str, case: Cup) -> Made | None:
    """Hold, draw, open; a run that ends early gives None and a sentence on the page."""
    model, press = case.build()
    where = "the run ends before the end of the stroke"
    try:
        drawn = page.solve(label, model, press.closing, frames=50, options=NEWTON)
        where = "the press does not open"
        page.solve(f"{label}: released", model, press.opening, options=NEWTON)
    except NoConvergence as error:
        page.text(f"{label}: {where}. {error.where}; {error.cause}.")
        return None
    punch, stroke = 4e-3 * np.abs(drawn["punch_fz"]), drawn["stroke"]
    way = passage(case, section(model.mesh, drawn.frames[-1].points["displacement"]))
    left = let_go(stroke, np.abs(drawn["holder_fz"]))
    force, after = (largest_force(stroke, punch, way, between=part) for part in ((0.0, left), (left, np.inf)))
    thinning = float(forming_fields(model.mesh, model.u)["thinning"].max())
    ears, cells = ear_profile(model.mesh, model.u), len(model.mesh.connectivity)
    return Made(ears, _flange(drawn), force, after, float(punch.max()), thinning, cells, _wall(model.mesh, model.u))


def cosine(ears: EarProfile) -> float:
    """Amplitude of cos 4θ, negative where the ears stand between the axes: a quarter has it at 0 or 45 degrees."""
    size, angle = ears.wave(4)
    return size if abs(angle) < 22.5 else -size


def _wall(mesh: Mesh, u: Floats) -> tuple[float, float]:
    """Mean thickness of the wall: its volume over its area; and that of the upper fifth of it."""
    x = mesh.displaced(u)[mesh.connectivity]
    lower, upper = x[:, :4], x[:, 4:8]
    middle = 0.5 * (lower + upper)
    area = 0.5 * np.linalg.norm(np.cross(middle[:, 2] - middle[:, 0], middle[:, 3] - middle[:, 1]), axis=1)
    volume = area * np.linalg.norm((upper - lower).mean(axis=1), axis=1)
    height = middle[:, :, 2].mean(axis=1) - x[:, :, 2].min()
    layers = len(mesh.connectivity) // len(mesh.faces["lower"])

    def thickness(above: float) -> float:
        there = height > above
        return layers * float(volume[there].sum() / area[there].sum()) if there.any() else np.nan

    return thickness(WALL), thickness(height.max() - 0.2 * (height.max() - WALL))


def _flange(drawn: Result) -> EarProfile:
    """Radius of the rim over the angle while it is on the flange."""
    stroke = np.array([drawn.rows[frame.number]["stroke"] for frame in drawn.frames])
    frame = drawn.frames[int(np.flatnonzero(stroke <= FLANGE)[-1])]
    mesh = drawn.model.mesh
    ids = mesh.nodes("rim_lower")
    x, y = (mesh.points + frame.points["displacement"])[ids, :2].T
    order = np.argsort(np.arctan2(y, x))
    return EarProfile(np.degrees(np.arctan2(y, x))[order], np.hypot(x, y)[order])
