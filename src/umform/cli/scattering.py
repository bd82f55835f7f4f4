"""Options for the scatter of the results of a command: what scatters, how much, within which limits."""

from __future__ import annotations

import inspect
import math
import shlex
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import typer

from umform.cli.root import say_of
from umform.cli.spec_options import in_place_of
from umform.errors import InvalidValue

if TYPE_CHECKING:
    from umform.results.outcome import Outcome
    from umform.studies.scatter import Scattered
    from umform.studies.scatter.study import Plan

_Outcome = TypeVar("_Outcome", bound="Outcome")
_PANEL = "Scatter of the results"


#: Option, its values and its help, by the names of `uf.scatter`.
_OPTIONS = {
    "sources": ("--scatter", "PATH=SIZE", "Standard deviation of a parameter, such as `thickness=2%` or `0.02`"),
    "tolerances": (
        "--tolerance-of",
        "PATH=SIZE",
        "Tolerance of a parameter, such as `die_radius=±0.05`: three standard deviations",
    ),
    "correlations": ("--correlate", "A,B=NUMBER", "Correlation of two parameters, from -1 to 1"),
    "limits": ("--limit", "NAME=LOW:HIGH", "Limits of a result, such as `angle=89:91`; for Cp and Cpk"),
    "hold": ("--hold", "NAME=PATH", "Result that a parameter keeps constant, such as `angle=stroke`"),
    "of": ("--measure", "NAME", "Result; default: those with limits, or all"),
}


@dataclass(frozen=True)
class ScatterOptions:
    """Options of scatter as they are typed.

    Attributes
    ----------
    typed : dict of str to list of str
        Texts of the options by their names.
    """

    typed: dict[str, list[str] | None]

    def __bool__(self) -> bool:
        return any(self.typed.values())

    def check(self, subject: Any) -> None:
        """Refuse all that can be wrong without a run."""
        if self:
            with self._refusals():
                self._plan(subject)

    def run(self, subject: Any) -> Scattered:
        """The scatter of a problem or a case."""
        with self._refusals():
            return self._plan(subject).run()

    def added_to(
        self, outcome: _Outcome, case: Any, place: Path, found: Mapping[str, str] | None = None
    ) -> tuple[_Outcome, list[Path]]:
        """The outcome of a process with the scatter of its results, which widens their bands, and the files.

        Without any scatter, the outcome itself. A note says that strokes that were found for angles or a force, given
        by the names of these, are constant, unless they are held.
        """
        if not self:
            return outcome, []
        from umform.studies.scatter.found import RESULTS

        spread = self.run(case)
        outcome = outcome.with_deviations(
            {one.name: math.nan if one.deviation.value is None else one.deviation.value for one in spread}
        )
        free = {name: path for name, path in (found or {}).items() if name not in self._pairs("hold")}
        constant = [
            f"the stroke is constant: --hold {shlex.quote(f'{name}={path}')} keeps the {name}"
            for name, path in free.items()
        ]
        follows = "stroke" in spread.derivatives.held.values()
        if _from_contact(case) and not follows and any(one.path.endswith("thickness") for one in spread.sources):
            constant.append(
                "the stroke counts from first contact, so the punch stops higher on a thicker sheet: "
                "--hold below_die=stroke is a press that always stops at the same height"
            )
        for annex in spread.annexes:
            notes = [*annex.notes, *constant * (annex.title == RESULTS)]
            outcome = outcome.with_annex(replace(annex, notes=notes))
        return outcome, spread.write(place)

    @staticmethod
    @contextmanager
    def _refusals() -> Iterator[None]:
        """Print what is wrong with options in their words, and exit with code 1; paths stay as they are."""
        try:
            yield
        except InvalidValue as error:
            error.where, *_ = _OPTIONS.get(error.where, (error.where,))
            say_of(error)
            raise typer.Exit(1) from error

    def _plan(self, subject: Any) -> Plan:
        from umform.studies.scatter.source import Scatter
        from umform.studies.scatter.study import Plan

        tolerances = {}
        for name, text in self._pairs("tolerances").items():
            try:
                tolerances[name] = Scatter.of(text, tolerance=True)
            except InvalidValue as error:
                error.where = name
                raise
        sources = self._pairs("sources")
        twice = sorted(sources.keys() & tolerances.keys())
        if twice:
            raise InvalidValue(
                "a parameter cannot scatter twice",
                where="--scatter, --tolerance-of",
                value=", ".join(twice),
                remedy="a standard deviation or a tolerance",
            )
        return Plan.of(
            subject,
            sources | tolerances,
            self.typed["of"],
            correlations={
                _two(pair): _number(text, f"{pair}={text}") for pair, text in self._pairs("correlations").items()
            },
            limits=self._pairs("limits"),
            hold=self._pairs("hold"),
        )

    def _pairs(self, name: str) -> dict[str, Any]:
        """Texts behind the sign = by those before it."""
        pairs: dict[str, Any] = {}
        for text in self.typed[name] or ():
            key, sign, value = text.partition("=")
            if not (sign and key.strip() and value.strip()) or key.strip() in pairs:
                raise InvalidValue(
                    "a name has two values" if key.strip() in pairs else "this is no name with a value",
                    where=name,
                    value=text,
                    cause="" if sign else "the sign = is missing",
                    remedy=f"write {_OPTIONS[name][1]}, once for each name",
                )
            pairs[key.strip()] = value.strip()
        return pairs


def _from_contact(case: Any) -> bool:
    """Whether the stroke of a case counts from first contact with the upper face of its sheet: an air bend."""
    from umform.processes.air_bending.spec import AirBending  # not for the help of the command

    return isinstance(case, AirBending) and case.stroke is not None and not case.bottoming


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


def scatter_options() -> list[inspect.Parameter]:
    """The options of a command."""
    kind = inspect.Parameter.KEYWORD_ONLY
    return [
        inspect.Parameter(name, kind, default=None, annotation=_repeatable(*told)) for name, told in _OPTIONS.items()
    ]


def with_scatter(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command the options of scatter; its parameter ``scatter`` gets them."""
    made: Callable[..., Any] = in_place_of("scatter", scatter_options(), ScatterOptions)(command)
    return made


def _repeatable(name: str, metavar: str, text: str) -> Any:
    info = typer.Option(name, metavar=metavar, help=f"{text}; repeatable.", rich_help_panel=_PANEL)
    return Annotated[list[str] | None, info]
