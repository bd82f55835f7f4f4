"""Which runs are compared, and the tables: costs of all runs of a case, ratios of all comparisons."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from entries import Entry, Outcome

#: The runs of a case by their key.
Found = Mapping[str, tuple[Entry, Outcome]]


@dataclass(frozen=True)
class Comparison:
    """Two runs of a case.

    Attributes
    ----------
    what : str
        What they have in common.
    own, other : str
        Keys of the run of umform and of that of the other code.
    goal : float, optional
        How many times fewer CPU seconds umform is to take.
    """

    what: str
    own: str
    other: str
    goal: float | None = None


def as_good(found: Found, error: Mapping[str, float], goals: Mapping[str, float] | None = None) -> list[Comparison]:
    """For each run of another code the cheapest run of umform whose error, in %, is no larger; goals by element."""
    made = []
    for key, off in error.items():
        better = [k for k, e in error.items() if found[k][0].peer == "umform" and e <= off]
        if found[key][0].peer != "umform" and better:
            cheapest = min(better, key=lambda k: found[k][1].cost.cpu)
            goal = (goals or {}).get(found[key][0].element)
            made.append(Comparison(f"error {error[cheapest]:.2g} % against {off:.2g} %", cheapest, key, goal))
    return made


def costs(found: Found, measures: Mapping[str, Mapping[str, float]]) -> list[list[str]]:
    """Rows of the runs of a case, header first."""
    names = list(dict.fromkeys(name for row in measures.values() for name in row))
    header = ["run", "CPU s", "start-up s", "MB", "increments", "iterations", "unknowns", "solver", *names]
    rows = [header]
    for key, (_, o) in found.items():
        row = [key, f"{o.cost.cpu:.3g}", f"{o.start_up:.2f}" if o.start_up else "-", f"{o.cost.memory:.0f}"]
        row += [str(o.increments), str(o.iterations), str(o.unknowns), o.solver]
        mine = measures.get(key, {})
        rows.append(row + [f"{mine[name]:.4g}" if name in mine else "-" for name in names])
    return rows


HEADER = ["case", "what", "umform", "other", "CPU", "CPU without start-up", "iterations", "memory", "goal", "verdict"]


def ratios(case: str, found: Found, comparisons: Iterable[Comparison]) -> list[list[str]]:
    """Rows of comparisons: other code over umform, so that above 1 is better for umform."""
    rows = []
    for compared in comparisons:
        (_, own), (_, other) = found[compared.own], found[compared.other]
        cpu = other.cost.cpu / own.cost.cpu
        working = (other.cost.cpu - other.start_up) / (own.cost.cpu - own.start_up)
        numbers = (cpu, working, other.iterations / own.iterations, other.cost.memory / own.cost.memory)
        row = [case, compared.what, compared.own, compared.other, *(f"{number:.3g}" for number in numbers)]
        rows.append([*row, *_verdict(compared.goal, cpu, working)])
    return rows


def _verdict(goal: float | None, cpu: float, working: float) -> tuple[str, str]:
    if goal is None:
        return "-", "slower" if cpu < 1 else "-"
    return f"{goal:g}", "met" if cpu >= goal else "missed (met without start-up)" if working >= goal else "missed"


def markdown(rows: Sequence[Sequence[str]]) -> str:
    """A table in Markdown; columns after the words are aligned to the right."""
    words = [not any(_is_number(row[i]) for row in rows[1:]) for i in range(len(rows[0]))]
    rule = ["---" if word else "---:" for word in words]
    return "\n".join("| " + " | ".join(row) + " |" for row in (rows[0], rule, *rows[1:]))


def _is_number(word: str) -> bool:
    return word.replace(".", "").replace("-", "").replace("e+", "").isdigit()
