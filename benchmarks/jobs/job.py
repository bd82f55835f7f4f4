"""What a job is, which kinds there are, and how a number becomes one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import umform as uf
from jobs import air_bends, plates, profiles, strips
from jobs.drawing import Drawing

#: What all draws follow from; another one makes other jobs, and the explanations of failures void.
SEED = "umform 1"
COUNT = 300
_MOST_DRAWS = 200


@dataclass
class Done:
    """What a job gave.

    Attributes
    ----------
    results : list of Result
        Runs whose balance is judged.
    deviations : dict of str to (float, float)
        What else is known of the answer: by how much it is off, and the most that it may be.
    """

    results: list[uf.Result]
    deviations: dict[str, tuple[float, float]] = field(default_factory=dict)


@dataclass(frozen=True)
class Kind:
    """How jobs of a kind are drawn, whether their keys are what umform takes, and how they run."""

    draw: Callable[[Drawing], dict[str, Any]]
    run: Callable[[dict[str, Any]], tuple[list[uf.Result], dict[str, tuple[float, float]]]]
    check: Callable[[dict[str, Any]], object] = lambda keys: None


KINDS: dict[str, Kind] = {
    "air bend": Kind(air_bends.draw, air_bends.run, air_bends.case),
    "air bend with free edges": Kind(air_bends.draw_wide, air_bends.run, air_bends.case),
    "stroke for an angle": Kind(air_bends.draw_search, air_bends.search, air_bends.case),
    "strip over a cylinder": Kind(strips.draw, strips.run, strips.case),
    "wide sheet with free edges": Kind(strips.draw_wide, strips.run_wide),
    "sections of users": Kind(profiles.draw, profiles.run, profiles.tools),
    "plate under a tool": Kind(plates.draw, plates.run),
}
#: The kinds of thirty jobs in a row.
_SHARES = {
    "air bend": 8,
    "air bend with free edges": 3,
    "stroke for an angle": 2,
    "strip over a cylinder": 7,
    "wide sheet with free edges": 3,
    "sections of users": 4,
    "plate under a tool": 3,
}
_ROW = [name for name, share in _SHARES.items() for _ in range(share)]


@dataclass(frozen=True)
class Job:
    """A job: its number, its kind and all that it was drawn as."""

    number: int
    kind: str
    keys: dict[str, Any]

    def run(self) -> Done:
        """Do it; raises what umform raises."""
        return Done(*KINDS[self.kind].run(self.keys))

    def finer(self) -> Job:
        """The same with increments of half the size."""
        steps = self.keys.get("steps")
        halved = {"increment": 0.5 * self.keys["increment"]} if steps is None else {"steps": 2 * steps}
        return replace(self, keys=self.keys | halved)


def job(number: int) -> Job:
    """The job of a number: the first draw that umform takes as a job."""
    name = _ROW[number % len(_ROW)]
    kind, drawing = KINDS[name], Drawing(f"{SEED} {number}")
    for _ in range(_MOST_DRAWS):
        keys = kind.draw(drawing)
        try:
            kind.check(keys)
        except uf.UmformError:
            continue
        return Job(number, name, keys)
    raise RuntimeError(f"no job of the kind {name!r} in {_MOST_DRAWS} draws")
