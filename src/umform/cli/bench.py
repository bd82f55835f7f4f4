"""``umform bench``: bending on a page in the browser."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from umform.cli.root import Debug, Verbose, app


@app.command()
def bench(
    folder: Annotated[Path, typer.Option(metavar="FOLDER", help="Folder of jobs, results and index.")] = Path(
        "results/bench"
    ),
    port: Annotated[int, typer.Option(min=0, max=65535, help="Port on 127.0.0.1; 0: any free port.")] = 8765,
    processes: Annotated[int, typer.Option(min=1, max=64, help="Jobs at a time.")] = 1,
    disk: Annotated[float, typer.Option(min=0.001, max=1e6, help="GB that the folder may have.")] = 10.0,
    browser: Annotated[bool, typer.Option("--browser/--no-browser", help="Open the page in the browser.")] = True,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Open a local page in the browser: bends, parts of several bends, hems, drawn parts, flat patterns,
    bend tables and decks.

    The server listens on 127.0.0.1 only, and requires the token in the link. Each job runs in a separate process; jobs
    are kept in the folder and continue when the bench is restarted. Needs `pip install "umform[bench]"`.
    """
    try:
        from umform.bench.server import serve
    except ModuleNotFoundError as error:
        missing = (error.name or "").partition(".")[0]
        if missing not in ("starlette", "uvicorn"):
            raise
        from umform.errors import UmformError

        raise UmformError(
            f"umform bench needs {missing}",
            where="umform bench",
            cause=str(error),
            remedy='pip install "umform[bench]"',
        ) from error

    def ready(link: str, door: Path) -> None:
        typer.echo(f"The bench is open at {link}")
        typer.echo(f"Jobs are in {folder}; Ctrl-C ends the bench, jobs go on when it is started again.")
        if browser:
            import webbrowser

            webbrowser.open(door.resolve().as_uri())  # not the link: others can read the arguments of a program

    try:
        serve(folder, port, processes, 1e9 * disk, ready)
    except KeyboardInterrupt:
        typer.echo("The bench has ended.")
