"""How results change with parameters, as a table and a picture: base of derivatives and of slopes of whole runs."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from umform.errors import InvalidValue
from umform.results.outcome import Annex, Study
from umform.results.quantity import UNKNOWN, Quantity
from umform.spec import Scalar
from umform.studies.derivatives.derivative import Derivative

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Rates(Study):
    """Changes of responses with parameters; `main` has the names of the responses that the process is for."""

    parameters: tuple[Scalar, ...]
    responses: tuple[Quantity, ...]
    main: tuple[str, ...]

    @abstractmethod
    def __getitem__(self, key: tuple[str, str]) -> Derivative:
        """The derivative of a response with respect to a parameter, each by its name."""

    @abstractmethod
    def write(self, folder: str | Path) -> list[Path]:
        """Write tables and picture into a folder; returns the files."""

    @property
    @abstractmethod
    def notes(self) -> list[str]:
        """Remarks on the numbers."""

    @property
    @abstractmethod
    def warnings(self) -> list[str]:
        """Warnings about the numbers."""

    def __iter__(self) -> Iterator[Derivative]:
        """All of them, by response, then by parameter."""
        return (self[one.name, other.path] for one in self.responses for other in self.parameters)

    @staticmethod
    def _index(names: Sequence[str], name: str, what: str) -> int:
        if name not in names:
            raise InvalidValue(f"there is no such {what}", value=name, remedy="one of " + ", ".join(names))
        return names.index(name)

    @property
    def table(self) -> list[list[str]]:
        """A header, and a row for each response: its value, and its change for 1 % more of each parameter."""
        rows = [["quantity", "value", *self._short_names, "unit"]]
        for response in self.responses:
            ones = [self[response.name, one.path] for one in self.parameters]
            if all(one.value in (None, 0.0) for one in ones):
                continue
            rows.append([response.label, response.number(response.value), *map(_for_one_percent, ones), response.unit])
        return rows

    @property
    def _short_names(self) -> list[str]:
        """Last part of each path, or the whole path where another one ends alike."""
        last = [one.path.rpartition(".")[2] for one in self.parameters]
        return [
            name if last.count(name) == 1 and not name.isdecimal() else one.path
            for name, one in zip(last, self.parameters, strict=True)
        ]

    def _columns(self) -> dict[str, list[Any]]:
        """Columns of the file of all of them."""
        ones = list(self)
        return {
            "response": [one.response.name for one in ones],
            "response_value": [one.response.value for one in ones],
            "parameter": [one.parameter.path for one in ones],
            "parameter_value": [one.parameter.value for one in ones],
            "value": [one.value for one in ones],
            "relative": [one.relative for one in ones],
            "unit": [one.unit for one in ones],
        }

    def _changes(self, response: str) -> bool:
        """Whether a response depends on the parameters: 1 % of one changes it by more than 1e-8 of its value."""
        ones = [self[response, one.path] for one in self.parameters]
        return any(abs(one.change or 0.0) > 1e-8 * abs(one.response.value or 0.0) for one in ones)

    @property
    def annex(self) -> Annex:
        """Table and picture for the outcome of a process."""
        title = "Changes for 1 % more of"
        zeros = ", ".join(one.path for one in self.parameters if not one.value)
        own = [f"changes for 1 more in place of 1 % where the value is zero: {zeros}"] if zeros else []
        notes = [*self.notes, *own]
        if not self.responses:
            return Annex(title, self.table, notes, self.warnings)
        main = self._main
        label = next(one.label for one in self.responses if one.name == main)
        caption = f"Change of the {label} for 1 % more of each parameter."
        return Annex(title, self.table, notes, self.warnings, lambda: self.plot(main), caption)

    @property
    def _main(self) -> str:
        """The response of the picture: the first that the process is for, or the first of all, that changes."""
        names = [one.name for one in self.responses]
        order = [*(name for name in self.main if name in names), *names]
        return next(filter(self._changes, order), order[0])

    def plot(self, response: str, path: str | Path | None = None) -> Figure:
        """Bars of the relative derivatives of a response, the largest on top."""
        from umform.studies.derivatives.picture import tornado

        self._index([one.name for one in self.responses], response, "response")
        return tornado([one for one in self if one.response.name == response], path)


def _for_one_percent(one: Derivative) -> str:
    """Change of the response for 1 % more of the parameter; for 1 of a parameter that is zero."""
    if one.change is None:
        return UNKNOWN
    band = "" if one.band is None else f" ± {one.band * abs(one.size):.2g}"
    return f"{one.change:+.3g}{band}"
