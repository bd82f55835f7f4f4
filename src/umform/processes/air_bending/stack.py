"""Several sheets that are bent at once: the further ones, on the first."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, ClassVar, Protocol

from annotated_types import Ge, Le

from umform.errors import InvalidValue
from umform.processes.rules import PLASTIC, WITHOUT_RATE, check_rolling
from umform.spec import About, check_fields, names_its_words
from umform.spec.types import Length

if TYPE_CHECKING:
    from umform.materials import J2, Metal


@names_its_words
@dataclass(frozen=True)
class StackedSheet:
    """A sheet on those below it, such as a protective foil or the second of two blanks.

    Examples
    --------
    >>> from umform.materials import J2, Perfect
    >>> from umform.processes.air_bending import AirBending, StackedSheet
    >>> foil = StackedSheet(0.1, J2(E=300.0, nu=0.45, hardening=Perfect(12.0)), friction=0.2)
    >>> AirBending(thickness=1.0, opening=12.0, stroke=4.0, on_top=[foil], friction=0.2).height
    1.1
    """

    groups: ClassVar = {"thickness": "Second sheet"}
    """Group of the parameters from each of these on."""

    thickness: Length
    """Thickness of the sheet."""
    material: Annotated[J2 | Metal, PLASTIC, WITHOUT_RATE]
    """Law of the sheet."""
    friction: Annotated[float, Ge(0.0), Le(2.0), About(cause="per cent instead of a part of one")] = 0.0
    """Coefficient of friction with the sheet below."""
    bonded: bool = False
    """Whether it sticks to the sheet below, as the foil that protects a blank, or clad metal."""

    def __post_init__(self) -> None:
        check_fields(self)
        if self.bonded and self.friction:
            raise InvalidValue(
                "a bonded sheet does not slide",
                where="friction",
                value=f"{self.friction:g}",
                cause="bonded beside it",
                remedy="leave one of them out",
            )


class Stacked(Protocol):
    """What a case with several sheets has: the further ones, bottoming, the rolling direction of all."""

    @property
    def on_top(self) -> tuple[StackedSheet, ...]:
        """See `AirBending`."""

    @property
    def bottoming(self) -> bool:
        """See `AirBending`."""

    @property
    def rolling(self) -> float | None:
        """See `AirBending`."""

    @property
    def shears(self) -> bool:
        """See `AirBending`."""


def of_sheet(case: Stacked, what: str, number: int = 0) -> str:
    """Name of a set of one of the sheets, counted from the die from 0: ``upper``, or ``upper of sheet1`` of several."""
    return f"{what} of {name_of(number)}" if case.on_top else what


def name_of(number: int) -> str:
    """Name of a sheet, counted from the die from 0, in a deck."""
    return f"sheet{number + 1}"


def bonded_sheets(case: Stacked) -> list[list[int]]:
    """Numbers of the sheets that stick together, from the die upwards."""
    groups = [[0]]
    for number, sheet in enumerate(case.on_top, 1):
        if sheet.bonded:
            groups[-1].append(number)
        else:
            groups.append([number])
    return groups


def edges_of(case: Stacked, group: int = 0) -> list[str]:
    """Sets of the nodes of the section, of the sheets that are bonded to the first, or of another group."""
    return [edge for number in bonded_sheets(case)[group] for edge in edges_of_sheet(case, number)]


def edges_of_sheet(case: Stacked, number: int) -> list[str]:
    """Sets of the nodes of the section of one sheet: its face y0, and y1 if it shears along the bend."""
    faces = ("y0", "y1") if case.shears else ("y0",)
    return [of_sheet(case, face, number) for face in faces]


def between(number: int) -> str:
    """Name of the contact of a sheet with the next one."""
    return f"between{number + 1}"


def check_stack(case: Stacked) -> None:
    """Refuse what no stack has: bottoming, and a metal with directions without a rolling direction.

    Raises
    ------
    InvalidValue
    """
    for sheet in case.on_top:
        check_rolling(sheet.material, case.rolling)
    if case.on_top and case.bottoming:
        raise InvalidValue(
            "several sheets are not pressed onto the flanks of the die",
            where="bottoming",
            value=f"{len(case.on_top) + 1} sheets",
            cause="on_top beside bottoming",
            remedy="one sheet, or an air bend",
        )


def refuse_stack(sheet: Stacked, where: str) -> None:
    """Refuse several sheets where one is meant.

    Raises
    ------
    InvalidValue
    """
    if sheet.on_top:
        raise InvalidValue(
            "this has one sheet",
            where=where,
            value=f"{len(sheet.on_top) + 1} sheets",
            cause="on_top of the sheet is not empty",
            remedy="AirBending without on_top; only single air bends have several sheets",
        )
