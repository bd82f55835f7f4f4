"""The operator's sheet: the flat pattern, the bends in their order with tools, stops, strokes and forces."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from umform.flat_pattern.bending import BentPart, deduction
from umform.flat_pattern.drawing import svg
from umform.flat_pattern.order import Orders, Section
from umform.flat_pattern.pattern import FlatBend, FlatPattern
from umform.report import parts

#: Degrees within which a flange is square, so that a stop meets its outer face.
_SQUARE = 0.5


@dataclass(frozen=True)
class Step:
    """One bend as the operator makes it.

    Attributes
    ----------
    bend : FlatBend
        The bend.
    turned : bool
        The part is turned over before it.
    opening, punch_radius, die_angle : float
        Tools, in mm and degrees.
    stop : float, optional
        Distance of the stop from the bend line in mm; None if there is nothing square to stop against.
    against : str
        What lies against the stop.
    stroke : float, optional
        Stroke of the punch from where it touches the sheet, in mm.
    loaded_angle : float, optional
        Angle between the legs under load, in degrees.
    force : float, optional
        Largest force in kN over the length of the bend.
    """

    bend: FlatBend
    turned: bool
    opening: float
    punch_radius: float
    die_angle: float
    stop: float | None
    against: str
    stroke: float | None
    loaded_angle: float | None
    force: float | None


def steps_of(orders: Orders, bent: BentPart | None = None) -> list[Step]:
    """Steps of an operator in the order of the pattern.

    Parameters
    ----------
    orders : Orders
        The pattern with its order, and the tools.
    bent : BentPart, optional
        The simulated part, whose strokes and forces replace those of single bends.
    """
    pattern, found, direction = orders.pattern, list[Step](), "up"
    by_number = {bend.number: bend for bend in pattern.bends}
    for place, number in enumerate(pattern.order):
        bend, case = by_number[number], orders.case(by_number[number])
        section = max(orders.sections[number], key=lambda one: one.length)
        stop, against = _stop(pattern, section, number, pattern.order[:place])
        stroke, force, loaded = bend.allowance.stroke, bend.allowance.force, None
        if bent is not None:
            measures = bent.part.bends[place].measures
            stroke, force, loaded = measures.stroke, measures.largest_force, measures.loaded_angle
        found.append(
            Step(
                bend,
                bend.direction != direction,
                case.opening,
                case.punch_radius,
                case.die_angle,
                stop,
                against,
                stroke,
                loaded,
                None if force is None else force * bend.length / 1000.0,
            )
        )
        direction = bend.direction
    return found


def _stop(pattern: FlatPattern, section: Section, number: int, done: tuple[int, ...]) -> tuple[float | None, str]:
    """Distance of the stop: the nearer flat edge, else the outer face of a square flange that is bent already."""
    places, by_number = dict(section.places), {bend.number: bend for bend in pattern.bends}
    here = places[number]
    sides = {
        side: [(abs(at - here), n) for n, at in section.places if n in done and (at - here) * side > 0.0]
        for side in (-1.0, 1.0)
    }
    edges = [here if side < 0.0 else section.length - here for side, bent in sides.items() if not bent]
    if edges:
        return min(edges), "flat edge"
    nearest = sorted(min(bent) for bent in sides.values())
    for away, other in nearest:
        if abs(by_number[other].angle - 90.0) < _SQUARE:
            return away + 0.5 * deduction(by_number[other], pattern), f"outer face of the flange of bend {other}"
    return None, "no square flange: mark the bend line"


def write_sheet(path: Path, orders: Orders, bent: BentPart | None = None, note: str = "") -> Path:
    """Write the sheet as HTML, for printing.

    Parameters
    ----------
    path : Path
        The page, ending in .html.
    orders : Orders
        The pattern with its order, and the tools.
    bent : BentPart, optional
        The simulated part.
    note : str
        Source of the material data; may be empty.
    """
    pattern = orders.pattern
    length, width = pattern.size.tolist()
    given = {
        "part": pattern.path.name,
        "metal": orders.tooling.metal or "not named",
        "thickness": f"{pattern.thickness:.4g} mm",
        "flat size": f"{length:.2f} x {width:.2f} mm",
        "flat area": f"{pattern.area:.0f} mm²",
    }
    content = [parts.pairs(given), *(parts.note(text, bad=True) for text in _red(pattern, bent))]
    content += [
        parts.heading("Bends in their order"),
        _table([_row(k, s) for k, s in enumerate(steps_of(orders, bent), 1)]),
    ]
    content += [parts.paragraph(text) for text in _remarks(orders, bent)]
    content += [parts.heading("Flat pattern"), f'<figure><div class="wide">{svg(pattern)}</div></figure>']
    if bent is not None:
        from umform.processes.bend_sequence.pictures import picture

        content += [parts.heading("Bends by simulation"), parts.figure(picture(bent.part), "Each bend under load.")]
        rows = [
            [f"{k}", f"{wanted:.3f}", f"{found:.3f}", f"{found - wanted:+.3f}"]
            for k, (wanted, found) in enumerate(zip(bent.flanges, bent.part.flanges, strict=True), start=1)
        ]
        content += [parts.table(["flange", "drawing, mm", "simulation, mm", "difference, mm"], rows)]
    content += [parts.note(text) for text in (*pattern.warnings, *([note] if note else []))]
    return parts.write_html(
        path, f"Operator's sheet: {pattern.path.stem}", f"{len(pattern.bends)} bends", content, style=_STYLE
    )


#: The whole flat pattern is seen at once.
_STYLE = "figure svg { max-height: 70vh; }"
_HEAD = [
    "step",
    "bend",
    "turn over",
    "direction",
    "angle of the part",
    "die V, mm",
    "punch R, mm",
    "stop, mm",
    "against",
    "stroke, mm",
    "angle under load",
    "length, mm",
    "force, kN",
]


def _table(rows: list[list[str]]) -> str:
    """The steps, without columns that no step has a value of."""
    used = [k for k in range(len(_HEAD)) if any(row[k] for row in rows)]
    return parts.table([_HEAD[k] for k in used], [[row[k] for k in used] for row in rows])


def _row(place: int, step: Step) -> list[str]:
    bend = step.bend
    return [
        str(place),
        str(bend.number),
        "turn over" if step.turned else "",
        bend.direction,
        f"{180.0 - bend.angle:.2f}°",
        f"{step.opening:g} / {step.die_angle:g}°",
        f"{step.punch_radius:g}",
        _number(step.stop, 2),
        step.against,
        _number(step.stroke, 3),
        _number(step.loaded_angle, 2),
        f"{bend.length:.1f}",
        _number(step.force, 1),
    ]


def _number(value: float | None, decimals: int) -> str:
    return "" if value is None else f"{value:.{decimals}f}"


def _red(pattern: FlatPattern, bent: BentPart | None) -> list[str]:
    red = [] if pattern.order or not pattern.bends else ["no order of the bends: see the remarks"]
    return red + (bent.part.collisions if bent is not None else [])


def _remarks(orders: Orders, bent: BentPart | None) -> list[str]:
    """How order, strokes and forces were found."""
    found = [
        "The order was looked for by geometry: punch, ram, die and table against the sections across each bend line. "
        "Flanges at the ends of a bend line are not looked at: a punch between them must be shorter than their "
        "distance."
    ]
    if bent is not None:
        found.append("Strokes, angles under load and forces are of the simulation of the whole part, with springback.")
    elif all(bend.allowance.stroke is not None for bend in orders.pattern.bends):
        found.append("Strokes and forces are those of single bends of this metal with these tools.")
    found.append("A stop is the distance from the bend line, the middle of the punch, to what lies against it.")
    return found
