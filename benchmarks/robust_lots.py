"""The lots of random jobs: which jobs, how they may end, what the tests run of them, their page."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from forming import FORMING
from jobs import BENDS, Lot

_HERE = Path(__file__).parent


@dataclass(frozen=True)
class Rated:
    """A lot of jobs and what is expected of it.

    Attributes
    ----------
    name : str
        Of the option ``--lot``.
    lot : Lot
        The jobs.
    good : tuple of str
        Outcomes that count as finished.
    goal : float
        Share of them.
    sample : tuple of int
        Jobs that the ordinary tests run.
    page : str
        The page, with places for numbers.
    """

    name: str
    lot: Lot
    good: tuple[str, ...]
    goal: float
    sample: tuple[int, ...]
    page: str

    @property
    def explanations(self) -> Path:
        """File with the reason of each failure."""
        return _HERE / ("robust_failures.toml" if self.name == "bends" else f"robust_failures_{self.name}.toml")

    @property
    def benchmark(self) -> str:
        """Name in the file of all benchmarks."""
        return "robust" if self.name == "bends" else f"robust-{self.name}"


#: Of all kinds: the cheapest ones, cheap ones that throw much away, and two that jump at the end of a stable path.
_BENDS_SAMPLE = (
    8, 9, 22, 23, 24, 33, 46, 57, 71, 72, 77, 93, 99, 104, 112, 117, 124, 130, 133, 141, 165, 166, 167, 180, 191, 194,
    197, 218, 224, 228, 233, 237, 244, 245, 264, 269, 270, 271, 274, 282, 292, 296,
)  # fmt: skip

_BENDS = """# How many jobs finish

{count} random jobs resemble those of users: bends with the metals, dies and punches of a workshop, to a stroke or to
an angle; strips over cylinders; strips between tools with drawn sections; plates under balls, plungers and rings.
Elements, penalties, contact points and multipliers are random. A job has finished if all its steps are complete and
forces and energies balance. The number of a job defines it completely.

```console
python benchmarks/robust.py --page docs/robust-rate.md     # or: make robust
python benchmarks/robust.py --job 117
```

{rate:.1%} finish; the goal is {goal:.1%} and no job that hangs: {verdict}.

{table}

Evaluations are those of residual and tangent. "Thrown away" are those of failed attempts of Newton's method.

## Jobs that do not finish

{failures}

## Jobs that jump

Jobs: {jumps}. The stable path ends, as in perfect plasticity it may, and the sheet jumps to the next stable state, of
which the run warns ([attempts](attempts.md)).
"""
#: Of all kinds, cheap ones; two of them failed where contact without forces or a rate was not foreseen.
_DRAWS_SAMPLE = (3, 6, 17, 24, 25, 27, 30, 31, 34, 36, 42, 49, 55, 58, 59, 69, 88, 92, 140)
_DRAWS = """# How many drawing jobs finish

{count} random jobs of drawing and forming, on coarse meshes: hats, joggles and rails between drawn tools, Z and L
bends, wiping, stretch bending, foils, cups, boxes, flanged holes, bulges, Nakajima specimens, stretched sheets. Metals
and laws, friction from 0 to 0.2, holders by force, on springs and at a gap, thicknesses from 0.01 to 12 mm, units (mm,
inch, m), elements, contact rules and increments are random. The number of a job defines it completely.

```console
python benchmarks/robust.py --lot draws --page docs/robust-draws.md     # or: make robust-draws
python benchmarks/robust.py --lot draws --job 117
```

A job has finished if all its steps are complete and its answer is right, or if `umform check` refuses it with a reason.
Right means: forces, moments and energies balance, tools that carry each other have the same force, the work of each
tool adds up, plastic flow keeps the volume, penetrations are those allowed, symmetric jobs have symmetric answers.
Limits are those of [what balances](balances.md); coarse meshes may miss symmetry by 0.5 %; cups and U-bends of the
processes may leave resultants of 1 %, ten times the tolerance of their residual, as may runs that warn of a residual
above the tolerance. A run that warns of a penetration, a drift of the energies, the volume of its mesh or a residual
has marked its numbers and counts as finished: {marked} jobs.

{rate:.1%} finish; the goal is {goal:.1%} and no job that hangs or ends with a wrong number: {verdict}. All take
{seconds:.0f} CPU seconds.

{table}

Evaluations are those of residual and tangent. "Thrown away" are those of failed attempts of Newton's method.

## Jobs that do not finish

{failures}

## Jobs that jump

Jobs: {jumps}. The stable path ends, and the sheet jumps to the next stable state, of which the run warns
([attempts](attempts.md)).
"""

LOTS = {
    "bends": Rated(
        "bends",
        BENDS,
        ("arrived",),
        0.995,
        _BENDS_SAMPLE,
        _BENDS,
    ),
    "draws": Rated("draws", FORMING, ("arrived", "refused"), 0.98, _DRAWS_SAMPLE, _DRAWS),
}
