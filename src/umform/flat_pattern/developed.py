"""Flat length and bend lines of a part from its outside dimensions, by computed bends, a K-factor or a table."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from umform.errors import InvalidValue, placed
from umform.flat_pattern.allowance import (
    Allowance,
    AllowanceProvider,
    AllowanceTable,
    DeductionTable,
    KFactor,
    outside,
)
from umform.io.store import Store
from umform.processes.air_bending.formulas import INNER_RADIUS
from umform.processes.air_bending.spec import AirBending
from umform.processes.bend_sequence.outside import OutsideBend, OutsidePart
from umform.processes.bend_sequence.spec import BendSequence, Bodies
from umform.sheet_metals import name_of
from umform.studies.bend_table import StoredBend, stored_bends
from umform.studies.bend_table import bend as stored_bend

if TYPE_CHECKING:
    from umform.processes.bend_sequence.form import OutsideForm


@dataclass(frozen=True)
class Deduction:
    """Bend deduction of one bend.

    Attributes
    ----------
    value : float
        Outside lengths of both flanges less their flat length, in mm.
    radius : float
        Inside radius in mm that the bend gets.
    source : str
        Where it comes from.
    notes : tuple of str
        Remarks on its run, such as a coarse mesh.
    """

    value: float
    radius: float
    source: str
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Developed:
    """A part in the flat.

    Attributes
    ----------
    part : OutsidePart
        Its outside dimensions.
    deductions : tuple of Deduction
        Of each bend, in order of bending.
    """

    part: OutsidePart
    deductions: tuple[Deduction, ...]

    @property
    def length(self) -> float:
        """Flat length in mm. eq. (5.93)"""
        return self.part.flat(self._values)[0]

    @property
    def positions(self) -> tuple[float, ...]:
        """Distance of the bend lines from the left end in mm, in order of bending. eq. (5.93)"""
        return self.part.flat(self._values)[1]

    @property
    def _values(self) -> list[float]:
        return [one.value for one in self.deductions]

    def sequence(self, sheet: AirBending, bodies: Bodies | None = None) -> BendSequence:
        """The bends of the flat strip, which give the outside dimensions."""
        return self.part.sequence(self._values, sheet, bodies)


def developed(
    part: OutsidePart,
    sheet: AirBending,
    *,
    allowance: AllowanceProvider | None = None,
    store: Store | None = None,
) -> Developed:
    """Flat length and bend lines of a part.

    Parameters
    ----------
    part : OutsidePart
        Its outside dimensions.
    sheet : AirBending
        Thickness, material, mesh and default tools.
    allowance : callable, optional
        A K-factor or a table; without it, each bend is computed with its tools, or taken from the store.
    store : Store, optional
        Where computed bends are kept; default: that of the user.

    Raises
    ------
    InvalidValue
        If the tools do not bend so far, or the table has no such bend, metal or die.
    """
    found = []
    for number, bend in enumerate(part.bends, start=1):
        case = case_of(sheet, bend)
        if allowance is not None:
            found.append(_of(allowance, case, bend, part.acute))
        else:
            with placed(f"bend {number}, angle", "angle"):
                found.append(_computed(stored_bend(case, bend.angle, store=store), part.acute))
    return Developed(part, tuple(found))


def developed_of(form: OutsideForm, sheet: AirBending, folder: Path = Path()) -> Developed:
    """Flat length and bend lines of the part of a file, by the K-factor or the table that it names.

    Parameters
    ----------
    form : OutsideForm
        Data of the file.
    sheet : AirBending
        Thickness, material, mesh and default tools.
    folder : Path
        That of the file, for the path of a table.

    Raises
    ------
    InvalidValue, FileProblem
        As of `developed`, or the table cannot be read.
    """
    if form.k_factor is not None and form.table is not None:
        raise InvalidValue(
            "give one source of the flat length of bends",
            where="table",
            cause="k_factor is given, too",
            remedy="leave one of them out, or both: then the bends are computed",
        )
    given = None if form.k_factor is None else KFactor(form.k_factor)
    allowance = AllowanceTable.read(folder / form.table) if form.table is not None else given
    return developed(form.part(), sheet, allowance=allowance)


def developed_at_once(part: OutsidePart, sheet: AirBending, allowance: AllowanceProvider, store: Store) -> Developed:
    """The same without a run: bends that are in the store as computed, the others by a K-factor or a table."""
    found = []
    for bend in part.bends:
        case = case_of(sheet, bend)
        known = stored_bends(case, [bend.angle], store=store)
        found.append(_computed(known[0], part.acute) if known else _of(allowance, case, bend, part.acute))
    return Developed(part, tuple(found))


def case_of(sheet: AirBending, bend: OutsideBend) -> AirBending:
    """Sheet and tools of a bend."""
    return replace(sheet, **dict(bend.tools), stroke=None)  # type: ignore[arg-type]


def _computed(found: StoredBend, acute: str) -> Deduction:
    case = found.case
    source = f"computed: V {case.opening:g}, punch R {case.punch_radius:g}, bend {found.key[:12]}"
    value = found.tangent_deduction if _to_tangent(found.wanted, acute) else found.deduction
    return Deduction(value, found.radius, source, found.notes)


def _of(allowance: AllowanceProvider, case: AirBending, bend: OutsideBend, acute: str) -> Deduction:
    """By the usual inside radius of an air bend, a part of the opening."""
    if isinstance(allowance, DeductionTable):
        allowance = allowance.of(name_of(case.material), case.opening)
    radius, turn = INNER_RADIUS * case.opening, 180.0 - bend.angle
    found: Allowance = allowance(turn, radius, case.thickness)
    setback = radius + case.thickness if _to_tangent(bend.angle, acute) else outside(turn, radius, case.thickness)
    return Deduction(2.0 * setback - found.length, radius, found.source)


def _to_tangent(angle: float, acute: str) -> bool:
    return acute == "tangent" and angle < 90.0
