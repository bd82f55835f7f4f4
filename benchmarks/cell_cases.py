"""Problems that contact at points and over cells are compared on."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

import needs_book  # noqa: F401
import umform as uf
from umform import materials as mt
from umform import mesh as meshes
from umform.elements import element
from umform_book.contact import half_space

Floats = NDArray[np.float64]
Rule = dict[str, Any]

STEEL = mt.J2(E=210e3, nu=0.3, hardening=mt.Swift(strength=520.0, offset=0.004, exponent=0.22))


@dataclass(frozen=True)
class Curve:
    """Way and force of what is driven, and what it took.

    Attributes
    ----------
    way, force : ndarray
        Of the control, increment by increment.
    iterations : int
        All together.
    seconds : float
        CPU time.
    drift : float
        Largest of the balance.
    penetration : float
        The largest.
    cells : str
        Their number at each tool.
    expected : float, optional
        Ripple to expect of the cells of all tools.
    """

    way: Floats
    force: Floats
    iterations: int
    seconds: float
    drift: float
    penetration: float
    cells: str
    expected: float | None

    def deviation(self, reference: Curve) -> float:
        """Root of the mean square of the difference of the forces, over that of the force."""
        force = np.interp(reference.way, self.way, self.force)
        return float(np.sqrt(np.mean((force - reference.force) ** 2) / np.mean(reference.force**2)))

    def ripple(self, reference: Curve) -> float:
        """The same without what changes slowly: the difference less the cubic polynomial in the way next to it."""
        difference = np.interp(reference.way, self.way, self.force) - reference.force
        smooth = np.polynomial.Polynomial.fit(reference.way, difference, 3)(reference.way)
        return float(np.sqrt(np.mean((difference - smooth) ** 2) / np.mean(reference.force**2)))

    def jump(self) -> float:
        """Largest change of slope from one increment to the next, over the largest force, per length."""
        slope = np.diff(self.force) / np.diff(self.way)
        late = self.way[1:-1] > 0.2 * self.way[-1]  # behind the first yield
        return float(np.abs(np.diff(slope))[late].max() / np.abs(self.force).max())


class Problem(Protocol):
    """What is solved with any rule."""

    @property
    def name(self) -> str:
        """As in the tables."""
        ...

    def bend(self, rule: Rule, steps: int) -> Curve:
        """Solve it in so many increments."""
        ...


def solved(model: uf.Model, driven: Any, to: float, steps: int, names: tuple[str, ...]) -> Curve:
    """Drive it, and measure."""
    start = time.process_time()
    result = uf.solve(model, uf.Move(driven, to=to, steps=steps), frames=0)
    seconds = time.process_time() - start
    drift = float(np.abs(result.balance().drift).max())
    way, sign = result[driven.name], 1.0 if to > 0 else -1.0
    deepest = max(float(result[f"{name}_penetration"].max()) for name in names)
    ripples = [contact.ripple for contact in model.contacts if contact.ripple is not None]
    cells = "/".join(str(contact.cells) for contact in model.contacts)
    return Curve(
        sign * way, sign * result[f"{driven.name}_force"], int(result["iterations"].sum()), seconds, drift, deepest,
        cells, sum(ripples) if ripples else None,
    )  # fmt: skip


@dataclass(frozen=True)
class Strip:
    """A strip that is bent over a cylinder.

    Attributes
    ----------
    element : str
        Name in the catalogue.
    cells : tuple of int
        Elements along x and y.
    penalty : float
        Pressure per penetration.
    shape : {"", "graded", "distorted"}
        Whether the elements differ in size by a factor of four, or are no rectangles.
    friction : float, optional
        Coefficient of friction.
    """

    element: str
    cells: tuple[int, int]
    penalty: float
    shape: str = ""
    friction: float | None = None

    @property
    def name(self) -> str:
        """As in the tables."""
        shape = f", {self.shape}" if self.shape else ""
        rough = "" if self.friction is None else f", friction {self.friction}"
        return f"{self.element} {self.cells[0]}x{self.cells[1]}{shape}, {self.penalty:g}{rough}"

    def mesh(self) -> meshes.Mesh:
        """The half strip, symmetric about x = 0."""
        mesh = meshes.strip(60.0, 10.0, 1.0, self.cells, cell=element(self.element).cell)
        x, y = mesh.points[:, 0].copy(), mesh.points[:, 1].copy()
        if self.shape == "distorted":
            inside = np.sin(np.pi * x / 60.0)
            mesh.points[:, 0] += inside * (0.8 * np.sin(2.1 * x) + 0.6 * np.sin(0.6 * y + 0.9 * x))
            mesh.points[:, 1] += 0.12 * y * (10.0 - y) * np.sin(1.3 * x)
        if self.shape == "graded":
            mesh.points[:, 0] -= 0.6 / (2.0 * np.pi / 15.0) * np.sin(2.0 * np.pi * x / 15.0)
        return mesh

    def bend(self, rule: Rule, steps: int) -> Curve:
        """Push its lower edge at x = 0 down."""
        law = mt.J2(kappa=175000.0, mu=80770.0, hardening=mt.Perfect(160.0))
        mesh = self.mesh()
        model = uf.Model(mesh, self.element, material=law, thickness_order=1, thickness_points=5)
        model.symmetry("x0", normal="x")
        punch = model.prescribe("x0_lower", "z", name="punch")
        model.fix(np.intersect1d(mesh.nodes("x0_lower"), mesh.nodes("y0_lower")), "y")
        tool = uf.Cylinder(centre=(25, 0, -20.5), axis="y", radius=20)
        model.contact("lower", tool, penalty=self.penalty, friction=self.friction, name="tool", **rule)
        return solved(model, punch, -15.0, steps, ("tool",))


@dataclass(frozen=True)
class Brake:
    """A sheet of 2 mm in a die of 16 mm, plane strain; elements of 0.5 mm and the default penetration.

    Attributes
    ----------
    name : str
        As in the tables.
    shoulder, tip : float
        Radii of die and punch.
    """

    name: str
    shoulder: float
    tip: float

    def bend(self, rule: Rule, steps: int) -> Curve:
        """Drive the punch."""
        mesh = meshes.strip(16.0, 1.0, 2.0, (32, 1)).moved((0.0, 0.0, 1.0))
        model = uf.Model(mesh, "ANS3DEAS", material=STEEL, thickness_order=1, thickness_points=5)
        model.symmetry("x0", "x")
        model.fix(np.arange(len(mesh.points)), "y")
        model.contact("lower", uf.VDie(16.0, 85.0, self.shoulder), name="die", **rule)
        punch = model.contact("upper", uf.Punch(self.tip, 85.0, origin=(0.0, 0.0, 2.0)), name="punch", **rule)
        return solved(model, model.drive(punch, "-z", name="stroke"), 4.5, steps, ("die", "punch"))


@dataclass(frozen=True)
class Hertz:
    """A rigid cylinder of R = 200 that is pressed into an elastic block, until the contact is 1 wide on each side.

    Attributes
    ----------
    size : float
        Length of the elements next to the contact.
    """

    size: float

    @property
    def name(self) -> str:
        """As in the tables."""
        return f"Hertz, elements of {self.size:g} half-widths"

    def bend(self, rule: Rule, steps: int) -> Curve:
        """Drive the cylinder."""
        body = half_space.block(self.size, 40.0, 1.35, "hex8", plane=True)
        model = uf.Model(body, "ANS3DEAS", material=mt.SVK(E=half_space.E, nu=half_space.NU))
        model.symmetry("x0", "x")
        model.symmetry(np.arange(len(body.points)), "y")
        model.fix("lower", "z")
        tool = uf.Cylinder((0.0, 0.0, 200.0), "y", 200.0)
        contact = model.contact("upper", tool, penalty=100.0 * half_space.E_STAR, name="tool", **rule)
        return solved(model, model.drive(contact, "-z", name="depth"), 0.0115, steps, ("tool",))


PROBLEMS: list[Problem] = [
    *(
        Strip(name, cells, penalty, shape)
        for name, cells, shape in (
            ("ANS3DEAS", (24, 1), ""),
            ("MI9K3DEAS", (12, 1), ""),
            ("ANS3DEAS", (24, 3), "distorted"),
            ("ANS3DEAS", (24, 1), "graded"),
        )
        for penalty in (100.0, 1e4)
    ),
    Strip("ANS3DEAS", (24, 1), 1e4, friction=0.1),
    Brake("air bending, shoulder 2", 2.0, 1.5),
    Brake("V-die, sharp shoulder 0.4", 0.4, 0.4),
    Hertz(0.5),
]
