"""Drawing: the parameters that all drawn parts have, and what does not fit together."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Self, cast

from annotated_types import Ge, Le

from umform.errors import InvalidValue
from umform.processes.rules import PLASTIC, WITHOUT_RATE, check_contact_points
from umform.processes.solution import drawing_options, solution_keys, usual_pace
from umform.spec import About, check_fields, parameters
from umform.spec.types import ContactPoints, Friction, Penalty, Size

if TYPE_CHECKING:
    from umform.analysis.newton.options import NewtonOptions
    from umform.analysis.steps import Pace
    from umform.materials import Material, Metal
    from umform.materials.j2 import Plastic
    from umform.model import Model
    from umform.problem.problem import Problem
    from umform.processes.draw.press import Press

#: Clearances beside the punch in thicknesses: less is a wrong number rather than ironing, more leaves the sheet loose.
_TIGHTEST, _LOOSEST = 0.9, 20.0

#: Young's modulus in MPa of sheet metal; beyond, another unit is meant.
_YOUNG = (1e3, 1e6)
#: Least pressure of a holder in MPa: one in kN is a thousandth of one in N. The largest is the yield stress.
_LEAST_PRESSURE = 0.02

#: Angle that an element turns over a radius.
Turn = Annotated[float, Ge(1.0), Le(45.0), About("degrees", cause="radians, or a number of elements")]


@dataclass(frozen=True, kw_only=True)
class Draw:
    """A sheet that is held between a die and a holder, and drawn into the die by a punch; in mm, N and MPa."""

    groups: ClassVar = {"thickness": "Sheet", "punch_edge": "Tools", "element": "Solution"}
    """Group of the parameters from each of these on."""
    meshes: ClassVar[dict[str, dict[str, Any]]]
    """What a coarse and a fine mesh have instead of the defaults."""

    thickness: Annotated[
        float, Ge(0.01), Le(100.0), About("mm", cause="metres in place of millimetres, or a sign", remedy="such as 1")
    ]
    """Thickness of the sheet."""
    material: Annotated[Plastic, PLASTIC, WITHOUT_RATE]
    """Law of the sheet."""
    punch_edge: Size
    """Radius of the edge of the punch."""
    die_edge: Size
    """Radius of the edge of the die."""
    friction: Friction
    """Coefficient of friction on all tools."""
    stroke: Size | None = None
    """Travel of the punch."""
    element: str
    """Element of the catalogue."""
    turn: Turn
    """Largest angle that an element turns, over the edge of the punch or of the die."""
    layers: (
        Annotated[
            int, Ge(1), Le(10), About(cause="a thickness", remedy="1 or 2; None follows the rule for sharp bends")
        ]
        | None
    ) = 1
    """Number of layers of elements; None, on the command line 0: as many as the sharpest radius needs, eq. (2.29)."""
    thickness_points: Annotated[int, Ge(2), Le(20), About(cause="the number of layers", remedy="such as 5")] | None = (
        None
    )
    """Number of points through the thickness of each layer; without it, that of the law."""
    contact_points: ContactPoints
    """Number of contact points per direction and facet."""
    penalty: Penalty | None = None
    """Contact pressure per penetration; without it, by the allowed penetration, eq. (4.29)."""
    newton: NewtonOptions = field(default_factory=drawing_options)
    """Tolerances and predictor."""
    pace: Pace = field(default_factory=usual_pace)
    """Increments of the stroke."""

    def __post_init__(self) -> None:
        check_fields(self)
        check_contact_points(self.element, self.contact_points)
        _check_stiffness(self.material)

    def record(self) -> dict[str, Any]:
        """All parameters by name."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @property
    def as_made(self) -> Self:
        """The same with the sizes of tools and press that follow from others as numbers: made once, they stay."""
        raise NotImplementedError

    def problem(self) -> Problem:
        """The computed part of the blank in its tools: held, drawn, released."""
        raise NotImplementedError

    def build(self) -> tuple[Model, Press]:
        """Model of the computed part, and the steps of the press."""
        from umform.processes.draw.press import Press

        made = self.problem().build()
        return made.model, Press.of(made.steps)

    def _sheet(self) -> dict[str, Any]:
        """Tables of the element, the law and the options of the solution."""
        from umform.problem.keys import law_keys

        return {
            "element": {"name": self.element, "thickness_points": self.thickness_points},
            "material": law_keys(cast("Metal", self.material), "x"),
            "solution": solution_keys(self.newton),
        }

    @cached_property
    def needed_layers(self) -> int:
        """Layers by the rule for sharp bends, for the smallest radius of the tools. eq. (2.29)"""
        from umform.elements import element
        from umform.elements.locking import layers_for
        from umform.model.bodies.through_thickness import completed, points_through

        yield_stress, _ = self.material.hardening.curve()(0.0)
        made, law = element(self.element), cast("Material", self.material)
        order = completed(made, law, *points_through(made, law, self.thickness_points, None)).thickness_order
        radius = min(self.punch_edge, self.die_edge)
        return layers_for(order, self.thickness, radius, self.material.kappa / float(yield_stress))

    @property
    def stacked(self) -> int:
        """Layers of elements."""
        return self.needed_layers if self.layers is None else self.layers


def _check_stiffness(material: Plastic) -> None:
    """Refuse a Young's modulus that is not in MPa."""
    if not _YOUNG[0] <= material.E <= _YOUNG[1]:
        raise InvalidValue(
            f"Young's modulus of a metal lies between {_YOUNG[0]:g} and {_YOUNG[1]:g} MPa",
            where="young",
            value=f"{material.E:.4g}",
            cause="GPa, or Pa, in place of MPa",
            remedy="in MPa: 210e3 for steel, 70e3 for aluminium",
        )


def unusual_pressure(force: float | None, flange: float, material: Plastic) -> list[str]:
    """Warning of a holder force in another unit: its pressure is far from usual.

    Parameters
    ----------
    force : float, optional
        On the whole holder.
    flange : float
        Area of the blank between holder and flat of the die.
    material : J2 or Metal
        Law of the sheet.
    """
    if force is None or not flange > 0.0:
        return []
    pressure, strength = force / flange, float(material.hardening.curve()(0.0)[0])
    if _LEAST_PRESSURE <= pressure <= strength:
        return []
    what = f"the holder force of {force:.4g} N is a pressure of {pressure:.3g} MPa on the flange"
    if pressure < _LEAST_PRESSURE:
        return [f"{what}: kN in place of N? The sheet wrinkles under a holder that is too weak; 1 to 5 MPa are usual"]
    return [f"{what}, above the yield stress {strength:.4g}; 1 to 5 MPa are usual"]


def check_clearance(air: float, thickness: float, *, where: str, value: float, remedy: str) -> None:
    """Refuse a clearance between punch and die that does not fit the sheet.

    Parameters
    ----------
    air : float
        Clearance beside the punch.
    thickness : float
        Thickness of the sheet.
    where, value : str, float
        Parameter of the die, for the message.
    remedy : str
        Its usual value.
    """
    if _TIGHTEST * thickness <= air < _LOOSEST * thickness:
        return
    raise InvalidValue(
        "the gap between punch and die does not fit the sheet",
        where=where,
        value=value,
        cause=f"a gap of {air:.4g} beside the punch for a sheet of {thickness:g}; "
        + ("tools of a thinner sheet" if air < thickness else "a diameter for a radius"),
        remedy=remedy,
    )


def tight(air: float, thickness: float, *, what: str, wanted: float) -> list[str]:
    """Warning of a clearance below the thickness, with the usual size of the die."""
    if air >= thickness * (1.0 - 1e-9):
        return []
    text = f"the gap of {air:.4g} between punch and die is smaller than the thickness {thickness:g}: they iron the wall"
    return [f"{text}, and the forces rise; {what} of {wanted:.4g} lets the sheet pass"]


def coarse(case: Draw) -> list[str]:
    """Warn of a mesh that is coarser than the usual one: its numbers are not those of the part."""
    spec: type = type(case)
    usual = parameters(spec)["turn"].default
    if case.turn <= usual:
        return []
    return [
        f"coarse mesh: an element turns {case.turn:g} degrees over a radius, {usual:g} is usual. Forces, thinning, "
        "strains and springback are those of this mesh; they may be off by tens of per cent"
    ]
