"""Ears without tools: a flange that is compressed around the cup, by a formula, and a narrow ring of elements."""

from __future__ import annotations

import numpy as np

from umform import Model, Move, cylindrical, mesh, solve
from umform.materials import Metal
from umform.results.forming import EarProfile
from umform.sheet_metals import uniaxial

#: What staggered heights of the points, which are no images of each other, leave of the symmetry of a part, mm.
SYMMETRIC = 0.01
#: Radius and width of the ring, and elements on a quarter of it.
_RADIUS, _WIDTH, _AROUND = 50.0, 0.3, 30


def compressed_flange(material: Metal, blank: float, wall: float) -> EarProfile:
    r"""Lengths that the radii of a flange have in the wall, by the r-values alone.

    A point of the blank at the radius R reaches the wall with the strain ln(wall / R) around the cup. Uniaxial
    compression in that direction, at right angles to its radius, stretches the radius by :math:`-r / (1 + r)` of it,

    .. math:: h = \int_{wall}^{blank} (R / wall)^m \, dR , \qquad m = r / (1 + r) .

    The state at the rim from which Yoon, Dick and Barlat (Int. J. Plasticity 27 (2011) 1165-1184) begin.

    Parameters
    ----------
    material : Metal
        Metal with the r-values.
    blank, wall : float
        Radii of the blank and of the middle of the wall.

    Returns
    -------
    EarProfile
    """
    angle = np.arange(0.0, 360.0, 7.5)
    r = np.array([uniaxial(material.yield_function, around + 90.0)[1] for around in angle])
    power = 1.0 + r / (1.0 + r)
    return EarProfile(angle, wall / power * ((blank / wall) ** power - 1.0))


def narrow_ring(material: Metal, compressed: float, rolling: float = 0.0) -> tuple[EarProfile, EarProfile]:
    """Radial strain of a narrow ring that is compressed around its axis: by elements, and by the r-values.

    The hole is drawn in without sliding around it, on a smooth plane. The rim is free, so that the ring is in uniaxial
    compression but for a width, and its radial strain is r / (1 + r) of the compression.

    Parameters
    ----------
    material : Metal
        Metal with the r-values.
    compressed : float
        Logarithmic strain around the ring, positive.
    rolling : float
        Angle of the rolling direction in degrees.

    Returns
    -------
    found, expected : EarProfile
        Over the angle; strains in place of heights.
    """
    ring = mesh.ring(_RADIUS, _RADIUS + _WIDTH, 1.0, (_AROUND, 1))
    along = (np.cos(np.radians(rolling)), np.sin(np.radians(rolling)), 0.0)
    model = Model(ring, "ANS3DEAS", material=material, rolling=along, thickness_points=2)
    round_z = cylindrical((0.0, 0.0, 0.0), "z")
    model.fix("lower", "z")
    model.fix("hole", "t", axes=round_z)
    inwards = model.prescribe("hole", "r", "inwards", axes=round_z)
    solve(model, Move(inwards, to=_RADIUS * np.expm1(-compressed), steps=10), frames=0, progress=False)
    x = ring.points + model.u.reshape(-1, 3)
    ids = ring.nodes("rim_lower")
    angle = np.degrees(np.arctan2(ring.points[ids, 1], ring.points[ids, 0])) % 360.0
    width = np.hypot(*x[ids, :2].T) - _RADIUS * np.exp(-compressed)
    order = np.argsort(angle)
    r = np.array([uniaxial(material.yield_function, at - rolling + 90.0)[1] for at in angle[order]])
    return (
        EarProfile(angle[order], np.log(width[order] / _WIDTH)),
        EarProfile(angle[order], compressed * r / (1.0 + r)),
    )
