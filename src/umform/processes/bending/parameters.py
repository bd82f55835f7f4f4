"""Parameters of free bending, with the values of the example; light, since the command line reads its defaults here."""

from __future__ import annotations

from dataclasses import asdict, dataclass, fields
from typing import Any

from umform.processes.bending.checks import check_parameters

#: What the numbers of this example rest on; said wherever they are shown.
RECONSTRUCTION = (
    "The geometry is a reconstruction: the paper prints the material, the penalty, the stroke and the meshes, but no "
    "dimensions. Strip, cylinder and supports were chosen so that the example shows what the paper's text describes."
)

#: Displacements at which the forces are compared, as fractions of the stroke: 2, 5, 10 and 15 of 15 mm.
MARKS = (2 / 15, 5 / 15, 10 / 15, 1.0)


@dataclass(frozen=True)
class FreeBending:
    """One case of free bending, in mm, N and MPa.

    Half of a strip, symmetric about x = 0, lies on a rigid frictionless cylinder along y; the lower nodes of x = 0 are
    pushed down by the stroke and released to zero force.

    Parameters
    ----------
    length, width, thickness : float
        Half strip: x from 0 to length, y from 0 to width, mid-surface at z = 0.
    radius, tool_x : float
        Cylinder and the x of the cylinder axis.
    tool_z : float, optional
        z of its axis; by default it just touches the strip.
    kappa, mu : float
        Bulk and shear modulus.
    yield_stress, hardening : float
        Yield stress and linear hardening modulus (0: perfect plasticity).
    penalty : float
        Contact pressure per penetration.
    stroke : float
        Largest displacement.
    steps : int
        Equal increments up to the stroke.
    unload : bool
        Take the displacement back until the force is zero.
    mesh : tuple of int
        Elements along x and y.
    element : str
        Name in the catalogue.
    contact : int or "nodes"
        Gauss points per direction and contact facet, or the nodes.
    thickness_points : int
        Points through the thickness.
    thickness_rule : {"gauss", "lobatto", "split"}
        Where they lie.
    thickness_order : int
        Order of the thickness strain in t: 1 is the paper, 3 is for sharp bends.
    tie_E33 : bool
        Tie the thickness strain at the nodes of the mid-surface.
    solver : str
        Sparse solver.
    line_search : bool
        Shorten increments of Newton's method that go too far.

    Raises
    ------
    InvalidValue
        If a value does not fit; ``where`` is the name of the parameter.

    Notes
    -----
    Order 3 with ``tie_E33`` needs two elements or more over the width: a single bilinear one lets the section tilt
    freely across the strip, and the strip collapses.
    """

    length: float = 60.0
    width: float = 10.0
    thickness: float = 1.0
    radius: float = 20.0
    tool_x: float = 25.0
    tool_z: float | None = None
    kappa: float = 175000.0
    mu: float = 80770.0
    yield_stress: float = 160.0
    hardening: float = 0.0
    penalty: float = 100.0
    stroke: float = 15.0
    steps: int = 300
    unload: bool = True
    mesh: tuple[int, int] = (24, 1)
    element: str = "ANS3DEAS"
    contact: int | str = 2
    thickness_points: int = 5
    thickness_rule: str = "gauss"
    thickness_order: int = 1
    tie_E33: bool = False
    solver: str = "auto"
    line_search: bool = True

    def __post_init__(self) -> None:
        check_parameters({field.name: getattr(self, field.name) for field in fields(self)})

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
