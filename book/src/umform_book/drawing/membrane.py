"""Reference of stretching over a punch: an axisymmetric membrane of J2 metal in numpy, with contact and friction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_banded

from umform.materials import J2
from umform_book.drawing.plane_stress import State, flow

Floats = NDArray[np.float64]
_Touch = tuple[Floats, Floats, Floats]

#: Pressure per penetration, MPa/mm; and of that, what elastic slip has.
_PENALTY, _STICK = 2e4, 0.5
#: Newton's method: residual over forces of elements at which it ends, most iterations, least damping in MPa/mm,
#: longest step in mm.
_TOLERANCE, _MOST, _DAMPING, _LONGEST = 1e-7, 200, 1e-3, 1.0
#: First stroke, from which the flat membrane begins as a cone, mm.
_FIRST = 1.0
#: Penetration of that first guess, mm.
_OVERLAP = 1e-4


@dataclass(frozen=True)
class Round:
    """A circle in the meridian plane that the middle of the sheet slides on, at half of the thickness from it.

    Attributes
    ----------
    centre : tuple of float
        (r, z) of its centre at the start.
    radius : float
        Of the tool.
    friction : float
        Coefficient.
    moves : bool
        Whether it moves down with the stroke.
    """

    centre: tuple[float, float]
    radius: float
    friction: float
    moves: bool


@dataclass(frozen=True)
class Sheet:
    """Clamped disc."""

    material: J2
    thickness: float
    radius: float


@dataclass(frozen=True)
class Stretched:
    """The membrane at given strokes.

    Attributes
    ----------
    force : ndarray, shape (strokes,)
        Of the tool that moves.
    place : ndarray, shape (n,)
        Radius of the middle of each element before.
    meridional, hoop, thickness : ndarray, shape (strokes, n)
        Logarithmic strains.
    contact : ndarray, shape (strokes,)
        Radius before of the outermost node that the moving tool touches.
    """

    force: Floats
    place: Floats
    meridional: Floats
    hoop: Floats
    thickness: Floats
    contact: Floats


class Membrane:
    """Conical elements with one point each; contact and friction at the nodes."""

    def __init__(self, sheet: Sheet, tools: tuple[Round, ...], elements: int) -> None:
        self.sheet, self.tools = sheet, tools
        self.R = np.linspace(0.0, sheet.radius, elements + 1)
        self.L, self.middle = np.diff(self.R), 0.5 * (self.R[1:] + self.R[:-1])
        self.volume = 2.0 * np.pi * self.middle * self.L * sheet.thickness
        self.area = np.zeros(elements + 1)
        half = self.volume / (2.0 * sheet.thickness)
        self.area[1:] += half
        self.area[:-1] += half
        self.x = np.stack([self.R, np.zeros_like(self.R)], axis=1)
        self.state = State(np.zeros((elements, 2)), np.zeros(elements))
        self.slip = np.zeros((len(tools), elements + 1))
        self.half = np.full(elements + 1, 0.5 * sheet.thickness)
        self.stroke, self.force, self.reach = 0.0, 0.0, 0.0

    def strains(self, x: Floats) -> Floats:
        """Logarithmic strains (n, 2) along the meridian and around."""
        along = np.linalg.norm(np.diff(x, axis=0), axis=1)
        logs: Floats = np.log(np.stack([along / self.L, 0.5 * (x[1:, 0] + x[:-1, 0]) / self.middle], axis=1))
        return logs

    def thickness_strain(self) -> Floats:
        """Logarithmic thickness strain: plastic flow keeps the volume, elastic strains change it slightly."""
        elastic = self.strains(self.x) - self.state.plastic
        nu = self.sheet.material.nu
        strain: Floats = -self.state.plastic.sum(axis=1) - nu / (1.0 - nu) * elastic.sum(axis=1)
        return strain

    def _inner(self, x: Floats) -> tuple[Floats, Floats, State]:
        """Forces (n, 2, 2) and tangents (n, 4, 4) of the elements."""
        tau, moduli, after = flow(self.sheet.material, self.strains(x), self.state)
        d = np.diff(x, axis=0)
        l2 = (d**2).sum(axis=1)[:, None]
        rm = 0.5 * (x[1:, 0] + x[:-1, 0])
        B = np.zeros((len(d), 2, 4))
        B[:, 0] = np.concatenate([-d, d], axis=1) / l2
        B[:, 1, 0] = B[:, 1, 2] = 0.5 / rm
        f = np.einsum("e,ei,eij->ej", self.volume, tau, B)
        K = np.einsum("e,eik,eij,ejl->ekl", self.volume, B, moduli, B)
        second = np.eye(2) / l2[:, :, None] - 2.0 * np.einsum("ei,ej->eij", d, d) / (l2**2)[:, :, None]
        signs = np.array([[1.0, -1.0], [-1.0, 1.0]])
        K += np.einsum("e,ab,eij->eaibj", self.volume * tau[:, 0], signs, second).reshape(-1, 4, 4)
        K[:, ::2, ::2] -= (self.volume * tau[:, 1] * 0.25 / rm**2)[:, None, None]
        return f, K, after

    def _touch(self, k: int, x: Floats, stroke: float) -> tuple[Floats, Floats, Floats]:
        """Forces (n, 2) of a tool on the nodes, their derivatives (n, 2, 2), elastic slip (n,)."""
        tool = self.tools[k]
        down = np.array([0.0, -1.0]) * (stroke if tool.moves else 0.0)
        back = np.array([0.0, -1.0]) * (self.stroke if tool.moves else 0.0)
        d = x - tool.centre - down
        rho = np.linalg.norm(d, axis=1)
        n = d / rho[:, None]
        t = np.stack([-n[:, 1], n[:, 0]], axis=1)
        gap = rho - tool.radius - self.half
        p = _PENALTY * np.maximum(-gap, 0.0) * self.area
        dp = np.where(gap < 0.0, -_PENALTY, 0.0) * self.area
        way = x - down - self.x + back
        D = (way * t).sum(axis=1)
        stiff = _STICK * _PENALTY * self.area
        trial = np.where(gap < 0.0, stiff * (self.slip[k] + D), 0.0)
        bound = tool.friction * p
        slides = np.abs(trial) > bound
        m = np.where(slides, bound * np.sign(trial), trial)
        f = p[:, None] * n - m[:, None] * t
        tt, nt = np.einsum("ei,ej->eij", t, t), np.einsum("ei,ej->eij", n, t)
        nn, tn = np.einsum("ei,ej->eij", n, n), np.einsum("ei,ej->eij", t, n)
        dm_n = np.where(slides, tool.friction * dp * np.sign(trial), 0.0)
        dm_t = np.where(slides | (gap >= 0.0), 0.0, stiff * (1.0 - (way * n).sum(axis=1) / rho))
        K = dp[:, None, None] * nn + (p / rho)[:, None, None] * tt + (m / rho)[:, None, None] * nt
        K -= dm_n[:, None, None] * tn + dm_t[:, None, None] * tt
        return f, K, m / np.maximum(stiff, 1e-300)

    def _residual(self, x: Floats, stroke: float) -> tuple[Floats, Floats, float, State, list[_Touch]]:
        """Forces out of balance (n, 2), derivatives in diagonals, largest force of an element, state, what tools do."""
        f, K, after = self._inner(x)
        r = np.zeros_like(x)
        r[:-1] += f[:, :2]
        r[1:] += f[:, 2:]
        touches = [self._touch(k, x, stroke) for k in range(len(self.tools))]
        for touch in touches:
            r -= touch[0]
        r[0, 0] = 0.0
        r[-1] = 0.0
        return r, _banded(K, [-touch[1] for touch in touches]), float(np.abs(f).max()), after, touches

    def advance(self, stroke: float, guess: Floats) -> None:
        """Equilibrium at the next stroke from a guess: Newton's method, damped after Levenberg while it is far off."""
        x, damping = guess.copy(), 0.0
        r, A, size, after, touches = self._residual(x, stroke)
        for _ in range(_MOST):
            if float(np.abs(r).max()) < _TOLERANCE * size:
                break
            damped = A.copy()
            damped[3] += damping * np.repeat(self.area, 2)
            dx = _solved(damped, r)
            dx *= min(1.0, _LONGEST / float(np.abs(dx).max()))
            tried = self._residual(x + dx, stroke)
            if np.linalg.norm(tried[0]) < np.linalg.norm(r) * (1.0 + 1e-6) + 1e-9:
                x, damping = x + dx, 0.1 * damping if damping > _DAMPING else 0.0
                r, A, size, after, touches = tried
            else:
                damping = max(10.0 * damping, _DAMPING)
        else:
            raise ArithmeticError(f"the membrane does not converge at a stroke of {stroke:g}")
        self.reach = float(self.R[np.flatnonzero(touches[0][0].any(axis=1))[-1]])
        self.force = -float(touches[0][0][:, 1].sum())
        self.x, self.state, self.stroke = x, after, stroke
        self.slip = np.array([touch[2] for touch in touches])
        thin = 0.5 * self.sheet.thickness * np.exp(self.thickness_strain())
        self.half[1:-1] = 0.5 * (thin[1:] + thin[:-1])
        self.half[0], self.half[-1] = thin[0], thin[-1]


def _banded(K: Floats, nodal: list[Floats]) -> Floats:
    """Element and nodal matrices in the diagonals that solve_banded takes: 3 on each side."""
    size = 2 * (len(K) + 1)
    A = np.zeros((7, size))
    first = 2 * np.arange(len(K))
    for i in range(4):
        for j in range(4):
            A[3 + i - j, first + j] += K[:, i, j]
    first = 2 * np.arange(len(K) + 1)
    for matrix in nodal:
        for i in range(2):
            for j in range(2):
                A[3 + i - j, first + j] += matrix[:, i, j]
    return A


def _solved(A: Floats, r: Floats) -> Floats:
    """Newton's step; the axis and the rim are held: their rows and columns are those of a unit matrix."""
    b = -r.ravel().copy()
    for dof in (0, A.shape[1] - 2, A.shape[1] - 1):
        A[:, dof] = 0.0
        for column in range(max(dof - 3, 0), min(dof + 4, A.shape[1])):
            A[3 + dof - column, column] = 0.0
        A[3, dof], b[dof] = 1.0, 0.0
    step: Floats = solve_banded((3, 3), A, b).reshape(-1, 2)
    return step


def _laid(r: Floats, stroke: float, radius: float) -> Floats:
    """Heights of a membrane that lies on a ball and is straight from there to its rim."""
    slope = np.arcsin(radius / np.hypot(r[-1], radius - stroke)) - np.arctan2(radius - stroke, r[-1])
    ball = radius - stroke - np.sqrt(np.maximum(radius**2 - r**2, 0.0))
    return np.where(r < radius * np.sin(slope), ball + _OVERLAP, (r - r[-1]) * np.tan(slope))


def stretch(
    sheet: Sheet, tools: tuple[Round, ...], strokes: Floats, *, elements: int = 240, step: float = 0.1
) -> Stretched:
    """Push the first tool, which moves, into the sheet; rows at each of the strokes.

    Parameters
    ----------
    sheet : Sheet
        Clamped disc.
    tools : tuple of Round
        The punch first.
    strokes : ndarray
        Rising.
    elements : int
        Along the meridian.
    step : float
        Largest increment of the stroke, mm.
    """
    membrane = Membrane(sheet, tools, elements)
    rows = []
    before = None
    for stroke in strokes:
        start = max(membrane.stroke, _FIRST - step)
        for part in np.linspace(start, stroke, int(np.ceil((stroke - start) / step)) + 1)[1:]:
            guess = membrane.x.copy()
            if before is None:
                guess[:, 1] = _laid(membrane.R, part, tools[0].radius + 0.5 * sheet.thickness)
            elif membrane.stroke > before[1]:
                guess += (membrane.x - before[0]) * (part - membrane.stroke) / (membrane.stroke - before[1])
            before = (membrane.x.copy(), membrane.stroke)
            membrane.advance(float(part), guess)
        strain = membrane.strains(membrane.x)
        rows.append((membrane.force, strain[:, 0], strain[:, 1], membrane.thickness_strain(), membrane.reach))
    force, meridional, hoop, thickness, contact = (np.array(column) for column in zip(*rows, strict=True))
    return Stretched(force, membrane.middle, meridional, hoop, thickness, contact)
