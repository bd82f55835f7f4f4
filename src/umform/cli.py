"""The command line: ``umform demo free-bending``, ``umform elements``; what fails says so in a few lines."""

from __future__ import annotations

import logging
import sys
import traceback
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer.core import TyperGroup

import umform
from umform.errors import UmformError
from umform.processes.bending.parameters import RECONSTRUCTION, FreeBending

if TYPE_CHECKING:
    from umform.elements import Element
    from umform.processes.bending.showcase import Outcome

INTERRUPTED = 130


class Commands(TyperGroup):
    """The commands, with the one place where errors become messages and exit codes."""

    def invoke(self, ctx: Any) -> Any:
        """Run a command; print what goes wrong on standard error, and a traceback only with ``--debug``."""
        try:
            return super().invoke(ctx)
        except UmformError as error:
            _show_traceback(ctx)
            from umform.processes.bending.options import message

            typer.echo(f"umform: {message(error)}", err=True)
            raise typer.Exit(1) from error
        except KeyboardInterrupt as error:
            typer.echo("\numform: interrupted; the runs are given up, files of before stay as they were", err=True)
            raise typer.Exit(INTERRUPTED) from error
        except Exception as error:
            if type(error).__module__.split(".")[0] in ("typer", "click"):
                raise  # usage errors and regular exits
            _show_traceback(ctx)
            typer.echo(f"umform: an error that nobody expected: {type(error).__name__}: {error}", err=True)
            typer.echo("  remedy: report it, with the command and what it prints with --debug", err=True)
            raise typer.Exit(1) from error


def _show_traceback(ctx: Any) -> None:
    if ctx.meta.get("debug"):
        typer.echo(traceback.format_exc(), err=True)


app = typer.Typer(
    cls=Commands,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode="markdown",
    context_settings={"help_option_names": ["-h", "--help"]},
    help=umform.__doc__,
)
demos = typer.Typer(no_args_is_help=True, rich_markup_mode="markdown", help="Run an example and show what comes out.")
app.add_typer(demos, name="demo")


def _print_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"umform {umform.__version__}")
        raise typer.Exit


def _log(count: int) -> int:
    from umform.log import log_to_stderr

    if count:
        log_to_stderr(logging.INFO if count == 1 else logging.DEBUG)
    return count


def _remember_debug(ctx: typer.Context, wanted: bool) -> bool:
    ctx.meta["debug"] = wanted or ctx.meta.get("debug", False)
    return wanted


Verbose = Annotated[
    int, typer.Option("--verbose", "-v", count=True, callback=_log, help="Log each increment; -vv each iteration.")
]
Debug = Annotated[bool, typer.Option("--debug", callback=_remember_debug, help="Show the traceback of an error.")]
Version = Annotated[
    bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Show the version and exit.")
]


@app.callback()
def _root(version: Version = False, verbose: Verbose = 0, debug: Debug = False) -> None:
    pass


_root.__doc__ = umform.__doc__


@app.command()
def elements() -> None:
    """Show the catalogue of elements."""
    from rich import box
    from rich.table import Table

    from umform.elements import CATALOGUE

    table = Table("name", "nodes", "assumed strains", "enhanced modes", "source", box=box.SIMPLE_HEAD)
    for name, make in CATALOGUE.items():
        table.add_row(name, *_described(make()))
    _console().print(table)


def _described(element: Element) -> tuple[str, str, str, str]:
    """Nodes, tied components, number of modes a component, source."""
    tied = " ".join(dict.fromkeys(f"E{row.component}" for row in element.tying)) or "none"
    counts: dict[str, int] = {}
    for mode in element.modes:
        component = "+".join(dict.fromkeys(f"E{term.component}" for term in mode))
        counts[component] = counts.get(component, 0) + 1
    enhanced = ", ".join(f"{count} {component}" for component, count in counts.items()) or "none"
    return str(element.nodes), tied, enhanced, element.citation


def _console() -> Any:
    """Where tables go: as wide as the terminal, wide enough for all columns elsewhere."""
    from rich.console import Console

    return Console(width=None if sys.stdout.isatty() else 120, highlight=False)


def _option(help_text: str, panel: str, *names: str) -> Any:
    return typer.Option(*names, help=help_text, rich_help_panel=panel)


_RUNS, _STRIP, _MATERIAL, _SOLUTION = "Which runs", "Strip and tool (mm)", "Material (MPa)", "Solution"
Default = FreeBending


@demos.command("free-bending", epilog=RECONSTRUCTION)
def free_bending(
    out: Annotated[
        str, typer.Option(metavar="FOLDER", help="Folder for tables, pictures, fields and report.")
    ] = "results/free-bending",
    mesh: Annotated[list[str] | None, _option("Elements along and across, as 24x1; may be repeated.", _RUNS)] = None,
    element: Annotated[list[str] | None, _option("Element of the catalogue; may be repeated.", _RUNS)] = None,
    contact: Annotated[
        list[str] | None, _option("Contact points per direction and facet, or nodes; may be repeated.", _RUNS)
    ] = None,
    thickness_points: Annotated[int | None, _option("Points through the thickness.", _RUNS)] = None,
    thickness_rule: Annotated[str | None, _option("gauss, lobatto or split.", _RUNS)] = None,
    thickness_order: Annotated[int | None, _option("Order of the thickness strain, 1 to 4.", _RUNS)] = None,
    tie_E33: Annotated[bool | None, _option("Tie the thickness strain.", _RUNS, "--tie-e33/--no-tie-e33")] = None,
    length: Annotated[float, _option("Length of the half strip.", _STRIP)] = Default.length,
    width: Annotated[float, _option("Width of the strip.", _STRIP)] = Default.width,
    thickness: Annotated[float, _option("Thickness of the strip.", _STRIP)] = Default.thickness,
    radius: Annotated[float, _option("Radius of the cylinder.", _STRIP)] = Default.radius,
    tool_x: Annotated[float, _option("x of its axis.", _STRIP)] = Default.tool_x,
    tool_z: Annotated[float | None, _option("z of its axis; default: it touches the strip.", _STRIP)] = None,
    kappa: Annotated[float, _option("Bulk modulus.", _MATERIAL)] = Default.kappa,
    mu: Annotated[float, _option("Shear modulus.", _MATERIAL)] = Default.mu,
    yield_stress: Annotated[float, _option("Yield stress.", _MATERIAL)] = Default.yield_stress,
    hardening: Annotated[float, _option("Linear hardening modulus.", _MATERIAL)] = Default.hardening,
    penalty: Annotated[float, _option("Contact pressure per penetration.", _SOLUTION)] = Default.penalty,
    stroke: Annotated[float, _option("Largest displacement.", _SOLUTION)] = Default.stroke,
    steps: Annotated[int, _option("Increments up to the stroke.", _SOLUTION)] = Default.steps,
    unload: Annotated[bool, _option("Release to zero force.", _SOLUTION)] = Default.unload,
    solver: Annotated[str, _option("auto, banded, pardiso or superlu.", _SOLUTION)] = Default.solver,
    line_search: Annotated[
        bool, _option("Shorten Newton's increments that go too far.", _SOLUTION, "--line-search/--no-line-search")
    ] = Default.line_search,
    processes: Annotated[int | None, _option("Runs at a time; default: the processors.", _SOLUTION)] = None,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Bend a strip over a cylinder and release it.

    Without options, the 14 runs of the example: 8-node elements on 24x1 and 48x2, 18-node elements on 12x1 and 24x2,
    with contact at the nodes and at two numbers of Gauss points, and a cubic thickness strain on the fine meshes.
    What is said of mesh, element and contact selects runs; a thickness option replaces the cubic ones; all other
    options hold for all runs.
    """
    from umform.processes.bending.options import read_contact, read_mesh
    from umform.processes.bending.showcase import Selection, demo

    selection = Selection(
        meshes=tuple(read_mesh(text) for text in mesh or ()),
        elements=tuple(element or ()),
        contacts=tuple(read_contact(text) for text in contact or ()),
    )
    through = {
        "thickness_points": thickness_points,
        "thickness_rule": thickness_rule,
        "thickness_order": thickness_order,
        "tie_E33": tie_E33,
    }
    given: dict[str, Any] = {name: value for name, value in through.items() if value is not None}
    base = FreeBending(
        length=length,
        width=width,
        thickness=thickness,
        radius=radius,
        tool_x=tool_x,
        tool_z=tool_z,
        kappa=kappa,
        mu=mu,
        yield_stress=yield_stress,
        hardening=hardening,
        penalty=penalty,
        stroke=stroke,
        steps=steps,
        unload=unload,
        solver=solver,
        line_search=line_search,
        **given,
    )
    _show(demo(out, selection.runs(base, sharp=not given), processes=processes), out)


def _show(outcome: Outcome, out: str) -> None:
    """Print the table, where the files are, and what went wrong."""
    from rich import box
    from rich.table import Table

    from umform.processes.bending.options import as_typed
    from umform.processes.bending.table import header, rows
    from umform.report.repeats import counted

    table = Table(title="Free bending of a strip over a cylinder", box=box.SIMPLE_HEAD)
    for number, name in enumerate(header(outcome.runs)):
        table.add_column(name, justify="left" if number == 0 else "right", no_wrap=number > 0)
    for row in rows(outcome.runs):
        table.add_row(*row)
    console = _console()
    console.print(table)
    console.print(RECONSTRUCTION)
    console.print(f"Written to {out}: {', '.join(file.name for file in outcome.files)}", soft_wrap=True)
    for run in outcome.runs:
        for warning in counted(run.warnings):
            typer.echo(f"umform: {run.case.name}: {warning}", err=True)
    failed = [run for run in outcome.runs if run.failure]
    for run in failed:
        typer.echo(f"umform: {run.case.name}: {as_typed(run.failure)}", err=True)
    if failed:
        typer.echo(f"  what was reached before is in {out}", err=True)
        raise typer.Exit(1)


def main() -> None:
    """Start the command line."""
    app()


if __name__ == "__main__":
    main()
