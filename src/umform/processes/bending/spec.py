"""Free bending: its parameters, with the values of the example, and what does not fit together."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Annotated, Any, ClassVar, Literal

from annotated_types import Ge, Le

from umform.errors import InvalidValue
from umform.processes.rules import whole
from umform.spec import About, Checked, check_fields, names_its_words
from umform.spec.types import ContactPoints, Length, Penalty, Stress

#: What the numbers of this example rest on; said wherever they are shown.
RECONSTRUCTION = (
    "The geometry is a reconstruction: the paper prints the material, the penalty, the stroke and the meshes, but no "
    "dimensions. Strip, cylinder and supports were chosen so that the example shows what the paper's text describes."
)

#: Displacements at which the forces are compared, as fractions of the stroke: 2, 5, 10 and 15 of 15 mm.
MARKS = (2 / 15, 5 / 15, 10 / 15, 1.0)


#: Contact points per direction and facet, or the nodes.
ContactRule = int | Literal["nodes"]
#: A coordinate of the axis of the cylinder.
_Place = Annotated[float, About("mm", cause="a missing value")]


def _check_mesh(mesh: Sequence[int], name: str) -> None:
    """Refuse other than two counts; they are shown as they are typed."""
    if len(mesh) != 2 or not all(whole(count, 1) for count in mesh):
        raise InvalidValue(
            "a mesh has one element or more along and across the strip",
            where=name,
            value="x".join(map(str, mesh)),
            cause="zero, or one of the two numbers is missing",
            remedy="such as 24x1",
        )


@names_its_words
@dataclass(frozen=True)
class FreeBending:
    """One case of free bending, in mm, N and MPa.

    Half of a strip, symmetric about x = 0, lies on a rigid frictionless cylinder along y; the lower nodes of x = 0 are
    pushed down by the stroke and released to zero force.

    Notes
    -----
    Order 3 with ``tie_E33`` needs two elements or more over the width: a single bilinear one lets the section tilt
    freely across the strip, and the strip collapses.
    """

    groups: ClassVar = {
        "length": "Strip and tool",
        "kappa": "Material",
        "penalty": "Solution",
        "mesh": "Which runs",
        "solver": "Solution",
    }
    """Group of the parameters from each of these on."""

    length: Length = 60.0
    """Length of the half strip."""
    width: Length = 10.0
    """Width of the strip."""
    thickness: Length = 1.0
    """Thickness of the strip."""
    radius: Length = 20.0
    """Radius of the cylinder."""
    tool_x: _Place = 25.0
    """Distance of the axis of the cylinder from the middle of the strip."""
    tool_z: _Place | None = None
    """Height of the axis of the cylinder above the mid-surface; without it, the cylinder just touches the strip."""
    kappa: Stress = 175000.0
    """Bulk modulus."""
    mu: Stress = 80770.0
    """Shear modulus."""
    yield_stress: Stress = 160.0
    """Yield stress."""
    hardening: Annotated[
        float, Ge(0.0), About("MPa", cause="softening needs a length scale that this law does not have")
    ] = 0.0
    """Linear hardening modulus; 0 is perfect plasticity."""
    penalty: Penalty = 100.0
    """Contact pressure per penetration."""
    stroke: Annotated[Length, About(cause="a sign: the stroke counts downwards")] = 15.0
    """Stroke: the largest displacement."""
    steps: Annotated[int, Ge(1), About(cause="zero or a sign")] = 300
    """Number of equal increments up to the stroke; with fewer than 60 the forces are coarse."""
    unload: bool = True
    """Whether the displacement is taken back until the force is zero."""
    mesh: Annotated[tuple[int, int], Checked(_check_mesh)] = (24, 1)
    """Elements along and across the strip."""
    element: str = "ANS3DEAS"
    """Element of the catalogue."""
    contact: Annotated[ContactPoints | Literal["nodes"], About(remedy="such as 2, 5 or nodes")] = 2
    """Number of contact points per direction and facet, or the nodes."""
    thickness_points: Annotated[int, Ge(2), Le(15), About(cause="there are no rules with fewer or more points")] = 5
    """Number of points through the thickness."""
    thickness_rule: Annotated[Literal["gauss", "lobatto", "split"], About(cause="a typing error")] = "gauss"
    """Rule of these points: gauss, lobatto or split."""
    thickness_order: Annotated[int, Ge(1), Le(4), About(cause="there are no modes of other orders")] = 1
    """Order of the thickness strain: 1 is the paper, 3 is for sharp bends."""
    tie_E33: bool = False
    """Whether the thickness strain is tied at the nodes of the mid-surface."""
    solver: str = "auto"
    """Sparse solver: auto, multifrontal, banded, pardiso or superlu."""
    line_search: bool = True
    """Whether increments of Newton's method that go too far are shortened."""

    def __post_init__(self) -> None:
        check_fields(self)
        _check_thickness(self.thickness_points, self.thickness_order, self.thickness_rule)
        _check_room(self)

    @property
    def centre(self) -> tuple[float, float, float]:
        """A point on the axis of the cylinder."""
        z = -(self.radius + 0.5 * self.thickness) if self.tool_z is None else self.tool_z
        return (self.tool_x, 0.0, z)

    @property
    def marks(self) -> tuple[float, ...]:
        """Displacements at which the forces are compared."""
        return tuple(self.stroke * fraction for fraction in MARKS)

    @property
    def mesh_name(self) -> str:
        """The mesh as in 24x1."""
        return f"{self.mesh[0]}x{self.mesh[1]}"

    @property
    def contact_name(self) -> str:
        """The contact rule: nodes, 2x2, ..."""
        return "nodes" if self.contact == "nodes" else f"{self.contact}x{self.contact}"

    @property
    def is_paper_element(self) -> bool:
        """Whether the thickness strain is that of the paper: linear, and tied nowhere."""
        return self.thickness_order == 1 and not self.tie_E33

    @property
    def variant_name(self) -> str:
        """What sets the thickness strain apart from that of the paper; empty if nothing does."""
        order = f"order {self.thickness_order}" if self.thickness_order != 1 else ""
        return " ".join(part for part in (order, "tied" if self.tie_E33 else "") if part)

    @property
    def name(self) -> str:
        """Short name of the run."""
        parts = (self.element, self.mesh_name, self.contact_name, self.variant_name)
        return " ".join(part for part in parts if part)

    def problem(self) -> dict[str, Any]:
        """Settings of the physical problem and of its steps, which all runs of a comparison share."""
        discretisation = (
            "mesh",
            "element",
            "contact",
            "thickness_points",
            "thickness_rule",
            "thickness_order",
            "tie_E33",
        )
        settings = asdict(self) | {"tool_z": self.centre[2]}
        return {key: value for key, value in settings.items() if key not in discretisation}

    @property
    def is_example(self) -> bool:
        """Whether strip, cylinder, material and stroke are those of the example, so that its references hold."""
        numerical = ("steps", "unload", "solver", "line_search")
        mine, example = self.problem(), FreeBending().problem()
        return all(mine[key] == example[key] for key in mine if key not in numerical)


def _check_room(case: FreeBending) -> None:
    """Reject a stroke that the cylinder and its mirror image leave no room for.

    The sheet can at most be folded about its upper face: its lower face is then an arc of radius t about a point of
    x = 0, which goes down with the stroke and must stay clear of the cylinder.
    """
    t, R, (x, _, z), stroke = case.thickness, case.radius, case.centre, case.stroke
    if not 0.0 <= x < R + t or z >= 0.5 * t:
        return
    room = 0.5 * t - z - math.sqrt((R + t) ** 2 - x**2)
    if 0.0 <= room < stroke:
        raise InvalidValue(
            "the cylinder leaves no room for the stroke",
            where="stroke",
            value=stroke,
            cause=f"between it, with radius {R:g} at x = {x:g}, and its mirror image a sheet of {t:g} can go down by "
            f"{room:.4g} at most",
            remedy=f"a smaller stroke, a smaller radius, or tool_x={R + t:g} or more",
        )


def _check_thickness(points: int, order: int, rule: str) -> None:
    if points <= order:
        raise InvalidValue(
            f"thickness order {order} needs at least {order + 1} thickness points",
            where="thickness_points",
            value=points,
            cause="fewer points cannot see the highest mode",
            remedy=f"thickness_points={order + 1} or more",
        )
    if rule == "split" and points % 2:
        raise InvalidValue(
            "the split rule needs an even number of thickness points",
            where="thickness_points",
            value=points,
            cause="it puts as many points into one half of the thickness as into the other",
            remedy=f"thickness_points={points - 1 if points == 15 else points + 1}",
        )
