"""The server of the bench: page, assets and API, on 127.0.0.1 only."""

from __future__ import annotations

import os
import re
import secrets
import socket
import threading
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager, contextmanager, suppress
from importlib.resources import files
from pathlib import Path

import uvicorn
from starlette.applications import Starlette
from starlette.middleware import Middleware
from starlette.requests import Request
from starlette.responses import PlainTextResponse, Response
from starlette.routing import Route

from umform.bench.api import routes
from umform.bench.guard import Guard
from umform.bench.jobs import Queue
from umform.bench.library import library
from umform.errors import FileProblem, InvalidValue
from umform.io.atomic import write_problem
from umform.io.locks import try_lock

HOST = "127.0.0.1"
_KINDS = {
    ".js": "text/javascript",
    ".css": "text/css",
    ".json": "application/json",
    ".svg": "image/svg+xml",
    ".html": "text/html",
}
#: Limit of open files: each request needs one.
_MOST_FILES = 8192
#: Leads a browser to the page: its own address, which other users of the machine can see, has no token.
_REDIRECT = '<!DOCTYPE html><title>umform bench</title><meta http-equiv="refresh" content="0; url={link}">'
_TOKEN = re.compile(r"[A-Za-z0-9_-]{20,}")


def application(queue: Queue, token: str, port: int) -> Starlette:
    """The application.

    Parameters
    ----------
    queue : Queue
        The queue; it starts and ends with the application.
    token : str
        The secret of the link.
    port : int
        Port that requests must name.
    """

    @asynccontextmanager
    async def lifespan(app: Starlette) -> AsyncIterator[None]:
        queue.start()
        threading.Thread(target=library, name="umform-bench-library", daemon=True).start()  # the first page needs it
        try:
            yield
        finally:
            queue.close()

    assets = {path.name: path.read_bytes() for path in files("umform.bench").joinpath("page").iterdir()}

    def asset(name: str) -> Response:
        ending = Path(name).suffix
        if name not in assets or ending not in _KINDS:
            return PlainTextResponse("there is no such file", 404)
        return Response(assets[name], media_type=_KINDS[ending], headers={"cache-control": "no-cache"})

    pages = [
        Route("/", lambda request: asset("index.html")),
        Route("/favicon.ico", lambda request: asset("icon.svg")),
        Route("/assets/{name}", lambda request: asset(request.path_params["name"])),
    ]
    return Starlette(
        routes=[*pages, *routes(queue)],
        lifespan=lifespan,
        middleware=[Middleware(Guard, token=token, port=port)],
        exception_handlers={Exception: _unexpected},
    )


def _unexpected(request: Request, error: Exception) -> Response:
    return PlainTextResponse("unexpected error: see the terminal of the server", 500)


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Lock the folder of a bench: one server at a time.

    Raises
    ------
    FileProblem
        If another server has locked it, or it cannot be created.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        lock = (folder / "bench.lock").open("w")
    except OSError as error:
        raise write_problem(folder, error, "the folder of the bench cannot be created") from error
    with lock:
        if not try_lock(lock):
            raise FileProblem(
                "another bench uses this folder",
                where=str(folder),
                cause="it runs in another terminal",
                remedy="open the link that it printed, or choose another folder with --folder",
            )
        yield


def token_of(folder: Path) -> str:
    """The token of a folder; it is kept for open pages after a restart, unless others can read it."""
    path = folder / "token"
    with suppress(OSError, ValueError):
        known = path.read_text(encoding="ascii").strip()
        if _TOKEN.fullmatch(known) and (os.name != "posix" or path.stat().st_mode & 0o077 == 0):
            return known
    token = secrets.token_urlsafe(24)
    _write_private(path, token)
    return token


def _write_private(path: Path, content: str) -> None:
    """Write a file that others cannot read."""
    path.unlink(missing_ok=True)
    with os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w") as text:
        text.write(content)


def listening(port: int) -> socket.socket:
    """A socket on 127.0.0.1.

    Raises
    ------
    InvalidValue
        If the port is taken.
    """
    listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    if os.name == "posix":  # elsewhere it lets two servers have one port
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind((HOST, port))
        listener.listen()  # at once, so that no other server takes the port
    except OSError as error:
        listener.close()
        raise InvalidValue(
            "the port cannot be used",
            where="--port",
            value=port,
            cause=error.strerror or "taken",
            remedy="--port 0 takes any free port",
        ) from error
    return listener


def serve(folder: Path, port: int, at_once: int, disk: float, opened: Callable[[str, Path], None]) -> None:
    """Serve the bench until Ctrl-C.

    Parameters
    ----------
    folder : Path
        Where jobs and index are.
    port : int
        0: any free port.
    at_once : int
        Jobs at a time.
    disk : float
        Bytes that the folder may have.
    opened : callable
        Called with the link, and with a page that leads there and that only its owner can read.
    """
    _raise_file_limit()
    with locked(folder), listening(port) as listener:
        own = int(listener.getsockname()[1])
        token = token_of(folder)
        app = application(Queue(folder, at_once, disk), token, own)
        config = uvicorn.Config(
            app, log_level="warning", access_log=False, ws="none", server_header=False, timeout_graceful_shutdown=2
        )
        link = f"http://{HOST}:{own}/?token={token}"
        redirect = folder / "open.html"
        try:
            _write_private(redirect, _REDIRECT.format(link=link))
            opened(link, redirect)
            uvicorn.Server(config).run(sockets=[listener])
        finally:
            redirect.unlink(missing_ok=True)


def _raise_file_limit() -> None:
    """Raise the limit of open files for many requests at once; Windows has none."""
    try:
        import resource
    except ModuleNotFoundError:
        return
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    with suppress(ValueError, OSError):
        resource.setrlimit(resource.RLIMIT_NOFILE, (max(soft, min(hard, _MOST_FILES)), hard))
