"""Bends of several metals, thicknesses and tools to several angles, side by side; the store is the checkpoint."""

from __future__ import annotations

import itertools
import math
import re
from bisect import bisect_left
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from umform.errors import InvalidValue, UmformError
from umform.io.store import Store
from umform.pool import check_processes, run_all
from umform.problem.metal_file import metal_of
from umform.processes.air_bending.spec import AirBending
from umform.progress import Show, progress_bar
from umform.spec import check_arguments, check_fields, each
from umform.studies.bend_table.stored import TOLERANCE, StoredBend, bends, check_bend

#: Angle of punch and die that is not part of the names of files.
_USUAL = AirBending.die_angle


@dataclass(frozen=True)
class Setup:
    """Sheet and tools of a table.

    Attributes
    ----------
    metal : str
        Name of the metal, for people and files.
    case : AirBending
        Sheet and tools.
    """

    metal: str
    case: AirBending

    def __post_init__(self) -> None:
        check_fields(self)

    @property
    def tools(self) -> str:
        """Name of the metal in these tools, fit for files."""
        case = self.case
        metal = re.sub(r"[^A-Za-z0-9.]+", "-", self.metal)
        sharp = "" if case.die_angle == case.punch_angle == _USUAL else f"-{case.die_angle:g}-{case.punch_angle:g}deg"
        return f"{metal}-V{case.opening:g}-r{case.punch_radius:g}-d{case.die_radius:g}{sharp}"

    @property
    def name(self) -> str:
        """The same with the thickness."""
        return f"{self.tools}-t{self.case.thickness:g}"


@dataclass(frozen=True)
class Between:
    """Numbers of a bend between two bends of a table.

    Attributes
    ----------
    angle, radius, k_factor, allowance, deduction : float
        As of a `StoredBend`.
    error : float
        Error of allowance and deduction in mm, measured by runs between the two bends; 0 for a bend of the table.
    """

    angle: float
    radius: float
    k_factor: float
    allowance: float
    deduction: float
    error: float


@dataclass(frozen=True)
class Tabled:
    """The bends of a setup.

    Attributes
    ----------
    setup : Setup
        Sheet and tools.
    bends : tuple of StoredBend
        From sharp to flat.
    failed : dict of float to str
        Angles without a bend, and the reason.
    checks : tuple of StoredBend
        Bends in the middle of each interval, if they were asked for; of one whose bend between has failed several.
    """

    setup: Setup
    bends: tuple[StoredBend, ...]
    failed: dict[float, str]
    checks: tuple[StoredBend, ...] = ()

    def at(self, angle: float) -> Between:
        """A bend of the table, or the cubic through four of them of radius and K.

        Raises
        ------
        InvalidValue
            The angle is beyond the table, or the intervals were not checked.
        """
        known = [one.wanted for one in self.bends]
        if not known or not known[0] <= angle <= known[-1]:
            raise InvalidValue(
                "the angle is beyond the table, which is not extrapolated",
                where="angle",
                value=angle,
                cause=f"the bends of {self.setup.name} have {known[0]:g} to {known[-1]:g} degrees" if known else "",
                remedy="add the angle to the table",
            )
        if angle in known:
            one = self.bends[known.index(angle)]
            return Between(angle, one.radius, one.k_factor, one.allowance, one.deduction, 0.0)
        checks = [one for one in self.checks if bisect_left(known, one.wanted) == bisect_left(known, angle)]
        if not checks:
            raise InvalidValue(
                "the error between the angles of the table is not known",
                where="angle",
                value=angle,
                cause="the intervals were not checked by runs",
                remedy="bend_table(..., check=True), `umform bend table --check`, or add the angle",
            )
        errors = (abs(_between(self, one.wanted).deduction - one.deduction) for one in checks)
        return replace(_between(self, angle), error=max(errors))

    @property
    def by_radius(self) -> tuple[StoredBend, ...]:
        """Bends from the one with the smallest radius on: beyond it radii grow again, and one radius has two angles."""
        smallest = min(range(len(self.bends)), key=lambda number: self.bends[number].radius)
        return self.bends[smallest:]

    @property
    def remarks(self) -> list[str]:
        """What limits the numbers: a coarse mesh, K of sharp bends, radii that several angles have."""
        found = sorted({note for one in self.bends for note in one.notes if note.startswith("coarse")})
        odd = [one for one in self.bends if not 0.0 <= one.k_factor <= 1.0]
        if odd:
            found.append(f"K is {odd[0].k_factor:.2f} at {_listed(odd)} degrees: the bend is no circle there; take BD")
        again = self.bends[: len(self.bends) - len(self.by_radius)] if self.bends else ()
        if again:
            found.append(
                f"the radius of {_listed(again)} degrees is larger than that of {self.by_radius[0].wanted:g}: tables "
                "over the radius end there"
            )
        return found

    @property
    def cubic_error(self) -> float | None:
        """Largest error of `at` in mm; None if it was not checked."""
        return max((self.at(one.wanted).error for one in self.checks), default=None)

    @property
    def linear_error(self) -> float | None:
        """Largest error in mm of deductions that a CAD system interpolates linearly over the angle."""
        known, values = [one.wanted for one in self.bends], [one.deduction for one in self.bends]
        errors = (abs(float(np.interp(one.wanted, known, values)) - one.deduction) for one in self.checks)
        return max(errors, default=None)


def _listed(bends: Sequence[StoredBend]) -> str:
    return ", ".join(f"{one.wanted:g}" for one in bends)


def _between(part: Tabled, angle: float) -> Between:
    """Radius and K by the polynomial through the four nearest bends on both sides, the rest by its definition."""
    known = [one.wanted for one in part.bends]
    first = min(max(bisect_left(known, angle) - 2, 0), max(len(known) - 4, 0))
    near = part.bends[first : first + 4]
    weights = [
        math.prod((angle - other.wanted) / (one.wanted - other.wanted) for other in near if other is not one)
        for one in near
    ]
    radius = sum(weight * one.radius for weight, one in zip(weights, near, strict=True))
    k = sum(weight * one.k_factor for weight, one in zip(weights, near, strict=True))
    T, theta = part.setup.case.thickness, math.radians(180.0 - angle)
    allowance = theta * (radius + k * T)
    return Between(angle, radius, k, allowance, 2.0 * (radius + T) * math.tan(0.5 * theta) - allowance, math.nan)


@dataclass(frozen=True)
class BendTable:
    """Bends of several setups.

    Attributes
    ----------
    parts : tuple of Tabled
        One for each setup.
    tolerance : float
        Tolerance of the angles in degrees.
    notes : tuple of str
        Lines for the head of each file, such as what a measured bend has corrected.
    """

    parts: tuple[Tabled, ...]
    tolerance: float
    notes: tuple[str, ...] = ()

    @property
    def computed(self) -> int:
        """Number of bends that were not in the store."""
        return sum(one.computed for part in self.parts for one in (*part.bends, *part.checks))

    @property
    def failed(self) -> dict[str, str]:
        """Bends that are missing, and the reasons."""
        return {
            f"{part.setup.name}, {angle:g} degrees": why for part in self.parts for angle, why in part.failed.items()
        }


def setups(
    metals: str | Sequence[str],
    case: AirBending,
    *,
    thicknesses: Sequence[float] = (),
    openings: Sequence[float] = (),
    punch_radii: Sequence[float] = (),
    die_radii: Sequence[float] = (),
) -> list[Setup]:
    """All combinations of metals, thicknesses and tools, each once; what is not given is that of the case.

    Metals are names of the library, or paths of files of `umform bend correct` or `umform metal fit`.

    Raises
    ------
    InvalidValue
        The library has no such metal, tools do not fit a thickness, or two metals have one name.

    Examples
    --------
    >>> from umform.processes.air_bending import AirBending
    >>> from umform.studies.bend_table import setups
    >>> [one.case.thickness for one in setups(["DC04"], AirBending(), thicknesses=[1.0, 2.0])]
    [1.0, 2.0]
    """
    metals = each(metals)
    check_arguments(setups, metals=metals, case=case, thicknesses=thicknesses, openings=openings)
    check_arguments(setups, punch_radii=punch_radii, die_radii=die_radii)
    lists = {
        "thickness": thicknesses,
        "opening": openings,
        "punch_radius": punch_radii,
        "die_radius": die_radii,
    }
    chosen = [sorted(set(values)) or [getattr(case, name)] for name, values in lists.items()]
    found: dict[str, Setup] = {}
    for metal, sizes in itertools.product(metals, itertools.product(*chosen)):
        sheet = metal_of(metal, sizes[0])
        changes: dict[str, Any] = dict(zip(lists, sizes, strict=True))
        one = Setup(sheet.name, replace(case, **changes, material=sheet.law))
        if found.setdefault(one.name, one) != one:
            raise InvalidValue(
                "two metals of a table have one name",
                where=metal,
                value=sheet.name,
                cause="another metal before it has this name, too; that of a file is its own without the ending",
                remedy="another name for one of the files, such as coil-1.toml",
            )
    return list(found.values())


def bend_table(
    wanted: Sequence[Setup],
    angles: Sequence[float],
    *,
    tolerance: float = TOLERANCE,
    check: bool = False,
    notes: str | Sequence[str] = (),
    store: Store | None = None,
    processes: int | None = None,
    progress: Show = None,
) -> BendTable:
    """Bends of several setups to several angles.

    Each bend is stored when it is there: a stopped table goes on where it was. Processes are spawned, so a script
    needs ``if __name__ == "__main__":``.

    Parameters
    ----------
    wanted : sequence of Setup
        Sheets and tools.
    angles : sequence of float
        Angles between the legs in degrees, 15 to 165.
    tolerance : float
        Tolerance of the angles in degrees.
    check : bool
        Measure the error of interpolation by a run in the middle between each two angles.
    notes : str or sequence of str
        Lines for the head of each file.
    store : Store, optional
        Default: that of the user.
    processes : int, optional
        Setups at a time; default: as many as processors.
    progress : bool, optional
        Show a progress bar; default: only on a terminal.

    Raises
    ------
    InvalidValue
        Angles that the tools cannot have; nothing is computed then.
    FileProblem
        The store cannot be written.

    Examples
    --------
    >>> from pathlib import Path
    >>> from umform.processes.air_bending import AirBending
    >>> from umform.studies.bend_table import bend_table, setups, write_table
    >>> table = bend_table(setups(["DC04"], AirBending()), [90.0, 120.0])  # doctest: +SKIP
    >>> files = write_table(table, Path("bends"), ["csv", "freecad"])  # doctest: +SKIP
    """
    check_arguments(bend_table, wanted=wanted, angles=angles, tolerance=tolerance, check=check, store=store)
    notes = each(notes)
    check_arguments(bend_table, notes=notes)
    check_processes(processes)
    for setup in wanted:
        for angle in angles:
            _check(setup, angle, tolerance)
    store = Store() if store is None else store
    store.prepare()
    task = partial(_tabled, angles=sorted(set(angles)), tolerance=tolerance, check=check, folder=store.folder)
    with progress_bar(progress) as tick:
        if len(wanted) == 1:  # it runs in this process
            task = partial(task, tick=lambda done: tick("bends", done))
        parts = run_all(
            task,
            list(wanted),
            [1.0] * len(wanted),
            on_failure=_raise,
            processes=processes,
            tick=lambda done: tick("bends", done),
        )
    return BendTable(tuple(parts), tolerance, tuple(notes))


def _check(setup: Setup, angle: float, tolerance: float) -> None:
    try:
        check_bend(setup.case, angle, tolerance)
    except InvalidValue as error:
        error.cause = f"{setup.name}: {error.cause}"
        raise


def _tabled(
    setup: Setup,
    angles: Sequence[float],
    tolerance: float,
    check: bool,
    folder: Path,
    tick: Callable[[float], None] = lambda done: None,
) -> Tabled:
    failed: dict[float, str] = {}

    def miss(angle: float, error: UmformError) -> None:
        failed[angle] = f"{error.what}: {error.cause}" if error.cause else error.what

    middles = [0.5 * (low + high) for low, high in itertools.pairwise(angles)] if check else []
    wanted = [*angles, *middles]
    done = itertools.count(1)
    found = bends(
        setup.case,
        wanted,
        tolerance=tolerance,
        store=Store(folder),
        each=lambda one: tick(next(done) / len(wanted)),
        on_failure=miss,
    )
    rows = tuple(one for one in found if one.wanted in angles)
    ends = (rows[0].wanted, rows[-1].wanted) if rows else (math.inf, -math.inf)
    checks = tuple(one for one in found if one.wanted not in angles and ends[0] < one.wanted < ends[1])
    return Tabled(setup, rows, {angle: why for angle, why in failed.items() if angle in angles}, checks)


def _raise(setup: Setup, error: Exception) -> Tabled:
    raise error
