"""A problem that can be solved: the model, its controls and contacts, the steps, and the options of the solution."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from os import PathLike
from typing import Any

from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import Result, resume, solve
from umform.analysis.steps import Step
from umform.model import Model
from umform.model.contact import Contact
from umform.model.terms.control import Control
from umform.surfaces import Tool, ToolSizes


@dataclass(frozen=True, kw_only=True)
class Solving:
    """Settings of a solution; on a rank other than the first these suffice, and the rank receives its share of the
    model.

    Attributes
    ----------
    options : NewtonOptions
        Options of Newton's method.
    solver : str
        Sparse solver.
    frames : int
        States that each step keeps.
    """

    options: NewtonOptions
    solver: str
    frames: int

    def solve(self, *, solver: str | None = None, **options: Any) -> Result:
        """Solve the problem; ``progress``, ``checkpoint``, ``every`` and ``note`` as for :func:`umform.solve`."""
        model, steps = self._given()
        return solve(model, steps, **self._settings(solver), **options)

    def resume(self, path: str | PathLike[str], *, solver: str | None = None, **options: Any) -> Result:
        """Resume a run of the problem; ``progress`` and ``every`` as for :func:`umform.resume`."""
        model, steps = self._given()
        return resume(path, model, steps, **self._settings(solver), **options)

    def _given(self) -> tuple[Model | None, list[Step]]:
        return None, []

    def _settings(self, solver: str | None) -> dict[str, Any]:
        return {"solver": solver or self.solver, "options": self.options, "frames": self.frames}


@dataclass(frozen=True, kw_only=True)
class Prepared(Solving):
    """A model and its steps.

    Attributes
    ----------
    model : Model
        The model.
    contacts : dict of str to Contact
        Its contacts by name.
    controls : dict of str to Control
        Its controls by name.
    steps : list of Step
        Steps, in order.
    tools : dict of str to Tool
        Surfaces of its tools by name.
    notes : sequence of str
        Notes on cuts and sizes of elements, for the results.
    sizes : ToolSizes, optional
        Sizes of the elements of a blank that follow the radii of the tools.
    """

    model: Model
    contacts: dict[str, Contact]
    controls: dict[str, Control]
    steps: list[Step]
    tools: dict[str, Tool]
    notes: Sequence[str] = ()
    sizes: ToolSizes | None = None

    def solve(self, *, solver: str | None = None, **options: Any) -> Result:
        """Solve the problem; ``progress``, ``checkpoint``, ``every`` and ``note`` as for :func:`umform.solve`."""
        return self._noted(partial(super().solve, solver=solver, **options))

    def resume(self, path: str | PathLike[str], *, solver: str | None = None, **options: Any) -> Result:
        """Resume a run of the problem; ``progress`` and ``every`` as for :func:`umform.resume`."""
        return self._noted(partial(super().resume, path, solver=solver, **options))

    def _noted(self, run: Callable[[], Result]) -> Result:
        """Run, and leave the notes with the result, or with what was reached of it."""
        try:
            result = run()
        except BaseException as error:
            self._note(getattr(error, "result", None))
            raise
        self._note(result)
        return result

    def _note(self, result: Result | None) -> None:
        if result is None:
            return
        for note in self.notes:
            result.note(note)

    def _given(self) -> tuple[Model | None, list[Step]]:
        return self.model, self.steps
