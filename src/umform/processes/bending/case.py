"""One case of free bending: build the model, bend, release, measure."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from umform.analysis.newton.newton import Newton
from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import Result, solve
from umform.analysis.steps import Move, Release
from umform.elements import element as catalogue_element
from umform.errors import UmformError
from umform.model import Model
from umform.model.terms.control import Prescribed
from umform.processes.bending.measures import at_marks, jump, roughness
from umform.processes.bending.problem import problem_of
from umform.processes.bending.spec import FreeBending
from umform.report.repeats import counted
from umform.results.balance_summary import Balanced, balanced
from umform.results.quantity import Quantity, values
from umform.results.run_record import run_record
from umform.results.shape import Shape
from umform.spec import check_arguments
from umform.timing import Timing

if TYPE_CHECKING:
    from umform.report.live import Live

Floats = NDArray[np.float64]

#: Width of the window in which jumps are looked for, as a fraction of the stroke: 0.1 of 15 mm.
_WINDOW = 0.1 / 15


@dataclass(frozen=True)
class Bending:
    """Results of one case.

    Attributes
    ----------
    case : FreeBending
        Its parameters.
    step : ndarray of int
        Step of each converged state: 0 at the start, 1 bending, 2 release.
    u, F : ndarray
        Displacement (downwards) and force (half strip, full width) of each converged state.
    shape : Shape or None
        Deformed strip at the end of the stroke, or in the last state kept on the way there; None without any state.
    solver : str
        Sparse solver that was used.
    iterations : int
        Newton iterations of all increments.
    seconds : float
        Wall time.
    warnings : tuple of str
        Warnings of the run.
    failure : str
        Why the case ended early; empty if it is complete.
    timing : Timing
        Where the time went.
    balance : Balanced or None
        Balance of forces and energies.
    checks : dict
        Penetration of the contact and balance, as JSON data.
    result : Result or None
        Everything else; None for a case that ran in another process.
    live : Live or None
        Interactive parts of its page, if requested.
    """

    case: FreeBending
    step: NDArray[np.int64]
    u: Floats
    F: Floats
    shape: Shape | None
    solver: str
    iterations: int
    seconds: float
    warnings: tuple[str, ...] = ()
    failure: str = ""
    timing: Timing = field(default_factory=Timing)
    balance: Balanced | None = None
    checks: dict[str, dict[str, object]] = field(default_factory=dict)
    result: Result | None = None
    live: Live | None = None

    @property
    def loading(self) -> tuple[Floats, Floats]:
        """Displacement and force while the strip is bent."""
        bent = self.step < 2
        return self.u[bent], self.F[bent]

    @property
    def forces(self) -> list[float | None]:
        """Forces at the marks."""
        return at_marks(*self.loading, self.case.marks)

    @property
    def zero_force(self) -> float | None:
        """Displacement at which the force is zero again; None if the case did not come so far."""
        return None if self.failure or not self.case.unload else float(self.u[-1])

    @property
    def jump(self) -> float | None:
        """Jump measure J: largest ``|dF|/F`` within any 0.1 mm (of a stroke of 15 mm) beyond the first mark."""
        return jump(*self.loading, self.case.marks[0], self.case.stroke * _WINDOW)

    @property
    def roughness(self) -> float | None:
        """Deviation (root mean square) from a smooth fit beyond the first mark, relative to the mean force."""
        return roughness(*self.loading, self.case.marks[0])

    @property
    def main(self) -> list[str]:
        """Name of its first quantity."""
        return [one.name for one in self.quantities[:1]]

    @property
    def quantities(self) -> list[Quantity]:
        """The measures: forces at the marks, displacement without force, jumps and roughness in per cent."""
        forces = zip(self.case.marks, self.forces, strict=True)
        rough = {"J": ("J", self.jump), "rms": ("roughness", self.roughness)}
        return [
            *(Quantity(f"F({mark:g})", "N", 2, name=f"F_{mark:g}", value=force) for mark, force in forces),
            Quantity("u at F = 0", "mm", 3, name="u_zero_force", value=self.zero_force),
            *(
                Quantity(label, "%", 2, name=name, value=None if share is None else 100.0 * share)
                for label, (name, share) in rough.items()
            ),
        ]

    def record(self) -> dict[str, Any]:
        """The case and its measures in one flat record; there, J and roughness are no per cents."""
        case = self.case
        return {
            "run": case.name,
            "mesh": case.mesh_name,
            "element": case.element,
            "contact": case.contact_name,
            "thickness_points": case.thickness_points,
            "thickness_rule": case.thickness_rule,
            "thickness_order": case.thickness_order,
            "tie_E33": case.tie_E33,
            **values(self.quantities),
            "quantities": [one.record() for one in self.quantities],
            "J": self.jump,
            "roughness": self.roughness,
            "solver": self.solver,
            "iterations": self.iterations,
            "seconds": self.seconds,
            **self.checks,
            "warnings": counted(self.warnings),
            "failure": self.failure,
        }

    def detached(self) -> Bending:
        """The same without the model, to be sent to another process."""
        return replace(self, result=None)


def free_bending(case: FreeBending | None = None, *, frames: int = 1, progress: bool | None = None) -> Bending:
    """Bend a strip over a cylinder and release it.

    Parameters
    ----------
    case : FreeBending, optional
        The parameters; by default those of the example on its coarse mesh.
    frames : int
        States kept for pictures in each step; at least 1, the end of the step.
    progress : bool, optional
        Show a progress bar; default: only on a terminal.

    Returns
    -------
    Bending
        Curve, measures, shape, and the result with its history and frames.

    Raises
    ------
    NoConvergence
        If it cannot be continued; the attribute ``result`` holds what was reached, see `measured`.
    InvalidValue
        If a parameter does not fit.
    """
    check_arguments(free_bending, case=case, frames=frames)
    case = case or FreeBending()
    model, punch = build(case)
    down = Move(punch, to=-case.stroke, steps=case.steps)
    steps: list[Move | Release] = [down, Release(punch)] if case.unload else [down]
    options = NewtonOptions(line_search=case.line_search)
    result = solve(model, steps, solver=case.solver, options=options, frames=max(1, frames), progress=progress)
    return measured(case, result)


def check(case: FreeBending) -> None:
    """Build and check the model of a case, so that only the solution can fail later.

    Raises
    ------
    UmformError
        If element, mesh, tool or solver do not fit; ``where`` is the parameter, or begins with the name of the case.
    """
    model, _ = build(case)
    try:
        model.system.check()
    except UmformError as error:
        error.where = f"{case.name}, {error.where}" if error.where else case.name
        raise
    try:
        _ = Newton(model.system, solver=case.solver).solver
    except UmformError as error:
        error.where = error.where or "solver"
        raise


def build(case: FreeBending) -> tuple[Model, Prescribed]:
    """Model of a case, and the control that pushes the strip down."""
    cell_of(case.element)
    try:
        made = problem_of(case).build()
    except UmformError as error:
        error.where = error.where or case.name
        raise
    punch = made.controls["punch"]
    assert isinstance(punch, Prescribed)
    return made.model, punch


def cell_of(name: str) -> str:
    """The cell that an element of the catalogue stands on."""
    try:
        return catalogue_element(name).cell
    except UmformError as error:
        error.where = error.where or "element"
        raise


def failed(case: FreeBending, error: Exception) -> Bending:
    """The results up to an exception that ended a case."""
    result: Result | None = getattr(error, "result", None)
    if result is not None and len(result) and result.frames:
        return measured(case, result, error)
    nothing = np.zeros(0)
    return Bending(case, nothing.astype(np.int64), nothing, nothing, None, "", 0, 0.0, failure=failure_text(error))


def failure_text(error: Exception | None) -> str:
    """Text of an exception that ended a case; empty without one."""
    if error is None:
        return ""
    if isinstance(error, UmformError):
        return str(error)
    return (
        f"an error that nobody expected: {type(error).__name__}: {error}\n"
        "  remedy: report it, with the command and what it prints with -v"
    )


def measured(case: FreeBending, result: Result, failure: Exception | None = None) -> Bending:
    """Measures of a result, complete or ended by a failure."""
    step = result["step"].astype(np.int64)
    bent = [number for number, frame in enumerate(result.frames) if step[frame.number] < 2]
    return Bending(
        case=case,
        step=step,
        u=-result["punch"],
        F=-result["punch_force"],
        shape=Shape.of(result, bent[-1]),
        solver=result.solver,
        iterations=int(result["iterations"].sum()),
        seconds=result.seconds,
        warnings=(*_cautions(case, result.model.mesh.cell), *result.warnings),
        failure=failure_text(failure),
        timing=result.timing,
        balance=balanced(result),
        checks=run_record({"bending": result}),
        result=result,
    )


def _cautions(case: FreeBending, cell: str) -> Iterator[str]:
    """Warnings of settings that are known to mislead."""
    if cell == "hex8" and case.mesh[1] == 1 and not case.is_paper_element:
        yield (
            "one bilinear element over the width lets the section tilt freely across the strip: with this thickness "
            "strain the force collapses; take two elements or more"
        )
    if cell == "hex18" and case.contact in (1, 2):
        yield "18-node elements with fewer than 3 x 3 contact points are as jumpy as with nodes"
