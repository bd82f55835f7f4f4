"""Access: only a browser of this machine, on a page of this server, with the token of the link."""

from __future__ import annotations

import secrets
from collections.abc import Iterable
from urllib.parse import parse_qs

from starlette.datastructures import Headers, MutableHeaders
from starlette.requests import cookie_parser
from starlette.responses import JSONResponse, PlainTextResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

#: Largest request in bytes, and largest ones with a file, by their paths: a drawing, a part.
LONGEST_BODY, LONGEST_UPLOADS = 1_000_000, {"/api/tools": 8_100_000, "/api/parts": 26_700_000}
_OPEN = "/assets/"
_POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; "
    "connect-src 'self'; frame-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'self'"
)
_HEADERS = {
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cross-origin-resource-policy": "same-origin",
    "cross-origin-opener-policy": "same-origin",
}


class TooLong(Exception):
    """A request that is too long."""


class Guard:
    """Refuses requests from other origins or to other hosts, without the token, or too long; adds headers to answers.

    Parameters
    ----------
    app : ASGIApp
        The application behind it.
    token : str
        The secret of the link.
    port : int
        Port of the server.
    """

    def __init__(self, app: ASGIApp, token: str, port: int) -> None:
        self.app, self.token = app, token
        self.hosts = frozenset(f"{name}:{port}" for name in ("127.0.0.1", "localhost"))
        self.cookie = f"umform-bench-{port}"

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or pass it on."""
        if scope["type"] == "lifespan":
            await self.app(scope, receive, send)
            return
        if scope["type"] != "http":
            return
        headers = Headers(scope=scope)
        refusal = self._refusal(scope, headers)
        if refusal is not None:
            await refusal(scope, receive, _adding_headers(send, _HEADERS.items()))
            return
        more = dict(_HEADERS)
        if not scope["path"].startswith("/files/"):
            more["content-security-policy"] = _POLICY
        if not scope["path"].startswith(_OPEN):
            more["cache-control"] = "no-store"
        if self._in_link(scope):
            more["set-cookie"] = f"{self.cookie}={self.token}; Path=/; HttpOnly; SameSite=Strict"
        began = False

        async def watched(message: Message) -> None:
            nonlocal began
            began = began or message["type"] == "http.response.start"
            await send(message)

        try:
            await self.app(scope, _limited(receive, _longest(scope)), _adding_headers(watched, more.items()))
        except TooLong:
            if not began:
                await _too_long(_longest(scope))(scope, receive, _adding_headers(send, _HEADERS.items()))

    def _refusal(self, scope: Scope, headers: Headers) -> Response | None:
        """The answer to a refused request; None for others."""
        if headers.get("host", "") not in self.hosts:
            return PlainTextResponse("unknown host name", 421)
        origin = headers.get("origin")
        if origin is not None and origin.removeprefix("http://") not in self.hosts:
            return PlainTextResponse("request from another origin", 403)
        if headers.get("sec-fetch-site", "none") not in ("none", "same-origin") and scope["path"] != "/":
            return PlainTextResponse("request from another origin", 403)
        length = headers.get("content-length", "0")
        if not (length.isdecimal() and len(length) < 12 and int(length) <= _longest(scope)):
            return _too_long(_longest(scope))
        if scope["path"].startswith(_OPEN) or self._in_link(scope) or self._in_cookie(headers):
            return None
        return PlainTextResponse("the token is missing or wrong: open the link that `umform bench` printed", 401)

    def _in_link(self, scope: Scope) -> bool:
        given = parse_qs(scope["query_string"].decode("latin-1")[:500]).get("token", [""])[0] if _is_page(scope) else ""
        return secrets.compare_digest(given.encode(), self.token.encode())

    def _in_cookie(self, headers: Headers) -> bool:
        # The cookies of other servers of this host come too, in any form.
        given = cookie_parser(headers.get("cookie", "")[:8000]).get(self.cookie, "")
        return secrets.compare_digest(given.encode(), self.token.encode())


def _is_page(scope: Scope) -> bool:
    return bool(scope["path"] == "/" and scope["method"] == "GET")


def _longest(scope: Scope) -> int:
    return LONGEST_UPLOADS.get(scope["path"], LONGEST_BODY)


def _too_long(most: int) -> Response:
    return JSONResponse({"what": f"a request has at most {most} bytes"}, 413)


def _limited(receive: Receive, most: int) -> Receive:
    """Limit the length of a body, whatever its header says."""
    taken = 0

    async def limited() -> Message:
        nonlocal taken
        message = await receive()
        taken += len(message.get("body", b""))
        if taken > most:
            raise TooLong
        return message

    return limited


def _adding_headers(send: Send, headers: Iterable[tuple[str, str]]) -> Send:
    """Send an answer with more headers; its own are kept."""
    more = list(headers)

    async def adding(message: Message) -> None:
        if message["type"] == "http.response.start":
            own = MutableHeaders(scope=message)
            for name, value in more:
                own.setdefault(name, value)
        await send(message)

    return adding
