"""The report of any result: shape, curves, events, history, settings, deck, versions, warnings."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from umform.attempts import HARMLESS, Attempts
from umform.errors import InvalidValue
from umform.report import parts
from umform.report.key_numbers import key_numbers
from umform.report.live import Live, style
from umform.report.looks import UNKNOWN, Units
from umform.report.materials import material_text
from umform.report.repeats import counted
from umform.report.versions import versions
from umform.report.words import column_text, text_of
from umform.results.balance_summary import LIMIT, Balanced, balanced
from umform.results.outcome import MEASURES
from umform.results.penetration import stage_penetrations
from umform.results.quantity import Quantity

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from umform.results.history import History
    from umform.results.outcome import Annex, Outcome

_ENERGIES = {
    "external work": "external_work",
    "elastic energy": "elastic",
    "plastic work": "plastic",
    "energy of the contacts": "contact",
    "work of friction": "friction",
}
_BALANCE = (
    "Imbalances are relative to the largest forces and moments, the drift of external work from the sum of the "
    f"energies is relative to the largest energy; its limit is {100.0 * LIMIT:g} %. Works and energies are those of "
    "the computed part."
)


def write_report(
    result: History,
    path: str | Path,
    *,
    deck: str = "",
    title: str = "",
    note: str = "",
    more: Iterable[str] = (),
    drawn: Mapping[str, Figure] | None = None,
    numbers: Sequence[Quantity] = (),
    units: Units = UNKNOWN,
) -> Path:
    """Write one self-contained page about a result.

    Parameters
    ----------
    result : History
        A result with a history.
    path : str or Path
        The page to write, ending in .html.
    deck : str, optional
        The input of the result, to be embedded in the page.
    title : str, optional
        Heading of the page; default: element and number of increments.
    note : str, optional
        Name, source and limits of the material.
    more : iterable of str, optional
        Parts of the page that follow the curves.
    drawn : mapping of str to Figure, optional
        Pictures that have been drawn already: see :meth:`umform.report.live.Live.of`.
    numbers : sequence of Quantity, optional
        What is shown beside the shape; default: those of :mod:`umform.report.key_numbers`.
    units : Units, optional
        Names of the units.

    Returns
    -------
    Path
        The page.

    Raises
    ------
    InvalidValue
        If the name does not end in .html, or the deck is no text.
    """
    parts.check_name(path)
    if not isinstance(deck, str):
        raise InvalidValue(
            "the deck of a report is its text",
            where="deck",
            value=deck,
            cause="the path of the deck",
            remedy="Path(...).read_text()",
        )
    model = result.model
    kinds = dict.fromkeys(body.element.name for body in model.bodies)
    size = f"{', '.join(kinds)}: {len(model.mesh.connectivity)} elements"
    lead = f"{size}; computed in {result.seconds:.1f} s"
    title, lead = (title, lead) if title else (size, f"computed in {result.seconds:.1f} s")
    live = Live.of(result, drawn=drawn, units=units)
    content = _parts(result, live, deck, note, more, numbers or key_numbers(result, units))
    return parts.write_html(path, title, lead, content, style=style(), scripts=live.scripts)


def _parts(
    result: History, live: Live, deck: str, note: str, more: Iterable[str], numbers: Sequence[Quantity]
) -> Iterator[str]:
    warnings = counted(result.warnings)
    yield parts.warned(warnings)
    yield parts.first_screen(numbers, live.shape)
    yield parts.warnings(warnings)
    yield from map(parts.note, live.notes)
    yield parts.heading("Curves")
    yield live.curves
    yield from more
    if result.events:
        yield parts.section("Events", [parts.items(counted(result.events))], opened=True)
    yield parts.section("History", [_end_values(result), live.table])
    yield parts.section("Settings", [parts.paragraph(note) if note else "", parts.pairs(settings(result))])
    if deck:
        yield parts.section("Deck", [parts.lines(deck)])
    yield from closing({"run": result}, result)


def outcome_parts(
    outcome: Outcome,
    picture: str,
    middle: Iterable[str],
    parameters: Mapping[str, object],
    note: str,
    *,
    model: str = "Model",
) -> Iterator[str]:
    """The report of a process.

    Parameters
    ----------
    outcome : Outcome
        What the process reports.
    picture : str
        The part, for the first screen.
    middle : iterable of str
        What only this process has, behind the numbers.
    parameters : mapping of str to object
        The parameters, for people.
    note : str
        Source of the material data; may be empty.
    model : str
        Heading of the model of the last run.
    """
    warnings = counted(outcome.warnings)
    yield parts.warned(warnings)
    yield parts.first_screen(outcome.leading, picture)
    yield parts.warnings(warnings)
    if outcome.all_notes:
        yield parts.items(outcome.all_notes)
    yield from middle
    for title, (header, *rows) in outcome.tables.items():
        shown = len(outcome.leading) == len(outcome.quantities) or title != MEASURES  # on the first screen, or here
        yield parts.section(title, [parts.table(header, rows)], opened=shown)
    for annex in outcome.annexes:
        yield from annex_parts(annex)
    yield from parameter_parts(parameters, note)
    main = list(outcome.stages.values())[-1]
    yield parts.section(model, [parts.pairs(settings(main))])
    yield from closing(outcome.stages, main)


def annex_parts(annex: Annex) -> Iterator[str]:
    """A study of the results of a process."""
    yield parts.heading(annex.title)
    for message in annex.warnings:
        yield parts.note(message, bad=True)
    header, *rows = annex.table
    yield parts.table(header, rows)
    yield from map(parts.note, annex.notes)
    if annex.picture is not None:
        yield parts.figure(annex.picture(), annex.caption)


def parameter_parts(values: Mapping[str, object], note: str) -> Iterator[str]:
    """The parameters of a process, with the source of its material data."""
    given = parts.pairs({name.replace("_", " "): value for name, value in values.items() if value is not None})
    yield parts.section("Parameters", [parts.paragraph(note) if note else "", given])


def closing(stages: Mapping[str, History], main: History) -> Iterator[str]:
    """The end of every report: contacts and balance of each stage, the time of the main one, and versions."""
    if any(result.model.system.penalised for result in stages.values()):
        kept = all(one.kept for rows in stage_penetrations(stages).values() for one in rows.values())
        yield parts.section("Contacts", contacts(stages), opened=not kept)
    yield from balance_parts({stage: balanced(result) for stage, result in stages.items()})
    yield parts.section("Where the time went", [time_spent(main)])
    yield parts.section("Versions", [parts.pairs(versions())])


def _end_values(result: History) -> str:
    """All columns of the history at the start and at the end of each step."""
    ends = {int(row["step"]): row for row in result.rows}
    columns = [name for name in result.columns() if name != "step"]
    header = ["", *("start" if step == 0 else f"end of step {step}" for step in ends)]
    return parts.table(
        header, [[column_text(name), *(f"{row[name] + 0.0:.6g}" for row in ends.values())] for name in columns]
    )


def time_spent(result: History) -> str:
    """Seconds, shares and calls of the parts of the run; its attempts."""
    rows = [
        [name, f"{seconds:.2f}", f"{100 * share:.1f}", "" if calls is None else str(calls)]
        for name, seconds, share, calls in result.timing.rows()
    ]
    return parts.table(["", "s", "%", "calls"], rows) + _attempts(result.timing.attempts)


def _attempts(attempts: Attempts) -> str:
    """How often each strategy was tried and succeeded, and discarded evaluations."""
    rows = [[name, str(tried), str(won)] for name, tried, won in attempts.rows()]
    rows += [[f"given up: {cause}", str(count), ""] for cause, count in attempts.causes.most_common()]
    rows += [["return maps in stages", str(attempts.staged), ""]] if attempts.staged else []
    table = parts.table([attempts.summary, "tried", "won"], rows)
    return parts.folded_part("Numerics", parts.paragraph(HARMLESS) + table)


def settings(result: History) -> dict[str, object]:
    """Model of a run as text."""
    model = result.model
    iterations = result.summary()["iterations"]
    rows: dict[str, object] = {
        "effort": f"{iterations} Newton iterations in {len(result) - 1} increments; sparse solver {result.solver}",
        "mesh": f"{len(model.mesh.points)} nodes, {len(model.mesh.connectivity)} elements {model.mesh.cell}",
    }
    for body in model.bodies:
        options = ", ".join(f"{column_text(name)} {text_of(value)}" for name, value in body.element.options.items())
        of = f" of {body.name}" if len(model.bodies) > 1 else ""
        rows |= {
            f"element{of}": f"{body.element.name} ({options})" if options else body.element.name,
            f"points through the thickness{of}": f"{body.thickness_points} by {body.thickness_rule.capitalize()}",
            f"material{of}": material_text(body.material),
        }
    rows |= {
        "degrees of freedom": f"{model.supports.unknown_count} unknown of {model.u.size}",
    }
    between = {f"contact {pair.name}": "between sheets" for pair in model.system.sheet_contacts}
    return rows | {f"contact {pair.name}": pair.tool.surface for pair in model.contacts} | between


def contacts(stages: Mapping[str, History]) -> Iterator[str]:
    """Allowed and reached penetration of each contact; marked where it was not kept."""
    for stage, rows in stage_penetrations(stages).items():
        which = f"{stage}, " if len(stages) > 1 else ""
        for name, reached in rows.items():
            yield parts.note(f"{which}contact {name}: {reached.text}", bad=not reached.kept)


def balance_parts(balances: Mapping[str, Balanced | None]) -> Iterator[str]:
    """Balances of runs by name, a column for each; a drift beyond its limit is marked."""
    found = {name: one for name, one in balances.items() if one is not None}
    if found:
        yield parts.section(
            "Balance of forces and energies",
            [_balance_table(found), parts.paragraph(_BALANCE)],
            opened=any(one.quantity.missed for one in found.values()),
        )


def _balance_table(found: Mapping[str, Balanced]) -> str:
    ones = list(found.values())
    rows: list[list[str]] = [
        ["largest imbalance of forces", *(f"{one.force_imbalance:.1e}" for one in ones)],
        ["largest imbalance of moments", *(f"{one.moment_imbalance:.1e}" for one in ones)],
        ["largest drift of the energies, %", *(one.quantity.text for one in ones)],
        ["in step", *(str(one.drift_step) for one in ones)],
        ["energies at the start", *(f"{one.before:.6g}" for one in ones)],
        *(
            [f"work of {tool}", *(f"{one.works[tool]:.6g}" if tool in one.works else "" for one in ones)]
            for tool in dict.fromkeys(tool for one in ones for tool in one.works)
        ),
        *([f"{name} at the end", *(f"{getattr(one, key):.6g}" for one in ones)] for name, key in _ENERGIES.items()),
    ]
    return parts.table(["", *found], rows)
