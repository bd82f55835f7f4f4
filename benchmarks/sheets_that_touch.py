"""What contact of sheets costs: search, contact, elements, factors, and how couplings across two sheets fill these.

python benchmarks/sheets_that_touch.py --page docs/performance-contact.md   # or: make touch
python benchmarks/sheets_that_touch.py --case fold --side 25
python benchmarks/sheets_that_touch.py --search   # no run: one search of more and more facets
"""

from __future__ import annotations

import argparse
import logging
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np

import pages
import record
import umform as uf
from umform.model.contact.sheets import SheetContact
from umform.model.contact.sheets.passes import TURN
from umform.model.equations.assembly import Assembly
from umform.solvers import Pattern
from umform.solvers.multifrontal import Multifrontal

STEEL = uf.J2(E=210e3, nu=0.3, hardening=uf.Swift(500.0, 0.01, 0.2))
#: Square roots of the numbers of elements of the runs.
SIDES = {"two sheets": (25, 50, 100), "fold": (25,)}
#: Those of the numbers of facets in a search alone.
SEARCHED = (50, 100, 200)
#: Edge of an element of the fold, in thicknesses.
SIZE = 0.5


def two_sheets(side: int, *, touching: bool = True) -> tuple[uf.Model, list[Any]]:
    """Two sheets of 1 mm on each other, clamped at two edges, under a pressure; their meshes do not match."""
    lower = max(side**2 // 2 // round(side * 0.7), 1)
    across = round(side * 0.7)
    one = uf.mesh.strip(100.0, 100.0, 1.0, (lower, across))
    other = uf.mesh.strip(100.0, 100.0, 1.0, (across, lower)).moved((0.0, 0.0, 1.0))
    model = uf.Model(uf.mesh.together(a=one, b=other), "ANS3DEAS", material=STEEL)
    for edge in ("x0 of a", "x1 of a", "x0 of b", "x1 of b"):
        model.fix(edge)
    if touching:
        model.sheet_contact("upper of a", "lower of b", name="touch")
    load = model.traction("upper of b", (0.0, 0.0, -1.0), "load")
    return model, [uf.Move(load, 0.2, steps=2)]


def fold(side: int, *, touching: bool = True) -> tuple[uf.Model, list[Any]]:
    """A strip of 1 mm that is folded by half a turn about 0.8 mm; its free end is moved onto the other flank."""
    along, radius = 2 * side, 0.8
    flank = 0.5 * (along * SIZE - np.pi * radius) + 0.4

    def bent(X: Any) -> Any:
        s, y, z = X.T
        angle, beyond = np.clip((s - flank) / radius, 0.0, np.pi), s - flank - np.pi * radius
        x = np.where(s < flank, s, np.where(beyond > 0.0, flank - beyond, flank + (radius - z) * np.sin(angle)))
        above = np.where(beyond > 0.0, 2.0 * radius - z, radius - (radius - z) * np.cos(angle))
        return np.column_stack([x, y, np.where(s < flank, z, above)])

    mesh = uf.mesh.strip(along * SIZE, side * SIZE / 2.0, 1.0, (along, side // 2)).transformed(bent)
    model = uf.Model(mesh, "ANS3DEAS", material=STEEL)
    if touching:
        model.self_contact("upper", name="touch")
    model.fix("x0")
    end = model.prescribe("x1", "z", "end")
    model.fix("x1", "y")
    return model, [uf.Move(end, -0.65, steps=4)]


CASES: dict[str, Callable[..., tuple[uf.Model, list[Any]]]] = {"two sheets": two_sheets, "fold": fold}


class Watch:
    """CPU seconds and calls of the search and of new patterns, without what they call of each other."""

    def __init__(self) -> None:
        self.seconds = {"search": 0.0, "pattern": 0.0}
        self.calls = {"search": 0, "pattern": 0}
        self._inside: list[float] = []

    def _timed(self, name: str, function: Callable[..., Any]) -> Callable[..., Any]:
        def call(*given: Any, **named: Any) -> Any:
            start = time.thread_time()
            self._inside.append(0.0)
            try:
                return function(*given, **named)
            finally:
                passed = time.thread_time() - start
                self.seconds[name] += passed - self._inside.pop()
                if self._inside:
                    self._inside[-1] += passed

        return call

    @contextmanager
    def watching(self) -> Iterator[None]:
        """Count and time meanwhile; the timing of a run is by CPU time."""
        covers, couples, made = SheetContact.covers, SheetContact.couples, Assembly.__init__
        revert, looked = SheetContact.revert, SheetContact._search

        def search(contact: SheetContact) -> None:
            self.calls["search"] += 1
            looked(contact)

        def counted(*given: Any) -> None:
            self.calls["pattern"] += 1
            made(*given)

        with ExitStack() as stack:
            for owner, name, new in (
                (SheetContact, "covers", self._timed("search", covers)),
                (SheetContact, "couples", self._timed("search", couples)),
                (SheetContact, "revert", self._timed("search", revert)),
                (SheetContact, "_search", search),
                (Assembly, "__init__", self._timed("pattern", counted)),
                (time, "perf_counter", time.thread_time),
            ):
                stack.enter_context(patch.object(owner, name, new))
            yield


def fill(model: uf.Model) -> tuple[int, float]:
    """Entries of the factors of the tangent as an unsymmetric matrix, and CPU seconds of the order."""
    values, pattern = model.evaluate(model.u).values, model.system.pattern
    if pattern.symmetric:
        from scipy.sparse import csr_array, triu

        upper = csr_array((values, pattern.indices, pattern.indptr), shape=(pattern.n, pattern.n))
        whole = csr_array(upper + triu(upper, 1).T)
        whole.sort_indices()
        pattern = Pattern(pattern.n, whole.indptr.astype(np.int32), whole.indices.astype(np.int32), False)
        values = whole.data
    solver, start = Multifrontal(), time.thread_time()
    solver.analyse(pattern)
    ordered = time.thread_time() - start
    return solver.factor(values).fill, ordered


def pairs_of(couplings: Sequence[Any]) -> Any:
    """Each pair of nodes once, shape (k, 2)."""
    return np.unique(np.concatenate([one.ids for one in couplings]), axis=0)


def measured(name: str, side: int) -> tuple[dict[str, str], dict[str, float]]:
    """One run."""
    watch, start = Watch(), time.thread_time()
    with watch.watching():
        model, steps = CASES[name](side)
        result = uf.solve(model, steps, progress=False, frames=0)
        whole = time.thread_time() - start
    timing = result.timing
    filled, _ = fill(model)
    alone, _ = fill(CASES[name](side, touching=False)[0])
    assert result["touch_active"][-1] > 0.0
    contact = model.system.sheet_contacts[0]
    facets = sum(map(len, contact.facets))
    seconds = {
        "search": watch.seconds["search"],
        "contact": timing.contact.seconds,
        "elements": timing.elements.seconds + timing.recovery.seconds,
        "pattern": watch.seconds["pattern"],
        "order": timing.analysis.seconds - watch.seconds["pattern"],
        "factors": timing.factorisation.seconds + timing.solve.seconds,
    }
    row = {
        "case": name,
        "elements": f"{len(model.mesh.connectivity)}",
        "CPU s": f"{whole:.1f}",
        **{f"{part}, %": f"{100.0 * value / whole:.1f}" for part, value in seconds.items()},
        "search, ms": f"{1e3 * watch.seconds['search'] / max(watch.calls['search'], 1):.1f}",
        "searches": str(watch.calls["search"]),
        "patterns": str(watch.calls["pattern"]),
        "evaluations": str(timing.attempts.evaluations),
        "couplings of a facet": f"{len(pairs_of(contact.couples())) / facets:.0f}",
        "fill": f"{1e-6 * filled:.2f} M",
        "without contact": f"{1e-6 * alone:.2f} M",
    }
    return row, {f"{name} {side**2}, {part} s": value for part, value in seconds.items()}


def searched(name: str, side: int) -> dict[str, str]:
    """The first search of a model, without a run: the least CPU time of three, of candidates and of couplings."""
    start = time.thread_time()
    model, _ = CASES[name](side)
    made = time.thread_time() - start
    contact = model.system.sheet_contacts[0]
    passes, u = contact.passes, np.zeros_like(model.u)
    found, coupled = [], []
    for _ in range(3):
        times = [time.thread_time()]
        for one in passes:
            one.search(u, contact._way, TURN)
        times.append(time.thread_time())
        couplings = [one.couplings() for one in passes]
        times.append(time.thread_time())
        found.append(times[1] - times[0]), coupled.append(times[2] - times[1])
    facets, pairs = sum(map(len, contact.facets)), len(pairs_of(couplings))
    part = 1e9 / (facets * np.log2(facets))
    return {
        "case": name,
        "facets": f"{facets}",
        "model, s": f"{made:.1f}",
        "candidates, ms": f"{1e3 * min(found):.1f}",
        "over n log2 n, ns": f"{part * min(found):.0f}",
        "couplings, ms": f"{1e3 * min(coupled):.0f}",
        "couplings of a facet": f"{pairs / facets:.0f}",
        "of a coupling, ns": f"{1e9 * min(coupled) / pairs:.0f}",
    }


def main() -> None:
    """Run the cases, print and write the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--case", choices=CASES, nargs="*", default=list(CASES))
    parser.add_argument("--side", type=int, nargs="*", help="square roots of the elements")
    parser.add_argument("--search", action="store_true", help="the search alone, of more elements")
    parser.add_argument("--page", type=Path, metavar="FILE", help="write the table into this page")
    record.add_option(parser)
    given = parser.parse_args()
    logging.getLogger("umform").addHandler(logging.NullHandler())
    uf.set_threads(1)
    rows, numbers = [], {}
    for name in given.case:
        for side in given.side or (SEARCHED if given.search else SIDES[name]):
            row, more = (searched(name, side), {}) if given.search else measured(name, side)
            rows.append(row)
            numbers |= more
            print(" | ".join(f"{key} {value}" for key, value in row.items()), flush=True)
    if numbers:
        record.write(given.json, "sheets that touch", numbers)
    if given.page:
        pages.put(given.page, "search" if given.search else "touch", pages.table(rows, left=(0, 1)))


if __name__ == "__main__":
    main()
