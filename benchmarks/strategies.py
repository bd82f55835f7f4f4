"""Attempts of Newton's method: strategies that were tried and succeeded, discarded evaluations and their causes.

``python benchmarks/strategies.py --page docs/attempts.md`` writes the tables between the marks of the page.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Callable
from pathlib import Path

import needs_book  # noqa: F401
import pages
import umform as uf
from dome import build as dome
from umform.attempts import Attempts
from umform.processes.air_bending.search import find_stroke
from umform.processes.air_bending.spec import AirBending
from umform.processes.bending.case import build as build_bending
from umform.processes.bending.case import free_bending
from umform.processes.bending.showcase import Selection
from umform.processes.bending.spec import FreeBending
from umform.timing import Timing, timings
from umform_book.book import Order, cases, chapters, run_case


def domes(cells: int, increments: int | None) -> Callable[[], object]:
    """A sphere that is pressed into a clamped sheet."""

    def run() -> object:
        model, move = dome(cells)
        return uf.solve(model, uf.Move(move.control, move.to, steps=increments), frames=0, progress=False)

    return run


def demo() -> None:
    """The 14 runs of ``umform demo free-bending``."""
    for case in Selection().runs(FreeBending()):
        free_bending(case, frames=0, progress=False)


def one_of_the_demo(increments: int | None) -> Callable[[], object]:
    """The first run of the demo with its release, in perfect plasticity, in few increments."""

    def run() -> object:
        case = FreeBending()
        model, punch = build_bending(case)
        steps = [uf.Move(punch, to=-case.stroke, steps=increments), uf.Release(punch)]
        return uf.solve(model, steps, frames=0, progress=False)

    return run


def in_the_book(title: str) -> Callable[[], None]:
    """A chapter of the verification book, on its short meshes."""
    return lambda: run_chapter(title)


def run_chapter(title: str) -> None:
    """Run all of its cases."""
    chapter = next(chapter for chapter in chapters() if chapter.title == title)
    with tempfile.TemporaryDirectory() as folder:
        for kind in ("images", "results"):
            (Path(folder) / kind).mkdir()
        for case in chapter.cases:
            assert case.name in cases()
            run_case(Order(case.name, Path(folder), short=True))


WORKLOADS: dict[str, Callable[[], object]] = {
    "dome, 1 024 elements, 10 increments": domes(32, 10),
    "dome, 2 500 elements, 10 increments": domes(50, 10),
    "dome, 2 500 elements, 4 increments": domes(50, 4),
    "dome, 2 500 elements, at a pace": domes(50, None),
    "dome, 10 000 elements, 10 increments": domes(100, 10),
    "demo, 14 runs of 300 increments": demo,
    "one run of the demo at a pace": one_of_the_demo(None),
    "one run of the demo, 20 increments": one_of_the_demo(20),
    "stroke for 90 degrees in air bending": lambda: find_stroke(AirBending(), 90.0, progress=False),
    "chapter of contact in the book": in_the_book("Contact"),
    "chapter of friction in the book": in_the_book("Friction"),
}


def attempts(work: Callable[[], object]) -> Attempts:
    """The counts of all runs in some work."""
    with timings() as runs:
        work()
    return Timing.sum(runs).attempts


def tables(found: dict[str, Attempts]) -> str:
    """Two tables in Markdown: shares and strategies by workload, causes over all of them."""
    names = list(dict.fromkeys(name for one in found.values() for name in one.tried))
    lines = [
        "| | evaluations | discarded | " + " | ".join(names) + " |",
        "|---|---:|---:|" + "---:|" * len(names),
    ]
    for workload, one in found.items():
        shares = [f"{one.won[name]} of {one.tried[name]}" if one.tried[name] else "" for name in names]
        lines.append(f"| {workload} | {one.evaluations} | {100 * one.share:.1f} % | " + " | ".join(shares) + " |")
    whole = Attempts()
    for one in found.values():
        whole.add(one)
    lines += ["", "| attempts given up, all runs above | |", "|---|---:|"]
    lines += [f"| {cause} | {count} |" for cause, count in whole.causes.most_common()]
    return "\n".join(lines) + "\n"


def main() -> None:
    """Run the workloads one after the other."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", choices=list(WORKLOADS), action="append", metavar="NAME", help="default: all")
    parser.add_argument("--page", type=Path, help="page that gets the tables between its marks")
    arguments = parser.parse_args()
    uf.set_threads(1)
    text = tables({name: attempts(WORKLOADS[name]) for name in arguments.only or WORKLOADS})
    print(text)
    if arguments.page:
        pages.put(arguments.page, "attempts", text)


if __name__ == "__main__":
    main()
