"""Collisions of a part with parts of the press: the punch above its flanks, ram, die, table."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.processes.air_bending.spec import AirBending
from umform.processes.bend_sequence.sides import Strip
from umform.processes.bend_sequence.spec import Bodies
from umform.surfaces import Extruded, Profile

Floats = NDArray[np.float64]

#: Depth of a collision relative to the thickness; less is the penetration of contact and the unevenness of the strip.
_TOUCHES = 0.05


@dataclass(frozen=True)
class Collision:
    """A collision of the part with a body of the tools.

    Attributes
    ----------
    tool : str
        "punch" or "die".
    stroke : float
        Stroke of first contact; 0 if the part does not fit between the tools.
    distance : float
        Place of first contact: distance from the bend line on the flat strip, positive to the right of the tools.
    """

    tool: str
    stroke: float
    distance: float


def collisions(case: AirBending, zone: float, bodies: Bodies, states: Iterable[tuple[float, Strip]]) -> list[Collision]:
    """Bodies that the part touches outside of the zone of its bend.

    Parameters
    ----------
    case : AirBending
        Sheet and tools of the bend.
    zone : float
        Length on each side of the bend line where contact with the tools is intended.
    bodies : Bodies
        Sizes of the bodies.
    states : iterable of (float, Strip)
        Strokes, and the strip at each in the frame of the tools, in ascending order.
    """
    die, punch = Extruded(die_body(case, bodies)), Extruded(punch_body(case, bodies))
    found: dict[str, Collision] = {}
    for stroke, strip in states:
        beyond = np.abs(strip.reference[:, 0, 0]) > zone
        if not beyond.any():
            return []
        at = np.repeat(strip.reference[beyond, 0, 0], strip.reference.shape[1])
        x = strip.current[beyond].reshape(-1, 2)
        for name, tool, lift in (("die", die, 0.0), ("punch", punch, case.thickness - stroke)):
            gap = tool.gap(np.stack([x[:, 0], np.zeros(len(x)), x[:, 1] - lift], axis=1))[0]
            k = int(gap.argmin())
            if gap[k] < -_TOUCHES * case.thickness and name not in found:
                found[name] = Collision(name, stroke, float(at[k]))
    return list(found.values())


def punch_body(case: AirBending, bodies: Bodies) -> Profile:
    """Section of punch and ram; the origin is the lowest line of the tip."""
    flank, radius = np.tan(np.radians(0.5 * case.punch_angle)), case.punch_radius
    tip = radius - radius / np.sin(np.radians(0.5 * case.punch_angle))
    half, wide, high = 0.5 * (case.punch_width or bodies.punch_width), 0.5 * bodies.ram_width, bodies.punch_height
    half = max(half, 1.01 * radius)
    edge = min(tip + half / flank, high)
    right = [(half, edge), (half, high + edge), (wide, high + edge), (wide, 4.0 * high + edge)]
    left = [(-x, z) for x, z in reversed(right)]
    corners = [(0.0, float(tip)), *right, *left]
    return Profile.from_corners(corners, [radius, *[0.0] * (len(corners) - 1)])


def die_body(case: AirBending, bodies: Bodies) -> Profile:
    """Section of die and table; the origin is the middle of the V at the height of the top."""
    half, deep = 0.5 * case.opening, bodies.die_height
    wide, table = half + 0.5 * bodies.die_width, max(0.5 * bodies.table_width, half + 0.5 * bodies.die_width + 1.0)
    bottom = half / np.tan(np.radians(0.5 * case.die_angle))
    deep = max(deep, 1.2 * bottom)
    right = [(table, -3.0 * deep), (table, -deep), (wide, -deep), (wide, 0.0), (half, 0.0)]
    left = [(-x, z) for x, z in reversed(right)]
    return Profile.from_corners([*right, (0.0, -float(bottom)), *left], [0.0] * (2 * len(right) + 1))
