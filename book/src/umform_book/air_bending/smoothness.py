"""Smooth curves in the air: lift-off from the punch, a second contact at the die, sliding around the shoulder."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial import Polynomial

from umform.analysis.run import Result
from umform.analysis.steps import Move
from umform.processes.air_bending import AirBending
from umform.processes.air_bending.loading import OPTIONS, force_per_width
from umform.processes.air_bending.problem import build
from umform.processes.bending.measures import SMOOTH_DEGREE, jump
from umform_book.air_bending.runs import Floats
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.page import Page

THICKNESS = 1.0
#: Window of J in thicknesses: that of the page bending-contact-points, 0.1 mm for a sheet of 1 mm.
WINDOW = 0.1
#: Largest J beyond the smooth curve.
LIMIT = 0.01


@dataclass(frozen=True)
class Event:
    """Setup of a run.

    Attributes
    ----------
    name : str
        In tables.
    case : AirBending
        The brake.
    strokes, ways : tuple of float
        Ends of the steps, and the way of one increment in each.
    """

    name: str
    case: AirBending
    strokes: tuple[float, ...]
    ways: tuple[float, ...]


LIFT_OFF = Event(
    "lift-off",
    AirBending(thickness=THICKNESS, opening=12.0, punch_radius=3.0, die_radius=1.5),
    (4.2,),
    (0.05,),
)
SECOND = Event(
    "second contact",
    AirBending(thickness=THICKNESS, opening=8.0, die_angle=120.0, die_radius=1.0, punch_radius=0.75),
    (1.75, 2.0),
    (0.05, 0.005),
)
SLIDING = Event(
    "sliding",
    AirBending(thickness=THICKNESS, opening=12.0, die_radius=0.6, punch_radius=1.1, elements_per_thickness=5.0),
    (4.5,),
    (0.05,),
)
EVENTS = (LIFT_OFF, SECOND, SLIDING)

RULES: dict[str, Callable[[AirBending], AirBending]] = {
    "automatic": lambda case: case,  # the default of the brake
    "5 points, E/h": lambda case: replace(case, contact_points=5, penalty=case.material.E / case.thickness),
    "5 points": lambda case: replace(case, contact_points=5),
    "3 points": lambda case: replace(case, contact_points=3),
}

#: Rules of each event.
RUN = {
    LIFT_OFF.name: ("automatic", "5 points, E/h"),
    SECOND.name: ("automatic", "5 points"),
    SLIDING.name: ("automatic", "5 points, E/h", "3 points"),
}
#: Way in thicknesses by which the second contact may come too early or too late: less than half of the penetration.
EARLY = 0.002


@dataclass(frozen=True)
class Run:
    """A curve of loading: stroke, force for each mm, and the result."""

    event: Event
    u: Floats
    F: Floats
    result: Result

    @property
    def corner(self) -> tuple[float, float]:
        """Strokes while the legs come into contact with the flanks: the slope grows to its peak and halves."""
        fine = self.u >= self.event.strokes[0] - 1e-9
        u, slope = self.u[fine], np.gradient(self.F[fine], self.u[fine])
        peak = int(np.argmax(slope))
        begin = int(np.argmax(slope > 5.0 * slope[1]))
        end = peak + int(np.argmax(slope[peak:] < 0.5 * slope[peak]))
        return float(u[begin - 1]), float(u[end])

    def split(self) -> list[tuple[str, Floats, Floats]]:
        """Parts of the curve beyond a thickness of stroke: before and after the second contact, if there is one."""
        beyond = self.u >= THICKNESS - 1e-9
        if self.event is not SECOND:
            return [("", self.u[beyond], self.F[beyond])]
        begin, end = self.corner
        before, after = beyond & (self.u <= begin), self.u >= end
        return [(", before", self.u[before], self.F[before]), (", after", self.u[after], self.F[after])]


def _run(page: Page, event: Event, rule: str) -> Run:
    model, punch = build(RULES[rule](event.case))
    starts = (0.0, *event.strokes[:-1])
    steps = [
        Move(punch, to=end, steps=round((end - start) / way))
        for start, end, way in zip(starts, event.strokes, event.ways, strict=True)
    ]
    result = page.solve(f"{event.name}, {rule}", model, steps, options=OPTIONS, frames=8)
    return Run(event, result["stroke"], force_per_width(event.case, result["stroke_force"]), result)


def beyond_smooth(u: Floats, F: Floats) -> tuple[float, float]:
    """J of the difference between force and a smooth curve, and J of that curve: least-squares polynomials."""
    smooth = Polynomial.fit(u, F, SMOOTH_DEGREE)(u)
    window = WINDOW * THICKNESS
    rest = max(
        float(np.ptp((F - smooth)[(u >= begin - 1e-9) & (u <= begin + window + 1e-9)]) / F[at])
        for at, begin in enumerate(u)
    )
    return rest, jump(u, smooth, u[0], window) or 0.0


def _happened(page: Page, run: Run) -> None:
    """Check that the event of the run occurs."""
    punch = run.result.frames[-1].contacts["punch"]
    if run.event is LIFT_OFF:
        middle = float(punch.gap[np.argmin(np.abs(punch.x[:, 0]))])
        page.text(
            f"Lift-off: at the end the sheet is {middle:.3f} mm away from the tip of the punch in the middle; it "
            f"touches the punch at x = {punch.x[punch.gap <= 0.0, 0].min():.2f} mm and beyond."
        )
        page.check("lift-off: the middle is more than 0.02 h away (1: it is)", float(middle > 0.02), 1.0, 0.0)
    elif run.event is SECOND:
        begin, end = run.corner
        gain = run.F[-1] / np.interp(begin, run.u, run.F)
        page.text(
            f"Second contact: the legs meet the flanks from {begin:.3f} to {end:.3f} mm of stroke; the force then "
            f"grows to {gain:.1f} times until the end."
        )
        page.check("second contact: the force grows to more than twice (1: it does)", float(gain > 2.0), 1.0, 0.0)
    else:
        passed = _elements_passed(run)
        page.text(f"Sliding: {passed} elements pass the shoulder.")
        page.check("sliding: five elements or more pass the shoulder (1: they do)", float(passed >= 5), 1.0, 0.0)


def _corner(page: Page, few: Run, many: Run) -> None:
    """Distance of the curves in the stroke, where the legs meet the flank and the force is too steep for J."""
    begin, _ = few.corner
    beyond = few.u >= begin
    apart = np.abs(np.interp(few.F[beyond], many.F[many.u >= begin], many.u[many.u >= begin]) - few.u[beyond])
    steep = (few.F[beyond] > 1.1 * few.F[beyond][0]) & (few.F[beyond] < many.F[-1])
    what = "second contact, once the force has grown by 10 %: distance in the stroke of the curve of 5 points, over h"
    page.at_most(what, float(apart[steep].max()) / THICKNESS, EARLY)


def _elements_passed(run: Run) -> int:
    """Elements between the first and the last one that the shoulder touches, the flat sheet not counted."""
    facets = len(run.result.model.contacts[0].facets)
    gaps = [frame.contacts["die"].gap.reshape(facets, -1) for frame in run.result.frames[1:]]
    touched = np.concatenate([np.flatnonzero((gap <= 0.0).any(axis=1)) for gap in gaps])
    return int(np.ptp(touched))


def run(page: Page) -> None:
    """Fill the page."""
    rows: list[tuple[str | float | int, ...]] = []
    found: dict[tuple[str, str], Run] = {}
    pairs = [(event, rule) for event in EVENTS for rule in RUN[event.name]]
    for event, rule in page.each(page.pick(pairs, pairs[:1]), lambda pair: f"{pair[0].name}, {pair[1]}"):
        this = found[event.name, rule] = _run(page, event, rule)
        settings = " / ".join(f"{c.points}, {c.penalty:.3g}" for c in this.result.model.contacts)
        for part, u, F in this.split():
            rest, smooth = beyond_smooth(u, F)
            whole = jump(u, F, u[0], WINDOW * THICKNESS) or float("nan")
            rows.append((event.name + part, rule, settings, 100 * whole, 100 * smooth, 100 * rest))
            if rule == "automatic":  # the others are shown as what they are
                page.at_most(f"{event.name}{part}, {rule}: J beyond the smooth curve", rest, LIMIT)
        if rule == "automatic":
            _happened(page, this)
            name, picture = event.name, event.name.replace(" ", "-")
            page.shape(picture, this.result, f"{name}, at the end", values="contact_pressure", view=(-90, 0))
    columns = ("curve", "rule", "points, penalty of die / punch", "J %", "J of the smooth curve %", "J beyond it %")
    page.table(f"J within {WINDOW:g} h, beyond a stroke of h", columns, rows)
    if page.short:
        return
    _corner(page, found[SECOND.name, "5 points"], found[SECOND.name, "automatic"])
    curves = [Curve(f"{name}, {rule}", run.u, run.F / run.F[run.u <= 1.6].max()) for (name, rule), run in found.items()]
    figure = plot(curves, "stroke over h", "force over its largest up to 1.6 h", limits=(0.0, 2.0))
    page.figure("curves", figure, "Force over stroke")
    page.text(
        "J includes the slope of the smooth curve; the last column is the part of the contact. While the legs meet "
        "the flanks, the force changes its slope within a few hundredths of h; there the curve is compared with that "
        "of half of the points, in the stroke. Around the shoulder three points result from two within the expected "
        "length of the contact. Late in the stroke the force is a third of the expected one, the contact is shorter, "
        "and the curve rises in steps: the automatic rule takes six there, eq. (4.31). A penalty of E/h is 2 to 5 "
        "times the automatic one: the contact is shorter, and five points are too few."
    )


CASE = Case(
    name="air-bend-smoothness",
    title="Air bending: lift-off, second contact, sliding around the shoulder",
    problem=f"""
Sheet of h = {THICKNESS:g} mm like DC04, plane strain, two layers of BEND18 of 6 points, three elements per thickness
(sliding: five), increments of 0.05 h. Automatic contact points and penalty (penetration h/200), the default; beside it
5 points with a penalty of E/h, and the automatic penalty with fewer points.

* Lift-off: opening 12 h, tip of 3 h, blunter than the bend: the sheet leaves the tip in the middle.
* Second contact: opening 8 h, die of 120 degrees: the legs are pressed against the flanks, increments of 0.005 h.
* Sliding: opening 12 h, shoulders of 0.6 h, around which the legs slide.
""",
    reference=f"""
Smoothness only. J as in [bending-contact-points](bending-contact-points.md): largest change of the force within
{WINDOW:g} h over the force. The smooth curve is the least-squares polynomial of degree {SMOOTH_DEGREE}, on either side
of the second contact, where the true slope jumps. J of the difference is the part of the contact, with waves that no
polynomial follows. Limit: {100 * LIMIT:g} %.
""",
    run=run,
    picture="curves",
    cost=45.0,
)
