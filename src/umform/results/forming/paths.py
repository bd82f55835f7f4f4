"""Paths of the strain in the plane of a sheet, from states of a run. eqs. (5.182), (5.183)"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from umform.mesh import Mesh
from umform.results.forming.effective_strain import EffectiveStrain
from umform.results.forming.strains import stretched

Floats = NDArray[np.float64]

#: Effective strain over which the direction of flow is taken: at the rim of a cup, shorter turns come from bending over
#: an edge and from ironing.
LASTING = 0.02


@dataclass(frozen=True)
class StrainPaths:
    """Path of the strain in the middle of each cell, in increments between states.

    Attributes
    ----------
    major, minor : ndarray, shape (increments, cells)
        Principal values of each increment of logarithmic strain.
    effective : ndarray, shape (increments, cells)
        Effective strain at the end of each increment.
    bend : ndarray, shape (cells,)
        Angle in degrees between the strains of the first and the second half of the effective strain.
    """

    major: Floats
    minor: Floats
    effective: Floats
    bend: Floats

    @cached_property
    def direction(self) -> Floats:
        """Angle of the flow at the end of each increment, in radians: 0 in plane strain, pi / 4 in equibiaxial flow.

        It is that of the last `LASTING` of effective strain, shape (increments, cells): a neck needs flow that lasts.
        """
        reached = np.concatenate([np.zeros_like(self.effective[:1]), self.effective])
        sums = [np.cumsum(np.concatenate([np.zeros_like(one[:1]), one]), axis=0) for one in (self.major, self.minor)]
        rate = np.empty((2, *self.effective.shape))
        for cell in range(reached.shape[1]):
            path = reached[:, cell]
            since = path[1:] - LASTING
            for which, along in enumerate(sums):
                rate[which, :, cell] = along[1:, cell] - np.interp(since, path, along[:, cell])
        angle: Floats = np.arctan2(rate[1], rate[0])
        return angle


def strain_paths(mesh: Mesh, states: Sequence[Floats], effective: EffectiveStrain) -> StrainPaths:
    """Paths of the strain through states of a run.

    Parameters
    ----------
    mesh : Mesh
        Undeformed mesh.
    states : sequence of ndarray, shape (n, 3) or (3 n,)
        Displacements of the nodes in their order; the undeformed sheet is the first state.
    effective : EffectiveStrain
        Effective strain of an increment.
    """
    squares = [stretched(mesh, u) for u in states]
    before = np.broadcast_to(np.eye(2), squares[0].shape)
    major, minor = [], []
    for C in squares:
        logs = _increment(before, C)
        minor.append(logs[0])
        major.append(logs[1])
        before = C
    rates = np.array(major), np.array(minor)
    reached = np.cumsum(effective(*rates), axis=0)
    return StrainPaths(*rates, reached, _bend(np.array(squares), reached))


def _increment(before: Floats, now: Floats) -> tuple[Floats, Floats]:
    """Smaller and larger logarithmic stretch between two states with the tensors F F^T (cells, 2, 2). eq. (5.182)"""
    moved = np.linalg.solve(before, now)
    half = 0.5 * np.trace(moved, axis1=-2, axis2=-1)
    off = moved[..., 0, 0] - moved[..., 1, 1]
    root = np.sqrt(np.maximum(0.25 * off**2 + moved[..., 0, 1] * moved[..., 1, 0], 0.0))
    return 0.5 * np.log(half - root), 0.5 * np.log(half + root)


def _bend(squares: Floats, reached: Floats) -> Floats:
    """Angle between the strain at half of the effective strain and what follows, in degrees. eq. (5.183)"""
    values, axes = np.linalg.eigh(squares)
    logs = 0.5 * np.einsum("kcij,kcj,kclj->kcil", axes, np.log(values), axes)
    logs = np.concatenate([np.zeros_like(logs[:1]), logs])
    path = np.concatenate([np.zeros_like(reached[:1]), reached])
    half = 0.5 * path[-1]
    later = np.clip((path < half).sum(axis=0), 1, len(path) - 1)
    cells = np.arange(path.shape[1])
    low, high = path[later - 1, cells], path[later, cells]
    share = np.divide(half - low, high - low, out=np.ones_like(half), where=high > low)[:, None, None]
    middle = (1.0 - share) * logs[later - 1, cells] + share * logs[later, cells]
    rest = logs[-1] - middle
    product = np.einsum("cij,cij->c", middle, rest)
    size = np.linalg.norm(middle, axis=(1, 2)) * np.linalg.norm(rest, axis=(1, 2))
    cosine = np.divide(product, size, out=np.ones_like(size), where=size > 0.0)
    angle: Floats = np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))
    return angle
