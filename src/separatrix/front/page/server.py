"""The server of the local page, on this machine only: its routes, and the guard that refuses strangers."""

from __future__ import annotations

import contextlib
import hmac
import os
import secrets
import socket
from collections.abc import AsyncIterator
from http import HTTPStatus
from pathlib import Path
from typing import Any

import uvicorn
from fastapi import FastAPI, Request
from fastapi.responses import PlainTextResponse, RedirectResponse, Response
from fastapi.staticfiles import StaticFiles
from starlette.datastructures import MutableHeaders
from starlette.exceptions import HTTPException
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from separatrix import present
from separatrix.front.page import answers, editing
from separatrix.front.page.folder import Folder, Page
from separatrix.front.page.worker import Jobs
from separatrix.ground.errors import InputError, SeparatrixError
from separatrix.ground.units import printable

HOST = "127.0.0.1"
MOST_CONNECTIONS, IDLE = 200, 10
"""Connections at once; time after which an idle one is closed [s]."""

STATIC = {
    "static": Path(__file__).with_name("static"),
    "blocks": Path(present.__file__).with_name("static"),  # how a page of blocks looks, in a report as here
}
"""Folders of style and script, by their addresses."""

MOST_BYTES = 64 * 1024**2
"""Size of an upload."""

TOO_LARGE = f"The upload is larger than {MOST_BYTES // 1024**2} MB."

POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; "
    "connect-src 'self'; font-src 'self'; form-action 'self'; base-uri 'none'; frame-ancestors 'none'"
)
"""Only own files; no inline script. Styles in a figure cannot run anything."""

HEADERS = {
    "content-security-policy": POLICY,
    "x-content-type-options": "nosniff",
    "x-frame-options": "DENY",
    "referrer-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "cross-origin-opener-policy": "same-origin",
}
"""On every response."""


def application(root: Path) -> FastAPI:
    """Return the page of a folder, unguarded."""
    page = Page(folder=Folder(root=root), jobs=Jobs(root))

    @contextlib.asynccontextmanager
    async def life(_: FastAPI) -> AsyncIterator[None]:
        yield
        page.jobs.close()

    app = FastAPI(lifespan=life, docs_url=None, redoc_url=None, openapi_url=None)
    app.state.root, app.state.page = root, page
    for routes in (editing.routes, answers.routes, answers.routes_of_logs):
        app.include_router(routes(page))
    for place, folder in STATIC.items():
        app.mount(f"/{place}", StaticFiles(directory=folder))

    @app.exception_handler(SeparatrixError)
    @app.exception_handler(HTTPException)
    def refused(request: Request, error: SeparatrixError | HTTPException) -> Response:
        text, status = str(error), int(HTTPStatus.UNPROCESSABLE_ENTITY)
        if isinstance(error, HTTPException):
            place = f"{request.method} {printable(request.url.path, 100)}"
            text, status = f"{place} is not an address of this page.", error.status_code
        template = "refusal.html" if "hx-request" in request.headers else "refused.html"
        return page.html(template, status, faults=text.split("\n"))

    return app


class TooLarge(Exception):  # noqa: N818 - a reply, not a fault
    """The body of a request is larger than any upload may be."""


class Guard:
    """Answer only requests that a person at this machine made from the page itself.

    Every request must name this host, not come from another site, and bring the token: first in the link
    that `separatrix app` prints, then in a cookie. Bodies are bounded while they arrive.
    """

    def __init__(self, application: ASGIApp, *, token: str, port: int) -> None:
        self.application, self.token = application, token
        self.hosts = (f"127.0.0.1:{port}", f"localhost:{port}")
        self.cookie = f"separatrix-{port}"

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer one request."""
        if scope["type"] == "lifespan":
            await self.application(scope, receive, send)
        elif scope["type"] != "http":
            await send({"type": "websocket.close", "code": 1008})
        elif (reply := self._reply(Request(scope))) is not None:
            await reply(scope, receive, send)
        else:
            await self._pass(scope, receive, send)

    def _reply(self, asked: Request) -> Response | None:
        """Return why a request is refused, or the way in; None if the page answers it."""
        headers, host = asked.headers, asked.headers.get("host", "")
        if host not in self.hosts:
            words = "This server answers to 127.0.0.1 and localhost only."
            return _refusal(HTTPStatus.MISDIRECTED_REQUEST, words)
        origin, site = headers.get("origin"), headers.get("sec-fetch-site")
        is_own = origin in (None, f"http://{host}") and site in (None, "same-origin", "none")
        if not is_own or (asked.method not in ("GET", "HEAD") and origin is None):
            return _refusal(HTTPStatus.FORBIDDEN, "Requests of other sites are refused.")
        length = headers.get("content-length", "0")
        if not length.isdigit() or int(length) > MOST_BYTES:
            return _refusal(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, TOO_LARGE)
        if asked.scope["path"] == "/" and self._is_token(asked.query_params.get("token", "")):
            cookie = f"{self.cookie}={self.token}; Path=/; HttpOnly; SameSite=Strict"
            return RedirectResponse("/", HTTPStatus.SEE_OTHER, HEADERS | {"set-cookie": cookie})
        if not self._is_token(asked.cookies.get(self.cookie, "")):
            words = "Open the link that `separatrix app` printed in the terminal: it contains a token."
            return _refusal(HTTPStatus.FORBIDDEN, words)
        return None

    def _is_token(self, given: str) -> bool:
        return hmac.compare_digest(given.encode(), self.token.encode())

    async def _pass(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Let the page answer, with our headers; a body that grows beyond the bound is cut off."""
        taken, begun, is_refused = 0, False, False

        async def bounded() -> Message:
            nonlocal taken, is_refused
            message = await receive()
            taken += len(message.get("body", b""))
            if taken > MOST_BYTES:
                if not begun:
                    await _refusal(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, TOO_LARGE)(scope, receive, send)
                is_refused = True
                raise TooLarge
            return message

        async def with_headers(message: Message) -> None:
            nonlocal begun
            if is_refused:  # what the page makes of the end of the body
                return
            if message["type"] == "http.response.start":
                begun = True
                MutableHeaders(scope=message).update(HEADERS)
            await send(message)

        with contextlib.suppress(TooLarge):
            await self.application(scope, bounded, with_headers)


def _refusal(status: HTTPStatus, words: str) -> Response:
    return PlainTextResponse(words, status, HEADERS | {"connection": "close"})


def listening(port: int) -> socket.socket:
    """Return a socket that listens on this machine only; port 0 takes any free one."""
    try:
        return socket.create_server((HOST, port), backlog=128)
    except OSError as error:
        got, cure = f"{port} ({os.strerror(error.errno or 0)})", "Leave it out for any that is free."
        raise InputError("--port", "cannot be used", got, cure) from None


class Server(uvicorn.Server):
    """The page of a folder behind its guard; `link` opens it."""

    def __init__(self, root: Path, *, port: int = 0) -> None:
        self.socket, token = listening(port), secrets.token_urlsafe(24)
        port = self.socket.getsockname()[1]
        self.link = f"http://{HOST}:{port}/?token={token}"
        guarded = Guard(application(root), token=token, port=port)
        bounds: Any = {"limit_concurrency": MOST_CONNECTIONS, "timeout_keep_alive": IDLE}
        bounds |= {"timeout_graceful_shutdown": 3, "lifespan": "on"}
        quiet: Any = {"log_level": "warning", "access_log": False, "server_header": False}
        super().__init__(uvicorn.Config(guarded, **bounds, **quiet))

    def serve_until_ended(self) -> None:
        """Serve until Ctrl-C."""
        self.run(sockets=[self.socket])
