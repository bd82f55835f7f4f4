"""Patches of elements in homogeneous states of large strain, and the eigenvalues of their tangents."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from umform import mesh
from umform.errors import SolveError
from umform.materials import J2, NeoHooke
from umform.model import Evaluation, Model
from umform_book.linear_algebra import stiffness
from umform_book.variants import Variant

Floats = NDArray[np.float64]

#: Iterations of the enhanced parameters at given displacements: more than Newton's method takes for them.
_ITERATIONS = 4
POINTS = 8
EDGE = 4.0


@dataclass(frozen=True)
class State:
    """Stretches along the axes; along axes without stress they are adjusted."""

    name: str
    stretches: tuple[float, float, float]
    free: tuple[int, ...]


#: Isochoric stretches to begin with.
STATES = (
    State("uniaxial 0.5", (0.5, 2**0.5, 2**0.5), (1, 2)),
    State("uniaxial 1.5", (1.5, 1.5**-0.5, 1.5**-0.5), (1, 2)),
    State("biaxial 0.7", (0.7, 0.7, 0.7**-2), (2,)),
    State("biaxial 1.4", (1.4, 1.4, 1.4**-2), (2,)),
    State("plane strain 0.5", (0.5, 1.0, 2.0), (2,)),
    State("plane strain 1.5", (1.5, 1.0, 1 / 1.5), (2,)),
    State("through the thickness 0.5", (2**0.5, 2**0.5, 0.5), (0, 1)),
    State("through the thickness 1.5", (1.5**-0.5, 1.5**-0.5, 1.5), (0, 1)),
)


@dataclass(frozen=True)
class Patch:
    """A square patch with edges of 4 and thickness 1: so many elements along an edge, and layers; maybe distorted."""

    variant: Variant
    count: int
    layers: int = 1
    distorted: bool = False

    @property
    def label(self) -> str:
        """Name in tables."""
        name = f"stack of {self.layers} {self.variant.label}" if self.layers > 1 else self.variant.label
        return f"{name}, length {self.length:g} h{', distorted' if self.distorted else ''}"

    @property
    def length(self) -> float:
        """Length of the elements, where they are squares."""
        return EDGE / self.count

    def model(self, material: J2 | NeoHooke) -> Model:
        """The patch without supports."""
        element = self.variant.element
        x = np.linspace(0.0, EDGE, self.count + 1)
        sheet = mesh.grid(x, x, np.linspace(-0.5, 0.5, self.layers + 1), element.cell)
        if self.distorted:
            lines = np.linspace(0.0, EDGE, self.count + 1)
            sheet = sheet.transformed(lambda X: _swirled(X, lines))
        return Model(sheet, element, material=material, thickness_points=POINTS // self.layers)


def _swirled(X: Floats, lines: Floats) -> Floats:
    """Corners moved in the plane by up to 0.3, those of the edges along them; sides between corners stay straight."""

    def wave(x: Floats, half_waves: int, phase: float) -> Floats:
        return np.asarray(np.interp(x, lines, np.sin(half_waves * np.pi * lines / EDGE + phase)))

    x, y = X[:, 0], X[:, 1]
    quarter = 0.5 * np.pi
    moved = wave(x, 1, 0.0) * wave(y, 2, quarter), wave(x, 2, quarter) * wave(y, 1, 0.0), 0.0 * x
    return X + 0.3 * np.column_stack(moved)


def stretch(model: Model, stretches: Floats, path: Sequence[float]) -> Evaluation:
    """Stretch a model homogeneously along a path of parts of the logarithm.

    The tangent is that of the last increment; that of a large plastic one is softer than the tangent of the material.

    Raises
    ------
    SolveError
        If an element fails.
    """
    X = model.mesh.points
    for part in path:
        u = (X * (stretches**part - 1.0)).ravel()
        model.system.revert()
        model.evaluate(model.u)
        model.system.recover(u - model.u)
        for _ in range(_ITERATIONS):
            evaluation = model.evaluate(u)
            if evaluation.failed >= 0:
                raise SolveError("an element failed in a homogeneous state", value=stretches)
            model.system.recover(np.zeros(u.size))
        evaluation = model.evaluate(u)
        model.system.commit(evaluation)
    return evaluation


def stress_free(state: State, material: J2 | NeoHooke, path: Sequence[float]) -> Floats:
    """The stretches of a state without stress along its free axes, found on one element."""
    face = {0: "x1", 1: "y1", 2: "upper"}[state.free[-1]]
    free = list(state.free)

    def stretches(factor: float) -> Floats:
        found = np.array(state.stretches)
        found[free] *= factor
        return found

    def force(factor: float) -> float:
        model = Patch(Variant("ANS3DEAS"), 1).model(material)
        residual = stretch(model, stretches(factor), path).residual
        return float(residual[3 * model.mesh.nodes(face) + free[-1]].sum())

    # plastic flow keeps the volume but for elastic strains; elastic states need not be isochoric at all
    between = (0.995, 1.005) if isinstance(material, J2) else (0.45, 2.2)
    return stretches(float(brentq(force, *between, xtol=1e-9)))


def lowest_eigenvalues(
    patch: Patch, material: J2 | NeoHooke, states: Mapping[str, Floats], path: Sequence[float]
) -> dict[str, tuple[float, int]]:
    """Lowest eigenvalue and number of negative ones of a patch clamped at its lateral sides, for each state."""
    found = {}
    for name, stretches in states.items():
        model = patch.model(material)
        values = _clamped_eigenvalues(model, stretch(model, stretches, path))
        found[name] = float(values[0]), int((values < 0.0).sum())
    return found


def first_loss(patch: Patch, material: J2 | NeoHooke, stretches: Floats, path: Sequence[float]) -> float:
    """Thickness at the first negative eigenvalue on a path of compression; NaN if none comes."""
    model = patch.model(material)
    for part in path:
        if _clamped_eigenvalues(model, stretch(model, stretches, (part,)))[0] < 0.0:
            return float(stretches[2] ** part)
    return float("nan")


def _clamped_eigenvalues(model: Model, evaluation: Evaluation) -> Floats:
    K = stiffness(model, evaluation).toarray()
    X = model.mesh.points[:, :2]
    inner = np.flatnonzero((X.min(axis=1) > 1e-9) & (X.max(axis=1) < EDGE - 1e-9))
    dofs = (3 * inner[:, None] + np.arange(3)).ravel()
    return np.asarray(np.linalg.eigvalsh(K[np.ix_(dofs, dofs)]))
