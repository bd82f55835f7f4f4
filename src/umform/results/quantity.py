"""Numbers that processes report: label, unit, decimals, value, band, limit; as text, table, record and columns."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields, replace
from functools import cache
from typing import Any, Self, get_type_hints

#: Text of an unknown number, and of an unknown error.
UNKNOWN, NO_BAND = "–", "unknown"


class Bad(str):
    """Text of a cell whose number is beyond its limit: red wherever it is shown."""


@dataclass(frozen=True)
class Band:
    """Estimated error of a number.

    Attributes
    ----------
    error : float
        Half of the width of the band, in the unit of the number; NaN if a run for it failed.
    source : str
        Where it comes from.
    middle : float, optional
        The best estimate, such as the extrapolation to zero element size, if it is not the value itself.
    parts : mapping of str to float
        Changes of the number by single refinements.
    """

    error: float
    source: str
    middle: float | None = None
    parts: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Quantity:
    """A number that a process reports.

    As the annotation of a field, ``radius: Annotated[float, Quantity("inside radius", "mm", 3)]``, it has no value, and
    the name is that of the field: see :func:`quantities_of`.

    Attributes
    ----------
    label, unit : str
        What people read.
    decimals : int or None
        Digits behind the point; None: as many as the error has, or `digits`.
    name : str
        Key in records and tables; default: the label.
    value : float or None
        The number; None or NaN: unknown.
    band : Band or None
        Its estimated error, if there is one.
    limit : float or None
        The largest allowed value, or the least one.
    at_least : bool
        Whether the limit is the least allowed value.
    slack : float
        Relative excess of the limit that is round-off.
    hint : str
        What the number is for.
    digits : int
        Significant digits of a number without `decimals` and error.
    leading : bool
        Whether it is one of the few numbers that are shown first.
    """

    label: str
    unit: str = ""
    decimals: int | None = None
    name: str = ""
    value: float | None = None
    band: Band | None = None
    limit: float | None = None
    at_least: bool = False
    slack: float = 0.0
    hint: str = ""
    digits: int = 4
    leading: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", self.name or self.label)
        object.__setattr__(self, "value", _known(self.value))

    @property
    def best(self) -> float | None:
        """The middle of the band, or the value."""
        return self.value if self.band is None or self.band.middle is None else self.band.middle

    @property
    def missed(self) -> bool:
        """Whether the number is beyond its limit."""
        if self.best is None or self.limit is None:
            return False
        return self.best < self.limit if self.at_least else self.best > (1.0 + self.slack) * self.limit

    @property
    def verdict(self) -> str:
        """MISSED, and by how much, of a number beyond its limit; else empty."""
        if not self.missed:
            return ""
        over = not self.at_least and self.limit
        return f"MISSED {self.best / self.limit:.3g} times over" if over else "MISSED"  # type: ignore[operator]

    @property
    def text(self) -> str:
        """The best number as text, marked beyond its limit."""
        number = self.number(self.best)
        return Bad(f"{number} {self.verdict}") if self.missed else number

    @property
    def error_text(self) -> str:
        """The error as text."""
        error = None if self.band is None else _known(self.band.error)
        if error is None:
            return NO_BAND
        return f"± {self.number(error)}" if error or self.decimals is not None else ""

    @property
    def full_text(self) -> str:
        """Number, error and unit as text."""
        error = "" if self.band is None else f" {self.error_text}".rstrip()
        unit = "°" if self.unit == "degrees" else f" {self.unit}".rstrip()
        return f"{self.text}{error}{unit}"

    @property
    def heading(self) -> str:
        """Label and unit, above a column."""
        return f"{self.label}, {self.unit}" if self.unit else self.label

    @property
    def key(self) -> str:
        """Name and unit, above a column of a CSV file."""
        return f"{self.name} {self.unit}".strip()

    def number(self, value: float | None, sign: str = "") -> str:
        """A value, an error or a change of this quantity as text."""
        if _known(value) is None or value is None:
            return UNKNOWN
        error = None if self.band is None or self.decimals is not None else _known(self.band.error)
        if self.decimals is None and not error:
            return f"{value + 0.0:{sign}.{self.digits}g}"
        places = self.decimals if self.decimals is not None else max(1 - math.floor(math.log10(error or 1.0)), 0)
        return f"{value + 0.0:{sign}.{places}f}"

    def record(self) -> dict[str, Any]:
        """All of it as JSON data, None for unknown numbers; ``missed`` says whether it is beyond its limit."""
        band = None if self.band is None else asdict(self.band)
        if band is not None:
            parts = {name: _known(change) for name, change in band["parts"].items()}
            band |= {"error": _known(band["error"]), "parts": parts}
        return asdict(self) | {"band": band, "missed": self.missed}

    @classmethod
    def of(cls, record: Mapping[str, Any]) -> Self:
        """The quantity of a record."""
        given = {one.name: record[one.name] for one in fields(cls)}
        band = given["band"] and dict(given["band"])
        if band:
            changes = {name: math.nan if change is None else change for name, change in band["parts"].items()}
            error = math.nan if band["error"] is None else band["error"]
            band = Band(**band | {"error": error, "parts": changes})
        return cls(**given | {"band": band})


def _known(value: float | None) -> float | None:
    return None if value is None or math.isnan(value) else value


@cache
def declared(kind: type) -> dict[str, Quantity]:
    """The quantities that a dataclass declares as annotations of its fields, by their names and without values."""
    hints = get_type_hints(kind, include_extras=True)
    found = {name: getattr(hints[name], "__metadata__", ()) for name in (one.name for one in fields(kind))}
    return {
        name: replace(one, name=name) for name, extras in found.items() for one in extras if isinstance(one, Quantity)
    }


def quantities_of(measures: Any, bands: Mapping[str, Band] | None = None) -> list[Quantity]:
    """The declared quantities of a dataclass with their values.

    Parameters
    ----------
    measures : dataclass instance
        The numbers.
    bands : mapping of str to Band, optional
        Their errors by the names of the fields.
    """
    known = bands or {}
    return [
        replace(one, value=getattr(measures, name), band=known.get(name))
        for name, one in declared(measures.__class__).items()
    ]


def prefixed(quantity: Quantity, prefix: str) -> Quantity:
    """A quantity of a part of a process: the prefix is before label and name."""
    return replace(quantity, label=prefix + quantity.label, name=prefix + quantity.name)


def values(quantities: Iterable[Quantity]) -> dict[str, float | None]:
    """Values by name; None for unknown ones."""
    return {one.name: one.value for one in quantities}


def table(quantities: Sequence[Quantity]) -> list[list[str]]:
    """A header and a row for each quantity: label, number, unit.

    With bands there are columns of the errors, of the numbers on the finest mesh if others are extrapolated, and of the
    changes by refinements; without them the labels have their hints.
    """
    bands = [one.band for one in quantities if one.band is not None]
    parts = list(dict.fromkeys(name for band in bands for name in band.parts))
    extrapolated = any(band.middle is not None for band in bands)
    rows = [["quantity", "value", *["error"] * bool(bands), *["finest mesh"] * extrapolated, *parts, "unit"]]
    for one in quantities:
        band = one.band
        label = f"{one.label} ({one.hint})" if one.hint and not bands else one.label
        finest = replace(one, band=None).number(one.value) if band and band.middle is not None else ""
        changes = [one.number(band.parts[name], "+") if band and name in band.parts else "" for name in parts]
        errors = [one.error_text] * bool(bands)
        rows.append([label, one.text, *errors, *[finest] * extrapolated, *changes, one.unit])
    return rows


def side_by_side(columns: Mapping[str, Sequence[Quantity]], corner: str = "quantity") -> list[list[str]]:
    """A header and a row for each quantity of several lists, a column for each list; a quantity may miss in a list."""
    found = {title: {one.label: one for one in column} for title, column in columns.items()}
    rows = {label: one for column in found.values() for label, one in column.items()}
    return [
        [corner, *found, "unit"],
        *(
            [label, *(column[label].text if label in column else "" for column in found.values()), one.unit]
            for label, one in rows.items()
        ),
    ]


def in_rows(rows: Sequence[Sequence[Quantity]]) -> list[list[str]]:
    """A header with labels and units, and a row for each list of the same quantities."""
    return [[one.heading for one in rows[0]], *([one.text for one in row] for row in rows)] if rows else []


def columns(rows: Sequence[Sequence[Quantity]], *, units: bool = False) -> dict[str, list[float | None]]:
    """Columns of a CSV file, a row for each list; ``units`` puts them behind the names.

    A quantity may miss in a list: its cell is None.
    """
    names = {one.name: one.key if units else one.name for row in rows for one in row}
    found = [values(row) for row in rows]
    return {title: [row.get(name) for row in found] for name, title in names.items()}


def list_columns(quantities: Sequence[Quantity]) -> dict[str, list[Any]]:
    """Columns of a CSV file with a row for each quantity."""
    rows = [one.record() | {"error": None, "source": None} | (one.record()["band"] or {}) for one in quantities]
    return {name: [row[name] for row in rows] for name in ("name", "label", "value", "unit", *_BEHIND)}


#: Columns of a row of a quantity behind its unit.
_BEHIND = ("error", "source", "limit", "missed")
