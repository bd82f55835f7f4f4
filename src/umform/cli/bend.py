"""``umform bend``: air bending of a sheet in a V-die."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from umform.cli import bend_correct, bend_table  # noqa: F401  (they add their commands)
from umform.cli.bend_goals import (
    check_budgeted,
    check_flat_only,
    check_goal,
    check_length,
    check_measured,
    check_no_goal,
    check_press,
    strokes_of,
)
from umform.cli.bends import alone, bends
from umform.cli.check import Force
from umform.cli.deflection import deflected, press_brake
from umform.cli.drawn_tools import drawn_tools, named_tools
from umform.cli.folders import out_option, results_folder, say_written
from umform.cli.identify import MOST, Find, Quantities, identify_case
from umform.cli.metal import SheetMetal, with_metal
from umform.cli.options import (
    SHEET,
    SOLUTION,
    All,
    PrintDeck,
    option,
    print_deck,
)
from umform.cli.outcome_screen import show_outcome
from umform.cli.plausible import refuse_implausible
from umform.cli.root import Csv, Debug, Overwrite, Verbose, printing, say
from umform.cli.sequence import run_sequence
from umform.cli.spec_options import Given, given_by
from umform.cli.stack import OnTop, stacked
from umform.cli.studies import Studies, with_studies
from umform.cli.timing import Timed, show_timing
from umform.cli.warnings import print_warnings_once
from umform.errors import UmformError
from umform.processes.air_bending.goal import Goal, check_angle
from umform.processes.air_bending.spec import AirBending
from umform.spec import check_value, parameters
from umform.studies.deflection.press_brake import PressBrake

if TYPE_CHECKING:
    from umform.analysis.run import Result
    from umform.processes.air_bending.bend import AirBend
    from umform.processes.air_bending.brake import Brake
    from umform.processes.air_bending.measures import Measures


_GOAL, _TOOLS = "What to do", "Tools"


@bends.callback(invoke_without_command=True)
@alone
@given_by(Goal, PressBrake, AirBending, omit=("material", "punch_section", "die_section", "on_top"))
@with_metal
@with_studies()
def bend(
    context: typer.Context,
    given: Given,
    *,
    out: Annotated[str | None, out_option("tables, pictures, fields and report", "results/bend")] = None,
    table: Annotated[str | None, option("Bending table at strokes first:last:step, such as 4:6:0.5.", _GOAL)] = None,
    angles: Annotated[
        str | None, option("Bending table at angles first:last:step, such as 90:150:15, or 90,120.", _GOAL)
    ] = None,
    sequence: Annotated[
        Path | None, option("Several bends in one part: a TOML file, see docs/bending-operations.md.", _GOAL)
    ] = None,
    flat_only: Annotated[
        bool, option("With --sequence and outside dimensions: flat length and bend lines only, nothing is bent.", _GOAL)
    ] = False,
    budget: Annotated[bool, option("Error budget: repeat with refinements and show the changes.", _GOAL)] = False,
    punch: Annotated[str | None, option("Usual punch by name, such as 88/R0.8; see `umform tools`.", _TOOLS)] = None,
    die: Annotated[str | None, option("Usual die by name, such as V16/88; see `umform tools`.", _TOOLS)] = None,
    punch_dxf: Annotated[Path | None, option("DXF drawing of the punch, in place of its numbers.", _TOOLS)] = None,
    punch_layer: Annotated[str | None, option("Layer with its section; default: the whole drawing.", _TOOLS)] = None,
    die_dxf: Annotated[Path | None, option("DXF drawing of the die, in place of its numbers.", _TOOLS)] = None,
    die_layer: Annotated[str | None, option("Layer with its section; default: the whole drawing.", _TOOLS)] = None,
    length: Annotated[
        float | None,
        option("Bend length for the total force in kN and t; the model does not change.", SHEET, "--length", "-l"),
    ] = None,
    metal: SheetMetal,
    on_top: OnTop = None,
    processes: Annotated[int | None, option("Runs of the budget at a time.", SOLUTION)] = None,
    studies: Studies,
    find: Annotated[list[str] | None, Find] = None,
    quantity: Annotated[list[str] | None, Quantities] = None,
    deck: PrintDeck = False,
    everything: All = False,
    csv: Csv = "plain",
    overwrite: Overwrite = False,
    force: Force = False,
    timing: Timed = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Air-bend a sheet in a V-die, and unload it.

    Give the stroke, the angle after springback, or a table of strokes or angles. Each number is defined in
    docs/air-bending.md.
    """
    from umform.io.staging import staging
    from umform.processes.air_bending.bottoming import with_travel
    from umform.processes.air_bending.brake import FRAMES, Brake
    from umform.processes.air_bending.files import FILES, RESULTS, write_files
    from umform.processes.air_bending.search import angle_table, bending_table
    from umform.timing import Timing, timings

    print_warnings_once()
    angle, force_per_metre, travel, tolerance = (given.pop(name) for name in parameters(Goal))
    stroke, bottoming = given["stroke"], given["bottoming"]
    brake_frame = press_brake(given, length, sequence=sequence is not None, bottoming=bottoming)
    if not bottoming and sequence is None:
        check_goal(angle, stroke, table, angles, force_per_metre, travel)
    strokes = [] if table is None else strokes_of(table)
    if strokes and angle is None and stroke is None and not bottoming:
        stroke = strokes[-1]
    others = [] if angles is None else sorted(set(bend_table.values_of(angles, "--angles")), reverse=True)
    last_row = bool(others) and angle is None and stroke is None and not bottoming
    angle = others.pop() if last_row else angle
    check_value(Goal, "tolerance", tolerance)
    check_length(length)
    if processes is not None:
        from umform.pool import check_processes  # the import is slow

        check_processes(processes)
        check_budgeted(processes, budget)
    law, note = metal.law(given["thickness"])
    given = named_tools(context, given, punch, die)
    tools = drawn_tools(context, punch_dxf, punch_layer, die_dxf, die_layer)
    case = AirBending(**{**given, "stroke": stroke}, **tools, material=law, on_top=tuple(stacked(on_top or ())))
    if sequence is not None:
        goals = [angle, stroke, table, angles, force_per_metre, travel, bottoming, budget, deck, bool(find or quantity)]
        check_no_goal("--sequence", *goals)
        run_sequence(
            sequence,
            case,
            note,
            out,
            length,
            studies,
            tolerance=tolerance,
            overwrite=overwrite,
            everything=everything,
            flat_only=flat_only,
            force=force,
            timing=timing,
        )
        return
    check_flat_only(flat_only)
    if find or quantity:
        others_given = [table, angles, force_per_metre, budget, bool(studies.typed), studies.by]
        check_measured(angle, *others_given, deck, everything, timing)
    studies.check_wanted(searched=stroke is None and travel is None)
    goal = "angle" if angle is not None else "force" if force_per_metre is not None else ""
    held = {goal: "stroke"} if goal else {}
    if studies.typed:  # refuse what is wrong before the run
        some = replace(case, stroke=stroke or 0.5 * case.largest_stroke)
        studies.check(some, held)
    if bottoming:
        check_press(angle, table, angles, budget, stroke, force_per_metre, travel)
        case = case if travel is None else with_travel(case, travel)
        check_value(Goal, "force_per_metre", force_per_metre)
    if strokes:
        replace(case, stroke=strokes[-1])  # refuses a stroke beyond air bending before the first run
    for one in [*others, angle]:
        if one is not None:
            check_angle(case, one)
    if find or quantity or studies.want:
        refuse_implausible(case, force=force)
    if find or quantity:
        identify_case(case, find or (), None, quantity, out, "bend-identified", MOST, overwrite)
        return
    said: list[str] = []
    place = None if deck else results_folder(out, "bend", RESULTS, overwrite=overwrite, say=said.append)
    case = studies.compensated(case)
    if place is None:
        _print_deck(case, angle, force_per_metre, tolerance)
        return
    with timings() as spent:
        brake = Brake(case, frames=FRAMES)
    if not studies.want:
        refuse_implausible(case, force=force)
    for text in said:  # only of a run that starts
        say(text)
    with staging(place, FILES):
        with _what_was_reached(place) as rows:
            rows += bending_table(case, strokes, brake=brake) if strokes else []
            rows += angle_table(case, others, tolerance=tolerance, brake=brake) if others else []
            done = _bent(brake, case, angle, force_per_metre, tolerance)
            done = replace(done, table=(*rows, *[done.measures] * last_row), bend_length=length)
        more: list[Path] = []
        try:
            if budget:
                from umform.processes.air_bending.budget import error_budget

                done = replace(done, budget=error_budget(done, processes=processes))
            for one, written in studies.added_to(done, done.case, place, hold=held, goal=goal):
                done = one
                more += written
            done, along = deflected(done, brake_frame, place)
            more += along
            with printing(f"the files of the bend are in {place}"):
                show_outcome(done, note=note, everything=everything)
        except KeyboardInterrupt as stop:
            stop.add_note(f"  results so far are in {place}: all but the budget")
            raise
        finally:  # even if the table cannot be printed
            with done.result.timing.files:
                files = [*write_files(place, done, note), *more]
    say_written(place, files)
    if timing:
        show_timing(Timing.sum(spent), "Where the time went, but for the runs of the budget")
    studies.end()


def _print_deck(case: AirBending, angle: float | None, force_per_metre: float | None, tolerance: float) -> None:
    """Print a bend as a deck, with the stroke that its angle or its force needs."""
    from umform.processes.air_bending.bottoming import press_to_force
    from umform.processes.air_bending.search import find_stroke

    if force_per_metre is not None:
        case = press_to_force(case, force_per_metre, frames=1).case
    elif angle is not None:
        case = find_stroke(case, angle, tolerance=tolerance, frames=1).case
    print_deck(case)


def _bent(
    brake: Brake, case: AirBending, angle: float | None, force_per_metre: float | None, tolerance: float
) -> AirBend:
    """Bend to a force, to a stroke, or to an angle after springback."""
    from umform.processes.air_bending.bottoming import press_to_force
    from umform.processes.air_bending.case import air_bending
    from umform.processes.air_bending.search import find_stroke

    if force_per_metre is not None:
        return press_to_force(case, force_per_metre, brake=brake).bend
    if angle is not None:
        return find_stroke(case, angle, tolerance=tolerance, brake=brake).bend
    return air_bending(case, brake=brake)


@contextmanager
def _what_was_reached(out: Path) -> Iterator[list[Measures]]:
    """Write the history and the states of a run that ended early, and the finished rows of the table.

    Yields
    ------
    list of Measures
        Gets the rows of the table when all are finished.
    """
    rows: list[Measures] = []
    try:
        yield rows
    except (UmformError, KeyboardInterrupt) as stop:
        from umform.processes.air_bending.files import write_table

        reached: Result | None = getattr(stop, "result", None)
        rows = rows or getattr(stop, "rows", rows)
        files = [out / "table.csv"] if rows else []
        if rows:
            write_table(out / "table.csv", rows)
        if reached is not None and reached.frames:
            files += [reached.write(out / name) for name in ("history.csv", "bend.vtkhdf")]
        if files:
            stop.add_note(f"  results so far are in {out}: {', '.join(file.name for file in files)}")
        raise
