"""Measurements of a sheet: values over the angle, a tension test, cycles; files are read and checked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.sheet_metals import Directions
from umform.studies.calibration.columns import number, read_rows

Floats = NDArray[np.float64]
Path = str | PathLike[str]
#: Names of columns in a file where they differ from ours.
Names = Mapping[str, str] | None

#: A strain that must be in per cent, and the range of stresses in MPa at which metals yield.
_LARGEST_STRAIN, _SOFTEST, _HARDEST = 2.0, 10.0, 5000.0
#: Largest relative decrease of the true stress in a tension test.
_FALL = 0.01


@dataclass(frozen=True)
class Test:
    """A bar along the rolling direction.

    Attributes
    ----------
    strain, stress : ndarray, shape (n,)
        Logarithmic strain and true stress; NaN where a stress was not measured.
    """

    strain: Floats
    stress: Floats

    __test__ = False  # no test of pytest


@dataclass(frozen=True)
class Unloading:
    """Slopes of unloading.

    Attributes
    ----------
    eqps, modulus : ndarray, shape (n,)
        Plastic strains, and the slope from each.
    """

    eqps: Floats
    modulus: Floats


@dataclass(frozen=True)
class Measurements:
    """All measurements; None for missing ones.

    Attributes
    ----------
    directions : Directions, optional
        Yield stresses and r-values over the angle, and biaxial tension.
    tension : Test, optional
        Tension up to the largest force.
    cycles : Test, optional
        Tension and compression.
    unloading : Unloading, optional
        Slopes of unloading over the plastic strain.
    """

    directions: Directions | None = None
    tension: Test | None = None
    cycles: Test | None = None
    unloading: Unloading | None = None


def read_directions(path: Path, names: Names = None) -> Directions:
    """Read yield stresses and r-values: columns angle, stress, r; the angle ``biaxial`` has the biaxial point.

    Stresses in MPa are divided by that at 0 degrees. A cell of what was not measured is empty.

    Raises
    ------
    FileProblem, InvalidValue
        If columns are missing, a cell is not a number, an angle comes twice, or a value is not positive.
    """
    example = "angle,stress,r / 0,1.0,0.21 / 45,0.81,1.58 / biaxial,1.03,0.67"
    rows = read_rows(path, ("angle", "stress", "r"), example, names)
    stresses: dict[float, float] = {}
    r: dict[float, float] = {}
    biaxial: list[float | None] = [None, None]
    for row in rows:
        stress, ratio = (number(path, row, column, empty=True) for column in ("stress", "r"))
        if row[1]["angle"].casefold() == "biaxial":
            biaxial = [stress, ratio]
            continue
        angle = number(path, row, "angle")
        assert angle is not None
        if angle in stresses or angle in r or not 0.0 <= angle <= 90.0:
            raise InvalidValue(
                "angles lie between 0 and 90 degrees, each once",
                where=f"{path}, line {row[0]}",
                value=angle,
                cause="radians, two specimens of one angle, or a quadrant that symmetry repeats",
                remedy="one row for each angle, with the mean of its specimens",
            )
        stresses |= {} if stress is None else {angle: stress}
        r |= {} if ratio is None else {angle: ratio}
    if biaxial[0] is not None:
        scale = _first(stresses | {-1.0: biaxial[0]}, path)
    else:
        scale = _first(stresses, path)
    normalised = {angle: stress / scale for angle, stress in stresses.items()}
    try:
        return Directions(normalised, r, None if biaxial[0] is None else biaxial[0] / scale, biaxial[1])
    except InvalidValue as error:
        error.where = str(path)
        raise


def _first(stresses: dict[float, float], path: Path) -> float:
    """What stresses are divided by: that at 0 degrees, or 1 if they are about 1."""
    if 0.0 in stresses:
        return stresses[0.0]
    if all(0.2 < stress < 5.0 for stress in stresses.values()):
        return 1.0
    raise InvalidValue(
        "stresses in MPa need that at 0 degrees",
        where=str(path),
        value=sorted(stresses),
        cause="the row of the angle 0 was left out, or has no stress",
        remedy="the yield stress along the rolling direction, or all stresses divided by it",
    )


def read_tension(
    path: Path, young: float, *, engineering: bool = False, percent: bool = False, names: Names = None
) -> Test:
    """Read a tension test along the rolling direction up to the largest force.

    Parameters
    ----------
    path : str or PathLike
        CSV file with the columns stress, and strain or plastic_strain.
    young : float
        Young's modulus in MPa.
    engineering : bool
        Strains are elongations over the first length, stresses forces over the first area; they are converted up to
        the largest force.
    percent : bool
        Strains are in per cent.
    names : mapping of str to str, optional
        Names of columns in the file where they differ: ``{"stress": "sigma"}``.

    Raises
    ------
    FileProblem, InvalidValue
        If columns are missing or the numbers contradict their units or their kind.
    """
    plastic_given, strain, stress = _pairs(path, percent, names, empty=False)
    if plastic_given:
        strain = strain + stress / young
    if engineering:
        top = int(np.argmax(stress)) + 1
        strain, stress = np.log1p(strain[:top]), (stress * (1.0 + strain))[:top]
    elif float(stress.max()) - float(stress[-1]) > _FALL * float(stress.max()):
        raise InvalidValue(
            "the true stress of a tension test does not fall",
            where=str(path),
            value=f"{stress.max():.4g} MPa, then {stress[-1]:.4g} MPa",
            cause="engineering values, force over the first area, or rows of the neck",
            remedy="engineering=True for engineering values; rows up to the largest force",
        )
    _check_elastic(path, strain, stress, young)
    if not (np.diff(strain) > 0.0).all():
        row = int(np.flatnonzero(np.diff(strain) <= 0.0)[0]) + 1
        raise InvalidValue(
            "the strains of a tension test rise",
            where=f"{path}, measurement {row + 1}",
            value=f"{strain[row - 1]:.6g}, then {strain[row]:.6g}",
            cause="noise, unloading, or cycles",
            remedy="leave such rows out; cycles belong to --cycles",
        )
    return Test(strain, stress)


def read_cycles(
    path: Path, young: float, *, engineering: bool = False, percent: bool = False, names: Names = None
) -> Test:
    """Read cycles along the rolling direction: columns strain and stress, in their order; parameters as for tension.

    Each turning point must be there; its stress may be left empty.
    """
    plastic_given, strain, stress = _pairs(path, percent, names, empty=True)
    if plastic_given:
        raise InvalidValue(
            "cycles need total strains",
            where=str(path),
            value="plastic_strain",
            cause="the elastic part was taken away",
            remedy="a column strain: strain = plastic strain + stress / E",
        )
    if engineering:
        strain, stress = np.log1p(strain), stress * (1.0 + strain)
    known = np.isfinite(stress)
    _check_elastic(path, np.abs(strain[known]), np.abs(stress[known]), young, cycles=True)
    turns = np.diff(strain)
    if not (turns > 0.0).any() or not (turns < 0.0).any():
        raise InvalidValue(
            "cycles go forth and back",
            where=str(path),
            value=f"strains from {strain.min():.4g} to {strain.max():.4g} without a turn",
            cause="a tension test, or rows that were sorted by their strain",
            remedy="--tension for a tension test; rows in the order of time",
        )
    return Test(strain, stress)


def read_unloading(path: Path, young: float, *, percent: bool = False, names: Names = None) -> Unloading:
    """Read slopes of unloading: columns plastic_strain and modulus, in MPa; parameters as for tension.

    Raises
    ------
    FileProblem, InvalidValue
        If columns are missing, or the numbers contradict their units.
    """
    rows = read_rows(path, ("plastic_strain", "modulus"), "plastic_strain,modulus / 0.02,185000", names)
    table = np.array([[number(path, row, name) for name in ("plastic_strain", "modulus")] for row in rows], dtype=float)
    if len(table) < 3:
        raise InvalidValue(
            "three or more measurements are needed",
            where=str(path),
            value=len(table),
            cause="a cut file, or lines without numbers",
            remedy="a line for each measurement, three at least",
        )
    eqps, modulus = table.T * np.array([[0.01 if percent else 1.0], [1.0]])
    if not ((eqps >= 0.0).all() and (eqps < _LARGEST_STRAIN).all()):
        worst = eqps[(eqps < 0.0) | (eqps >= _LARGEST_STRAIN)][0]
        raise InvalidValue(
            "plastic strains are fractions and not negative",
            where=str(path),
            value=worst,
            cause="per cent, or a sign",
            remedy="percent=True, or strains divided by 100",
        )
    if not ((modulus > young / 3.0).all() and (modulus < 1.1 * young).all()):
        raise InvalidValue(
            "the slope of unloading is at most Young's modulus, and no less than a third",
            where=str(path),
            value=modulus[(modulus <= young / 3.0) | (modulus >= 1.1 * young)][0],
            cause="GPa, or Young's modulus of another metal",
            remedy=f"slopes in MPa; Young's modulus is {young:g} MPa",
        )
    return Unloading(eqps, modulus)


def _pairs(path: Path, percent: bool, given: Names, *, empty: bool) -> tuple[bool, Floats, Floats]:
    """Whether strains are plastic, strains, and stresses of a file."""
    rows = read_rows(path, ("stress",), "strain,stress / 0.05,275", given)
    header = rows[0][1] if rows else {}
    names = [name for name in ("strain", "plastic_strain") if name in header]
    if len(names) != 1:
        read_rows(path, ("strain",), "strain,stress / 0.05,275, or plastic_strain,stress", given)
        raise InvalidValue(
            "a test has the column strain or plastic_strain, and three rows or more",
            where=str(path),
            value=", ".join(header) or "no rows",
            cause="both columns, or a file with a header only",
            remedy="one of them",
        )
    strain = np.array([number(path, row, names[0]) for row in rows], dtype=float) * (0.01 if percent else 1.0)
    stress = np.array([number(path, row, "stress", empty=empty) for row in rows], dtype=float)
    known = stress[np.isfinite(stress)]
    if len(known) < 3:
        raise InvalidValue(
            "three or more measurements are needed",
            where=str(path),
            value=len(known),
            cause="a cut file, or lines without numbers",
            remedy="a line for each measurement, three at least",
        )
    if float(np.abs(strain).max()) > _LARGEST_STRAIN:
        raise InvalidValue(
            "strains are fractions",
            where=str(path),
            value=f"largest strain {np.abs(strain).max():.4g}",
            cause="per cent",
            remedy="percent=True, or strains divided by 100",
        )
    if not _SOFTEST < float(np.abs(known).max()) < _HARDEST:
        raise InvalidValue(
            "stresses are in MPa",
            where=str(path),
            value=f"largest stress {np.abs(known).max():.4g}",
            cause="GPa, Pa, or forces",
            remedy=f"stresses between {_SOFTEST:g} and {_HARDEST:g} MPa",
        )
    return names[0] == "plastic_strain", strain, stress


def _check_elastic(path: Path, strain: Floats, stress: Floats, young: float, *, cycles: bool = False) -> None:
    """Reject strains that are smaller than their elastic part: no metal is stiffer than its E."""
    if not young > 1000.0:
        raise InvalidValue(
            "Young's modulus is in MPa",
            where="--young",
            value=young,
            cause="GPa",
            remedy="210000 for steel, 70000 for aluminium",
        )
    if cycles:  # on the way back strains are small and stresses are not
        first = int(np.argmax(strain[1:] < strain[:-1])) + 1
        strain, stress = strain[:first], stress[:first]
    plastic = strain - stress / young
    worst = int(np.argmin(plastic))
    if plastic[worst] < -1e-3:
        raise InvalidValue(
            "a strain is smaller than stress / E",
            where=f"{path}, measurement {worst + 1}",
            value=f"strain {strain[worst]:.5g}, stress {stress[worst]:.5g} MPa, E {young:g} MPa",
            cause="plastic strains in a column called strain, stresses in another unit, or a modulus too small",
            remedy="call the column plastic_strain, or give the modulus of the metal: --young",
        )
