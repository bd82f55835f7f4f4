"""The angle along a bend: its run, and the stroke that the deflection of the press brake takes away."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.io.tables import write_csv
from umform.processes.air_bending import AirBend, AirBending
from umform.results.outcome import Annex, Study
from umform.studies.deflection.beam import crown
from umform.studies.deflection.press_brake import PressBrake
from umform.studies.derivatives import derivatives
from umform.studies.own_case import refuse_other_case

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]
#: Files: the angle along the bend, and its picture.
TABLE, PICTURE = FILES = ("along.csv", "along.png")
#: Points along the bend.
_POINTS = 101
#: Change of the force by the deflection beyond which a uniform line load is no estimate.
_UNIFORM = 0.05
_COLUMNS = ("mm from the middle", "deflection, mm", "crowning, mm", "stroke, mm", "angle, degrees")


@dataclass(frozen=True, repr=False)
class AngleAlong(Study):
    """Angle along a bend.

    Attributes
    ----------
    case : AirBending
        The bend.
    brake : PressBrake
        The press brake.
    length : float
        Length of the bend.
    angle, force : float
        Angle after unloading in degrees and force per length of bend, at the stroke of the case.
    slope, stiffness : float
        Their derivatives with respect to the stroke.

    Examples
    --------
    >>> from umform.processes.air_bending import AirBending
    >>> from umform.studies.deflection import PressBrake, angle_along
    >>> case = AirBending(stroke=3.0, layers=1, elements_per_thickness=1)
    >>> brake = PressBrake(span=3100.0, ram_height=1400.0, ram_thickness=60.0)
    >>> found = angle_along(case, brake, 3000.0)
    >>> 0.7 < found.error < 0.9 and 0.05 < found.best_crowning < 0.07
    True
    """

    case: AirBending
    brake: PressBrake
    length: float
    angle: float
    force: float
    slope: float
    stiffness: float

    @property
    def y(self) -> Floats:
        """Distances from the middle of the bend."""
        return np.linspace(-0.5 * self.length, 0.5 * self.length, _POINTS)

    @property
    def deflection(self) -> Floats:
        """Way by which ram and bed give, along the bend."""
        return self.brake.deflection(self.y, self.length, self.force)

    @property
    def crown(self) -> Floats:
        """Rise of the bed along the bend for a crowning of 1."""
        return crown(self.y, self.brake.span or self.length)

    def angles(self, crowning: float | None = None) -> Floats:
        """Angle along the bend, with the crowning of the press brake or another one. eq. (5.96)"""
        rise = self.brake.crowning if crowning is None else crowning
        return np.asarray(self.angle + self.slope * (rise * self.crown - self.deflection))

    @property
    def error(self) -> float:
        """Angle in the middle less that at the ends, in degrees."""
        angles = self.angles()
        return float(angles[_POINTS // 2] - angles[0])

    @property
    def best_crowning(self) -> float:
        """Crowning with the same angle in the middle as at the ends. eq. (5.97)"""
        lost, rise, middle = self.deflection, self.crown, _POINTS // 2
        return float((lost[middle] - lost[0]) / (rise[middle] - rise[0]))

    @property
    def annex(self) -> Annex:
        """Table and picture."""
        angles, y, lost = self.angles(), self.y, self.deflection
        rise = self.brake.crowning * self.crown
        stroke = (self.case.stroke or 0.0) + rise - lost
        rows = [
            [f"{y[k]:.0f}", f"{lost[k]:.3f}", f"{rise[k]:.3f}", f"{stroke[k]:.3f}", f"{angles[k]:.2f}"]
            for k in range(0, _POINTS, (_POINTS - 1) // 4)
        ]
        best = self.angles(self.best_crowning)
        notes = [
            f"the angle in the middle is {self.error:+.2f} degrees from that at the ends, by a deflection of "
            f"{lost[_POINTS // 2]:.3f} mm in the middle and {self.slope:+.2f} degrees for each mm of stroke",
            f"crowning of {self.best_crowning:.3f} mm makes both equal; between them {np.ptp(best):.3f} degrees remain",
            f"the angle of the run is that without deflection: a stroke larger by {lost[0] - rise[0]:.3f} mm "
            "has it at the ends",
        ]
        share = abs(self.stiffness) * float(np.ptp(lost - rise)) / self.force
        warnings = [
            f"the deflection changes the force along the bend by {100.0 * share:.0f} %, which the estimate leaves out"
        ]
        return Annex(
            "Angle along the bend", [list(_COLUMNS), *rows], notes, warnings if share > _UNIFORM else [], self.plot,
            "Angle along the bend, with the deflection of ram and bed.",
        )  # fmt: skip

    def plot(self) -> Figure:
        """The angle along the bend as it is, without crowning, and with the best one."""
        from umform.plotting import Plot, house_style

        curves = {
            f"crowning {self.brake.crowning:.3g} mm": self.angles(),
            f"crowning {self.best_crowning:.3f} mm": self.angles(self.best_crowning),
        }
        with house_style():
            figure = Plot(figsize=(6.5, 3.2), layout="constrained")
            axes = figure.add_subplot()
            for label, angles in curves.items():
                axes.plot(self.y, angles, label=label)
            axes.set_xlabel("distance from the middle of the bend, mm")
            axes.set_ylabel("angle, degrees")
            axes.legend()
        return figure

    def write(self, folder: str | Path) -> list[Path]:
        """Write the table with all points, and the picture.

        Returns
        -------
        list of Path
            The files.
        """
        from umform.plotting import save

        folder = Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        rise = self.brake.crowning * self.crown
        stroke = (self.case.stroke or 0.0) + rise - self.deflection
        columns = (self.y, self.deflection, rise, stroke, self.angles())
        write_csv(folder / TABLE, dict(zip(_COLUMNS, columns, strict=True)))
        save(self.plot(), folder / PICTURE)
        return [folder / name for name in FILES]


def angle_along(case: AirBending, brake: PressBrake, length: float, bend: AirBend | None = None) -> AngleAlong:
    """Angle along a bend from the deflection of the press brake: a first order estimate. docs/theory, 5.16

    Parameters
    ----------
    case : AirBending
        The bend, with its stroke: the way of the punch at the side frames.
    brake : PressBrake
        Ram and bed.
    length : float
        Length of the bend, in the middle of the press brake.
    bend : AirBend, optional
        The bend of this case, if it has been run: its angle and force; those of the run of the derivatives otherwise.

    Raises
    ------
    InvalidValue
        If the bend is longer than the span, the press brake has none, or the bend is that of another case.
    """
    if brake.span is None or not 0.0 < length <= brake.span:
        raise InvalidValue(
            "a bend lies between the side frames",
            where="length",
            value=length,
            cause=f"their distance is {brake.span}",
            remedy="a bend no longer than the span",
        )
    if bend is not None:
        refuse_other_case(bend, case, "bend")
    found = derivatives(case, ["stroke"], ["angle", "force"])
    angle, force = (found[name, "stroke"] for name in ("angle", "force"))
    if angle.value is None or force.value is None:
        raise InvalidValue(
            "the change of the angle with the stroke is unknown",
            where="stroke",
            value=case.stroke,
            cause="; ".join(found.warnings) or "the run ended early",
            remedy="another stroke",
        )
    known = bend["angle"].value if bend else angle.response.value, bend["force"].value if bend else force.response.value
    return AngleAlong(case, brake, length, float(known[0] or 0.0), float(known[1] or 0.0), angle.value, force.value)
