"""The bend of a run of its problem."""

from __future__ import annotations

import numpy as np

from umform.analysis.run import Result
from umform.processes.air_bending.bend import AirBend, Loaded
from umform.processes.air_bending.goal import needed_stroke
from umform.processes.air_bending.loading import against_flank, force_per_width, loading
from umform.processes.air_bending.measures import Measures
from umform.processes.air_bending.section import Section
from umform.processes.air_bending.spec import AirBending
from umform.processes.air_bending.stack import edges_of
from umform.processes.air_bending.stacked import names_of_stack
from umform.results.quantity import declared


def outcome_of(case: AirBending, result: Result) -> AirBend:
    """The bend of a case from a run of its problem, which has a frame at the end of each step."""
    stroke = needed_stroke(case)
    last = len(loading(case, stroke))
    under_load = [frame for frame in result.frames if result.rows[frame.number]["step"] <= last]
    end, mesh = under_load[-1], result.model.mesh
    forces = force_per_width(case, result["stroke_force"])[: end.number + 1]
    edges = edges_of(case)
    section = Section.of(mesh, end.points["displacement"], edges)
    against = against_flank(case, end.contacts)
    loaded = Loaded(stroke, float(forces[-1]), float(np.max(forces)), section, against)
    return AirBend.of(case, result, loaded, loaded.measured(Section.of(mesh, result.model.u, edges), case.height))


def names_of(case: AirBending) -> list[str]:
    """Names of the quantities of a bend."""
    return [*declared(Measures), *["force_on_width"] * (case.width is not None), *names_of_stack(case)]
