"""Measures of a sheet that was drawn through a bead."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, Self

import numpy as np
from numpy.typing import NDArray

from umform.analysis.run import Result
from umform.processes.draw_bead.spec import DrawBead
from umform.processes.extrapolation import Limit
from umform.results import fields
from umform.results.outcome import Outcome
from umform.results.quantity import Quantity, quantities_of
from umform.sheet_metals import sheet_text

Floats = NDArray[np.float64]

#: Parts of the work of the drawing force.
_ENERGIES = ("elastic_energy", "plastic_work", "contact_energy", "friction_work")


@dataclass(frozen=True, repr=False)
class Drawn(Outcome):
    """A strip that was drawn through a bead; forces are per length of bead in N/mm.

    Attributes
    ----------
    case : DrawBead
        The parameters.
    way, restraint_curve, uplift_curve : ndarray, shape (n,)
        Travel of the strip in mm, drawing force, and force that separates the tools, in each increment.
    result : Result
        History, frames and iterations.
    limits : dict of str to Limit
        Numbers extrapolated to zero element size, by their names, if several meshes were run.
    """

    case: DrawBead
    way: Floats
    restraint_curve: Floats
    uplift_curve: Floats
    restraint: Annotated[float, Quantity("restraining force", "N/mm", 1, leading=True)]
    """Mean over the steady part of the travel, which begins when the exiting sheet has passed the whole bead."""
    restraint_spread: Annotated[float, Quantity("half range of the restraining force", "N/mm", 1)]
    """Half of the range of the force over this part: ripple due to the mesh."""
    uplift: Annotated[float, Quantity("uplift force", "N/mm", 1, leading=True)]
    """Mean over the steady part."""
    uplift_spread: Annotated[float, Quantity("half range of the uplift force", "N/mm", 1)]
    """Half of the range over this part."""
    closing_force: Annotated[float, Quantity("largest force to close", "N/mm", 1, leading=True)]
    """Largest force to close the tools."""
    thinning: Annotated[float, Quantity("thinning out", "%", 2, leading=True)]
    """Relative loss of thickness of the sheet that has passed the whole bead."""
    friction_share: Annotated[float, Quantity("share of friction in the work", "%", 1)]
    """Work of friction relative to that of the force, on the steady part."""
    balance: Annotated[float, Quantity("work less energies, over the work", "%", 2)]
    """Work of the force minus plastic, friction and elastic work, relative to the work of the force."""
    result: Result
    limits: dict[str, Limit] = field(default_factory=dict)

    @classmethod
    def of(cls, case: DrawBead, result: Result) -> Self:
        """Measure the result of a case."""
        drawing = result["step"] == result["step"].max()
        way, force, uplift = (result[name][drawing] for name in ("way", "way_force", "upper_tool_fz"))
        steady = way >= case.through
        work = float(np.trapezoid(force[steady], way[steady]))
        grown = {name: _growth(result[name][drawing][steady]) for name in _ENERGIES}
        return cls(
            case=case,
            way=way,
            restraint_curve=force,
            uplift_curve=uplift,
            restraint=_mean(way[steady], force[steady]),
            restraint_spread=0.5 * float(np.ptp(force[steady])),
            uplift=_mean(way[steady], uplift[steady]),
            uplift_spread=0.5 * float(np.ptp(uplift[steady])),
            closing_force=float(result["upper_tool_fz"][~drawing].max()),
            thinning=-100.0 * _change_of_thickness(case, result),
            friction_share=100.0 * grown["friction_work"] / work,
            balance=100.0 * (1.0 - sum(grown.values()) / work),
            result=result,
        )

    @property
    def forces(self) -> tuple[float, float]:
        """Restraint and uplift, extrapolated to zero element size if several meshes were run."""
        if not self.limits:
            return self.restraint, self.uplift
        return self.limits["restraint"].value, self.limits["uplift"].value

    @property
    def title(self) -> str:
        """Heading of tables and pages."""
        sheet = sheet_text(self.case.material, self.case.thickness)
        return f"Draw bead: {sheet}, {self['restraint'].full_text}"

    @property
    def quantities(self) -> list[Quantity]:
        """The measures; with several meshes, those that are extrapolated have a band."""
        return quantities_of(self, {name: limit.band for name, limit in self.limits.items()})

    @property
    def stages(self) -> dict[str, Result]:
        """The run by its name."""
        return {"drawing": self.result}

    @property
    def warnings(self) -> list[str]:
        """Warnings."""
        return self.result.warnings


def _growth(values: Floats) -> float:
    """Last minus first value."""
    return float(values[-1] - values[0])


def _mean(way: Floats, values: Floats) -> float:
    """Mean over the travel."""
    return float(np.trapezoid(values, way) / (way[-1] - way[0]))


def _change_of_thickness(case: DrawBead, result: Result) -> float:
    """Relative change at the end, where the sheet has moved from before one edge to behind the other."""
    model = result.model
    before = model.mesh.points[:, 0]
    now = before + model.u.reshape(-1, 3)[:, 0]
    passed = (before < -case.reach) & (now > case.reach)
    return float(fields.thickness_change(model)[passed].mean())
