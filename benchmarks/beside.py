"""What evaluations beside the iterations of accepted increments are for: line searches, passes, discarded attempts.

python benchmarks/beside.py --page docs/performance-draws.md   # or: make draws
python benchmarks/beside.py --job "square cup" --each          # each increment: residual, points that open, close, flow
"""

from __future__ import annotations

import argparse
import logging
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any, cast
from unittest.mock import patch

import draws
import needs_book  # noqa: F401
import pages
import record
import umform as uf
from umform.analysis.newton import newton
from umform.analysis.newton.newton import Newton
from umform.analysis.newton.strategies import Increment
from umform.analysis.steps.run_state import Run
from umform.attempts import Attempts
from umform.model.equations.evaluated import Evaluated
from umform.problem import load
from umform.problem.templates import template_file
from umform.processes.draw import draw
from umform.processes.solution import drawing_options
from umform.timing import Timing, timings
from umform_book.drawing import hemisphere, s_rail, square_cup
from umform_book.page import Page

#: Purposes beside the iterations, in the order of the columns.
PURPOSES = ("line search", "passes", "starts", "discarded", "other")


class _Page:
    """In place of a page of the book: solves with given options, and writes nothing."""

    def __init__(self, options: uf.NewtonOptions) -> None:
        self.options = options

    def solve(self, label: str, model: uf.Model, steps: Any, **of_the_page: Any) -> Any:
        return uf.solve(model, steps, options=self.options, frames=0, progress=False)


def _hemisphere(options: uf.NewtonOptions) -> str:
    page = cast(Page, _Page(options))
    dome = hemisphere.made(page, "", hemisphere.Setup(6, 4.0, "ANS3DEAS"), 0.3)
    return f"{1e-3 * dome.force[-1]:.2f} kN, {dome.thickness[-1].min():.4f}"


def _square_cup(options: uf.NewtonOptions) -> str:
    cup = square_cup.make(cast(Page, _Page(options)), "", square_cup.Setup(4.5), (15.0,))[15.0]
    return f"{cup.force:.2f} kN, {cup.side:.3f}, {cup.diagonal:.3f}"


def _s_rail(options: uf.NewtonOptions) -> str:
    model, steps = s_rail.model_of(s_rail.Setup(45.0, 14), 12.0)
    result = uf.solve(model, steps, options=options, frames=0, progress=False)
    return f"{1e-3 * float(result['stroke_force'][-1]):.2f} kN"


def _template(name: str, options: uf.NewtonOptions | None = None) -> str:
    problem = load(template_file(name)).build()
    options = options or problem.options
    result = uf.solve(problem.model, problem.steps, options=options, frames=0, progress=False)
    return f"{abs(result['punch_fz']).max():.2f} N, {abs(problem.model.u).max():.3f}"


def _drawn(name: str) -> str:
    return draws.numbers(draw(draws.PARTS[name], progress=False))


#: Models of the book, on coarse meshes: with the tolerances of `uf.solve`, and with those of drawing.
BOOK = {"hemisphere": _hemisphere, "square cup": _square_cup, "S-rail": _s_rail}
TEMPLATES = ("hat-rail", "cup", "square-cup")
JOBS: dict[str, Callable[[], str]] = {
    **{name: lambda name=name: _drawn(name) for name in ("cup", "U-bend, coarse")},
    **{f"{name}, tight": lambda job=job: job(uf.NewtonOptions()) for name, job in BOOK.items()},
    **{name: lambda job=job: job(drawing_options()) for name, job in BOOK.items()},
    **{f"template {name}, tight": lambda name=name: _template(name, uf.NewtonOptions()) for name in TEMPLATES},
    **{f"template {name}": lambda name=name: _template(name) for name in TEMPLATES},
}


class Purposes:
    """What each evaluation was for.

    Attributes
    ----------
    log : list of str
        The purpose of each evaluation.
    accepted : int
        Iterations of accepted increments.
    """

    def __init__(self, *, each: bool) -> None:
        self.log: list[str] = []
        self.accepted = 0
        self._now, self._each, self._told = ["iterations"], each, 0

    def beside(self) -> dict[str, int]:
        """Number of evaluations for each purpose."""
        counts = Counter(self.log)
        counts["other"] = counts.pop("iterations", 0) - self.accepted
        if counts["other"] < 0:  # passes by way of softer penalties are iterations of their increment
            counts["passes"], counts["other"] = counts["passes"] + counts["other"], 0
        return {purpose: counts[purpose] for purpose in PURPOSES}

    @contextmanager
    def watching(self) -> Iterator[None]:
        """Note the evaluations meanwhile."""
        evaluate, discard, keep = Evaluated.evaluate, Attempts._discard, Run.keep

        def evaluated(model: Any, *given: Any, **named: Any) -> Any:
            self.log.append(self._now[-1])
            return evaluate(model, *given, **named)

        def discarded(attempts: Attempts, mark: tuple[int, int]) -> None:
            discard(attempts, mark)
            count = attempts.evaluations - mark[0]
            self.log[len(self.log) - count :] = ["discarded"] * count

        def kept(run: Run, converged: Any, *given: Any, **named: Any) -> None:
            keep(run, converged, *given, **named)
            self.accepted += len(converged.iterations)
            if self._each:
                self._tell(run.model.system.time, converged.iterations)

        with ExitStack() as stack:
            for owner, name, new in (
                (Evaluated, "evaluate", evaluated),
                (Attempts, "_discard", discarded),
                (Run, "keep", kept),
                (newton, "shortened", self._for("line search", newton.shortened)),
                (newton, "lengthened", self._for("line search", newton.lengthened)),
                (Newton, "go_on", self._for("passes", Newton.go_on)),
                (Increment, "tangent", self._for("starts", Increment.tangent)),
            ):
                stack.enter_context(patch.object(owner, name, new))
            yield

    def _for(self, purpose: str, function: Callable[..., Any]) -> Callable[..., Any]:
        def call(*given: Any, **named: Any) -> Any:
            self._now.append(purpose)
            try:
                return function(*given, **named)
            finally:
                self._now.pop()

        return call

    def _tell(self, time: float, iterations: list[Any]) -> None:
        counts, self._told = dict(Counter(self.log[self._told :])), len(self.log)
        steps = [
            f"{one.residual:.0e} +{one.entered} -{one.left} flow {one.switched}"
            + (f" length {one.step_length:.2g}" if one.step_length != 1.0 else "")
            for one in iterations
        ]
        print(f"  time {time:.4f} {counts}: {'; '.join(steps)}")


def measured(name: str, *, each: bool = False) -> dict[str, str]:
    """One job."""
    purposes, start = Purposes(each=each), time.process_time()
    with purposes.watching(), timings() as runs:
        numbers = JOBS[name]()
    seconds, attempts = time.process_time() - start, Timing.sum(runs).attempts
    return {
        "job": name,
        "CPU s": f"{seconds:.1f}",
        "evaluations": str(attempts.evaluations),
        "beside, %": f"{100.0 * attempts.beside:.0f}",
        **{purpose: str(count) for purpose, count in purposes.beside().items()},
        "numbers": numbers,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--job", choices=JOBS, nargs="*", default=list(JOBS))
    parser.add_argument("--each", action="store_true", help="print each increment")
    parser.add_argument("--page", type=Path, metavar="FILE", help="write the table into this page")
    record.add_option(parser)
    given = parser.parse_args()
    logging.getLogger("umform").addHandler(logging.NullHandler())
    uf.set_threads(1)
    rows = []
    for name in given.job:
        rows.append(measured(name, each=given.each))
        print(" | ".join(rows[-1].values()), flush=True)
    record.write(given.json, "beside", {f"{row['job']}, evaluations": float(row["evaluations"]) for row in rows})
    if given.page:
        pages.put(given.page, "beside", pages.table(rows, left=(0, 9)))


if __name__ == "__main__":
    main()
