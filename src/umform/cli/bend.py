"""``umform bend``: air bending of a sheet in a V-die."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from umform.cli import bend_correct, bend_table  # noqa: F401  (they add their commands)
from umform.cli.bend_commands import alone, bends
from umform.cli.bend_goals import BendGoal, check_flat_only, check_length, check_measured, check_no_goal
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
    check_idle,
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
from umform.processes.air_bending.goal import Goal
from umform.processes.air_bending.spec import AirBending
from umform.processes.early_end import say_kept, what_was_reached
from umform.studies.deflection.press_brake import PressBrake

if TYPE_CHECKING:
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
    table: Annotated[
        str | None, option("Bending table at strokes first:last:step, such as 4:6:0.5, or 4,5.5.", _GOAL)
    ] = None,
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
    from umform.processes.air_bending.brake import FRAMES, Brake
    from umform.processes.air_bending.files import FILES, RESULTS, write_files
    from umform.timing import Timing, timings

    print_warnings_once()
    brake_frame = press_brake(given, length, sequence=sequence is not None, bottoming=given["bottoming"])
    goal = BendGoal.of(given, table, angles, several=sequence is not None)
    check_length(length)
    check_idle(
        context,
        processes=(budget, "--budget"),
        width_elements=(given["width"] is not None, "--width"),
        tolerance=(
            goal.name == "angle" or bool(goal.angles) or sequence is not None,
            "--angle, --angles or --sequence",
        ),
    )
    if processes is not None:
        from umform.pool import check_processes  # the import is slow

        check_processes(processes)
    law, note = metal.law(given["thickness"])
    given = named_tools(context, given, punch, die)
    tools = drawn_tools(context, punch_dxf, punch_layer, die_dxf, die_layer)
    case = AirBending(**given, **tools, material=law, on_top=tuple(stacked(on_top or ())))
    if sequence is not None:
        check_no_goal(
            "--sequence", *goal.typed, goal.stroke, goal.travel, goal.bottoming, budget, deck, bool(find or quantity)
        )
        run_sequence(
            sequence,
            case,
            note,
            out,
            length,
            studies,
            tolerance=goal.tolerance,
            overwrite=overwrite,
            everything=everything,
            flat_only=flat_only,
            force=force,
            timing=timing,
        )
        return
    check_flat_only(flat_only)
    if find or quantity:
        check_measured(*goal.typed, budget, bool(studies.typed), studies.by, deck, everything, timing)
    studies.check_wanted(searched=goal.searched)
    if studies.typed:  # refuse what is wrong before the run
        studies.check(replace(case, stroke=goal.stroke or 0.5 * case.largest_stroke), goal.held)
    case = goal.checked(case, budget=budget)
    if find or quantity or studies.want:
        refuse_implausible(case, force=force)
    if find or quantity:
        identify_case(case, find or (), None, quantity, out, "bend-identified", MOST, overwrite)
        return
    said: list[str] = []
    place = None if deck else results_folder(out, "bend", RESULTS, overwrite=overwrite, say=said.append)
    case = studies.in_deck(case) if deck else studies.compensated(case)
    if place is None:
        print_deck(goal.with_stroke(case))
        return
    with timings() as spent:
        brake = Brake(case, frames=FRAMES)
    if not studies.want:
        refuse_implausible(case, force=force)
    for text in said:  # only of a run that starts
        say(text)
    with staging(place, FILES):
        with _with_rows(place) as rows:
            for some in goal.rows(brake):
                rows += some
            done = goal.bent(brake)
            done = replace(done, table=(*rows, *[done.measures] * goal.last_row), bend_length=length)
            done = replace(done, searched=done.searched or studies.wanted_by("stroke"))
        more: list[Path] = []
        try:
            if budget:
                from umform.processes.air_bending.budget import error_budget

                done = replace(done, budget=error_budget(done, processes=processes))
            for one, written in studies.added_to(done, done.case, place, hold=goal.held):
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


@contextmanager
def _with_rows(out: Path) -> Iterator[list[Measures]]:
    """Write the finished rows of the table of a run that ended early, with its history and its states.

    Yields
    ------
    list of Measures
        Gets the rows of the table when all are finished.
    """
    rows: list[Measures] = []
    try:
        with what_was_reached(out, "bend.vtkhdf"):
            yield rows
    except (UmformError, KeyboardInterrupt) as stop:
        from umform.processes.air_bending.files import write_table

        rows = rows or getattr(stop, "rows", rows)
        if rows:
            write_table(out / "table.csv", rows)
            say_kept(stop, [out / "table.csv"])
        raise
