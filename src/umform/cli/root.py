"""The application: its options, its one place where errors become messages, and the console that tables go to."""

from __future__ import annotations

import logging
import sys
import traceback
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

import umform
from umform.errors import UmformError

INTERRUPTED = 130
_GIVEN_UP = """
umform: interrupted; the runs are given up, files of before stay as they were
  remedy: for long runs print the deck with --print-deck; umform run keeps what was reached, umform resume goes on"""


class Commands(TyperGroup):
    """The commands, with the one place where errors become messages and exit codes."""

    def invoke(self, ctx: Any) -> Any:
        """Run a command; print what goes wrong on standard error, and a traceback only with ``--debug``."""
        try:
            return super().invoke(ctx)
        except UmformError as error:
            _show_traceback(ctx)
            from umform.processes.bending.options import message

            typer.echo(f"umform: {message(error, _options(self, ctx.invoked_subcommand))}", err=True)
            raise typer.Exit(1) from error
        except KeyboardInterrupt as error:
            typer.echo(_GIVEN_UP, err=True)
            raise typer.Exit(INTERRUPTED) from error
        except BrokenPipeError:
            raise  # nobody reads on: `main` ends without a word
        except Exception as error:
            if type(error).__module__.split(".")[0] in ("typer", "click"):
                raise  # usage errors and regular exits
            _show_traceback(ctx)
            typer.echo(f"umform: an error that nobody expected: {type(error).__name__}: {error}", err=True)
            typer.echo("  remedy: report it, with the command and what it prints with --debug", err=True)
            raise typer.Exit(1) from error


def _options(group: TyperGroup, command: str | None) -> dict[str, str]:
    """Options of a command and of those below it, by the names that Python has for them."""
    chosen: Any = group.commands[command or ""]
    below = chosen.commands.values() if isinstance(chosen, TyperGroup) else [chosen]
    return {parameter.name: parameter.opts[0] for each in below for parameter in each.params}


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


def console() -> Any:
    """Where tables go: as wide as the terminal, wide enough for all columns elsewhere."""
    from rich.console import Console

    return Console(width=None if sys.stdout.isatty() else 120, highlight=False)
