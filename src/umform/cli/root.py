"""The application: its options, the conversion of errors to messages, and the console for tables."""

from __future__ import annotations

import logging
import os
import sys
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

import umform
from umform.cli import INTERRUPTED
from umform.cli.option_names import message, options_of
from umform.cli.usage import is_usage_error, usage_problem
from umform.errors import FileProblem, InvalidValue, UmformError, own_code
from umform.io.atomic import write_problem


class Commands(TyperGroup):
    """The commands, with the conversion of errors to messages and exit codes."""

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """A command of umform, or of another package."""
        from umform.cli.plugins import check_installed, plugin

        found = super().get_command(ctx, cmd_name) or plugin(cmd_name)
        if found is None:
            check_installed(cmd_name)
        return found

    def list_commands(self, ctx: Any) -> list[str]:
        """Names of all commands."""
        from umform.cli.plugins import plugins

        return list(dict.fromkeys([*super().list_commands(ctx), *plugins()]))

    def format_help(self, ctx: Any, formatter: Any) -> None:
        """Show the help, which lists the commands of other packages without loading them."""
        from umform.cli.importing import text_of
        from umform.cli.plugins import command_of, plugins

        own = self.commands
        others = {
            name: command_of(name, lambda: None, help=text_of(point.module, point.attr))
            for name, point in plugins().items()
        }
        self.commands = {**others, **own}
        try:
            super().format_help(ctx, formatter)
        finally:
            self.commands = own

    def make_context(self, *args: Any, **kwargs: Any) -> Any:
        """Read the options before the command."""
        try:
            return super().make_context(*args, **kwargs)
        except Exception as error:
            if not is_usage_error(error):
                raise
            say_of(error, str(usage_problem(error)))
            raise typer.Exit(2) from error

    def invoke(self, ctx: Any) -> Any:
        """Run a command; print errors on standard error, and a traceback only with ``--debug``."""
        try:
            with printing():
                return super().invoke(ctx)
        except UmformError as error:
            _show_traceback(ctx)
            command = ctx.meta.get("command") or self.get_command(ctx, ctx.invoked_subcommand or "")
            say_of(error, message(error, options_of(command) if command else {}))
            raise typer.Exit(1) from error
        except KeyboardInterrupt as error:
            say_of(error, "interrupted; what was not finished is given up")
            raise typer.Exit(INTERRUPTED) from error
        except BrokenPipeError:
            raise  # the reader stopped: `main` ends silently
        except OSError as error:
            _show_traceback(ctx)
            say_of(
                error, str(write_problem(Path(error.filename or "a file"), error, "a file cannot be read or written"))
            )
            raise typer.Exit(1) from error
        except Exception as error:
            if is_usage_error(error):
                say_of(error, str(usage_problem(error)))
                raise typer.Exit(2) from error
            if type(error).__module__.split(".")[0] in ("typer", "click"):
                raise  # regular exits
            _show_traceback(ctx)
            what, place = f"{type(error).__name__}: {error}", own_code(error)
            if place:
                remedy = "correct it there; --debug shows the traceback"
                say_of(error, f"an error in code of yours: {what}\n  where:  {place}\n  remedy: {remedy}")
            else:
                say_of(error, f"an error that nobody expected: {what}")
                typer.echo("  remedy: report it, with the command and what it prints with --debug", err=True)
            raise typer.Exit(1) from error


def say(text: object) -> None:
    """Print a remark on standard error."""
    typer.echo(f"umform: {text}", err=True)


def say_of(error: BaseException, text: str = "") -> None:
    """Print an error on standard error, with its notes: available results, and how to continue."""
    typer.echo("\n".join([f"umform: {text or error}", *getattr(error, "__notes__", ())]), err=True)


@contextmanager
def printing(kept: str = "") -> Iterator[None]:
    """Raise a single error if standard output is closed, or its disk is full.

    Parameters
    ----------
    kept : str
        What is available nevertheless.

    Raises
    ------
    FileProblem
    """
    try:
        yield
        sys.stdout.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        if isinstance(error, UmformError) or error.filename is not None or not _output_fails():
            raise
        raise FileProblem(
            "standard output takes no text",
            where="standard output",
            cause=(error.strerror or str(error)).lower(),
            remedy=f"lead it to a terminal, a file or /dev/null{'; ' if kept else ''}{kept}",
        ) from error


def _output_fails() -> bool:
    """Whether standard output cannot be written after a failure; it is then redirected to the null device."""
    try:
        sys.stdout.write("\n")
        sys.stdout.flush()
    except OSError:
        sys.stdout = Path(os.devnull).open("w", encoding="utf-8")  # noqa: SIM115  (to the end)
        _forget(sys.__stdout__)
        return True
    return False


def _forget(stream: Any) -> None:
    """Redirect the buffered data of a stream to the null device, so that Python reports no broken pipe at exit."""
    if stream is not None and not stream.closed:
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


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


def _write_csv_as(ctx: typer.Context, name: str) -> str:
    """Write the CSV files of a command in a style."""
    from umform.io.tables import csv_style  # it loads NumPy

    if not ctx.resilient_parsing and name != "plain":
        try:
            ctx.with_resource(csv_style(name))
        except InvalidValue as error:
            error.where = "--csv, UMFORM_CSV"
            raise
    return name


def _remember_debug(ctx: typer.Context, wanted: bool) -> bool:
    ctx.meta["command"] = ctx.command  # the innermost one is read last: messages name its options
    ctx.meta["debug"] = wanted or ctx.meta.get("debug", False)
    return wanted


Verbose = Annotated[
    int, typer.Option("--verbose", "-v", count=True, callback=_log, help="Log each increment; -vv each iteration.")
]
Debug = Annotated[bool, typer.Option("--debug", callback=_remember_debug, help="Show the traceback of an error.")]
Overwrite = Annotated[bool, typer.Option("--overwrite", help="Overwrite results of another run.")]
Csv = Annotated[
    str,
    typer.Option(
        "--csv",
        envvar="UMFORM_CSV",
        callback=_write_csv_as,
        help="CSV files: plain, or german with semicolons and decimal commas.",
    ),
]
Version = Annotated[
    bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Show the version and exit.")
]


@app.callback()
def _root(version: Version = False, verbose: Verbose = 0, debug: Debug = False) -> None:
    pass


_root.__doc__ = umform.__doc__


def console() -> Any:
    """Console for tables: the width of the terminal, or wide enough for all columns elsewhere."""
    from rich.console import Console

    return Console(width=None if sys.stdout.isatty() else 120, highlight=False)
