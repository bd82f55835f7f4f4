"""What the attempts of Newton's method cost that came to nothing: evaluations up to a revert, and why they failed."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any
from unittest.mock import patch

import umform as uf
from umform.solution.records import Failed


@dataclass
class Attempts:
    """Counts of a run.

    Attributes
    ----------
    evaluations : int
        All evaluations of residual or tangent.
    thrown : int
        Those that a model was put back from.
    failures : Counter of str
        Reasons of the attempts that failed, without the numbers of cells.
    """

    evaluations: int = 0
    thrown: int = 0
    failures: Counter[str] = field(default_factory=Counter)
    _open: int = 0  # since the model was last committed or reverted

    @property
    def share(self) -> float:
        """Part of the evaluations that was thrown away."""
        return self.thrown / self.evaluations if self.evaluations else 0.0


@contextmanager
def attempts() -> Iterator[Attempts]:
    """Count the attempts of all models inside of the ``with`` block: every failed one ends with a revert."""
    counts = Attempts()
    evaluate, commit, revert, failed = uf.Model.evaluate, uf.Model.commit, uf.Model.revert, Failed.__init__

    def evaluated(model: uf.Model, *words: Any, **keys: Any) -> Any:
        counts.evaluations += 1
        counts._open += 1
        return evaluate(model, *words, **keys)

    def committed(model: uf.Model, *words: Any) -> None:
        counts._open = 0
        commit(model, *words)

    def reverted(model: uf.Model) -> None:
        counts.thrown += counts._open
        counts._open = 0
        revert(model)

    def noted(error: Failed, reason: str, *words: Any, **keys: Any) -> None:
        counts.failures[re.sub(r"\d+", "N", reason)] += 1
        failed(error, reason, *words, **keys)

    hooks = {"evaluate": evaluated, "commit": committed, "revert": reverted}
    with patch.multiple(uf.Model, **hooks), patch.object(Failed, "__init__", noted):
        yield counts
