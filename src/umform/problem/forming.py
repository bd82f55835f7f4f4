"""Forming at the end of a run of a deck: strains, thinning, forming limits; what is written and reported of them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Self, cast

import numpy as np
from numpy.typing import NDArray

from umform.analysis.run import Result
from umform.io.tables import write_csv
from umform.model.contact.encounter import sheet_thickness
from umform.problem.problem import Problem
from umform.results.quantity import Quantity

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from umform.materials import Plastic
    from umform.results.forming import FormingLimit, PathFields

Floats = NDArray[np.float64]

#: Before the names of the numbers in an error budget.
_FORMING = "forming."


@dataclass(frozen=True)
class Forming:
    """Fields of forming at the end of a run, by element, and the limit that its deck gives.

    Attributes
    ----------
    fields : dict of str to ndarray
        The fields.
    limit : callable, optional
        The forming limit.
    paths : PathFields, optional
        Use of the path-dependent limit.
    known : sequence of Quantity
        Numbers of an error budget; those of forming among them have the bands.
    """

    fields: dict[str, Floats]
    limit: FormingLimit | None
    paths: PathFields | None = None
    known: Sequence[Quantity] = ()

    @classmethod
    def of(cls, deck: Problem, result: Result, known: Sequence[Quantity] = ()) -> Self | None:
        """Those of a run, which are added to its frames; None if the deck does not ask for them.

        Parameters
        ----------
        deck : Problem
            The deck.
        result : Result
            Its run.
        known : sequence of Quantity
            See above.
        """
        from umform.results.forming import KeelerBrazier, LimitTable, add_forming_fields, forming_fields

        output = deck.contents.output
        if not output.forming and output.forming_limit is None:
            return None
        mesh = result.model.mesh
        limit: FormingLimit | None = None
        if isinstance(output.forming_limit, str):
            limit = KeelerBrazier.of(sheet_thickness(mesh), cast("Plastic", result.model.bodies.only.material))
        elif output.forming_limit is not None:
            limit = LimitTable(*zip(*output.forming_limit, strict=True))
        add_forming_fields(result, limit)
        fields = forming_fields(mesh, result.model.u, limit)
        paths = None if limit is None else cls._paths(result, limit)
        return cls(fields if paths is None else fields | paths.fields, limit, paths, known)

    @staticmethod
    def _paths(result: Result, limit: FormingLimit) -> PathFields | None:
        """Paths through the states that the run has kept; None without states or without a metal."""
        from umform.results.forming import PathFields

        bodies = result.model.bodies
        material = bodies.only.material if len(bodies) == 1 else None
        states = [frame.points["displacement"] for frame in result.frames]
        if len(states) < 2 or not hasattr(material, "hardening"):
            return None
        return PathFields.of(result.model.mesh, states, limit, cast("Plastic", material))

    def warn(self, result: Result) -> None:
        """Warn of elements beyond the limit, and of paths that bend near it."""
        from umform.results.forming.strains import beyond_limit

        mesh = result.model.mesh
        text = None if self.limit is None else beyond_limit(mesh, self.fields)
        if text is not None:
            result.warn(f"the sheet tears: {text}")
        bent = None if self.paths is None else self.paths.warning(mesh)
        if bent is not None:
            result.warn(bent)

    def write(self, path: Path, result: Result) -> None:
        """Write the fields, with the middles of the elements in the blank."""
        mesh = result.model.mesh
        middle = mesh.points[mesh.connectivity].mean(axis=1)
        write_csv(path, dict(zip("xyz", middle.T, strict=True)) | self.fields)

    @property
    def numbers(self) -> list[Quantity]:
        """The largest values, as an error budget names them, with its bands."""
        from umform.results.forming import extremes

        budget = {one.name: one for one in self.known}
        found = [replace(one, name=f"{_FORMING}{one.name}", leading=False) for one in extremes(self.fields)]
        return [budget.get(one.name, one) for one in found]

    @cached_property
    def diagram(self) -> Figure:
        """Forming limit diagram, with the bands of an error budget."""
        from umform.report.forming import limit_diagram
        from umform.results.forming import BY_PATHS, MARGIN

        errors = {one.label: one.error for one in self.numbers}
        return limit_diagram(
            self.fields, self.limit, self.paths, errors.get(MARGIN, 0.0), 0.01 * errors.get(BY_PATHS, 0.0)
        )

    def parts(self) -> Iterator[str]:
        """Parts of the report."""
        from umform.report.forming import forming_parts

        return forming_parts(self.numbers, self.diagram)


def forming_numbers(deck: Problem, result: Result) -> list[Quantity]:
    """The largest values of a run; none if its deck does not ask for them."""
    found = Forming.of(deck, result)
    return [] if found is None else found.numbers
