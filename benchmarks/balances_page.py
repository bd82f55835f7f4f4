"""The page of the balances: the largest of each quantity, the jobs that miss a limit, and all jobs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from pages import item

_PAGE = """# What balances

{count} small jobs of all kinds of forming: friction, held tools, elements with 8 and 18 nodes, laws, units. After each,
everything that must balance is compared with its limit.

```console
python benchmarks/balances.py --page docs/balances.md     # or: make balances
python benchmarks/balances.py --job "wiping, augmented"   # jobs by a part of their name
```

{verdict} All jobs take {seconds:.0f} CPU seconds on coarse meshes: they test balances, not accuracy.

{summary}

{limits}

`result.balance()` has forces, moments, energies and the work of each tool of your own run, `result.volume_change()` the
volume.

## Limits that are missed

{misses}

## Limits that are missed for a known reason

{known}

## All jobs

Numbers above their limits are bold. A drift that falls with the square of given increments is within its limit.

{table}
"""

_Outcomes = Sequence[Mapping[str, Any]]


def largest(outcomes: _Outcomes, name: str) -> Mapping[str, Any] | None:
    """The job in which a quantity is largest; None if no job has it."""
    having = [one for one in outcomes if name in one["found"]]
    return max(having, key=lambda one: float(one["found"][name]), default=None)


def summary(outcomes: _Outcomes, limits: Mapping[str, Any]) -> str:
    """Largest value of each quantity, in Markdown."""
    rows = ["| quantity | limit | largest | in | jobs | of them miss |", "|---|---:|---:|---|---:|---:|"]
    for name, limit in limits.items():
        most = largest(outcomes, name)
        if most is None:
            continue
        having = sum(name in one["found"] for one in outcomes)
        missed = sum(name in one["misses"] for one in outcomes)
        value = most["found"][name]
        rows.append(f"| {name} | {limit.most:g} | {_bold(value, missed > 0)} | {most['name']} | {having} | {missed} |")
    return "\n".join(rows)


def page(outcomes: _Outcomes, limits: Mapping[str, Any], known: Sequence[Any]) -> str:
    """The page."""
    missed = [one for one in outcomes if one["misses"]]
    found = {one["name"]: one["found"] for one in outcomes}
    verdict = "All limits are kept." if not missed else f"{len(missed)} of {len(outcomes)} jobs miss a limit."
    return _PAGE.format(
        count=len(outcomes),
        verdict=verdict,
        seconds=sum(one["CPU s"] for one in outcomes),
        summary=summary(outcomes, limits),
        limits="\n".join(item(f"**{name}**: {limit.what}. Limit: {limit.why}.") for name, limit in limits.items()),
        misses="\n".join(_missed(limits, name, outcomes) for name in [*limits, "end"] if _missing(name, outcomes))
        or "None.",
        known="\n".join(
            item(f"**{one.job}**, {one.quantity}, {found[one.job].get(one.quantity, 0.0):.2g}: {one.cause}.")
            for one in known
        ),
        table=_table(outcomes, limits),
    )


def _missing(name: str, outcomes: _Outcomes) -> list[Mapping[str, Any]]:
    return [one for one in outcomes if name in one["misses"]]


def _missed(limits: Mapping[str, Any], name: str, outcomes: _Outcomes) -> str:
    """The jobs that miss a limit, the worst first."""
    if name == "end":
        return item(
            "**not finished**: " + "; ".join(f"{one['name']}: {one['error']}" for one in _missing(name, outcomes))
        )
    worst = sorted(_missing(name, outcomes), key=lambda one: -one["found"][name])
    text = "; ".join(f"{one['name']} {one['found'][name]:.2g}" for one in worst)
    return item(f"**{name}** above {limits[name].most:g}: {text}")


def _table(outcomes: _Outcomes, limits: Mapping[str, Any]) -> str:
    rows = ["| job | " + " | ".join(limits) + " | increments | CPU s |", "|---" + "|---:" * (len(limits) + 2) + "|"]
    for one in outcomes:
        values = [_bold(one["found"].get(name), name in one["misses"]) for name in limits]
        rows.append(f"| {one['name']} | {' | '.join(values)} | {one['increments']} | {one['CPU s']:.1f} |")
    return "\n".join(rows)


def _bold(value: float | None, missed: bool) -> str:
    text = "" if value is None else f"{value:.1e}" if 0.0 < value < 1e-3 else f"{value:.3g}"
    return f"**{text}**" if missed else text
