"""A section of a wide sheet that is bent while its tension is held: fibre by fibre, and as one element.

The middle fibre is stretched by l and the section turns by k for each unit of undeformed length. Z is the undeformed
height, y the place of a fibre above the middle one. The radial load that the tension needs acts at the middle fibre:

    l_1 = l + k y,   y' = l_3,   N = int S_11 l_1 dZ,   M = int S_11 l_1 y dZ,
    (S_33 l_3)' = k (S_11 l_1 - N delta(Z)).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform import Mesh, Model, _core
from umform.elements import element as catalogue_element
from umform.errors import SolveError
from umform.materials import Metal
from umform.mesh import strip

Floats = NDArray[np.float64]

FIBRES = 2000
#: Most iterations, and the largest change of a strain in one.
_ITERATIONS, _STEP = 200, 5e-3


class FibreSection:
    """Fibres of equal height that are free to move against each other.

    Parameters
    ----------
    law : Metal
        The law; its forces are those of its yield stress.
    fibres : int
        Number of fibres, even.
    """

    def __init__(self, law: Metal, fibres: int = FIBRES) -> None:
        self.law = law.law()
        self.h = 1.0 / fibres
        self.Z: Floats = np.asarray((np.arange(fibres) + 0.5) * self.h - 0.5, dtype=np.float64)
        self.history: Floats = np.tile(self.law.initial(), (fibres, 1))
        self.E33: Floats = np.zeros(fibres, dtype=np.float64)
        self.Q: Floats = np.zeros(fibres)
        self.stretch, self.curvature, self.moment, self.force = 1.0, 0.0, 0.0, 0.0

    @property
    def thickness(self) -> float:
        """Of the bent sheet, over that of the flat one."""
        return float(np.sqrt(1.0 + 2.0 * self.E33).mean())

    def bend(self, curvature: float, force: float, increments: int) -> None:
        """Hold the force and bend in equal increments."""
        begin, begun = self.curvature, self.force
        for part in np.linspace(0.0, 1.0, increments + 1)[1:]:
            self._settle(begin + part * (curvature - begin), begun + part * (force - begun), self.law.respond)

    def released(self) -> float:
        """Curvature without force and moment; the section itself stays as it is."""
        kept = dict(vars(self))
        slope, k, moment = 0.0, self.curvature, self.moment
        for _ in range(12):
            trial = k - (moment / slope if slope else 1e-3 * np.sign(moment))
            self._settle(trial, 0.0, self.law.respond)
            slope, k, moment = (self.moment - moment) / (trial - k), trial, self.moment
            if abs(moment) < 1e-7:
                break
            self.history = kept["history"]
        vars(self).update(kept)
        return k

    def _settle(self, k: float, force: float, respond: Any) -> None:
        """Equilibrium at a curvature and a force, by Newton's method for each fibre and for the stretch."""
        stretch, E33, Q, history = self.stretch, self.E33.copy(), self.Q, self.history
        E, half = np.zeros((len(E33), 6)), len(E33) // 2
        for _ in range(_ITERATIONS):
            l3 = np.sqrt(1.0 + 2.0 * E33)
            y = (np.cumsum(l3) - 0.5 * l3) * self.h
            y -= y[half] - 0.5 * l3[half] * self.h
            l1 = stretch + k * y
            E[:, 0], E[:, 2] = 0.5 * (l1**2 - 1.0), E33
            S, C, history = respond(E, self.history)
            P = S[:, 0] * l1
            N = float(P.sum() * self.h)
            Q = k * ((np.cumsum(P) - 0.5 * P) * self.h - N * (self.Z > 0.0))
            miss = S[:, 2] * l3 - Q
            if abs(N - force) < 1e-7 and np.abs(miss).max() < 1e-5:
                break
            thinner = -miss / (C[:, 2, 2] * l3 + S[:, 2] / l3)
            modulus = (C[:, 0, 0] - C[:, 0, 2] * C[:, 2, 0] / C[:, 2, 2]) * l1**2
            growth = (force - N - float((C[:, 0, 2] * l1 * thinner).sum() * self.h)) / float(modulus.sum() * self.h)
            growth = float(np.clip(growth, -_STEP, _STEP))
            stretch += growth
            E33 = E33 + np.clip(thinner - C[:, 2, 0] / C[:, 2, 2] * l1 * growth, -_STEP, _STEP)
        else:
            raise SolveError("no equilibrium of the fibres", where=f"curvature {k:.4g}")
        self.E33, self.Q, self.history, self.stretch, self.curvature = E33, Q, history, stretch, k
        self.moment, self.force = float((P * y).sum() * self.h), force


def _turned(cells: NDArray[np.int32], turns: int) -> NDArray[np.int32]:
    """Cells whose nodes are numbered from another corner: corners, then middles of the sides, then the centre."""
    half = cells.shape[1] // 2
    face = np.arange(half)
    for ring in (slice(0, 4), slice(4, 8)):
        face[ring] = np.roll(face[ring], -turns)
    return np.ascontiguousarray(cells[:, np.concatenate([face, face + half])])


class ElementSection:
    """One element, whose nodes follow the section: the middle fibre on an arc, the directors straight.

    Parameters
    ----------
    element : str
        Name in the catalogue.
    law : Metal
        The law.
    length : float
        Of the element, whose thickness is one.
    turns : int
        Quarter turns of the numbering of its nodes.
    **options
        Of the model, points through the thickness for instance.
    """

    def __init__(self, element: str, law: Metal, length: float = 0.5, turns: int = 0, **options: Any) -> None:
        flat = strip(length, length, 1.0, (1, 1), cell=catalogue_element(element).cell)
        self.mesh = Mesh(flat.points, {flat.cell: _turned(flat.connectivity, turns)})
        self.length = length
        self.body = Model(self.mesh, element, material=law, **options).bodies.only
        self.block = self.body.block
        self.x = self.mesh.points[:, 0] - 0.5 * length
        middle = 0.5 * (self.mesh.points[:, 2].min() + self.mesh.points[:, 2].max())
        self.z = self.mesh.points[:, 2] - middle
        equation = np.arange(self.mesh.points.size, dtype=np.int32)
        self.pattern = _core.Pattern(equation, [self.block.connectivity], self.block.symmetric)
        self.scatter = self.pattern.scatter(self.block.connectivity)
        self.order = (3 * self.mesh.connectivity[0][:, None] + np.arange(3)).ravel()
        self.unknowns: Floats = np.array([1.0, 1.0, 0.0])  # stretch, director, curvature
        self.force = self.moment = 0.0

    @property
    def stretch(self) -> float:
        """Of the middle fibre."""
        return float(self.unknowns[0])

    @property
    def thickness(self) -> float:
        """Of the bent sheet, over that of the flat one."""
        return float(self.unknowns[1])

    def bend(self, curvature: float, force: float, increments: int) -> None:
        """Hold the force and bend in equal increments."""
        begin, begun = self.unknowns[2], self.force
        for part in np.linspace(0.0, 1.0, increments + 1)[1:]:
            self._go(begin + part * (curvature - begin), begun + part * (force - begun))

    def _go(self, curvature: float, force: float, cuts: int = 4) -> None:
        """One increment, in halves where Newton's method fails."""
        kept, before = self.unknowns.copy(), self.force
        self.unknowns[2] = curvature
        try:
            self._settle(force, 2)
        except SolveError:
            if cuts == 0:
                raise
            self.unknowns, self.force = kept, before
            self.block.revert()
            self._go(0.5 * (kept[2] + curvature), 0.5 * (before + force), cuts - 1)
            self._go(curvature, force, cuts - 1)
        else:
            self.block.commit()

    def released(self) -> float:
        """Curvature without force and moment; the section itself stays as it is."""
        kept = self.unknowns.copy(), self.force, self.moment, self.block.state, self.block.alpha
        self._settle(0.0, 3)
        k = float(self.unknowns[2])
        self.unknowns, self.force, self.moment = kept[:3]
        self.block.restore(*kept[3:])
        return k

    def displacement(self) -> Floats:
        """Of all nodes."""
        origin = self.mesh.points - [0.5 * self.length, 0.0, 0.0]
        origin[:, 2] = self.z
        return np.asarray(self._position(self.unknowns) - origin.ravel())

    def _position(self, unknowns: Floats) -> Floats:
        stretch, d, k = unknowns
        angle = k * self.x
        bent = np.where(np.abs(angle) > 1e-9, angle, 1.0)
        along = stretch * self.x * np.where(np.abs(angle) > 1e-9, np.sin(bent) / bent, 1.0)
        up = -stretch * self.x * np.where(np.abs(angle) > 1e-9, (1.0 - np.cos(bent)) / bent, 0.0)
        place = [along + self.z * d * np.sin(angle), self.mesh.points[:, 1], up + self.z * d * np.cos(angle)]
        return np.asarray(np.stack(place, axis=1).ravel())

    def _slopes(self) -> Floats:
        steps = 1e-6 * np.eye(3)
        slopes = [self._position(self.unknowns + s) - self._position(self.unknowns - s) for s in steps]
        return np.asarray(np.stack(slopes, axis=1) / 2e-6)

    def _settle(self, force: float, free: int) -> None:
        """Equilibrium with the first unknowns free."""
        area, before = self.length**2, None
        for _ in range(60):
            u = self.displacement()
            if before is not None:
                self.block.recover(u - before)
            before = u
            f, values = np.zeros(u.size), np.zeros(self.pattern.indices.size)
            failed, *_ = self.block.evaluate(u, self.scatter, f, values, None, None)
            if failed >= 0:
                break
            P = self._slopes()[self.order]
            K, f = self.block.element(0, u)
            loads = P.T @ f / area - [force, 0.0, 0.0]
            self.moment = float(loads[2])
            if np.abs(loads[:free]).max() < 1e-6:
                self.force = force
                return
            self.unknowns[:free] -= np.linalg.solve((P.T @ K @ P / area)[:free, :free], loads[:free])
        raise SolveError("no equilibrium of the bent element", where=f"curvature {self.unknowns[2]:.4g}")
