"""How time and memory of many ranks grow with the elements of a sheet, from what benchmarks/ranks.py has measured."""

from __future__ import annotations

import numpy as np

GB = 1e9


class Growth:
    """How fill and operations of nested dissection on a sheet grow with its elements m, fitted to what was measured.

    Of a square grid the factors have a m log2(m) + b m entries and take c m^1.5 + d m log2(m) operations
    (George 1973): the leading terms are of separators as long as the sheet is wide.
    """

    def __init__(self, runs: list[dict]) -> None:
        m = np.array([run["elements"] for run in runs], dtype=float)
        self.fill_terms = self._fit(np.stack([m * np.log2(m), m], axis=1), [run["fill"] for run in runs])
        self.flop_terms = self._fit(np.stack([m**1.5, m * np.log2(m)], axis=1), [run["flops"] for run in runs])

    @staticmethod
    def _fit(terms: np.ndarray, values: list[float]) -> np.ndarray:
        """Least squares of the relative errors."""
        return np.linalg.lstsq(terms / np.array(values)[:, None], np.ones(len(values)), rcond=None)[0]

    def fill(self, m: float) -> float:
        """Entries of the factors."""
        return float(self.fill_terms @ [m * np.log2(m), m])

    def flops(self, m: float) -> float:
        """Operations of a factorisation."""
        return float(self.flop_terms @ [m**1.5, m * np.log2(m)])


class Costs:
    """What an element, an entry of the factors and an operation cost, by the largest run on one rank."""

    def __init__(self, run: dict, described: dict, tables: list[dict]) -> None:
        m, held, cpu = run["elements"], run["memory"], run["cpu"]
        self.start = held["start"]
        self.described, self.cutting = described["kept"] / GB, described["peak"] / GB
        self.own = (held["matrix"] - held["describe"]) / m
        # The factors and the tables of MUMPS are all that is taken after the matrix; so they are beside the blocks.
        small, large = tables
        each = {name: (large[name] - small[name]) / (large["unknowns"] - small["unknowns"]) for name in small}
        unknowns, solving = run["unknowns"], held["peak"] - held["matrix"]
        self.entry = (solving - each["bytes"] / GB * unknowns) / (run["fill"] - each["entries"] * unknowns)
        self.tables = (each["bytes"] / GB - self.entry * each["entries"]) * unknowns / m
        self.evaluation = cpu["evaluation"] / m
        self.rate = run["flops"] / cpu["factorisation"]
        self.solution = cpu["solution"] / run["fill"]

    def memory(self, m: float, ranks: int, growth: Growth, first: bool = True) -> float:
        """GB of a rank: elements, matrix, factors, tables of MUMPS; on the first one the description of the whole."""
        solving = self.start + self.tables * m + (self.own * m + self.entry * growth.fill(m)) / ranks
        return max(solving + self.described * m, self.start + self.cutting * m) if first else solving

    def seconds(self, m: float, growth: Growth) -> float:
        """CPU seconds of an iteration, over all ranks."""
        return self.evaluation * m + growth.flops(m) / self.rate + self.solution * growth.fill(m)
