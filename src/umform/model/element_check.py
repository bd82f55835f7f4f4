"""Check an element: number of zero eigenvalues, and patch tests of membrane and bending on distorted cells."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.elements import Element, element
from umform.materials import J2, SVK, Perfect
from umform.materials.material import Material
from umform.mesh import Mesh, strip
from umform.model.model import Model

Floats = NDArray[np.float64]

_E, _NU = 1e6, 0.25
#: Length, width and thickness of the plate, in-plane cells, and the shifts of its two inner corners.
_SIZE, _CELLS = (0.24, 0.12, 0.01), (3, 2)
_SHIFTS = {(1, 1): (-0.03, 0.02), (2, 1): (0.02, -0.025)}
#: Eigenvalues below this part of the largest are zero.
_ZERO = 1e-10


@dataclass(frozen=True)
class ElementCheck:
    """Result of :func:`check_element`.

    Attributes
    ----------
    zeros : int
        Number of zero eigenvalues of one distorted cell without supports: six rigid motions. More are mechanisms.
    membrane, bending : float
        Errors in the exact displacements of a constant membrane stress, and of constant curvatures and twist: the
        larger one of the forces at nodes without load, over the largest of all, and of the energy, over the exact one.
        Only elements without locking pass bending; one with thickness locking fails by its energy alone.
    """

    zeros: int
    membrane: float
    bending: float

    def ok(self, tolerance: float = 1e-8) -> bool:
        """Whether there are six zero eigenvalues and both patch tests are passed."""
        return self.zeros == 6 and max(self.membrane, self.bending) < tolerance


def check_element(made: str | Element) -> ElementCheck:
    """Zero eigenvalues and patch tests of an element, with an elastic law and with points and order of a plastic one.

    Parameters
    ----------
    made : str or Element
        An element of the catalogue or your own.

    Returns
    -------
    ElementCheck
        The worse of both laws.

    Examples
    --------
    >>> import umform as uf
    >>> uf.check_element("ANS3DEAS").ok()
    True
    >>> uf.check_element("DISP3D").bending > 0.01  # it locks
    True
    """
    known = element(made)
    laws: tuple[Material, ...] = (SVK(E=_E, nu=_NU), J2(E=_E, nu=_NU, hardening=Perfect(0.1 * _E)))
    checks = [(_zeros(known, law), *_patch_errors(known, law)) for law in laws]
    zeros = max((check[0] for check in checks), key=lambda count: abs(count - 6))
    return ElementCheck(zeros, max(check[1] for check in checks), max(check[2] for check in checks))


def _zeros(made: Element, law: Material) -> int:
    """Zero eigenvalues of one cell, whose edges are not parallel."""

    def skewed(X: Floats) -> Floats:
        x, y, z = X.T
        return np.column_stack([x + 0.2 * x * y, y - 0.15 * x * y, z])

    model = Model(strip(1.0, 1.0, 0.3, (1, 1), cell=made.cell).transformed(skewed), made, material=law)
    eigenvalues = np.linalg.eigvalsh(model.bodies.only.block.element(0, np.zeros_like(model.u))[0])
    return int((np.abs(eigenvalues) < _ZERO * eigenvalues.max()).sum())


def _patch_errors(made: Element, law: Material) -> tuple[float, float]:
    """Errors of forces and energy in the exact fields: membrane and bending."""
    plate = _plate(made.cell)
    model = Model(plate, made, material=law)
    x, y, z = plate.points.T
    inner = (np.minimum(x, _SIZE[0] - x) > 1e-9) & (np.minimum(y, _SIZE[1] - y) > 1e-9)
    thinning = _NU / (1.0 - _NU)
    membrane = np.column_stack([x + y / 2.0, y + x / 2.0, -2.0 * thinning * z])
    lift = (x * x + x * y + y * y) / 2.0 + thinning * (z * z - _SIZE[2] ** 2 / 4.0)
    bending = np.column_stack([-z * (x + y / 2.0), -z * (y + x / 2.0), lift])
    volume = float(np.prod(_SIZE))
    stretching = (2.0 / (1.0 - _NU) + 0.5 / (1.0 + _NU)) * _E * volume  # twice the energy
    plate_stiffness = _E * _SIZE[2] ** 2 / (12.0 * (1.0 - _NU**2)) * volume
    curving = plate_stiffness * (4.0 - 2.0 * (1.0 - _NU) * (1.0 - 0.25))
    errors = []
    for u, twice_energy in ((membrane, stretching), (bending, curving)):
        forces = model.system.evaluate(np.zeros(u.size), u.ravel()).predictor.reshape(-1, 3)
        unbalanced = np.abs(forces[inner]).max() / np.abs(forces).max()
        errors.append(max(float(unbalanced), abs(float((forces * u).sum()) / twice_energy - 1.0)))
    return errors[0], errors[1]


def _plate(cell: str) -> Mesh:
    """A plate of distorted cells with straight edges, its mid-surface at z = 0."""
    shifts = np.zeros((_CELLS[0] + 1, _CELLS[1] + 1, 2))
    for corner, shift in _SHIFTS.items():
        shifts[corner] = shift

    def distorted(X: Floats) -> Floats:
        place = X[:, :2] / _SIZE[:2] * _CELLS
        i, j = np.minimum(place.astype(int), np.array(_CELLS) - 1).T
        r, s = (place - np.column_stack([i, j])).T[:, :, None]
        moved = (1 - r) * (1 - s) * shifts[i, j] + r * (1 - s) * shifts[i + 1, j]
        moved = moved + (1 - r) * s * shifts[i, j + 1] + r * s * shifts[i + 1, j + 1]
        return np.column_stack([X[:, :2] + moved, X[:, 2]])

    return strip(*_SIZE, _CELLS, cell=cell).transformed(distorted)
