"""Collisions before a part is bent: by geometry alone, its bends as arcs of the radius that the shop reckons with."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from umform.processes.air_bending.formulas import INNER_RADIUS
from umform.processes.air_bending.spec import AirBending
from umform.processes.bend_sequence.collisions import Collision, collisions
from umform.processes.bend_sequence.part import REMEDY, when_and_where
from umform.processes.bend_sequence.sides import Strip
from umform.processes.bend_sequence.spec import Bend, BendSequence

Floats = NDArray[np.float64]

#: States of each bend that are looked at; most points along the strip.
_STATES, _MOST = 12, 2000
#: Degrees that a bend is bent beyond its angle, for the springback.
_BEYOND = 2.0


def foreseen_collisions(sequence: BendSequence) -> dict[int, list[Collision]]:
    """Collisions to be expected, by the number of the bend, counted from 1; the run finds those of the computed part.

    Parameters
    ----------
    sequence : BendSequence
        The part.
    """
    numbers = range(1, len(sequence.bends) + 1)
    return {number: hits for number in numbers if (hits := foreseen_at(sequence, number))}


def foreseen_at(sequence: BendSequence, number: int) -> list[Collision]:
    """Collisions to be expected at one bend, by its number; they depend on which bends are done, not on their order."""
    bend = sequence.bends[number - 1]
    return collisions(sequence.case(bend), sequence.zone(bend), sequence.bodies, list(_states(sequence, number - 1)))


def foreseen_text(sequence: BendSequence, number: int, hit: Collision) -> str:
    """Warning of a collision before the run."""
    return (
        f"bend {number}: by its geometry the part will collide with the body of the {hit.tool} "
        f"{when_and_where(sequence.bends[number - 1], hit)}. {REMEDY}"
    )


def _states(sequence: BendSequence, number: int) -> Iterator[tuple[float, Strip]]:
    """Strokes, and the strip at each in the frame of the tools."""
    bend = sequence.bends[number]
    case = sequence.case(bend)
    s, before = _flat(sequence, number), _heading_before(sequence, number)
    for slope in np.linspace(0.0, _last_slope(case, bend), _STATES):
        strip = _strip(s, before + _turned(s, case, 0.0, 2.0 * math.radians(slope)), case.thickness)
        rise = _rise(case, float(slope))
        tip = rise + 0.5 * case.thickness  # of the inner face on the bend line, where the punch is
        yield case.thickness - tip, Strip(strip.reference, strip.current + np.array([0.0, rise]), strip.order)


def _last_slope(case: AirBending, bend: Bend) -> float:
    """Largest slope of the legs in degrees."""
    if bend.angle is not None:
        return min(0.5 * (180.0 - bend.angle + _BEYOND), case.steepest)
    assert bend.stroke is not None  # one of the two
    slopes = np.linspace(0.0, case.steepest, 200)
    strokes = [case.rigid_stroke(slope) for slope in slopes]
    return float(np.interp(bend.stroke, strokes, slopes))


def _rise(case: AirBending, slope: float) -> float:
    """Height of the middle of the strip on the bend line, its legs on the shoulders of the die."""
    a, half = math.radians(slope), 0.5 * case.thickness
    radius = INNER_RADIUS * case.opening + half
    foot = radius * np.array([math.sin(a), 1.0 - math.cos(a)])  # where the arc ends, if it begins at the origin
    away = float(np.array([-math.sin(a), math.cos(a)]) @ (foot - np.array([case.shoulder, -case.die_radius])))
    return (case.die_radius + half - away) / math.cos(a)


def _flat(sequence: BendSequence, number: int) -> Floats:
    """Places along the flat strip from the bend line, positive to the right of the tools."""
    bend = sequence.bends[number]
    left, right = -bend.position, sequence.length - bend.position
    first, last = (-right, -left) if bend.over else (left, right)
    count = min(math.ceil((last - first) / (0.5 * sequence.sheet.thickness)), _MOST)
    return np.union1d(np.linspace(first, last, count + 1), [0.0])


def _heading_before(sequence: BendSequence, number: int) -> Floats:
    """Direction of the strip at these places by the bends so far, relative to that at the bend line."""
    bend, s = sequence.bends[number], _flat(sequence, number)
    heading = np.zeros(len(s))
    for other in sequence.bends[:number]:
        case = sequence.case(other)
        angle = 180.0 - 2.0 * _last_slope(case, other) if other.angle is None else other.angle
        turn = math.radians(180.0 - angle)
        away = (other.position - bend.position) * (-1.0 if bend.over else 1.0)
        heading += _turned(s, case, away, turn if other.over == bend.over else -turn)
    return heading


def _strip(s: Floats, heading: Floats, thickness: float) -> Strip:
    """The strip with its middle fibre along a direction, the bend line at the origin."""
    along = np.stack([np.cos(heading), np.sin(heading)], axis=1)
    steps = 0.5 * (along[1:] + along[:-1]) * np.diff(s)[:, None]
    middle = np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)])
    middle -= middle[np.searchsorted(s, 0.0)]
    normal = np.stack([-along[:, 1], along[:, 0]], axis=1)
    levels = np.array([-0.5, 0.5]) * thickness
    current = middle[:, None] + levels[:, None] * normal[:, None]
    reference = np.stack(np.broadcast_arrays(s[:, None], levels + 0.5 * thickness), axis=2)
    return Strip(reference, current, 1)


def _turned(s: Floats, case: AirBending, at: float, turn: float) -> Floats:
    """Direction of the strip by one bend at a place, relative to that at s = 0."""
    arc = (INNER_RADIUS * case.opening + 0.5 * case.thickness) * max(abs(turn), 1e-9)
    part = np.clip((np.append(s, 0.0) - at) / arc + 0.5, 0.0, 1.0)
    heading: Floats = turn * (part[:-1] - part[-1])
    return heading
