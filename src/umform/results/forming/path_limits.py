"""Forming limits that depend on the path: effective plastic strain over the direction of its rate. eq. (5.184)

After Stoughton and Yoon (2012): a strain limit moves with pre-strain, the limit of the effective plastic strain for the
present direction of flow does not.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.materials import Plastic
from umform.mesh import Mesh
from umform.results.forming.effective_strain import EffectiveStrain
from umform.results.forming.limits import LARGEST_STRAIN, FormingLimit
from umform.results.forming.paths import StrainPaths, strain_paths

Floats = NDArray[np.float64]

#: Half of the angle from uniaxial tension to plane strain, arctan(1/2), in degrees: beyond, a path is nearer to another
#: test of a forming limit than to that which it began as.
BENDS = 13.3
#: Share of a limit from which on a bent path is a warning.
_NEAR = 0.5
#: Places of the search for the first crossing of a ray and the limit, and halvings of the interval found.
_PLACES, _HALVINGS = 200, 50


@dataclass(frozen=True)
class PathLimit:
    """Largest effective plastic strain for a direction of flow, from a forming limit of proportional paths.

    Parameters
    ----------
    limit : callable
        Largest major strain over the minor one, of proportional paths.
    effective : EffectiveStrain
        Effective strain of an increment.

    Examples
    --------
    >>> import umform as uf
    >>> from umform.results.forming import EffectiveStrain, KeelerBrazier, PathLimit
    >>> limit = PathLimit(KeelerBrazier(1.0, 0.2), EffectiveStrain(uf.Mises()))
    >>> round(float(limit(0.0)), 3)  # plane strain: 2 / sqrt(3) of the major strain
    0.352
    """

    limit: FormingLimit
    effective: EffectiveStrain

    def __call__(self, direction: Floats | float) -> Floats:
        """Largest effective strain; infinite where the ray does not meet the limit. eq. (5.184)

        Parameters
        ----------
        direction : float or ndarray
            Angle of the rate from the major axis, in radians: arctan of the minor over the major rate.
        """
        ratio = np.tan(np.atleast_1d(np.asarray(direction, dtype=float)).ravel())
        forward = np.abs(np.atleast_1d(direction)).ravel() < 0.5 * np.pi
        major = np.where(forward, strain_on_ray(self.limit, ratio), np.inf)
        finite = np.isfinite(major)
        found = np.full(len(ratio), np.inf)
        found[finite] = self.effective(major[finite], ratio[finite] * major[finite])
        return found.reshape(np.shape(direction))


def strain_on_ray(limit: FormingLimit, ratio: Floats) -> Floats:
    """Major strain at which a proportional path first meets a forming limit; infinite if it does not.

    Parameters
    ----------
    limit : callable
        Largest major strain over the minor one.
    ratio : ndarray, shape (n,)
        Minor over major strain of each path.
    """
    places = np.linspace(0.0, LARGEST_STRAIN, _PLACES + 1)[1:]
    with np.errstate(invalid="ignore", over="ignore"):  # beyond the end of a curve
        left = np.array([limit(ratio * major) - major for major in places])
    crossed = (left <= 0.0).argmax(axis=0)
    high = places[crossed]
    low = high - places[0]
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        with np.errstate(invalid="ignore", over="ignore"):
            below = limit(ratio * middle) > middle
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    found: Floats = np.where((left <= 0.0).any(axis=0), 0.5 * (low + high), np.inf)
    return found


def strain_use(limit: FormingLimit, major: Floats, minor: Floats) -> Floats:
    """Share of a strain limit that strains have used, along the ray from the origin: 1 at the limit. eq. (5.185)

    Parameters
    ----------
    limit : callable
        Largest major strain over the minor one.
    major, minor : ndarray, shape (n,)
        Logarithmic strains.
    """
    rising = major > 0.0
    ratio = np.divide(minor, major, out=np.zeros_like(minor), where=rising)
    use: Floats = np.where(rising, major / strain_on_ray(limit, ratio), 0.0)
    return use


def path_use(limit: PathLimit, paths: StrainPaths) -> Floats:
    """Largest share of the path-dependent limit on each path so far. eq. (5.185)

    States in which the sheet is thicker than the blank do not count: the rim of a deep cup is squeezed before it is
    stretched a little, and the thinner wall below it carries the same force.

    Parameters
    ----------
    limit : PathLimit
        The limit.
    paths : StrainPaths
        Paths of n cells.

    Returns
    -------
    ndarray, shape (n,)
    """
    thinned = np.cumsum(paths.major + paths.minor, axis=0) > 0.0
    use: Floats = np.where(thinned, paths.effective / limit(paths.direction), 0.0).max(axis=0)
    return use


@dataclass(frozen=True)
class PathFields:
    """Use of the path-dependent limit by the cells of a sheet.

    Attributes
    ----------
    limit : PathLimit
        The limit.
    paths : StrainPaths
        The paths.
    strain_use : ndarray, shape (cells,)
        Share of the strain limit along the ray to the last strain.
    """

    limit: PathLimit
    paths: StrainPaths
    strain_use: Floats

    @classmethod
    def of(cls, mesh: Mesh, states: Sequence[Floats], limit: FormingLimit, material: Plastic) -> PathFields:
        """Those of a run.

        Parameters
        ----------
        mesh : Mesh
            Undeformed mesh.
        states : sequence of ndarray
            Displacements of the nodes in their order.
        limit : callable
            Forming limit of proportional paths.
        material : J2 or Metal
            Law of the sheet.
        """
        from umform.results.forming.strains import sheet_strains

        polar = PathLimit(limit, EffectiveStrain.of(material))
        last = sheet_strains(mesh, states[-1])
        used = strain_use(limit, last.major["middle"], last.minor["middle"])
        return cls(polar, strain_paths(mesh, states, polar.effective), used)

    @property
    def use(self) -> Floats:
        """Largest share of the path-dependent limit, shape (cells,)."""
        return path_use(self.limit, self.paths)

    @property
    def fields(self) -> dict[str, Floats]:
        """Fields of the cells by their names: ``strain_use``, ``path_use``, ``path_bend``."""
        return {"strain_use": self.strain_use, "path_use": self.use, "path_bend": self.paths.bend}

    def warning(self, mesh: Mesh) -> str | None:
        """Where the path bends so much that the strain diagram does not hold, and what the other limit says; or None.

        Parameters
        ----------
        mesh : Mesh
            Undeformed.
        """
        use = self.use
        bent = (self.paths.bend > BENDS) & (np.maximum(use, self.strain_use) > _NEAR)
        if not bent.any():
            return None
        worst = int(np.argmax(np.where(bent, np.maximum(use, self.strain_use), 0.0)))
        place = mesh.points[mesh.connectivity[worst]].mean(axis=0)
        return (
            f"the strain path bends by more than {BENDS:g} degrees in {int(bent.sum())} elements beyond half of a "
            f"limit, by {self.paths.bend[worst]:.0f} at ({place[0]:.3g}, {place[1]:.3g}) of the blank: the forming "
            f"limit diagram of strains does not hold there. It gives {100 * self.strain_use[worst]:.0f} % of the "
            f"limit, the path-dependent limit {100 * use[worst]:.0f} %"
        )
