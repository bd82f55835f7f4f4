"""The one-step estimate of a blank: `blank`, and what it finds."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.flat_pattern.one_step.case import Blank
from umform.flat_pattern.one_step.forces import Friction, Restraint
from umform.flat_pattern.one_step.law import PathLaw
from umform.flat_pattern.one_step.part import Sheet, sheet_of
from umform.flat_pattern.one_step.plane import about_z, crossings, flange, turn
from umform.flat_pattern.one_step.reading import moved_along_normals, surface_of
from umform.flat_pattern.one_step.solution import Found, flat_places
from umform.flat_pattern.one_step.strain import Formed, areas, flat_sides, log_strains
from umform.results.forming import FormingLimit, KeelerBrazier, limit_margin
from umform.results.history import History
from umform.results.outcome import Outcome
from umform.results.quantity import Band, Quantity
from umform.spec import check_value
from umform.surfaces.triangles import Triangles

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]

#: What every table and page says.
ESTIMATE = (
    "A one-step estimate: the forming is one proportional path without bending and what tools do on the way. An "
    "incremental run decides."
)
#: Error of the size of a blank over the size, not below what comparisons of docs/blank.md have.
SIZE_ERROR = 0.04
_COMPARED = f"{100 * SIZE_ERROR:g} % of the size, above all deviations from a measured cup and incremental runs"


@dataclass(frozen=True, eq=False, repr=False)
class BlankEstimate(Outcome):
    """An estimated blank.

    Attributes
    ----------
    case : Blank
        What was asked.
    sheet : Sheet
        The formed part.
    found : Found
        Places in the flat, in the axes of the part.
    limit : callable
        Forming limit.
    name : str
        Of the part.
    seconds_used : float
        CPU time.

    Examples
    --------
    >>> import numpy as np
    >>> import umform as uf
    >>> points = np.array([[0.0, 0.0, 0.0], [40.0, 0.0, 0.0], [40.0, 30.0, 0.0], [0.0, 30.0, 0.0]])
    >>> steel = uf.J2(210e3, 0.3, hardening=uf.Swift(520.0, 0.004, 0.2))
    >>> flat = uf.blank((points, np.array([[0, 1, 2], [0, 2, 3]])), uf.Blank(steel, thickness=1.0))
    >>> round(flat.area, 6), len(flat.outlines[0]), round(float(flat.fields["thickness"].min()), 6)
    (1200.0, 4, 1.0)
    """

    case: Blank
    sheet: Sheet
    found: Found
    limit: FormingLimit
    name: str
    seconds_used: float

    @property
    def title(self) -> str:
        """Heading of tables and pages."""
        return f"Blank of {self.name}: one-step estimate"

    @property
    def flat(self) -> Floats:
        """Places of the points in the flat, shape (n, 2)."""
        return self.found.X

    @cached_property
    def outlines(self) -> list[Floats]:
        """Closed outlines of the blank, the outer one first, then holes; each of shape (n, 2)."""
        return [self.flat[loop] for loop in self.sheet.loops]

    @cached_property
    def fields(self) -> dict[str, Floats]:
        """Values of the triangles: logarithmic strains of the sheet, thickness, thinning in %, margin to the limit."""
        formed = Formed.of(self.sheet.points, self.sheet.triangles)
        turned = self.flat @ turn(-self.case.rolling)
        e = log_strains(turned, self.sheet.triangles, formed)
        middle, half = 0.5 * (e[:, 0] + e[:, 1]), np.hypot(0.5 * (e[:, 0] - e[:, 1]), e[:, 2])
        major, minor = middle + half, middle - half
        share = areas(flat_sides(self.flat, self.sheet.triangles)) / formed.area
        return {
            "major": major,
            "minor": minor,
            "thickness": share * self.case.thickness,
            "thinning": 100.0 * (1.0 - share),
            "equivalent": PathLaw.of(self.case.material).equivalent(e),
            "limit_margin": limit_margin(self.limit, major, minor),
        }

    @cached_property
    def area(self) -> float:
        """Area of the blank."""
        return float(areas(flat_sides(self.flat, self.sheet.triangles)).sum())

    @property
    def quantities(self) -> list[Quantity]:
        """Size, areas, strains."""
        x, y = np.ptp(self.outlines[0], axis=0).tolist()
        fields = self.fields
        diameter = math.sqrt(4.0 * self.area / math.pi)

        def size(label: str, name: str, value: float) -> Quantity:
            band = None if self.case.clamped else Band(SIZE_ERROR * value, _COMPARED)
            return Quantity(label, "mm", 2, name=name, value=value, band=band, leading=True)

        margin = float(fields["limit_margin"].min())
        return [
            size("length of the blank along x", "length", x),
            size("width of the blank along y", "width", y),
            size("diameter of a disc of the same area", "diameter", diameter),
            Quantity("area of the blank", "mm²", 1, name="area", value=self.area),
            Quantity("area of the part", "mm²", 1, name="part_area", value=float(self._formed_area)),
            Quantity("largest thinning", "%", 1, name="thinning", value=float(fields["thinning"].max()), leading=True),
            Quantity(
                "largest thickening", "%", 1, name="thickening", value=float(-fields["thinning"].min()), leading=True
            ),
            Quantity("largest equivalent strain", "", 3, name="strain", value=float(fields["equivalent"].max())),
            Quantity(
                "least margin to the forming limit",
                "",
                3,
                name="limit_margin",
                value=margin,
                limit=0.0,
                at_least=True,
                leading=True,
            ),
        ]

    @property
    def _formed_area(self) -> float:
        return float(Formed.of(self.sheet.points, self.sheet.triangles).area.sum())

    @property
    def stages(self) -> Mapping[str, History]:
        """No runs."""
        return {}

    @property
    def iterations(self) -> int:
        """Iterations of Newton's method."""
        return self.found.iterations

    @property
    def seconds(self) -> float:
        """CPU time."""
        return self.seconds_used

    @property
    def notes(self) -> list[str]:
        """That it is an estimate, and where the sheet is thinnest."""
        x, y, z = self.sheet.points[self.sheet.triangles[self.fields["thinning"].argmax()]].mean(axis=0)
        return [ESTIMATE, f"thinnest at ({x:.4g}, {y:.4g}, {z:.4g})"]

    @property
    def warnings(self) -> list[str]:
        """Warnings."""
        found = []
        if self.found.loads < 1.0:
            found.append(
                f"only {100.0 * self.found.loads:.0f} % of holder force, beads and drawing stress have an equilibrium: "
                "under all of them the sheet tears, or its edge is unstable. The blank is that of this part"
            )
        elif self.found.ironed < 1.0:
            found.append(
                f"only {100.0 * self.found.ironed:.0f} % of the ironing has an equilibrium: walls are thicker than the "
                "gap"
            )
        times = sum(crossings(outline) for outline in self.outlines)
        if times:
            found.append(f"the outline crosses itself at {times} places: the flat sheet overlaps")
        return found


def blank(
    part: str | Path | Triangles | tuple[Floats, NDArray[np.integer]],
    case: Blank,
    *,
    scale: float = 1.0,
    weld: float = 0.0,
    size: float | None = None,
    offset: float = 0.0,
    limit: FormingLimit | None = None,
) -> BlankEstimate:
    """Estimate the blank of a formed part in one step: outline, strains, thickness.

    Parameters
    ----------
    part : str, Path, Triangles or (points, triangles)
        Mid-surface of the part, drawn along z: STL, STEP, IGES, a mesh that meshio reads, or the surface itself.
    case : Blank
        Sheet, holder, beads.
    scale : float
        Factor on coordinates of a file: 25.4 for an STL or mesh file in inches. CAD files are converted to mm before.
    weld : float
        Corners nearer than this are one point, mm; 0: 1e-6 of the size.
    size : float, optional
        Largest side of a triangle in mm; longer ones are halved. Without it triangles are taken as they are, and those
        of CAD files have up to 1/20 of the size of the part.
    offset : float
        Distance from the given surface to the mid-surface along its normals, mm; for a skin half of the thickness, and
        never more than one.
    limit : callable, optional
        Forming limit; without it that of Keeler and Brazier.

    Returns
    -------
    BlankEstimate

    Raises
    ------
    InvalidValue
        If a number is none, or the triangles would be far too many.
    UnfitTriangles
        If the surface is no sheet: closed, not connected, branched, folded, or of another unit.
    FileProblem
        If the file cannot be read.
    NoConvergence
        If no places in the flat are found.

    Examples
    --------
    >>> import numpy as np
    >>> import umform as uf
    >>> a, y = np.meshgrid(np.linspace(-1.0, 1.0, 21), np.linspace(0.0, 30.0, 7), indexing="ij")
    >>> points = np.stack([20.0 * np.sin(a), y, 20.0 * np.cos(a)], axis=-1).reshape(-1, 3)
    >>> corner = np.arange(147).reshape(21, 7)[:-1, :-1].ravel()
    >>> halves = [corner[:, None] + np.array(ids) for ids in ([0, 7, 8], [0, 8, 1])]
    >>> steel = uf.J2(210e3, 0.3, hardening=uf.Swift(520.0, 0.004, 0.2))
    >>> flat = uf.blank((points, np.concatenate(halves)), uf.Blank(steel, thickness=1.0))
    >>> round(flat["length"].value, 2), round(flat["width"].value, 2)
    (39.98, 30.0)
    """
    start = time.process_time()
    check_value(blank, "offset", offset)
    if abs(offset) > case.thickness:
        raise InvalidValue(
            "the mid-surface is farther from the given surface than the sheet is thick",
            where="offset",
            value=offset,
            cause="another unit, or a move of the part",
            remedy=f"{0.5 * case.thickness:g} or {-0.5 * case.thickness:g} for a skin",
        )
    where = str(part) if isinstance(part, str | Path) else "part"
    surface = moved_along_normals(surface_of(part, scale=scale, weld=weld, size=size), offset)
    sheet = sheet_of(surface.points, surface.triangles, case.thickness, where)
    turned = Sheet(sheet.points @ about_z(-case.rolling), sheet.triangles)
    law = PathLaw.of(case.material)
    if case.gap is not None:
        law = replace(law, thickest=math.log(case.gap / case.thickness))
    found = flat_places(turned, law, _forces(turned, case), friction=case.friction, clamped=case.clamped)
    found = replace(found, X=found.X @ turn(case.rolling))
    limit = limit or KeelerBrazier.of(case.thickness, case.material)
    name = Path(part).name if isinstance(part, str | Path) else "a part"
    return BlankEstimate(case, sheet, found, limit, name, time.process_time() - start)


def _forces(sheet: Sheet, case: Blank) -> list[Friction | Restraint]:
    """Forces per thickness: friction on the flange, or on the edge of a part without one; beads along the edge."""
    formed = Formed.of(sheet.points, sheet.triangles)
    length = float(np.linalg.norm(np.diff(sheet.points[[*sheet.loops[0], sheet.loops[0][0]]], axis=0), axis=1).sum())
    friction, edge = 2.0 * case.friction * case.holder_force / case.thickness, case.bead / case.thickness
    found: list[Friction | Restraint] = []
    under = flange(sheet)
    if friction and under.any():
        found.append(Friction.on(sheet, formed, under, friction))
    elif friction:
        edge += friction / length
    return [*found, Restraint.on(sheet, formed, edge)] if edge else found
