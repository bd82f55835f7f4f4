"""Numbers that processes report: label, unit, decimals, value, band, limit; as text, table, record and columns."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields, replace
from functools import cache
from html import escape
from typing import Any, Self, get_type_hints

from umform.notebook import Display, InNotebook

#: Text of an unknown number, and of an unknown error.
UNKNOWN, NO_BAND = "–", "unknown"
#: Significant digits of a number whose error is only round-off.
_MOST_DIGITS = 6
#: Text of the error of a number of one mesh.
OF_MESH = "of this mesh"


#: Unit of forces per length of a bend or a hem: that of press tables. The number in N/mm is the same.
FORCE_PER_LENGTH = "kN/m"

#: Source of the error that is left on a finer mesh.
ALL_BUT_MESH = "all but the mesh"


class Bad(str):
    """Text of a cell whose number is beyond its limit: red wherever it is shown."""

    def _repr_html_(self) -> str:
        return f'<b style="color:#d92d20">{escape(self)}</b>'


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
    sources : mapping of str to float
        Errors by single sources, such as the mesh, that are part of it.
    """

    error: float
    source: str
    middle: float | None = None
    parts: Mapping[str, float] = field(default_factory=dict)
    sources: Mapping[str, float] = field(default_factory=dict)

    def joined(self, other: Band) -> Band:
        """The wider one of two bands of a number, with the sources of both."""
        wide, narrow = (self, other) if not self.error < other.error else (other, self)
        text = wide.source if wide.source == narrow.source else f"{wide.source}; or {narrow.source} if that is more"
        return replace(wide, source=text, sources={**narrow.sources, **wide.sources})

    def beside_the_mesh(self, other: Band) -> Band:
        """An extrapolation over meshes with the rest of another band, by the root of the sum of squares."""
        more = other.sources.get(ALL_BUT_MESH)
        if more is None:
            return self
        text = f"{self.source}; errors by other sources {other.source}"
        sources = {"mesh": self.error, ALL_BUT_MESH: more}
        return replace(self, error=math.hypot(self.error, more), source=text, sources=sources)

    def widened(self, error: float, source: str, name: str) -> Band:
        """With an independent error of another source, by the root of the sum of squares."""
        return replace(
            self,
            error=math.hypot(self.error, error),
            source=f"{self.source}; with {source}" if self.source else source,
            sources={**self.sources, name: error},
        )


#: The band of a number that the user has given.
GIVEN = Band(0.0, "given")


@dataclass(frozen=True)
class Quantity(InNotebook):
    """A number that a process reports.

    As the annotation of a field, ``radius: Annotated[float, Quantity("inside radius", "mm", 3)]``, it has no value, and
    the name is that of the field: see :func:`quantities_of`.

    Attributes
    ----------
    label, unit : str
        What people read.
    decimals : int or None
        Digits behind the point; None: as many as the error has, or `digits`. They are more where they would show an
        error as zero that is within the `digits` of the number.
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
    of_mesh : bool
        Whether it is that of one mesh, whose error is not known.
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
    of_mesh: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", self.name or self.label)
        object.__setattr__(self, "value", _known(self.value))

    def _display(self) -> Display:
        return Display(self.label, {"": table([self])})

    @property
    def best(self) -> float | None:
        """The middle of the band, or the value."""
        return self.value if self.band is None or self.band.middle is None else self.band.middle

    @property
    def error(self) -> float:
        """The error, for the shade of a picture; 0 if it is not known."""
        return 0.0 if self.band is None or math.isnan(self.band.error) else self.band.error

    @property
    def relative_error(self) -> float:
        """The same over the number; 0 for a number that is 0."""
        return self.error / abs(self.value) if self.value else 0.0

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
            return OF_MESH if self.of_mesh else NO_BAND
        if self.band == GIVEN:
            return GIVEN.source
        text = f"± {self.number(error)}" if error or self.decimals is not None else ""
        return ", ".join(filter(None, [text, OF_MESH * self.of_mesh]))

    @property
    def has_error(self) -> bool:
        """Whether there is something to say of its error."""
        return self.band not in (None, GIVEN) or self.of_mesh

    @property
    def full_text(self) -> str:
        """Number, error and unit as text."""
        error = "" if self.band is None else f" {replace(self, of_mesh=False).error_text}".rstrip()
        unit = "°" if self.unit == "degrees" else f" {self.unit}".rstrip()
        return f"{self.text}{error}{unit}" + (f", {OF_MESH}" if self.of_mesh else "")

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
        error = None if self.band is None else _known(self.band.error)
        hidden = error and round(error, self.decimals or 0) == 0.0 and self.relative_error >= 10.0**-self.digits
        if self.decimals is not None and not hidden:
            return f"{value + 0.0:{sign}.{self.decimals}f}"
        if not error:
            return f"{value + 0.0:{sign}.{self.digits}g}"
        places = 1 - math.floor(math.log10(error or 1.0))
        if value:  # an error of round-off asks for all digits that there are
            places = min(places, max(self.digits, _MOST_DIGITS) - 1 - math.floor(math.log10(abs(value))))
        return f"{value + 0.0:{sign}.{max(places, 0)}f}"

    def record(self) -> dict[str, Any]:
        """All of it as JSON data, None for unknown numbers; ``missed`` says whether it is beyond its limit."""
        band = None if self.band is None else asdict(self.band)
        if band is not None:
            both = {of: {name: _known(one) for name, one in band[of].items()} for of in ("parts", "sources")}
            band |= {"error": _known(band["error"]), **both}
        return asdict(self) | {"band": band, "missed": self.missed}

    @classmethod
    def of(cls, record: Mapping[str, Any]) -> Self:
        """The quantity of a record."""
        given = {one.name: record.get(one.name, one.default) for one in fields(cls)}
        band = given["band"] and dict(given["band"])
        if band:
            changes = {of: {name: _nan(one) for name, one in band.get(of, {}).items()} for of in ("parts", "sources")}
            band = Band(**band | {"error": _nan(band["error"])} | changes)
        return cls(**given | {"band": band})


def _known(value: float | None) -> float | None:
    return None if value is None or math.isnan(value) else value


def _nan(value: float | None) -> float:
    return math.nan if value is None else value


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

    With bands or numbers of one mesh there are columns of the errors, of the numbers on the finest mesh if others are
    extrapolated, and of the changes by refinements; without changes the labels have their hints.
    """
    bands = [one.band for one in quantities if one.band is not None]
    parts = list(dict.fromkeys(name for band in bands for name in band.parts))
    extrapolated = any(band.middle is not None for band in bands)
    errors_known = any(one.has_error for one in quantities)
    rows = [["quantity", "value", *["error"] * errors_known, *["finest mesh"] * extrapolated, *parts, "unit"]]
    for one in quantities:
        band = one.band
        label = f"{one.label} ({one.hint})" if one.hint and not parts else one.label
        finest = replace(one, band=None).number(one.value) if band and band.middle is not None else ""
        changes = [one.number(band.parts[name], "+") if band and name in band.parts else "" for name in parts]
        errors = [one.error_text] * errors_known
        rows.append([label, one.text, *errors, *[finest] * extrapolated, *changes, one.unit])
    return rows


def side_by_side(columns: Mapping[str, Sequence[Quantity]], corner: str = "quantity") -> list[list[str]]:
    """A header and a row for each quantity of several lists, a column for each list; a quantity may miss in a list."""
    found = {title: {one.label: one for one in column} for title, column in columns.items()}
    rows = {label: one for column in found.values() for label, one in column.items()}
    return [
        [corner, *found, "unit"],
        *(
            [label, *(_with_error(column[label]) if label in column else "" for column in found.values()), one.unit]
            for label, one in rows.items()
        ),
    ]


def _with_error(one: Quantity) -> str:
    """Number and error as text; a number beyond its limit stays marked."""
    if one.band is None or not one.error_text:
        return one.text
    text = f"{one.text} {one.error_text}"
    return Bad(text) if one.missed else text


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
    """Columns of a CSV file with a row for each quantity; one of the finest mesh if others are extrapolated."""
    rows = []
    for one in quantities:
        row = one.record()
        rows.append(row | {"error": None, "source": None, "middle": None} | (row["band"] or {}) | {"value": one.best})
    found = {name: [row[name] for row in rows] for name in ("name", "label", "value", "unit", *_BEHIND)}
    extrapolated = [row["middle"] is not None for row in rows]
    if not any(extrapolated):
        return found
    finest = [one.value if other else None for one, other in zip(quantities, extrapolated, strict=True)]
    return found | {"finest_mesh": finest}


#: Columns of a row of a quantity behind its unit.
_BEHIND = ("error", "source", "of_mesh", "limit", "missed")
