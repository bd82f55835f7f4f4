"""Transfer of the state of elements to elements that lie elsewhere in the same sheet.

What the points of the new elements keep is the elastic strain: a plastic strain that is interpolated beside a total one
that is not leaves stresses of the size of the difference. docs/theory, eqs. (1.32), (1.33)
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform import _core
from umform.errors import InvalidValue
from umform.history_variables import named
from umform.materials import J2, SVK, Metal
from umform.mesh import Mesh
from umform.mesh.fitted.places import bilinear, located
from umform.mesh.fitted.sheet import Sheet
from umform.model.bodies.body import Body

Floats = NDArray[np.float64]
Numbers = NDArray[np.int64]

_PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))
#: Newton iterations for the thickness strain; a strain that counts as zero.
_ITERATIONS, _ZERO = 12, 1e-14


def can_transfer(body: Body) -> bool:
    """Whether the meaning of the history of a body is known: of elastic laws, J2 and Metal."""
    return isinstance(body.material, J2 | Metal) or len(body.material.law().initial()) == 0


@dataclass(frozen=True)
class Weights:
    """For each in-plane point of new stacks the points of the old one in which it lies, and their shares. eq. (1.32)

    Attributes
    ----------
    stacks : ndarray of int
        Old stacks in which they lie, ascending.
    of : ndarray of int, shape (new, points, 4)
        Rows of points, in the order of the old stacks.
    share : ndarray, shape (new, points, 4)
        Not negative; their sum is one.
    heights : ndarray, shape (points, layers)
        Of the points through the thickness, over each in-plane point of a stack.
    """

    stacks: Numbers
    of: Numbers
    share: Floats
    heights: Floats

    @classmethod
    def between(
        cls, sheet: Sheet, x: Floats, stacks: Numbers, new: Floats, rule: tuple[int, int], t: Floats
    ) -> Weights:
        """Bilinear interpolation between the points of an old stack, no further than to the last one.

        Parameters
        ----------
        sheet : Sheet
            The old sheet, with middles of its fibres x (fibres, 2).
        stacks : ndarray of int
            Those of it in which they may lie.
        new : ndarray, shape (new, 4, 2)
            Corners of the new ones.
        rule : tuple of int
            Points in r and s.
        t : ndarray, shape (layers,) or (points, layers)
            Heights of the points through the thickness.
        """
        own = _in_plane(rule)
        targets = np.einsum("qa,eai->eqi", own, new).reshape(-1, 2)
        places = located(targets, x, sheet.quads[stacks])
        used, quad = np.unique(places.quad, return_inverse=True)
        (i, a), (j, b) = (_between(_core.gauss(n)[0], places.rs[:, k]) for k, n in enumerate(rule))
        row = quad.reshape(-1, 1) * len(own) + np.stack(
            [j[:, p] * rule[0] + i[:, q] for p in (0, 1) for q in (0, 1)], 1
        )
        share = np.stack([b[:, p] * a[:, q] for p in (0, 1) for q in (0, 1)], axis=1)
        shape = (len(new), len(own), 4)
        heights = np.broadcast_to(t, (len(own), np.shape(t)[-1]))
        return cls(stacks[used], row.reshape(shape), share.reshape(shape), heights)

    def mean(self, values: Floats) -> Floats:
        """Means (new, points, ...) of values (old, points, ...) at all points, height by height."""
        across = self.of.shape[1]
        layers = np.moveaxis(values.reshape(len(values), -1, across, *values.shape[2:]), 1, 2)
        flat = layers.reshape(-1, *layers.shape[2:])  # [stack and point in the plane][layer]
        to, of = np.arange(across)[None, :, None], self.of % across
        there = np.einsum("eqkab,eqkb...->eqka...", self._between_heights()[to, of], flat[self.of])
        mean = np.moveaxis(np.einsum("eqk,eqk...->eq...", self.share, there), 2, 1)
        out: Floats = mean.reshape(len(mean), -1, *values.shape[2:])
        return out

    def _between_heights(self) -> Floats:
        """Linear interpolation from the heights of one column to those of another [to][of], and beyond their ends."""
        return np.array([[_line_through(of, to) for of in self.heights] for to in self.heights])


def _in_plane(rule: tuple[int, int]) -> Floats:
    """Shape functions (points, 4) at the points of a rule in r and s; r changes first."""
    s, r = np.meshgrid(_core.gauss(rule[1])[0], _core.gauss(rule[0])[0], indexing="ij")
    return bilinear(np.stack([r.ravel(), s.ravel()], axis=1))[0]


def _between(points: Floats, at: Floats) -> tuple[Numbers, Floats]:
    """For places on a line the two points around each one (n, 2), and their shares; beyond the last one it has all."""
    after = np.clip(np.searchsorted(points, at), 1, max(len(points) - 1, 1))
    ends = np.minimum(np.stack([after - 1, after], axis=1), len(points) - 1)
    low, high = points[ends].T
    share = np.clip((at - low) / np.where(high > low, high - low, 1.0), 0.0, 1.0)
    return ends, np.stack([1.0 - share, share], axis=1)


def _line_through(points: Floats, at: Floats) -> Floats:
    """Shares (at, points) of the two points around each place, or of the last two beyond them."""
    shares = np.ones((len(at), len(points)))
    if len(points) > 1:
        after = np.clip(np.searchsorted(points, at), 1, len(points) - 1)
        share = (at - points[after - 1]) / (points[after] - points[after - 1])
        shares = np.zeros((len(at), len(points)))
        shares[np.arange(len(at)), after - 1], shares[np.arange(len(at)), after] = 1.0 - share, share
    return shares


class Transfer:
    """The state of old cells of one layer, moved to new ones. eqs. (1.32), (1.33)

    Parameters
    ----------
    old : Body
        The body of the whole sheet, in its state.
    cells : ndarray of int
        Its rows on the old stacks of the weights.
    u : ndarray
        Its displacement.
    weights : Weights
        Of the points of the new cells.
    """

    def __init__(self, old: Body, cells: Numbers, u: Floats, weights: Weights) -> None:
        self._old, self._weights = old, weights
        block = old.block
        E, self._frame = _strains(old, cells, u, block.alpha[cells], old.mesh)
        self._parts = _parts(block.history_variables, block.state[cells])
        if self._parts:
            self._elastic = _elastic(self._parts, E, _logarithm(E), isinstance(old.material, J2))

    def to(self, new: Body, own: Numbers, mesh: Mesh, u: Floats, plastic: NDArray[np.bool_]) -> tuple[Floats, Floats]:
        """History and enhanced parameters of new cells of one layer.

        Parameters
        ----------
        new : Body
            The body on the new mesh.
        own : ndarray of int
            Rows of the new cells.
        mesh : Mesh
            The new mesh.
        u : ndarray
            Its displacement.
        plastic : ndarray of bool
            Cells with a history. The others have the initial one: they are free of stress where they are flat.
        """
        probe = _Probe(new, own, mesh, u)
        history_variables = new.block.history_variables
        state = np.tile(np.asarray(new.material.law().initial(), dtype=float), (len(own), new.block.points, 1))
        if not history_variables:
            return state, probe.alpha
        wanted = self._moved(self._elastic, probe.frame)
        probe.meet(np.trace(wanted, axis1=2, axis2=3))
        moved = np.empty_like(state)
        for name, part in named(moved, history_variables).items():
            values = self._parts[name]
            if history_variables[name] == 1:
                part[..., 0] = self._weights.mean(values)
            elif name == "Cp_inv":
                part[:] = _voigt(_metric(probe.E, wanted), 1.0)
            elif name == "plastic_strain":
                part[:] = _voigt(_logarithm(probe.E) - wanted, 2.0)
            else:
                part[:] = _voigt(self._moved(values, probe.frame), 1.0)
        state[plastic] = moved[plastic]
        return state, probe.alpha

    def _moved(self, tensor: Floats, frame: Floats) -> Floats:
        """Tensors (.., 3, 3) in the frames of the new points."""
        mean = self._weights.mean
        if self._old.rolling is not None:
            return mean(tensor)
        world = np.einsum("epki,epkl,eplj->epij", self._frame, tensor, self._frame)
        return np.asarray(np.einsum("epik,epkl,epjl->epij", frame, mean(world), frame))


def flowed(old: Body, cells: Numbers, weights: Weights) -> NDArray[np.bool_]:
    """New cells of one layer with a point that lies beside one that has flowed."""
    eqps = _parts(old.block.history_variables, old.block.state[cells]).get("eqps")
    if eqps is None:
        return np.zeros(len(weights.of), dtype=bool)
    return np.asarray((weights.mean(eqps) > _ZERO).any(axis=1))


def energies_at_points(body: Body, u: Floats) -> tuple[Floats, Floats]:
    """Elastic energy and plastic work by volume (cells, points, 2), and volumes (cells, points), at all points."""
    E, _, _, _, volume = body.block.point_fields(u)
    count, state = volume.size, body.block.state
    energies = body.material.law().energy(E.reshape(count, 6), state.reshape(count, -1))
    return np.stack([np.reshape(e, volume.shape) for e in energies], axis=-1), volume


class _Probe:
    """New cells whose enhanced thickness strain is to be found."""

    def __init__(self, body: Body, rows: Numbers, mesh: Mesh, u: Floats) -> None:
        self._body, self._rows, self._mesh, self._u = body, rows, mesh, u
        modes = body.element.modes
        self.alpha = np.zeros((len(rows), len(modes)))
        self.E, self.frame = _strains(body, rows, u, self.alpha, mesh)
        self._thick = [k for k, mode in enumerate(modes) if all(p.component == "33" for p in mode.polynomials)]

    def meet(self, trace: Floats) -> None:
        """Find the modes of the thickness strain for a trace of the logarithmic strain, by least squares. eq. (1.33)"""
        if not self._thick:
            return
        base = self.E
        slopes = []
        for k in self._thick:
            unit = self.alpha.copy()
            unit[:, k] += 1e-4
            slopes.append((_strains(self._body, self._rows, self._u, unit, self._mesh)[0] - base) / 1e-4)
        M = np.stack(slopes, axis=-1)
        for _ in range(_ITERATIONS):
            C = np.eye(3) + 2.0 * self.E
            miss = trace - 0.5 * np.log(np.linalg.det(C))
            slope = np.einsum("epij,epijk->epk", np.linalg.inv(C), M)
            self.alpha[:, self._thick] += np.einsum("ekp,ep->ek", np.linalg.pinv(slope), miss)
            self.E = base + np.einsum("epijk,ek->epij", M, self.alpha[:, self._thick])


def _strains(body: Body, rows: Numbers, u: Floats, alpha: Floats, mesh: Mesh) -> tuple[Floats, Floats]:
    """Strains and frames (cells, points, 3, 3) at all points of some cells, of an elastic law."""
    cells = body.connectivity[rows]
    nodes, local = np.unique(cells, return_inverse=True)
    law = SVK(E=1.0, nu=0.0).law()
    t, w = body.through
    rolling = body.rolling[rows] if body.rolling is not None and body.rolling.ndim == 2 else body.rolling
    connectivity = local.reshape(cells.shape).astype(np.int32)
    X = np.ascontiguousarray(mesh.points[nodes])
    technology = body.element.technology()
    block = _core.shell_block(technology, body.element.surface_rule, t, w, law, connectivity, X, rolling)
    block.restore(block.state, np.ascontiguousarray(alpha))
    E, _, frame, _, _ = block.point_fields(np.ascontiguousarray(u.reshape(-1, 3)[nodes].ravel()))
    return _tensor(E, 0.5), frame


def _parts(history_variables: dict[str, int], history: Floats) -> dict[str, Floats]:
    """The history by name: scalars (cells, points), tensors (cells, points, 3, 3); shears of strains are halved."""
    unknown = [name for name, size in history_variables.items() if size not in (1, 6)]
    if unknown:
        raise InvalidValue(
            "the history of a law cannot be moved to other points",
            where="trim",
            value=", ".join(unknown),
            cause="a variable with another number of components than 1 or 6",
            remedy='edge="elements", where all cells keep their points',
        )
    return {
        name: values[..., 0]
        if history_variables[name] == 1
        else _tensor(values, 0.5 if name == "plastic_strain" else 1.0)
        for name, values in named(history, history_variables).items()
    }


def _elastic(parts: dict[str, Floats], E: Floats, logarithm: Floats, j2: bool) -> Floats:
    """Logarithmic elastic strains. eq. (1.32)"""
    if not j2:
        return logarithm - parts["plastic_strain"]
    U = _function(np.eye(3) + 2.0 * E, lambda v: np.asarray(np.sqrt(v)))
    return _function(U @ parts["Cp_inv"] @ U, _half_log)


def _metric(E: Floats, elastic: Floats) -> Floats:
    """Plastic metric of elastic strains."""
    inverse = _function(np.eye(3) + 2.0 * E, lambda v: np.asarray(1.0 / np.sqrt(v)))
    return np.asarray(inverse @ _function(elastic, lambda v: np.asarray(np.exp(2.0 * v))) @ inverse)


def _logarithm(E: Floats) -> Floats:
    return _function(np.eye(3) + 2.0 * E, _half_log)


def _half_log(v: Floats) -> Floats:
    return np.asarray(0.5 * np.log(v))


def _function(A: Floats, f: Callable[[Floats], Floats]) -> Floats:
    """A function of symmetric tensors (..., 3, 3)."""
    values, vectors = np.linalg.eigh(0.5 * (A + np.swapaxes(A, -1, -2)))
    return np.asarray((vectors * f(values)[..., None, :]) @ np.swapaxes(vectors, -1, -2))


def _tensor(v: Floats, shear: float) -> Floats:
    """Symmetric tensors (..., 3, 3) of components (..., 6)."""
    A = np.empty((*v.shape[:-1], 3, 3))
    for k, (i, j) in enumerate(_PAIRS):
        A[..., i, j] = A[..., j, i] = v[..., k] * (1.0 if i == j else shear)
    return A


def _voigt(A: Floats, shear: float) -> Floats:
    """Components (..., 6) of symmetric tensors (..., 3, 3)."""
    return np.stack([A[..., i, j] * (1.0 if i == j else shear) for i, j in _PAIRS], axis=-1)
