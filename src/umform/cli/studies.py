"""Studies of a process beside its run: wanted results, derivatives, scatter."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import typer

from umform.cli.compensate import bounded, check_wanted, wanted
from umform.cli.scattering import ScatterOptions, scatter_options
from umform.cli.spec_options import in_place_of
from umform.errors import InvalidValue

if TYPE_CHECKING:
    from umform.results.outcome import Outcome
    from umform.studies.derivatives.rates import Rates
    from umform.studies.goals import Compensated

_Outcome = TypeVar("_Outcome", bound="Outcome")

Want = Annotated[
    list[str] | None,
    typer.Option(
        metavar="NAME=VALUE+-TOLERANCE",
        help="A wanted result, such as angle=90+-0.05; parameters --by follow; repeatable, see `umform compensate`.",
    ),
]
By = Annotated[
    list[str] | None,
    typer.Option(
        metavar="PATH",
        help="A parameter that follows a wanted result, with bounds as `holder_force=2000:8000`; repeatable.",
    ),
]
Derive = Annotated[
    list[str] | None,
    typer.Option(
        metavar="PATH",
        help="Derivatives of the results by a parameter, such as thickness; repeatable, see `umform derive`.",
    ),
]


@dataclass
class Studies:
    """Studies as they are typed.

    Attributes
    ----------
    want, by, derive : list of str or None
        Texts of these options.
    scatter : ScatterOptions
        Those of the scatter.
    found : Compensated, optional
        The runs on the way to wanted results.
    """

    want: list[str] | None
    by: list[str] | None
    derive: list[str] | None
    scatter: ScatterOptions
    found: Compensated | None = None

    @property
    def typed(self) -> list[str]:
        """Options of the studies that are typed."""
        options = {"--want": self.want, "--derive": self.derive, "--scatter": self.scatter}
        return [name for name, values in options.items() if values]

    def extrapolates(self, given: bool | None, *, usual: bool = True) -> bool:
        """Whether a command extrapolates from several meshes; beside a study, which has one mesh, it does not.

        Parameters
        ----------
        given : bool, optional
            ``--extrapolate`` or ``--no-extrapolate``.
        usual : bool
            Default without studies.

        Raises
        ------
        InvalidValue
            An extrapolation beside one of the studies.
        """
        if given and self.typed:
            raise InvalidValue(
                "numbers of several meshes have no goals, derivatives or scatter",
                where="--extrapolate",
                value=", ".join(self.typed),
                cause="these studies are those of one mesh, and its numbers are others",
                remedy="leave out --extrapolate, or the study",
            )
        return (usual and not self.typed) if given is None else given

    def check_wanted(self, *, searched: bool = False) -> None:
        """Refuse wanted results that are wrong before a run; ``searched``: the stroke, their start, is not known."""
        check_wanted(self.want, self.by, searched)

    def check(self, case: Any, hold: Mapping[str, str] | None = None) -> None:
        """Refuse what is no parameter, or follows a result, before the run."""
        if self.derive:
            from umform.studies.derivatives.derive import known_parameters

            known_parameters(case, self.derive, "--derive", hold)
        self.scatter.check(case)

    def compensated(self, case: Any) -> Any:
        """The case with parameters for the wanted results; the case itself without any."""
        self.check_wanted()
        if not self.want or not self.by:
            return case
        from umform.studies.goals import compensate

        paths, bounds = bounded(self.by)
        self.found = compensate(case, wanted(self.want), paths, bounds=bounds)
        return self.found.subject

    def wanted_by(self, path: str) -> str:
        """The wanted result that a parameter was found for, the angle if it is one of them; empty if it was given."""
        if self.found is None or path not in self.found.parameters:
            return ""
        return "angle" if "angle" in self.found.wanted else next(iter(self.found.wanted))

    def in_deck(self, case: Any) -> Any:
        """The case with parameters for the wanted results, for its deck; studies of its run are refused."""
        if self.derive or self.scatter:
            raise InvalidValue(
                "a deck is printed without a run, which has derivatives or scatter",
                where="--print-deck",
                value=", ".join(name for name in self.typed if name != "--want"),
                cause="both options",
                remedy="leave one out; `umform derive` and `umform sigma` take the deck",
            )
        return self.compensated(case)

    def added_to(
        self,
        outcome: _Outcome,
        case: Any,
        place: Path,
        *,
        hold: Mapping[str, str] | None = None,
        finished: bool = True,
        rates: Callable[[], Rates] | None = None,
    ) -> Iterator[tuple[_Outcome, list[Path]]]:
        """The outcome of a process with one study more each time, and the files of this study.

        Parameters
        ----------
        outcome : Outcome
            That of the run.
        case : Spec
            Its parameters.
        place : Path
            Folder of the files.
        hold : mapping of str to str, optional
            Results that parameters keep constant in the derivatives; a note of the scatter says that these stay.
        finished : bool
            Whether the run has ended; otherwise only the runs on the way to wanted results are added.
        rates : callable, optional
            Derivatives, if they are not those of a run with ``case``.
        """
        if self.derive and finished:
            from umform.studies.derivatives import derivatives

            found = rates() if rates else derivatives(case, self.derive, hold=hold)
            outcome = outcome.with_annex(found.annex)
            yield outcome, found.write(place)
        if self.scatter and finished:
            outcome, files = self.scatter.added_to(outcome, case, place, hold)
            yield outcome, files
        if self.found is not None:
            yield outcome.with_annex(self.found.annex), self.found.write(place)

    def end(self) -> None:
        """Exit with code 1 if the wanted results are not reached."""
        if self.found is not None and not self.found.reached:
            raise typer.Exit(1)


def with_studies(*, goals: bool = True) -> Callable[[Callable[..., Any]], Any]:
    """Give a command the options of the studies, perhaps without goals; its parameter ``studies`` gets them."""
    kind = inspect.Parameter.KEYWORD_ONLY
    own = {"want": Want, "by": By, "derive": Derive} if goals else {"derive": Derive}
    options = [inspect.Parameter(name, kind, default=None, annotation=hint) for name, hint in own.items()]
    return in_place_of("studies", [*options, *scatter_options()], _studies)


def _studies(values: dict[str, Any]) -> Studies:
    want, by, derive = (values.pop(name, None) for name in ("want", "by", "derive"))
    return Studies(want, by, derive, ScatterOptions(values))
