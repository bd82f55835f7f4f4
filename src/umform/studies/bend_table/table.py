"""Bends of several metals, thicknesses and tools to several angles, side by side; the store is the checkpoint."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

from umform.errors import InvalidValue, UmformError
from umform.io.store import Store
from umform.pool import check_processes, run_all
from umform.processes.air_bending.spec import AirBending
from umform.progress import Show, progress_bar
from umform.sheet_metals import get
from umform.studies.bend_table.stored import TOLERANCE, StoredBend, bends, check_bend


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

    @property
    def name(self) -> str:
        """Name that differs for setups of other sizes, fit for files."""
        case = self.case
        return f"{self.metal}-t{case.thickness:g}-V{case.opening:g}-r{case.punch_radius:g}-d{case.die_radius:g}"


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
    """

    setup: Setup
    bends: tuple[StoredBend, ...]
    failed: dict[float, str]


@dataclass(frozen=True)
class BendTable:
    """Bends of several setups.

    Attributes
    ----------
    parts : tuple of Tabled
        One for each setup.
    tolerance : float
        Tolerance of the angles in degrees.
    """

    parts: tuple[Tabled, ...]
    tolerance: float

    @property
    def computed(self) -> int:
        """Number of bends that were not in the store."""
        return sum(one.computed for part in self.parts for one in part.bends)


def setups(
    metals: Sequence[str],
    case: AirBending,
    *,
    thicknesses: Sequence[float] = (),
    openings: Sequence[float] = (),
    punch_radii: Sequence[float] = (),
    die_radii: Sequence[float] = (),
) -> list[Setup]:
    """All combinations of metals of the library, thicknesses and tools; what is not given is that of the case.

    Raises
    ------
    InvalidValue
        The library has no such metal, or tools do not fit a thickness.
    """
    lists = {
        "thickness": thicknesses,
        "opening": openings,
        "punch_radius": punch_radii,
        "die_radius": die_radii,
    }
    chosen = [sorted(set(values)) or [getattr(case, name)] for name, values in lists.items()]
    found = []
    for metal, sizes in itertools.product(metals, itertools.product(*chosen)):
        sheet = get(metal, sizes[0])
        changes: dict[str, Any] = dict(zip(lists, sizes, strict=True))
        found.append(Setup(sheet.name, replace(case, **changes, material=sheet.law)))
    return found


def bend_table(
    wanted: Sequence[Setup],
    angles: Sequence[float],
    *,
    tolerance: float = TOLERANCE,
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
    """
    check_processes(processes)
    for setup in wanted:
        for angle in angles:
            _check(setup, angle, tolerance)
    store = Store() if store is None else store
    store.prepare()
    task = partial(_tabled, angles=sorted(set(angles)), tolerance=tolerance, folder=store.folder)
    with progress_bar(progress) as tick:
        parts = run_all(
            task,
            list(wanted),
            [1.0] * len(wanted),
            on_failure=_raise,
            processes=processes,
            tick=lambda done: tick("bends", done),
        )
    return BendTable(tuple(parts), tolerance)


def _check(setup: Setup, angle: float, tolerance: float) -> None:
    try:
        check_bend(setup.case, angle, tolerance)
    except InvalidValue as error:
        error.cause = f"{setup.name}: {error.cause}"
        raise


def _tabled(setup: Setup, angles: Sequence[float], tolerance: float, folder: Path) -> Tabled:
    failed: dict[float, str] = {}

    def miss(angle: float, error: UmformError) -> None:
        failed[angle] = f"{error.what}: {error.cause}" if error.cause else error.what

    found = bends(setup.case, angles, tolerance=tolerance, store=Store(folder), on_failure=miss)
    return Tabled(setup, tuple(found), failed)


def _raise(setup: Setup, error: Exception) -> Tabled:
    raise error
