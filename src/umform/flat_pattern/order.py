"""An order of the bends in which the part does not collide with the tools, by sections across each bend line."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.flat_pattern.checks import crossings
from umform.flat_pattern.pattern import FlatBend, FlatPattern
from umform.flat_pattern.tooling import Tooling
from umform.processes.air_bending.spec import AirBending
from umform.processes.bend_sequence.foreseen_collisions import foreseen_at, foreseen_text
from umform.processes.bend_sequence.spec import TOOLS, Bend, BendSequence, Bodies

Floats = NDArray[np.float64]

#: Sine of the angle below which bend lines are parallel.
_PARALLEL = 1e-5
#: Places along a bend line that are nearer than this part of it are one.
_NEAR = 1e-3
#: Sets of bends without an order after which the search ends; collisions that a warning lists.
_MOST_SETS, _SHOWN = 5000, 4


@dataclass(frozen=True)
class Section:
    """The flat strip of a straight cut across a bend line.

    Attributes
    ----------
    length : float
        Its length in mm.
    places : tuple of (int, float)
        Numbers of the parallel bends that it crosses, and their distances from its left end, from left to right.
    """

    length: float
    places: tuple[tuple[int, float], ...]


@dataclass(frozen=True, eq=False)
class Orders:
    """Orders of the bends of a pattern with given tools.

    Attributes
    ----------
    pattern : FlatPattern
        The pattern.
    tooling : Tooling
        Tools of each bend.
    bodies : Bodies
        Bodies of the tools.
    """

    pattern: FlatPattern
    tooling: Tooling
    bodies: Bodies

    @cached_property
    def sections(self) -> dict[int, list[Section]]:
        """Sections across each bend."""
        return {bend.number: list(_sections(self.pattern, bend)) for bend in self.pattern.bends}

    @property
    def is_prismatic(self) -> bool:
        """Whether the part has one section: each cut crosses all bends at the same distances."""
        all_of_them = [section for sections in self.sections.values() for section in sections]
        return len({_steps(section) for section in all_of_them}) == 1 and len(all_of_them[0].places) == len(
            self.pattern.bends
        )

    @property
    def longest(self) -> Section:
        """The longest section with all bends, of a prismatic part."""
        return max(self.sections[self.pattern.bends[0].number], key=lambda section: section.length)

    def sequence(self, section: Section, order: list[int]) -> BendSequence:
        """The bends of a section in an order.

        Raises
        ------
        InvalidValue
            If a flange is too short for its die, or an angle beyond its tools.
        """
        place, by_number = dict(section.places), {bend.number: bend for bend in self.pattern.bends}
        sheet = self.case(by_number[order[0]])
        bends = []
        for number in order:
            bend, case = by_number[number], self.case(by_number[number])
            tools = {name: getattr(case, name) for name in TOOLS if getattr(case, name) != getattr(sheet, name)}
            bends.append(Bend(place[number], 180.0 - bend.angle, direction=bend.direction, tools=tools))
        try:
            return BendSequence(section.length, tuple(bends), sheet, self.bodies)
        except InvalidValue as error:
            place_of_bend = re.match(r"bend (\d+)", error.where)
            if place_of_bend is not None:  # name it by its number on the pattern
                error.where = f"bend {order[int(place_of_bend[1]) - 1]}"
            raise

    def case(self, bend: FlatBend) -> AirBending:
        """Sheet and tools of a bend."""
        return self.tooling.case(bend.angle, bend.radius, self.pattern.thickness)

    def hits(self, number: int, done: frozenset[int]) -> str:
        """The first collision of a bend after others, in words; empty if there is none."""
        for section in self.sections[number]:
            before = [n for n, _ in section.places if n in done]
            key = (section, number, tuple(before))
            if key not in self._known:
                sequence = self.sequence(section, [*before, number])
                hits = foreseen_at(sequence, len(sequence.bends))
                self._known[key] = foreseen_text(sequence, len(sequence.bends), hits[0]) if hits else ""
            if self._known[key]:
                after = f" after {_listed(done)}" if done else ""
                return f"bend {number}{after}: {self._known[key].partition(': ')[2]}"
        return ""

    @cached_property
    def _known(self) -> dict[tuple[Section, int, tuple[int, ...]], str]:
        return {}

    def find(self) -> tuple[tuple[int, ...], list[str]]:
        """An order without collision, and why there is none otherwise.

        Bends that go on in one direction come first, then those near an end: the part is turned over rarely. Bends
        that no cut crosses together do not hinder each other: each group has an order of its own.
        """
        order, reasons = tuple[int, ...](), dict[str, None]()
        try:
            for group in self._groups():
                found = _Search(self, group, order, reasons).go(frozenset(), ())
                if found is None:
                    what = f"no order of bends {_listed(group)} without collision was found with these tools"
                    return (), [what, *list(reasons)[:_SHOWN]]
                order += found
        except InvalidValue as error:
            return (), [f"no order of the bends was looked for: {error.where}: {error.what}, {error.cause}"]
        return order, []

    def _groups(self) -> list[frozenset[int]]:
        """Bends that cuts cross together, directly or by others."""
        groups = list[frozenset[int]]()
        for number, sections in self.sections.items():
            new = frozenset({number}.union(n for section in sections for n, _ in section.places))
            for group in [group for group in groups if group & new]:
                groups.remove(group)
                new |= group
            groups.append(new)
        down = {bend.number for bend in self.pattern.bends if bend.direction == "down"}
        return sorted(groups, key=lambda group: (len(group & down) / len(group), min(group)))


class _Search:
    """Search for an order of a group of bends; whether one collides depends on the bends that are done."""

    def __init__(
        self, orders: Orders, group: frozenset[int], before: tuple[int, ...], reasons: dict[str, None]
    ) -> None:
        self.orders, self.group, self.reasons = orders, group, reasons
        self.dead = set[frozenset[int]]()
        self.up = {bend.number: bend.direction == "up" for bend in orders.pattern.bends}
        self.first = self.up[before[-1]] if before else True
        sections = orders.sections
        self.near = {n: min(min(_ends(section, n)) for section in sections[n]) for n in group}

    def go(self, done: frozenset[int], order: tuple[int, ...]) -> tuple[int, ...] | None:
        """The rest of an order after some bends; None if there is none, or after too many sets of bends."""
        if done == self.group:
            return order
        if done in self.dead or len(self.dead) >= _MOST_SETS:
            return None
        last = self.up[order[-1]] if order else self.first
        for number in sorted(self.group - done, key=lambda n: (self.up[n] != last, self.near[n], n)):
            hit = self.orders.hits(number, done)
            if hit:
                self.reasons[hit] = None
                continue
            found = self.go(done | {number}, (*order, number))
            if found is not None:
                return found
        self.dead.add(done)
        return None


def _listed(numbers: frozenset[int]) -> str:
    return ", ".join(map(str, sorted(numbers)))


def _ends(section: Section, number: int) -> tuple[float, float]:
    place = dict(section.places)[number]
    return place, section.length - place


def _steps(section: Section) -> tuple[float, ...]:
    """Numbers of its bends and their distances, the same from either end."""
    numbers = [float(n) for n, _ in section.places]
    steps = [round(b - a, 3) for (_, a), (_, b) in pairwise(section.places)]
    return max((*numbers, *steps), (*numbers[::-1], *steps[::-1]))


def _rounded(section: Section) -> tuple[float, ...]:
    """The same from either end."""
    forth = (round(section.length, 3), *(round(place, 3) for _, place in section.places))
    back = (forth[0], *(round(section.length - place, 3) for _, place in section.places))
    return max(forth, back)


def _sections(pattern: FlatPattern, bend: FlatBend) -> Iterator[Section]:
    """Different sections across a bend: at the middles between places where the outline changes."""
    across = np.array([bend.along[1], -bend.along[0]])
    x = pattern.outer.points()
    ends = np.roll(x, -1, axis=0)
    found = dict[tuple[object, ...], Section]()
    others = [other for other in pattern.bends if abs(_cross(other.along, bend.along)) < _PARALLEL]
    corners = np.concatenate([x, *(line for other in others for line in other.lines)])
    for a, b in bend.lines:
        length = float(np.linalg.norm(b - a))
        stops = np.unique(np.clip((corners - a) @ bend.along, 0.0, length))
        stops = stops[np.append(True, np.diff(stops) > _NEAR * length)]
        stops = np.append(stops[:-1], length) if len(stops) > 1 else np.array([0.0, length])
        for s in 0.5 * (stops[1:] + stops[:-1]):
            at = a + s * bend.along
            ways = crossings(at, across, x, ends)
            low, high = float(ways[ways < 0.0].max()), float(ways[ways > 0.0].min())
            places = {bend.number: -low}
            for other in others:
                for line in other.lines if other is not bend else ():
                    hit = crossings(at, across, line[None, 0], line[None, 1])
                    if len(hit) and low < hit[0] < high:
                        places[other.number] = float(hit[0]) - low
            section = Section(high - low, tuple(sorted(places.items(), key=lambda pair: pair[1])))
            found.setdefault((*_rounded(section), tuple(n for n, _ in section.places)), section)
    yield from found.values()


def _cross(a: Floats, b: Floats) -> float:
    return float(a[0] * b[1] - a[1] * b[0])
