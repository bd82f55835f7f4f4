"""An equivalent draw bead: forces per length of a line on a tool, in place of a modelled bead."""

from __future__ import annotations

import logging
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from annotated_types import MinLen
from numpy.typing import ArrayLike, NDArray

from umform import _core
from umform.errors import InvalidBead
from umform.mesh import Mesh, Selector
from umform.model.contact.encounter import sheet_thickness
from umform.model.contact.found import ContactFound
from umform.model.contact.pair import Contact
from umform.model.contact.settings import ContactSettings
from umform.model.terms.term import Energies, Found
from umform.model.tools.tool import Tool
from umform.ranks import Ranks
from umform.spec import About, check_fields
from umform.spec.types import ContactPoints, NotNegative, Positive
from umform.surfaces.directions import coordinates

log = logging.getLogger("umform.contact")

Floats = NDArray[np.float64]

#: Default elastic slip allowed, and the gap at which a bead ends, in thicknesses.
_SLIP, _OFF = 1.0 / 200.0, 0.5
#: Points within half a band for an error of the resultant below 1e-3, and for one of some per cent.
_WANTED, _FEWEST, _MOST = 4.5, 1.5, 10


_FORCE = About(
    cause="a sign: restraint acts against the way of the sheet, uplift off the tool",
    remedy="from a test, or from the section of the bead by `umform bead`",
    error=InvalidBead,
)
_INVALID = About(error=InvalidBead)


@dataclass(frozen=True)
class BeadOptions:
    """An equivalent draw bead: a line on a tool that restrains the sheet."""

    curve: Annotated[Sequence[tuple[float, float, float]], MinLen(2), _INVALID]
    """Line: its corners on the tool, in its initial position."""
    restraint: Annotated[NotNegative, _FORCE]
    """Restraint: force per length of the line to draw the sheet across it. `umform bead` computes it from the section
    of a bead."""
    width: Annotated[Positive, _INVALID]
    """Width of the band over which a smooth hat function spreads the forces."""
    uplift: Annotated[NotNegative, _FORCE] = 0.0
    """Uplift: force per length of the line that lifts the sheet off the tool, as a bead does while it bends the
    sheet."""
    closed: bool = False
    """Whether the last point is joined to the first."""
    slip: Annotated[Positive, _INVALID] | None = None
    """Elastic slip that is allowed; by default 1/200 of the thickness."""
    points: Annotated[ContactPoints, _INVALID] | None = None
    """Gauss points per direction of a face; by default as many as the band needs. eq. (4.105)"""

    def __post_init__(self) -> None:
        check_fields(self)


@dataclass(frozen=True)
class BeadLine:
    """Parameters of an equivalent draw bead.

    Attributes
    ----------
    curve : ndarray, shape (k, 3)
        Corners of a polyline on the tool, in its frame: the initial position.
    restraint, uplift : float
        Largest force across the line, and force off the tool, both per length of the line.
    width : float
        Width of the band.
    slip : float
        Elastic slip.
    off : float
        Gap from which on the bead has no effect.
    closed : bool
        Whether the last point is joined to the first.
    """

    curve: Floats
    restraint: float
    uplift: float
    width: float
    slip: float
    off: float
    closed: bool

    def law(self) -> _core.ContactLaw:
        """In the form of the kernels."""
        line = self.curve.tolist(), self.closed, 0.5 * self.width
        return _core.bead_law(*line, self.restraint, self.uplift, self.slip, self.off)

    @property
    def length(self) -> float:
        """Length of the polyline."""
        corners = np.concatenate([self.curve, self.curve[:1]]) if self.closed else self.curve
        return float(np.linalg.norm(np.diff(corners, axis=0), axis=1).sum())


class Bead(Contact):
    """An equivalent draw bead on a tool; made by :meth:`umform.Model.bead`. eqs. (4.101) to (4.106)

    Parameters
    ----------
    mesh : Mesh
        The sheet.
    faces : Selector
        Lower or upper faces.
    tool : Tool
        The tool with the line.
    line : BeadLine
        Line, forces, band.
    points : int, optional
        Gauss points per direction and facet; default: as many as the band needs.
    name : str
        For the history.
    """

    fixed = ("tool", "name", "line")
    memory = (*Contact.memory, "before", "block", "_areas", "_no_multipliers", "_last")

    def __init__(self, mesh: Mesh, faces: Selector, tool: Tool, line: BeadLine, points: int | None, name: str) -> None:
        self.line = line
        points = _points(mesh, faces, 0.5 * line.width, points, f"bead {name}")
        settings = ContactSettings(penalty=line.law().penalty, points=points, slip=line.slip)
        super().__init__(mesh, faces, tool, settings, name)

    @property
    def has_friction(self) -> bool:
        """Whether it holds the sheet along the tool."""
        return True

    @property
    def has_potential(self) -> bool:
        """Whether its energy follows from the pressures: the lift depends on the place. eq. (4.106)"""
        return False

    def _law(self) -> _core.ContactLaw:
        return self.line.law()

    def columns(self, found: Found, ranks: Ranks) -> dict[str, float]:
        """Sums of restraint and lift, points in the band, slipping points, work."""
        assert isinstance(found, ContactFound)
        area, pressure = found.held.area, found.held.pressure
        across = found.held.traction - pressure[:, None] * found.held.normal
        values = [
            ranks.sum(float(area @ np.linalg.norm(across, axis=1))),
            ranks.sum(float(area @ pressure)),
            int(ranks.sum(float(found.active.sum()))),
            int(ranks.sum(float(found.slipping.sum()))),
            ranks.sum(found.friction_work),
        ]
        return dict(zip(self.column_names(), values, strict=True))

    def column_names(self) -> Iterable[str]:
        """Restraint, lift, active and slipping points, work."""
        return [f"{self.name}_{what}" for what in ("restraint", "lift", "active", "slipping", "work")]

    def energies(self, found: Found, u: Floats) -> Energies:
        """Elastic slip and work against the lift, and the work of the restraint. eq. (4.106)"""
        assert isinstance(found, ContactFound)
        return Energies(0.0, 0.0, float(found.held.stored), found.friction_work)


def bead_line(mesh: Mesh, tool: Tool, options: BeadOptions, where: str) -> BeadLine:
    """Make a checked bead.

    Raises
    ------
    InvalidBead
        If the line is invalid or not on its tool.
    """
    thickness, closed, width = sheet_thickness(mesh), options.closed, options.width
    slip = _SLIP * thickness if options.slip is None else options.slip
    line = BeadLine(
        _corners(options.curve, closed, where),
        float(options.restraint),
        float(options.uplift),
        float(width),
        float(slip),
        _OFF * thickness,
        bool(closed),
    )
    if not closed and line.length < width:
        raise InvalidBead(
            "the line of a bead is shorter than its band is wide",
            where=where,
            value=f"length {line.length:.4g}, width {width:.4g}",
            cause="its ends fade within half the width",
            remedy="a longer line or a narrower band",
        )
    _refuse_beside(line, tool, where)
    return line


def _corners(curve: ArrayLike | Sequence[ArrayLike], closed: bool, where: str) -> Floats:
    try:
        corners = np.array(curve, dtype=float)
    except (TypeError, ValueError):
        corners = np.empty(0)
    least = 3 if closed else 2
    if corners.ndim != 2 or corners.shape[1] != 3 or len(corners) < least or not np.isfinite(corners).all():
        raise InvalidBead(
            f"the line of a bead is at least {least} points (x, y, z)",
            where=where,
            value=f"shape {corners.shape}",
            cause="coordinates that are missing or not finite",
            remedy="bead(..., curve=[(40, -100, 0), (40, 100, 0)])",
        )
    steps = np.linalg.norm(np.diff(np.concatenate([corners, corners[:1]]) if closed else corners, axis=0), axis=1)
    if (steps == 0.0).any():
        raise InvalidBead(
            "two neighbouring points of the line of a bead are the same",
            where=where,
            value=corners[int(np.argmin(steps))].tolist(),
            cause="a closed line that ends with its first point",
            remedy="take one of them out",
        )
    return corners


def _refuse_beside(line: BeadLine, tool: Tool, where: str) -> None:
    """Reject a line that is farther from its tool than half the width of the band, at corners or between them."""
    following = np.roll(line.curve, -1, axis=0)
    middles = 0.5 * (line.curve + following)
    places = np.concatenate([line.curve, middles if line.closed else middles[:-1]])
    gap = np.abs(tool.kernel.gap(np.ascontiguousarray(places))[0])
    farthest = int(np.argmax(np.where(np.isfinite(gap), gap, np.inf)))
    if not gap[farthest] <= 0.5 * line.width:
        raise InvalidBead(
            "a bead lies beside its tool",
            where=f"{where}, {coordinates(places[farthest])}",
            value=f"gap {gap[farthest]:.4g}, half the width {0.5 * line.width:.4g}",
            cause="points of another tool, other units, or long straight lines on a round tool",
            remedy="points on the surface of the tool, close enough to each other",
        )


def _points(mesh: Mesh, faces: Selector, half_width: float, points: int | None, where: str) -> int:
    """Points per direction of a facet, so that the band contains enough of them. eq. (4.105)"""
    corners = mesh.points[mesh.facets(faces)[:, :4]]
    size = float(np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=-1).max())
    if points is None:
        points = min(max(math.ceil(_WANTED * size / half_width), 2), _MOST)
        least = math.ceil(_FEWEST * size / half_width)
        if least > _MOST:
            raise InvalidBead(
                "the band of a bead is narrower than the facets can see",
                where=where,
                value=f"width {2 * half_width:.4g}, longest side of a facet {size:.4g}",
                cause=f"{_MOST} points per direction leave fewer than three within the band",
                remedy=f"a finer mesh where the bead is, or width = {2 * _FEWEST * size / _MOST:.3g} at least",
            )
    if points * half_width < 0.5 * _WANTED * size:
        log.warning(
            "%s: %d points per side of a facet of %.4g in a band of %.4g: its force may be wrong by some per cent",
            where, points, size, 2 * half_width,
        )  # fmt: skip
    return int(points)
