"""The page of the bands: the parts, the share of finest answers within them, what they cost, and all errors."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from typing import Any

from band_jobs import COARSE, DECK, DEFAULT, FINEST, QUICK
from band_studies import (
    SEQUENCE,
    SINGLE,
    Checked,
    Part,
    budgets,
    by_coarse,
    changes,
    extrapolated,
    held_out,
    inside,
    other_half,
    studied,
)
from umform.problem.coarser import VARIANTS
from umform.problem.error_budget import SAFETY
from umform.results.studies import StudiedMesh, band_of

_PAGE = """# Bands of numbers

Each number that a bend, a sequence of bends, a hem, a cup, a U-bend or a deck prints can have a band: how far it may be
from the answer on a much finer mesh with smaller increments, more points, stiffer contact and tighter tolerances. It is
the `±` of the tables and the shade in the pictures; `band` in the JSON files has the error, its kind, and the errors by
single sources.

| band | numbers | cost |
|---|---|---|
| changes of this run by refinements, root of the sum of squares | `umform bend --budget` | several runs |
| changes of this run by coarser variants, likewise times {safety:g} | `umform run --budget` | {deck} of a run |
| two meshes, other sources as below | angles, springback, force, draw-in of `umform draw u` | {two} of a run |
| three meshes | forces and thinning of `umform bead` | [see there](draw-beads.md) |
| ripple of the force by the mesh, or the next line if that is more | punch force of `umform draw cup` | none |
| estimated from studies of other parts; a note below the table says so | all others but decks | none |

With `--scatter`, two standard deviations of the number by the parameters that scatter are added, by the root of the sum
of squares.

No band contains the error of the law of the metal, of an unknown friction, or of tools that are not rigid. These
numbers have no band, and are *of this mesh* in the tables: those of decks without `--budget`; the number of ears and
the amplitude from which they count; the stroke of a largest force, which a flat curve may have anywhere; the angle of
the first bend of a hem whose stroke is given (in Python only).
`--no-extrapolate` leaves out the coarser mesh of a U-bend, and estimates its bands from studies.

## Decks

`umform run --budget deck.toml` repeats a deck with each of these changes, in parallel, and prints the changes of all
measures, controls and forces at step ends, and with `forming` those of thinning, strains and forming limits.
The error is the root of the sum of squares, times {safety:g}. If a number converges at least linearly with element
size, increment and penetration, its true error is below that, unless a coarser mesh agrees by chance. The factor is the
smallest of 1, 1.25, 1.5 and 2 that puts 90 % of the answers of the decks below into their bands: it is chosen and
checked on the same decks. The numbers of `forming` are not among these answers.

| name | change |
|---|---|
| `mesh*2` | elements of a generated mesh twice as long, those of all sheets |
| `step*2` | increments twice as large, also those of a pace |
| `t-pts-2` | two points through the thickness less, for laws with a history |
| `c-pts-1` | one contact point, or cell, per direction and facet less; one more where there are two |
| `depth*2` | half of each penalty, or twice the allowed penetration; of sheets that touch half of the last penalty |
| `tol*10` | tolerances ten times as large, unless that of the residual is below 1e-6 |

The others run on the coarser mesh, where there is one. A mesh of a file, and that of an operation before, have none,
nor have bonded sheets whose nodes would not meet: the errors are then those by the other sources, and the table says
*of this mesh*. Arcs, the closing of tools and releases without a number of increments keep their increments in the same
way. A variant that does not converge leaves the error unknown, and a warning says why.

## Studies

`make bands` runs {count} small parts: each on its default mesh, on a coarse one, on the finest with all refinements
together, and most with each refinement alone ({seconds:.0f} CPU seconds in all).
Runs in `benchmarks/bands.jsonl` are not repeated unless their parameters change: delete it after a change of the code.

The differences of the default mesh from the finest one are taken as normally distributed about zero, with a standard
deviation that is proportional to the number or not, whichever is likelier; of forces it is proportional. The band of a
number is the root mean square of the differences times the factor of Student's distribution that contains 95 % for so
many parts: 2.2 for 11, 2.6 for 5, 4.3 for 2. Here no factor is fitted. On larger elements a band grows with the square
of their size, on smaller ones it falls in proportion to it. Bends with fewer layers than the default, or with elements
of 8 nodes, have no bands: the studies have none. Bends are in plane strain; bends with a width have their bands. Each
bend of a sequence has the bands of single ones, flanges have their own; the finest mesh of a sequence has four
layers, that of a single bend a stack of eight. Errors of hems, cups and U-bends in mm that are not proportional to the
number are so to the thickness.

**Hems.** Flat, open and rope hems have a study each, those over an inner sheet or an insert have one together
(*filled*), and hems of all forms by a force another, of flat ones and one over an insert: there the force is given,
height and gap follow. Their bands do not depend on the softness of the next paragraph. The finest mesh has eight
elements on a thickness and four layers. On it the fold itself has not converged: largest gap, creep, roll-in and inner
strain have the wide bands that the studies show. Studies of three parts are small: their factor is 3.2, and the check
by two others, with a factor of 4.3, is a weak one.

**Sharp bends.** The errors of bends depend less on thickness over inside radius than on the hardening that is left at
the outer face. They are taken as proportional to a power of {exponent}, the likeliest one, of the *softness*: the yield
stress over its slope at the strain of the outer face. A bend of a steel with little hardening has a wide band:

{bends}

{parts}

## Is the finest answer in the band?

Each part is left out in turn, and its bands are estimated from the others alone: scale, power and root mean square.
Then the parts are cut into two halves, and the bands of each half are estimated from the other one. The goal is 90 % of
all answers together; where a row below has less, the bands of that process are less certain.

{verdict}

{check}

{missed}

{coarse}

## Errors

Root mean squares of the errors of the default mesh, without the factor, and of what one refinement alone changes: the
finer mesh and the layers on the default mesh, the others on the coarse one; `all but the mesh` is what all others
change together on the fine mesh, and what an extrapolation over meshes lacks. Those of bends are for a
softness of 1, those of hems, cups and U-bends in mm for a thickness of 1 mm.

{errors}
"""

_Rows = Sequence[Mapping[str, Any]]


def page(
    rows: _Rows,
    found: Mapping[str, Mapping[str, Part]],
    units: Mapping[str, Mapping[str, str]],
    data: Mapping[str, Mapping[str, Any]],
) -> str:
    """The page in Markdown.

    Parameters
    ----------
    rows : sequence of mapping
        All runs.
    found, units, data : mapping
        By process: runs of each part, units of the numbers, the studies.
    """
    checks = checks_of(found, units)
    every = [one for checked, _ in checks.values() for one in checked]
    halves = [one for _, checked in checks.values() for one in checked]
    within = f"{_share(every):.0f} % of {len(every)} answers lie in their bands"
    by_halves = f"; by the other half of the parts, {_share(halves):.0f} % of {len(halves)}" if halves else ""
    bends = found.get(SINGLE, {})
    return _PAGE.format(
        two=_cost(found.get("u-bend", {}), [QUICK]),
        deck=_cost(found.get(DECK, {}), VARIANTS),
        count=sum(len(parts) for parts in found.values()),
        seconds=sum(row["cpu"] for row in rows),
        safety=SAFETY,
        exponent=data[SINGLE]["exponent"] if bends else "",
        bends=_bends(bends, data.get(SINGLE, {})),
        parts=_parts(found, data),
        verdict=f"{within}{by_halves}: the goal is {'met' if _share(every) >= 90.0 else 'missed'}.",
        check=_check(checks),
        missed=_missed(checks),
        coarse=_coarse(found),
        errors="\n\n".join(_errors(process, studies, _units(rows, process)) for process, studies in data.items()),
    )


def checks_of(
    found: Mapping[str, Mapping[str, Part]], units: Mapping[str, Mapping[str, str]]
) -> dict[tuple[str, str], tuple[Checked, Checked]]:
    """Whether the finest answers lie in the bands of the other parts, and of the other half, by process and kind."""
    checks: dict[tuple[str, str], tuple[Checked, Checked]] = {}
    for process, parts in found.items():
        if process == DECK:
            checks[process, "coarser variants"] = budgets(parts), []
            continue
        for mesh in (DEFAULT, COARSE):
            given = parts, units[process], mesh, process
            checks[process, f"estimated, {mesh} mesh"] = held_out(*given), other_half(*given)
    if SEQUENCE in found:
        single = studied(list(found[SINGLE].values()), units[SINGLE])
        for key in [key for key in checks if key[0] == SEQUENCE]:
            flanges = [one for one in checks[key][0] if one[1] not in single["quantities"]]
            checks[key] = flanges, []
        checks[SEQUENCE, "estimated by single bends"] = inside(found[SEQUENCE], single, DEFAULT, SINGLE), []
    if "u-bend" in found:
        checks["u-bend", "two meshes"] = extrapolated(found["u-bend"], units["u-bend"])
    return {key: both for key, both in checks.items() if both[0]}


def _share(checked: Checked) -> float:
    """Answers in their bands, in per cent."""
    return 100.0 * sum(one for *_, one in checked) / len(checked)


def _cost(parts: Mapping[str, Part], runs: Sequence[str]) -> str:
    """CPU time of other runs over that of the default."""
    other = sum(part[run]["cpu"] for part in parts.values() for run in runs if run in part)
    own = sum(part[DEFAULT]["cpu"] for part in parts.values())
    return f"{other / own:.1f}" if own else ""


def _sharpness(name: str, part: Part) -> float:
    thickness = float(name.split(", ")[1].removesuffix(" mm"))
    radius: float = part[DEFAULT]["values"]["radius"]
    return thickness / radius


def _bends(bends: Mapping[str, Part], data: Mapping[str, Any]) -> str:
    """Sharpness, softness, error and band of the angle of each bend."""
    lines = ["| bend | thickness over inside radius | softness | error of the angle, degrees | band, degrees |"]
    lines.append("|---|---:|---:|---:|---:|")
    for name, part in bends.items():
        change = changes(part, DEFAULT, FINEST)["angle"][0]
        at = StudiedMesh(SINGLE, softness=change.softness)
        band = band_of(data["quantities"]["angle"], data["exponent"], change.value, at, "")
        assert band is not None  # its own studies
        cells = (
            f"{_sharpness(name, part):.2f}",
            f"{change.softness:.2g}",
            f"{change.error:.2f}",
            f"± {band.error:.2f}",
        )
        lines.append(_row([name, *cells]))
    return "\n".join(lines)


def _parts(found: Mapping[str, Mapping[str, Part]], data: Mapping[str, Mapping[str, Any]]) -> str:
    lines = ["| process | parts |", "|---|---|"]
    lines += [f"| {process} | {'; '.join(parts)} |" for process, parts in found.items()]
    kept = {process: studies for process, studies in data.items() if process not in found}
    earlier = "parts of an earlier study, not checked here"
    lines += [f"| {name} | {one['parts']} {earlier} |" for name, one in kept.items()]
    return "\n".join(lines)


def _check(checks: Mapping[tuple[str, str], tuple[Checked, Checked]]) -> str:
    lines = ["| process | band | answers | in the band, % | of the other half, % |", "|---|---|---:|---:|---:|"]
    for (process, kind), (checked, half) in checks.items():
        by_half = f"{_share(half):.0f}" if half else ""
        lines.append(f"| {process} | {kind} | {len(checked)} | {_share(checked):.0f} | {by_half} |")
    return "\n".join(lines)


#: Processes whose bands could come from a coarser mesh of the part itself.
_COULD = ("cup", SEQUENCE)
_WHY = f"""\
**Why not a coarser mesh of the part itself?** For cups and sequences it costs half of a run or more, and the finest
answer lies within {SAFETY:g} times the change from it less often: errors by layers, contact points and penalty are not
in that change. They keep the studies, at no cost."""


def _coarse(found: Mapping[str, Mapping[str, Part]]) -> str:
    """What a coarser mesh of the part would cost and tell, where it is not used."""
    lines = ["| process | cost of the coarse mesh, of a run | answers | within, % |", "|---|---:|---:|---:|"]
    for process in _COULD:
        checked = by_coarse(found.get(process, {}))
        if checked:
            lines.append(_row([process, _cost(found[process], [COARSE]), str(len(checked)), f"{_share(checked):.0f}"]))
    return "\n\n".join([_WHY, "\n".join(lines)]) if len(lines) > 2 else ""


def _missed(checks: Mapping[tuple[str, str], tuple[Checked, Checked]]) -> str:
    found: dict[str, list[str]] = {}
    for (process, kind), (checked, _) in checks.items():
        for part, number, within in checked:
            if not within:
                found.setdefault(f"{process}, {kind}: {part}", []).append(number)
    if not found:
        return ""
    lines = (
        textwrap.fill(f"* {where}: {', '.join(dict.fromkeys(numbers))}", 120, subsequent_indent="  ")
        for where, numbers in found.items()
    )
    return "Answers beyond their bands:\n\n" + "\n".join(lines)


def _units(rows: _Rows, process: str) -> dict[str, str]:
    """Unit of each number of a process, also of one whose parts have no stored studies here."""
    return {name: unit for row in rows if row["process"] == process for name, unit in row["units"].items()}


def _errors(process: str, studies: Mapping[str, Any], units: Mapping[str, str]) -> str:
    rows = studies["quantities"]
    sources = list(dict.fromkeys(source for row in rows.values() for source in row["sources"]))
    lines = [f"**{process}**, {studies['parts']} parts", "", _row(["number", "error", "unit", "parts", *sources])]
    lines.append(_row(["---", "---:", "---", "---:", *["---:"] * len(sources)]))
    for name, row in rows.items():
        scale = 100.0 if row["relative"] else 1.0
        unit = "% of it" if row["relative"] else units.get(name, "")
        single = (f"{scale * row['sources'][one]:.2g}" if one in row["sources"] else "" for one in sources)
        lines.append(_row([name, f"{scale * row['meshes'][DEFAULT]:.2g}", unit, str(row["count"]), *single]))
    return "\n".join(lines)


def _row(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"
