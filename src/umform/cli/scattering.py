"""Options for the scatter of the results of a command: what scatters, how much, within which limits."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from umform.cli.given import in_place_of
from umform.cli.outcome_screen import print_table
from umform.cli.root import console
from umform.cli.warnings import echo_warnings
from umform.errors import InvalidValue

if TYPE_CHECKING:
    from umform.studies.scatter import Scattered
    from umform.studies.scatter.study import Plan

_PANEL = "Scatter of the results"


def _repeatable(metavar: str, help_text: str, *names: str) -> Any:
    info = typer.Option(*names, metavar=metavar, help=f"{help_text}; repeatable.", rich_help_panel=_PANEL)
    return Annotated[list[str] | None, info]


#: Options by the names that they have in `uf.scatter`.
_OPTIONS = {
    "sources": _repeatable("PATH=SIZE", "Standard deviation of a parameter, such as thickness=2% or 0.02", "--scatter"),
    "tolerances": _repeatable(
        "PATH=SIZE", "Tolerance of a parameter, such as die_radius=±0.05: three standard deviations", "--tolerance"
    ),
    "correlations": _repeatable("A,B=NUMBER", "Correlation of two parameters, from -1 to 1", "--correlate"),
    "limits": _repeatable("NAME=LOW:HIGH", "Limits of a result, such as angle=89:91; for Cp and Cpk", "--limit"),
    "hold": _repeatable("NAME=PATH", "Result that a parameter keeps constant, such as angle=stroke", "--hold"),
    "of": _repeatable("NAME", "Result; default: those with limits, or all", "--measure"),
}


@dataclass(frozen=True)
class Wishes:
    """What is wanted of the scatter, as it is typed.

    Attributes
    ----------
    typed : dict of str to list of str
        Texts of the options by their names.
    """

    typed: dict[str, list[str] | None]

    def __bool__(self) -> bool:
        return any(self.typed.values())

    def plan(self, subject: Any) -> Plan:
        """The plan for a problem or a case; all that can be wrong without a run is refused."""
        from umform.studies.scatter.source import Scatter
        from umform.studies.scatter.study import Plan

        tolerances = {
            name: Scatter.of(text, tolerance=True) for name, text in self._pairs("tolerances", "--tolerance").items()
        }
        return Plan.of(
            subject,
            self._pairs("sources", "--scatter") | tolerances,
            self.typed["of"],
            correlations={
                _two(pair): _number(text, f"{pair}={text}")
                for pair, text in self._pairs("correlations", "--correlate").items()
            },
            limits=self._pairs("limits", "--limit"),
            hold=self._pairs("hold", "--hold"),
        )

    def _pairs(self, name: str, option: str) -> dict[str, Any]:
        """Texts behind the sign = by those before it."""
        pairs: dict[str, Any] = {}
        for text in self.typed[name] or ():
            key, sign, value = text.partition("=")
            if not (sign and key.strip() and value.strip()) or key.strip() in pairs:
                raise InvalidValue(
                    "a name has two values" if key.strip() in pairs else "this is no name with a value",
                    where=option,
                    value=text,
                    cause="" if sign else "the sign = is missing",
                    remedy=f"write {option} {_OPTIONS[name].__metadata__[0].metavar}, once for each name",
                )
            pairs[key.strip()] = value.strip()
        return pairs


def _two(pair: str) -> tuple[str, str]:
    one, _, other = pair.partition(",")
    return one.strip(), other.strip()


def _number(text: str, typed: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InvalidValue(
            "a correlation is a number from -1 to 1",
            where="correlations",
            value=typed,
            cause="a decimal comma" if "," in text else "",
            remedy="two names and a number, such as thickness,strength=0.5",
        ) from None


def scattering(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command the options of scatter; its parameter ``wishes`` gets them."""
    kind = inspect.Parameter.KEYWORD_ONLY
    options = [inspect.Parameter(name, kind, default=None, annotation=hint) for name, hint in _OPTIONS.items()]
    return in_place_of("wishes", options, Wishes)(command)


def show_scatter(found: Scattered, folder: Path, said: Sequence[str] = ()) -> None:
    """Print the tables, write the files, and print the warnings.

    Parameters
    ----------
    found : Scattered
        The scatter.
    folder : Path
        Where the files go.
    said : sequence of str
        Warnings that have been printed.
    """
    for title, rows in found.tables.items():
        print_table(rows, title)
    files = ", ".join(file.name for file in found.write(folder))
    console().print(f"Written to {folder}: {files}", soft_wrap=True, markup=False)
    echo_warnings(text for text in found.warnings if text not in said)
