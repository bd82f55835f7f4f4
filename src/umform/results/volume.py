"""Change of the volume of a sheet, and how much of it the mean stress explains: plastic flow keeps the volume."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.materials.j2 import Plastic
from umform.model import Body, Model
from umform.results.fields import PointFields, body_fields

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class VolumeChange:
    """Change of the volume over the volume at first, negative where a sheet is compressed.

    Attributes
    ----------
    mesh : float
        Of the deformed mesh.
    strain : float
        By the strains of the elements, which the law gets; they are assumed and enhanced, and need not be those of the
        mesh.
    elastic : float
        That the mean stress explains: ln J = mean Kirchhoff stress / bulk modulus. Plastic flow has none, so that it
        equals that of the strains for :class:`umform.J2` and :class:`umform.Metal`. NaN for other laws.
    """

    mesh: float
    strain: float
    elastic: float


def volume_change(model: Model) -> VolumeChange:
    """Change of the volume of all bodies of a model, at its converged state.

    Parameters
    ----------
    model : Model
        The model; on many ranks the bodies of this rank.

    Examples
    --------
    >>> import umform as uf
    >>> steel = uf.J2(E=210e3, nu=0.3, hardening=uf.Perfect(200.0))
    >>> model = uf.Model(uf.mesh.strip(4.0, 1.0, 1.0, (2, 1)), material=steel)
    >>> _ = model.symmetry("x0", "x"), model.symmetry("y0", "y"), model.symmetry("lower", "z")
    >>> pull = model.prescribe("x1", "x", "pull")
    >>> result = uf.solve(model, uf.Move(pull, 0.4, steps=50), progress=False)
    >>> round(1e5 * result.volume_change().elastic, 1)  # 200 MPa / (3 * 175 GPa)
    38.1
    """
    total, parts = 0.0, np.zeros(3)
    for body in model.bodies:
        at = body_fields(body, model.u)
        total += float(at.volume.sum())
        parts += [float(((J - 1.0) * at.volume).sum()) for J in _of_points(body, at)]
    return VolumeChange(*(parts / total).tolist())


def _of_points(body: Body, at: PointFields) -> tuple[Floats, Floats, Floats]:
    """Volume ratios at the points: of the mesh, of the strains, by the mean stress."""
    shears = at.E[..., 3:]
    a, b, c = (1.0 + 2.0 * at.E[..., k] for k in range(3))
    ab, bc, ca = (shears[..., k] for k in range(3))
    C = a * b * c + 2.0 * ab * bc * ca - a * bc**2 - b * ca**2 - c * ab**2  # det(1 + 2 E)
    pressure = (at.S[..., :3].sum(axis=-1) + 2.0 * (at.S * at.E).sum(axis=-1)) / 3.0  # mean of S : C
    return np.linalg.det(at.F), np.sqrt(C), np.exp(pressure / _bulk(body.material, at))


def _bulk(material: Any, at: PointFields) -> Floats:
    """Bulk modulus at the points."""
    kappa = np.full(at.volume.shape, material.kappa if isinstance(material, Plastic) else np.nan)
    modulus = getattr(material, "modulus", None)
    return kappa if modulus is None or at.eqps is None else kappa * modulus.share(material.E, at.eqps)
