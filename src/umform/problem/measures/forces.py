"""Forces of all tools over the travel of one of them, and the work of friction."""

from __future__ import annotations

from functools import partial
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from umform.analysis.run import Result
from umform.errors import InvalidValue
from umform.model import Model
from umform.model.terms.control import Control, OnDofs, Prescribed
from umform.model.tools.tool_controls import ToolForce, ToolMotion
from umform.problem.measures.base import Formed, Measured, MeasurePart, in_states
from umform.problem.parts import Name
from umform.report.symmetry import modelled_part

Floats = NDArray[np.float64]


class Forces(MeasurePart):
    """Force of each tool over a travel, up to the end of forming, and the work of friction."""

    numbers = ("largest force of ", "work of friction")

    kind: Literal["forces"]
    control: Name
    """Control of the abscissa, such as the stroke or the force of a pressed tool; forces are those along its direction,
    those over another load or a turn along z."""

    def check(self, model: Model, *, released: bool) -> None:
        """Refuse a deck without tools."""
        if not model.tools:
            raise InvalidValue("there is no force of a tool", where="forces", remedy="a deck with contacts")

    def take(self, name: str, part: Formed) -> Measured:
        """Sizes of the forces, and the share of friction in the work."""
        from umform.report.part_pictures import forces_picture, of_unit

        result, units = part.result, part.units
        upto = slice(0, part.row + 1)
        direction = _direction(part.problem.controls[self.control])
        way = result[self.control][upto]
        forces = {tool.name: np.abs(_along(direction, result, tool.name))[upto] for tool in part.model.tools}
        rows = [in_states(f"largest force of {tool}", units.force, formed=float(f.max())) for tool, f in forces.items()]
        friction, external = result["friction_work"][upto], result["external_work"][upto]
        work = f"{units.force} {units.length}".strip()
        rows.append(in_states("work of friction", work, formed=float(friction[-1])))
        if external[-1] > 0.0:
            rows.append(
                in_states("work of friction over all work", "%", formed=100.0 * float(friction[-1] / external[-1]))
            )
        columns = {self.control: way, **forces, "external_work": external, "friction_work": friction}
        moves = isinstance(part.problem.controls[self.control], ToolMotion | Prescribed)
        axes = of_unit(self.control, units.length if moves else ""), of_unit("force", units.force)
        caption = f"Sizes of the forces of the tools over {self.control}; {modelled_part(part.model) or 'whole part'}."
        return Measured(rows, columns, partial(forces_picture, way, forces, *axes), caption)


def _along(direction: Floats, result: Result, tool: str) -> Floats:
    """Force of the sheet on a tool along a direction, in each row."""
    force: Floats = direction @ np.stack([result[f"{tool}_f{axis}"] for axis in "xyz"])
    return force


def _direction(control: Control) -> Floats:
    way = control.way if isinstance(control, ToolForce) else control
    if isinstance(way, OnDofs):
        return np.asarray(np.eye(3)[way.dofs[0] % 3])
    return np.asarray(way.direction if isinstance(way, ToolMotion) else (0.0, 0.0, 1.0))
