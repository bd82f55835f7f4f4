"""Settings of a contact: the penalty from the allowed penetration, and the number of points."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Annotated, Literal

from annotated_types import Ge, Gt, Le, Lt

from umform import _core
from umform.errors import InvalidPenalty, InvalidValue
from umform.mesh import Mesh, Selector
from umform.model.contact.cells import MOST, RIPPLE, cells_for, refuse_points_and_cells, ripple_of
from umform.model.contact.encounter import Encounter, Layer, sheet_thickness
from umform.model.contact.friction import AnyFriction, friction_kernel, refuse_slip_alone
from umform.model.contact.own_law import AnyContactLaw
from umform.model.contact.own_stiffness import measured, refuse_beside
from umform.model.contact.penalised import PenaltySettings
from umform.spec import About, check_fields
from umform.spec.types import ContactPoints, Positive
from umform.surfaces import Surface
from umform.surfaces.tool import check_is_surface

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
POINTS = 2
_CELLS = About(cause="a number of cells in all, or a word", remedy="3 on 4-node and 5 on 9-node faces to begin with")


@dataclass(frozen=True)
class ContactOptions:
    """Choices of a contact; the rest follows from mesh, tool and law."""

    penalty: (
        Annotated[
            float,
            Gt(0.0),
            About(
                cause="a sign or a missing value",
                remedy="omit it, and give the penetration that you allow if the default will not do",
                error=InvalidPenalty,
            ),
        ]
        | None
    ) = None
    """Penalty: contact pressure per penetration; by default from the allowed penetration, the strength of the sheet and
    the radius of the tool. eq. (4.29)"""
    penetration: Positive | None = None
    """Allowed penetration, instead of the penalty; by default 1/200 of the thickness. A run that exceeds it warns."""
    augmented: bool = False
    """Remove excess penetration by multipliers; penalty and penetration may then both be given. Costs a few iterations
    per increment."""
    points: ContactPoints | Literal["nodes", "auto"] | None = None
    """Contact points per direction of a face, by default 2: Gauss points, the nodes with their tributary areas, or as
    many as the contact length requires (auto) by eq. (4.31). Use at least 2 on 4-node and 3 on 9-node faces."""
    cells: Annotated[int, Ge(1), Le(MOST), _CELLS] | Literal["auto"] | None = None
    """Cells per direction of a face in place of points: a linear gap is integrated over them up to the moving edge of
    contact, so that the force is smooth; auto: as many as the allowed ripple requires, eq. (4.122). Use at least 3 on
    4-node and 5 on 9-node faces. The tangent is unsymmetric. docs/cells.md"""
    ripple: Annotated[float, Gt(0.0), Lt(1.0), About(cause="per cent", remedy="0.001")] | None = None
    """Allowed ripple for cells = auto, as a fraction of the force; by default 0.001."""
    friction: AnyFriction | None = None
    """Coefficient of friction, or a law; by default none."""
    slip: Annotated[Positive, About(remedy="omit it: 1/200 of the thickness of the sheet is allowed then")] | None = (
        None
    )
    """Elastic slip that is allowed: displacement of a sticking point before it slips, at any pressure; by default 1/200
    of the thickness. Multipliers remove it."""
    law: AnyContactLaw | None = None
    """Contact law of your own, the pressure over the gap, in place of the penalty. docs/contact-laws.md"""

    def __post_init__(self) -> None:
        check_fields(self)
        refuse_beside(self.law, self.penalty, self.augmented, self.points, self.cells)
        if self.penalty is not None and self.penetration is not None and not self.augmented:
            raise InvalidValue(
                "give the penalty or the penetration that is allowed, and not both",
                where="penetration",
                value=f"penalty {self.penalty:g}, penetration {self.penetration:g}",
                cause="the penalty follows from the penetration",
                remedy="leave one of them out; with augmented=True both may be given",
            )
        refuse_points_and_cells(self.points, self.cells)
        refuse_slip_alone(self.friction, self.slip)
        if self.ripple is not None and self.cells != "auto":
            raise InvalidValue(
                "a ripple can be wanted only of cells whose number follows from it",
                where="ripple",
                value=f"ripple {self.ripple}, cells {self.cells}",
                cause="a number of cells, or points",
                remedy="cells='auto'",
            )
        _ = self.friction_law

    @property
    def friction_law(self) -> _core.FrictionLaw | None:
        """The friction law; None without friction."""
        none = self.friction is None or (isinstance(self.friction, int | float) and self.friction == 0)
        return None if none else friction_kernel(self.friction)  # type: ignore[arg-type]


@dataclass(frozen=True, kw_only=True)
class ContactSettings(PenaltySettings):
    """Settings of a contact with a tool.

    Attributes
    ----------
    points : int or "nodes"
        Gauss points per direction and facet, or cells, or the nodes.
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
    law : ContactLaw or CompiledContactLaw, optional
        Pressure over the gap; ``penalty`` is then a measure of its stiffness. eq. (4.282)
    """

    points: int | str
    slip: float = 0.0
    ratio: float = 0.0
    cells: int | None = None
    ripple: float | None = None
    width_points: int | None = None
    law: AnyContactLaw | None = None


def contact_settings(
    mesh: Mesh, faces: Selector, tool: Surface, layers: Sequence[Layer], options: ContactOptions, where: str = "contact"
) -> ContactSettings:
    """Settings from the given values, the rest from mesh, tool and the layers of the sheet, that at the faces first.

    eqs. (4.29), (4.31), (4.122)

    Raises
    ------
    InvalidPenalty, InvalidValue
        If the tool is no surface, or nothing can be estimated.
    """
    check_is_surface(tool, where)
    rows = mesh.face_set(faces)
    thickness = sheet_thickness(mesh, rows)
    penalty, ripple, augmented, slip = options.penalty, options.ripple, options.augmented, options.slip
    over_cells, law, allowed = options.cells is not None, options.friction_law, options.penetration
    points: int | str = options.cells or options.points or POINTS
    if options.law is not None:
        penalty = measured(options.law, ALLOWED * thickness if allowed is None else allowed, where)
    estimated, given = penalty is None or points == "auto", penalty is not None
    if allowed is None and (penalty is None or augmented):
        allowed = ALLOWED * thickness
    met = None
    if estimated:
        met = Encounter.of(mesh, rows, tool.kernel(), layers, where)
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
        meet = partial(Encounter.of, mesh, rows, tool.kernel(), layers, where)
        expected = _ripple(met, meet, number, allowed)
    largest = 0.0 if given or augmented or met is None else _largest(met)
    plain = ContactSettings(
        penalty=float(penalty),
        points=points,
        allowed=allowed,
        augmented=bool(augmented),
        cells=number,
        ripple=expected,
        largest=largest,
        law=options.law,
    )
    if law is None:
        return plain
    slip = _SLIP * thickness if slip is None else float(slip)
    if given or allowed is None:
        pressure = _pressure(mesh, faces, tool, layers, penalty, points)
    else:
        pressure = penalty * allowed
    ratio = _tangential_stiffness(law, pressure, slip) / penalty
    return replace(plain, friction=options.friction, slip=slip, ratio=ratio)


def _pressure(
    mesh: Mesh, faces: Selector, tool: Surface, layers: Sequence[Layer], penalty: float, points: int | str
) -> float:
    """Expected pressure for a penalty. eqs. (4.28), (4.15)"""
    try:
        met = Encounter.of(mesh, mesh.face_set(faces), tool.kernel(), layers, "")
    except InvalidPenalty:  # no estimate: assume the penalty of the default penetration
        return penalty * ALLOWED * sheet_thickness(mesh, mesh.face_set(faces))
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
    return _STIFFEST * met.stiffness / met.depth


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
