"""What a lot of random jobs is: its kinds, and how a number becomes a job."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import umform as uf
from imbalance import ENERGIES, FORCES
from jobs.drawing import Drawing

_MOST_DRAWS = 200
#: What else is known of an answer: by how much it is off, and the most that it may be.
Deviations = dict[str, tuple[float, float]]


@dataclass
class Done:
    """What a job gave.

    Attributes
    ----------
    results : list of Result
        Runs whose balance is judged.
    deviations : dict of str to (float, float)
        What else is known of the answer: by how much it is off, and the most that it may be.
    forces : float
        Largest resultant of forces and moments over their magnitudes.
    energies : float
        Drift of the energies above which that of increments of half the size is looked at.
    """

    results: list[uf.Result]
    deviations: Deviations = field(default_factory=dict)
    forces: float = FORCES
    energies: float = ENERGIES


@dataclass(frozen=True)
class Kind:
    """How jobs of a kind are drawn, whether their keys are what umform takes, and how they run.

    ``share`` is the number of them in a row of jobs.
    """

    share: int
    draw: Callable[[Drawing], dict[str, Any]]
    run: Callable[[dict[str, Any]], Done | tuple[list[uf.Result], Deviations]]
    check: Callable[[dict[str, Any]], object] = lambda keys: None


@dataclass(frozen=True)
class Job:
    """A job: its number, its kind and all that it was drawn as."""

    number: int
    kind: str
    keys: dict[str, Any]
    how: Kind

    def run(self) -> Done:
        """Do it; raises what umform raises."""
        answer = self.how.run(self.keys)
        return answer if isinstance(answer, Done) else Done(*answer)

    def finer(self) -> Job:
        """The same with increments of half the size."""
        for name, factor in (("steps", 2), ("pace", 0.5), ("increment", 0.5)):
            if self.keys.get(name) is not None:
                return replace(self, keys=self.keys | {name: factor * self.keys[name]})
        raise ValueError(f"job {self.number} has no increments that could be halved")


@dataclass(frozen=True)
class Lot:
    """Random jobs of some kinds.

    Attributes
    ----------
    seed : str
        What all draws follow from; another one makes other jobs, and the explanations of failures void.
    count : int
        How many there are.
    kinds : mapping of str to Kind
        Their kinds by name, which come in rows.
    """

    seed: str
    count: int
    kinds: Mapping[str, Kind]

    @cached_property
    def row(self) -> list[str]:
        """The kinds of a row of jobs."""
        return [name for name, kind in self.kinds.items() for _ in range(kind.share)]

    def job(self, number: int) -> Job:
        """The job of a number: the first draw that umform takes as a job."""
        name = self.row[number % len(self.row)]
        kind, drawing = self.kinds[name], Drawing(f"{self.seed} {number}")
        for _ in range(_MOST_DRAWS):
            keys = kind.draw(drawing)
            try:
                kind.check(keys)
            except uf.UmformError:
                continue
            return Job(number, name, keys, kind)
        raise RuntimeError(f"no job of the kind {name!r} in {_MOST_DRAWS} draws")

    @cached_property
    def drawn(self) -> str:
        """Digest of all jobs."""
        text = json.dumps([self.job(number).keys for number in range(self.count)], sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()[:16]
