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
from umform.materials import J2, SVK, Metal
from umform.mesh import Mesh
from umform.mesh.fitted.places import bilinear
from umform.mesh.fitted.sheet import Sheet
from umform.model.body import Body

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
    """For each in-plane point of new stacks the points of the old ones that surround it, and their shares. eq. (1.32)

    Attributes
    ----------
    stacks : ndarray of int
        Old stacks.
    of : ndarray of int, shape (new, points, 3)
        Rows of points, in the order of the old stacks.
    share : ndarray, shape (new, points, 3)
        Not negative; their sum is one.
    """

    stacks: Numbers
    of: Numbers
    share: Floats

    @classmethod
    def between(cls, sheet: Sheet, x: Floats, stacks: Numbers, new: Floats, rule: tuple[int, int]) -> Weights:
        """Linear interpolation in triangles between the points of old stacks.

        Parameters
        ----------
        sheet : Sheet
            The old sheet, with middles of its fibres x (fibres, 2).
        stacks : ndarray of int
            Those of it that surround the new ones.
        new : ndarray, shape (new, 4, 2)
            Corners of the new ones.
        rule : tuple of int
            Points in r and s.
        """
        from scipy.spatial import Delaunay  # slow to import

        own, two = _in_plane(rule), _in_plane((max(rule[0], 2), max(rule[1], 2)))
        sources = np.einsum("qa,eai->eqi", two, x[sheet.quads[stacks]]).reshape(-1, 2)
        targets = np.einsum("qa,eai->eqi", own, new).reshape(-1, 2)
        second, first = np.divmod(np.arange(len(two)), max(rule[0], 2))  # a single point across stands for two
        row = np.minimum(second, rule[1] - 1) * rule[0] + np.minimum(first, rule[0] - 1)
        rows = (np.arange(len(stacks))[:, None] * len(own) + row).ravel()
        net = Delaunay(sources)
        simplex = net.find_simplex(targets)
        outside = np.flatnonzero(simplex < 0)
        share = _barycentric(net.transform[simplex], targets)
        for k in outside:  # beyond the last points, on the way to the edge of the sheet
            every = _barycentric(net.transform, targets[k])
            simplex[k] = int(np.nan_to_num(every.min(axis=1), nan=-np.inf).argmax())
            share[k] = every[simplex[k]]
        share = np.maximum(share, 0.0)
        share /= share.sum(axis=1, keepdims=True)
        shape = (len(new), len(own), 3)
        return cls(stacks, rows[net.simplices[simplex]].reshape(shape), share.reshape(shape))

    def mean(self, values: Floats) -> Floats:
        """Means (new, points, ...) of values (old, points, ...) at all points, layer by layer through the thickness."""
        across = self.of.shape[1]
        layers = np.moveaxis(values.reshape(len(values), -1, across, *values.shape[2:]), 1, 2)
        flat = layers.reshape(-1, *layers.shape[2:])  # [stack and point in the plane][layer]
        mean = np.moveaxis(np.einsum("eqk,eqk...->eq...", self.share, flat[self.of]), 2, 1)
        out: Floats = mean.reshape(len(mean), -1, *values.shape[2:])
        return out


def _in_plane(rule: tuple[int, int]) -> Floats:
    """Shape functions (points, 4) at the points of a rule in r and s; r changes first."""
    s, r = np.meshgrid(_core.gauss(rule[1])[0], _core.gauss(rule[0])[0], indexing="ij")
    return bilinear(np.stack([r.ravel(), s.ravel()], axis=1))[0]


def _barycentric(transform: Floats, points: Floats) -> Floats:
    """Barycentric coordinates (n, 3) of points (n, 2), or of one point, in triangles."""
    ab = np.einsum("nij,nj->ni", transform[:, :2], points - transform[:, 2])
    return np.column_stack([ab, 1.0 - ab.sum(axis=1)])


def transferred(
    old: Body, cells: Numbers, u_old: Floats, mesh: Mesh, new: Body, own: Numbers, u: Floats, weights: Weights
) -> tuple[Floats, Floats]:
    """History and enhanced parameters of new cells of one layer.

    Parameters
    ----------
    old : Body
        The body of the whole sheet, in its state.
    cells : ndarray of int
        Its rows on the old stacks of the weights.
    u_old, u : ndarray
        Displacements of the old and the new mesh.
    mesh : Mesh
        The new mesh.
    new : Body
        The body on it.
    own : ndarray of int
        Rows of the new cells.
    weights : Weights
        Of their points.
    """
    block = old.block
    E, frame = _strains(old, cells, u_old, block.alpha[cells], old.mesh)
    names, history = block.state_names, block.state[cells]
    probe = _Probe(new, own, mesh, u)
    if not names:
        return np.zeros((len(own), block.points, 0)), probe.alpha
    parts = _parts(names, history)
    j2 = isinstance(old.material, J2)
    elastic = _elastic(parts, E, _logarithm(E), j2)

    def moved(tensor: Floats) -> Floats:
        """Tensors (.., 3, 3) in the frames of the new points."""
        if old.rolling is not None:
            return weights.mean(tensor)
        world = np.einsum("epki,epkl,eplj->epij", frame, tensor, frame)
        return np.asarray(np.einsum("epik,epkl,epjl->epij", probe.frame, weights.mean(world), probe.frame))

    scalar = {name: weights.mean(values) for name, values in parts.items() if values.ndim == 2}
    wanted = moved(elastic)
    probe.meet(np.trace(wanted, axis1=2, axis2=3))
    state = np.empty((len(own), history.shape[1], history.shape[2]))
    at = 0
    new_E, new_h = probe.E, _logarithm(probe.E)
    deviator = wanted + ((np.trace(new_h - wanted, axis1=2, axis2=3)) / 3.0)[..., None, None] * np.eye(3)
    for name, size in names.items():
        if size == 1:
            state[..., at] = scalar[name]
        elif name == "Cp_inv":
            state[..., at : at + 6] = _voigt(_metric(new_E, deviator), 1.0)
        elif name == "plastic_strain":
            state[..., at : at + 6] = _voigt(new_h - deviator, 2.0)
        else:
            state[..., at : at + 6] = _voigt(moved(parts[name]), 1.0)
        at += size
    virgin = scalar["eqps"] <= _ZERO
    state[virgin] = old.material.law().initial()
    return state, probe.alpha


class _Probe:
    """New cells whose enhanced thickness strain is to be found."""

    def __init__(self, body: Body, rows: Numbers, mesh: Mesh, u: Floats) -> None:
        self._body, self._rows, self._mesh, self._u = body, rows, mesh, u
        modes = body.element.modes
        self.alpha = np.zeros((len(rows), len(modes)))
        self.E, self.frame = _strains(body, rows, u, self.alpha, mesh)
        self._thick = [k for k, mode in enumerate(modes) if all(term.component == "33" for term in mode)]

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


def _parts(names: dict[str, int], history: Floats) -> dict[str, Floats]:
    """The history by name: scalars (cells, points), tensors (cells, points, 3, 3); shears of strains are halved."""
    made, at = {}, 0
    for name, size in names.items():
        values = history[..., at : at + size]
        made[name] = values[..., 0] if size == 1 else _tensor(values, 0.5 if name == "plastic_strain" else 1.0)
        at += size
    unknown = [name for name, size in names.items() if size not in (1, 6)]
    if unknown:
        raise InvalidValue("the history of a law cannot be moved to other points", value=", ".join(unknown))
    return made


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
