"""Error budget: change of each measure when mesh, contact points or increments are refined, one at a time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from umform.elements import element
from umform.pool import run_all
from umform.processes.air_bending.brake import Brake
from umform.processes.air_bending.goal import needed_stroke
from umform.processes.air_bending.measures import Measures
from umform.processes.air_bending.problem import touching
from umform.processes.air_bending.spec import AirBending
from umform.processes.air_bending.stacked import SheetOfStack, quantities_of_stack, stack_of
from umform.progress import progress_bar
from umform.results.budget import Budget
from umform.results.quantity import quantities_of
from umform.spec import parameters

if TYPE_CHECKING:
    from umform.processes.air_bending.bend import AirBend

#: Element of the reference stack for the layers, and its points through the thickness of each element.
_STACK, _STACK_POINTS = element("EAS3DEAS", thickness_order=2, tie_E33=True), 4
_RUNS = (
    "refinements beside it: mesh, layers, points, penalty and increments. In the column stack, the sheet is eight "
    "layers of 8-node elements"
)


def refinements(case: AirBending) -> dict[str, AirBending]:
    """The case with one refinement at a time; t-pts are points through the thickness, c-pts contact points.

    Automatic values are refined from the value that they take. A parameter at its upper limit is made coarser instead.
    ``depth`` is the allowed penetration. The reference for the layers is a stack of eight: one layer more tells little
    about the error of two, which falls neither fast nor monotonically (docs/verification/air-bend-mesh.md).
    """
    elements, points = case.elements_per_thickness, case.thickness_points
    return {
        **_refined(case, "elements_per_thickness", {"mesh/2": 2.0 * elements, "mesh*2": 0.5 * elements}),
        **_layers(case),
        **_refined(case, "thickness_points", {"t-pts+2": points + 2, "t-pts-2": points - 2}),
        **_contacts(case),
        **_refined(case, "increment", {"step/2": 0.5 * case.increment, "step*2": 2.0 * case.increment}),
    }


def _refined(case: AirBending, name: str, values: dict[str, float]) -> dict[str, AirBending]:
    """The case with the first valid one of some values of a parameter."""
    label = next(label for label, value in values.items() if parameters(AirBending)[name].fits(value))
    changed: dict[str, Any] = {name: values[label]}
    return {label: replace(case, **changed)}


def _layers(case: AirBending) -> dict[str, AirBending]:
    """The case as a stack of as many layers as allowed, on the same lines of nodes along the sheet."""
    limits = parameters(AirBending)
    most = limits["layers"].most
    if case.layers == most:
        return {"layers-1": replace(case, layers=case.layers - 1)}
    finer = 2.0 if element(case.element).cell == "hex18" else 1.0  # their mid-side nodes become corner nodes
    along = finer * case.elements_per_thickness
    stack = replace(
        case,
        element=_STACK,
        layers=most,
        thickness_points=_STACK_POINTS,
        elements_per_thickness=along if limits["elements_per_thickness"].fits(along) else case.elements_per_thickness,
        width_elements=max(2, case.width_elements),  # a single element over the width would collapse
    )
    return {"stack": stack}


def _contacts(case: AirBending) -> dict[str, AirBending]:
    """The case with other contact points, and with a larger penalty."""
    contacts = list(touching(case).values())
    points = [int(contact.points) for contact in contacts]
    most = parameters(AirBending)["contact_points"].most
    if min(points) < most:
        cases = {"c-pts+2": replace(case, contact_points=min(most, max(points) + 2))}
    else:
        cases = {"c-pts-2": replace(case, contact_points=most - 2)}
    if case.penalty is not None:
        return cases | {"penalty*2": replace(case, penalty=2.0 * case.penalty)}
    allowed = contacts[0].allowed
    assert allowed is not None  # contact without a penalty has no such refinement
    return cases | {"depth/2": replace(case, penetration=0.5 * allowed)}


def error_budget(bend: AirBend, *, processes: int | None = None, progress: bool | None = None) -> Budget:
    """Run a bend again with each refinement, at the same stroke.

    The runs go in parallel processes, which are spawned: a script that calls this needs
    ``if __name__ == "__main__":``.

    Parameters
    ----------
    bend : AirBend
        The bend.
    processes : int, optional
        Number of processes; default: that of the processors.
    progress : bool, optional
        Show a progress bar; default: only on a terminal.
    """
    cases, base = refinements(bend.case), _numbers(bend.measures, bend.stack)
    with progress_bar(progress) as tick:
        answers = run_all(
            _run,
            list(cases.values()),
            [_cost(refined) for refined in cases.values()],
            on_failure=lambda task, error: str(error),
            processes=processes,
            tick=lambda done: tick("budget", done),
        )
    changes = {
        name: {
            key: answer.get(key, math.nan) - value if isinstance(answer, dict) else math.nan
            for key, value in base.items()
        }
        for name, answer in zip(cases, answers, strict=True)
    }
    return Budget(changes, {n: a for n, a in zip(cases, answers, strict=True) if isinstance(a, str)}, _RUNS)


def _run(case: AirBending) -> dict[str, float]:
    brake = Brake(case)
    brake.load(needed_stroke(case))
    loaded = brake.model.u.copy()
    measures = brake.unload()
    return _numbers(measures, stack_of(case, brake.run.result, loaded))


def _numbers(measures: Measures, stack: Sequence[SheetOfStack]) -> dict[str, float]:
    """The measures, and those of each of several sheets, by name; NaN for unknown ones."""
    found = [*quantities_of(measures), *quantities_of_stack(stack)]
    return {one.name: math.nan if one.value is None else one.value for one in found}


def _cost(case: AirBending) -> float:
    """Estimated cost of a case, in any unit."""
    return case.elements_per_thickness * case.layers * case.thickness_points / case.increment
