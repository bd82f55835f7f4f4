"""Settings of a contact: the penalty from the allowed penetration, and the number of points."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from umform import _core
from umform.errors import InvalidFriction, InvalidPenalty, InvalidValue
from umform.materials import Material
from umform.mesh import Mesh, Selector
from umform.model.contact.cells import RIPPLE, cells_for, checked_cells, ripple_of
from umform.model.contact.encounter import Encounter, sheet_thickness
from umform.model.contact.friction import AnyFriction, friction_kernel
from umform.surfaces import Surface

log = logging.getLogger("umform.contact")

#: Default allowed penetration, in thicknesses.
ALLOWED = 1.0 / 200.0
#: Length over which a flat tool, a blank holder for instance, spreads the line force, in thicknesses.
_FLAT = 20.0
#: Default allowed elastic slip, in thicknesses.
_SLIP = 1.0 / 200.0
#: Largest penalty over stiffness / thickness: beyond it the compression of the sheet exceeds ten times the penetration.
_STIFFEST = 10.0
#: Contact points that the expected contact length should contain, and the most points per direction. At a third of the
#: expected force, as late in air bending, the contact is 0.7 times as long and still contains four.
_WITHIN, _MOST = 6.0, 10
#: Default of the points per direction.
_POINTS = 2


@dataclass(frozen=True)
class ContactSettings:
    """Settings of a contact.

    Attributes
    ----------
    penalty : float
        Pressure per penetration.
    points : int or "nodes"
        Gauss points per direction and facet, or cells, or the nodes.
    allowed : float, optional
        Allowed penetration; None if only a penalty was given.
    augmented : bool
        Whether multipliers reduce the penetration to the allowed one, and the elastic slip.
    friction : float, Friction, FrictionByRegion or callable, optional
        Friction law; None without friction.
    slip : float
        Allowed elastic slip.
    ratio : float
        Tangential stiffness over the penalty at first contact, such that a point at the expected pressure slips at the
        allowed elastic slip.
    cells : int, optional
        Cells per direction and facet; None at points.
    ripple : float, optional
        Expected relative ripple of the force with cells; None for points, and if the law gives no estimate.
    width_points : int, optional
        Gauss points across facets of a body in plane strain, where nothing varies; None elsewhere.
    largest : float
        Penalty up to which it grows in a run where it leaves more than the allowed penetration. An estimate does; a
        given penalty and multipliers do not, and have 0.
    """

    penalty: float
    points: int | str
    allowed: float | None = None
    augmented: bool = False
    friction: AnyFriction | None = None
    slip: float = 0.0
    ratio: float = 0.0
    cells: int | None = None
    ripple: float | None = None
    width_points: int | None = None
    largest: float = 0.0


def contact_settings(
    mesh: Mesh,
    faces: Selector,
    tool: Surface,
    material: Material,
    *,
    penalty: float | None = None,
    penetration: float | None = None,
    points: int | str | None = None,
    cells: int | str | None = None,
    ripple: float | None = None,
    augmented: bool = False,
    friction: AnyFriction | None = None,
    slip: float | None = None,
    where: str = "contact",
) -> ContactSettings:
    """Settings from the given values, the rest from mesh, tool and law. eqs. (4.29), (4.31), (4.122)

    Raises
    ------
    InvalidPenalty, InvalidValue
        If a number is out of range, or two settings exclude each other.
    """
    _check(penalty, penetration, augmented, tool, where)
    cells = checked_cells(cells, ripple, where)
    points, over_cells = _places(points, cells, where), cells is not None
    law = _friction_law(friction, slip, where)
    estimated, given = penalty is None or points == "auto", penalty is not None
    allowed = penetration
    if allowed is None and (penalty is None or augmented):
        allowed = ALLOWED * sheet_thickness(mesh)
    met = None
    if estimated:
        met = Encounter.of(mesh, mesh.facets(faces), tool.kernel(), material, where)
        if points == "auto" and over_cells:
            points = _cells(met, penalty, allowed, ripple)
        elif points == "auto":
            points = _points(met, penalty, allowed, 2 if mesh.cell == "hex8" else 3)
        if penalty is None:
            assert allowed is not None
            penalty = _penalty(met, allowed, points)
        log.info(
            "%s: thickness %.4g, tool radius %.4g, line force about %.4g: penalty %.4g, points %s",
            where, met.thickness, met.radius, met.line_force, penalty, points,
        )  # fmt: skip
    assert penalty is not None
    points = "nodes" if points == "nodes" else int(points)
    allowed = None if allowed is None else float(allowed)
    number = int(points) if over_cells else None
    expected = None
    if number is not None:
        meet = partial(Encounter.of, mesh, mesh.facets(faces), tool.kernel(), material, where)
        expected = _ripple(met, meet, number, allowed)
    largest = 0.0 if given or augmented or met is None else _largest(met)
    plain = ContactSettings(
        float(penalty), points, allowed, bool(augmented), cells=number, ripple=expected, largest=largest
    )
    if law is None:
        return plain
    slip = _SLIP * sheet_thickness(mesh) if slip is None else float(slip)
    if given or allowed is None:
        pressure = _pressure(mesh, faces, tool, material, penalty, points)
    else:
        pressure = penalty * allowed
    ratio = _tangential_stiffness(law, pressure, slip) / penalty
    return replace(plain, friction=friction, slip=slip, ratio=ratio)


def _friction_law(friction: AnyFriction | None, slip: float | None, where: str) -> _core.FrictionLaw | None:
    """The checked friction law; None without friction."""
    if slip is not None and not (np.isfinite(slip) and slip > 0):
        raise InvalidValue(
            "the elastic slip that is allowed must be positive",
            where=where,
            value=slip,
            cause="a sign or a missing value",
            remedy="omit it: 1/200 of the thickness of the sheet is allowed then",
        )
    if friction is None or (isinstance(friction, int | float) and friction == 0):
        return None
    try:
        return friction_kernel(friction)
    except InvalidFriction as error:
        error.where = where
        raise


def _pressure(
    mesh: Mesh, faces: Selector, tool: Surface, material: Material, penalty: float, points: int | str
) -> float:
    """Expected pressure for a penalty. eqs. (4.28), (4.15)"""
    try:
        met = Encounter.of(mesh, mesh.facets(faces), tool.kernel(), material, "")
    except InvalidPenalty:  # no estimate: assume the penalty of the default penetration
        return penalty * ALLOWED * sheet_thickness(mesh)
    spacing = met.length if isinstance(points, str) else met.length / points
    length = max(contact_length(met.radius, met.line_force, penalty), spacing)
    return met.line_force / length


def _tangential_stiffness(law: _core.FrictionLaw, pressure: float, slip: float) -> float:
    """Traction per elastic slip, such that a point at the pressure slips at the allowed elastic slip. eq. (4.51)"""
    bound = law.bound(pressure)[0]
    return (bound if bound > 0.0 else pressure) / slip


def contact_length(radius: float, line_force: float, penalty: float) -> float:
    """Length of the contact of a round tool with a flat sheet. eq. (4.15)"""
    return 2.0 * math.cbrt(1.5 * radius * line_force / penalty)


def _length_at(met: Encounter, allowed: float) -> float:
    """Length of the contact at the allowed penetration, which is also the radius assumed for an edge."""
    return 2.0 * math.sqrt(2.0 * max(met.radius, allowed) * allowed)


def _penalty(met: Encounter, allowed: float, points: int | str) -> float:
    """Penalty that carries the line force at the allowed penetration. eq. (4.29)"""
    spacing = met.length if isinstance(points, str) else met.length / points
    touching = _FLAT * met.thickness if met.flat else 2.0 / 3.0 * _length_at(met, allowed)
    length = max(touching, spacing)
    return min(met.line_force / (allowed * length), _largest(met))


def _largest(met: Encounter) -> float:
    """Largest penalty that an estimate gives, or that grows in a run."""
    return _STIFFEST * met.stiffness / met.thickness


def _points(met: Encounter, penalty: float | None, allowed: float | None, least: int) -> int:
    """Points per direction, such that the contact length contains four, in wide dies too. eq. (4.31)"""
    length = _length(met, penalty, allowed)
    wanted = _WITHIN * met.length / length if length > 0.0 else _MOST
    return min(max(math.ceil(wanted), least), _MOST)


def _length(met: Encounter, penalty: float | None, allowed: float | None) -> float:
    """Contact length, from the penalty or at the allowed penetration."""
    if penalty is not None:
        return contact_length(met.radius, met.line_force, penalty)
    assert allowed is not None
    return _length_at(met, allowed)


def _ripple(met: Encounter | None, meet: Callable[[], Encounter], cells: int, allowed: float | None) -> float | None:
    """Expected relative ripple of the force with cells; None if the law gives no estimate. eq. (4.121)"""
    try:
        met = meet() if met is None else met
    except InvalidPenalty:
        return None
    return ripple_of(met, cells, _default(met) if allowed is None else allowed)


def _cells(met: Encounter, penalty: float | None, allowed: float | None, ripple: float | None) -> int:
    """Cells per direction. eq. (4.122)"""
    allowed = _default(met) if allowed is None else allowed
    return cells_for(met, RIPPLE if ripple is None else ripple, _length(met, penalty, allowed), allowed)


def _default(met: Encounter) -> float:
    """Default allowed penetration."""
    return ALLOWED * met.thickness


def _places(points: int | str | None, cells: int | str | None, where: str) -> int | str:
    """Checked number of points or cells per direction."""
    if cells is None:
        points = _POINTS if points is None else points
        if points not in ("auto", "nodes") and (isinstance(points, str) or points not in range(1, _MOST + 1)):
            raise InvalidValue(
                "contact points per direction must be 1 to 10, 'auto' or 'nodes'", where=where, value=points
            )
        return points
    if points is not None:
        raise InvalidValue(
            "contact is held at points or over cells, not both",
            where=where,
            value=f"points {points}, cells {cells}",
            cause="cells take the place of points",
            remedy="leave one of them away",
        )
    return cells


def _check(penalty: float | None, penetration: float | None, augmented: bool, tool: Surface, where: str) -> None:
    if penalty is not None and not (np.isfinite(penalty) and penalty > 0):
        raise InvalidPenalty(
            "the penalty must be positive",
            where=where,
            value=penalty,
            cause="a sign or a missing value",
            remedy="omit it, and give the penetration that you allow if the default will not do",
        )
    if penetration is not None and not (np.isfinite(penetration) and penetration > 0):
        raise InvalidValue("the penetration that is allowed must be positive", where=where, value=penetration)
    if penalty is not None and penetration is not None and not augmented:
        raise InvalidValue(
            "give the penalty or the penetration that is allowed, and not both",
            where=where,
            value=f"penalty {penalty:g}, penetration {penetration:g}",
            cause="the penalty follows from the penetration",
            remedy="leave one of them away; with augmented=True both may be given",
        )
    if not isinstance(tool, Surface):
        raise InvalidValue(
            "a tool must be a surface",
            where=where,
            value=type(tool).__name__,
            remedy="a tool of umform.surfaces, VDie or Cylinder for instance, or UserSurface(function)",
        )
