"""The server of the local page, on this machine only: its routes, and the guard that refuses strangers."""

from __future__ import annotations

import contextlib
import hmac
import secrets
import socket
from collections.abc import AsyncIterator, Awaitable, Callable, MutableMapping
from http import HTTPStatus
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs

import uvicorn
from fastapi import FastAPI, Request
from fastapi.responses import Response
from fastapi.staticfiles import StaticFiles
from starlette.exceptions import HTTPException

from separatrix import present
from separatrix.front.page import answers, editing, logs
from separatrix.front.page.folder import Folder, Page
from separatrix.front.page.worker import Jobs
from separatrix.ground.errors import InputError, SeparatrixError
from separatrix.ground.units import printable

HOST = "127.0.0.1"
MOST_CONNECTIONS = 200
IDLE = 10
"""Time after which an idle connection is closed [s]."""

STATIC = {
    "static": Path(__file__).with_name("static"),
    "blocks": Path(present.__file__).with_name("static"),  # how a page of blocks looks, in a report as here
}
"""Folders of style and script, by their addresses."""

Message = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Message]]
Send = Callable[[Message], Awaitable[None]]
Application = Callable[[Message, Receive, Send], Awaitable[None]]

READING = ("GET", "HEAD")
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
    for rooms in (editing, answers, logs):
        app.include_router(rooms.routes(page))
    for place, folder in STATIC.items():
        app.mount(f"/{place}", StaticFiles(directory=folder))

    def words(request: Request, text: str, status: int) -> Response:
        template = "refusal.html" if "hx-request" in request.headers else "refused.html"
        found = page.html(template, faults=text.split("\n"))
        found.status_code = status
        return found

    @app.exception_handler(SeparatrixError)
    def refused(request: Request, error: SeparatrixError) -> Response:
        return words(request, str(error), HTTPStatus.UNPROCESSABLE_ENTITY)

    @app.exception_handler(HTTPException)
    def unknown(request: Request, error: HTTPException) -> Response:
        place = f"{request.method} {printable(request.url.path, 100)}"
        return words(request, f"{place} is not an address of this page.", error.status_code)

    return app


class TooLarge(Exception):  # noqa: N818 - a reply, not a fault
    """The body of a request is larger than any upload may be."""


class Guard:
    """Answer only requests that a person at this machine made from the page itself.

    Every request must name this host, not come from another site, and bring the token: first in the link
    that `separatrix app` prints, then in a cookie. Bodies are bounded while they arrive.

    Parameters
    ----------
    application : callable
        The page, an ASGI application.
    token : str
        The secret of this server.
    port : int
        Where it listens.
    """

    def __init__(self, application: Application, *, token: str, port: int) -> None:
        self.application, self.token = application, token
        self.hosts = (f"127.0.0.1:{port}", f"localhost:{port}")
        self.cookie = f"separatrix-{port}"

    async def __call__(self, scope: Message, receive: Receive, send: Send) -> None:
        """Answer one request."""
        if scope["type"] == "lifespan":
            await self.application(scope, receive, send)
            return
        if scope["type"] != "http":
            await send({"type": "websocket.close", "code": 1008})
            return
        headers = {name.decode("latin-1"): value.decode("latin-1") for name, value in scope["headers"]}
        refusal = self._refusal(scope, headers)
        if refusal is not None:
            await _reply(send, *refusal)
        elif self._brings_token(scope):
            await self._enter(send)
        elif not self._has_cookie(headers):
            words = "Open the link that `separatrix app` printed in the terminal: it contains a token."
            await _reply(send, HTTPStatus.FORBIDDEN, words)
        else:
            await self._pass(scope, receive, send)

    def _refusal(self, scope: Message, headers: dict[str, str]) -> tuple[HTTPStatus, str] | None:
        """Return why a request is refused whatever it brings; None if it is not."""
        host = headers.get("host", "")
        if host not in self.hosts:
            return HTTPStatus.MISDIRECTED_REQUEST, "This server answers to 127.0.0.1 and localhost only."
        origin, site = headers.get("origin"), headers.get("sec-fetch-site")
        is_own = origin in (None, f"http://{host}") and site in (None, "same-origin", "none")
        if not is_own or (scope["method"] not in READING and origin is None):
            return HTTPStatus.FORBIDDEN, "Requests of other sites are refused."
        length = headers.get("content-length", "0")
        if not length.isdigit() or int(length) > MOST_BYTES:
            return HTTPStatus.REQUEST_ENTITY_TOO_LARGE, TOO_LARGE
        return None

    def _brings_token(self, scope: Message) -> bool:
        given = parse_qs(scope["query_string"].decode("latin-1")).get("token", [""])[0]
        return scope["path"] == "/" and self._is_token(given)

    def _has_cookie(self, headers: dict[str, str]) -> bool:
        pairs = (one.strip().partition("=") for one in headers.get("cookie", "").split(";"))
        return any(name == self.cookie and self._is_token(value) for name, _, value in pairs)

    def _is_token(self, given: str) -> bool:
        return hmac.compare_digest(given.encode(), self.token.encode())

    async def _enter(self, send: Send) -> None:
        """Keep the token in a cookie, and lead to the page without it in its address."""
        cookie = f"{self.cookie}={self.token}; Path=/; HttpOnly; SameSite=Strict"
        await _reply(send, HTTPStatus.SEE_OTHER, "", {"location": "/", "set-cookie": cookie})

    async def _pass(self, scope: Message, receive: Receive, send: Send) -> None:
        """Let the page answer, with our headers; a body that grows beyond the bound is cut off."""
        taken, begun, is_refused = 0, False, False

        async def bounded() -> Message:
            nonlocal taken, is_refused
            message = await receive()
            taken += len(message.get("body", b""))
            if taken > MOST_BYTES:
                if not begun:
                    await _reply(send, HTTPStatus.REQUEST_ENTITY_TOO_LARGE, TOO_LARGE)
                is_refused = True
                raise TooLarge
            return message

        async def with_headers(message: Message) -> None:
            nonlocal begun
            if is_refused:  # what the page makes of the end of the body
                return
            if message["type"] == "http.response.start":
                begun = True
                ours = [(name.encode(), value.encode()) for name, value in HEADERS.items()]
                message["headers"] = [*message.get("headers", ()), *ours]
            await send(message)

        with contextlib.suppress(TooLarge):
            await self.application(scope, bounded, with_headers)


async def _reply(send: Send, status: HTTPStatus, words: str, more: dict[str, str] | None = None) -> None:
    body = words.encode()
    headers = {"content-type": "text/plain; charset=utf-8", "content-length": str(len(body))}
    headers |= {"connection": "close"} if status >= HTTPStatus.BAD_REQUEST else {}
    headers |= HEADERS | (more or {})
    pairs = [(name.encode(), value.encode()) for name, value in headers.items()]
    await send({"type": "http.response.start", "status": int(status), "headers": pairs})
    await send({"type": "http.response.body", "body": body})


def listening(port: int) -> socket.socket:
    """Return a socket that listens on this machine only; port 0 takes any free one."""
    found = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    try:
        found.bind((HOST, port))
    except OSError as error:
        found.close()
        cure = "Choose another one, or leave it out for any that is free."
        raise InputError("--port", "cannot be used", got=f"{port} ({error.strerror})", cure=cure) from None
    found.listen(128)
    return found


class Server(uvicorn.Server):
    """The page of a folder behind its guard; `link` opens it."""

    def __init__(self, root: Path, *, port: int = 0) -> None:
        self.socket, token = listening(port), secrets.token_urlsafe(24)
        port = self.socket.getsockname()[1]
        self.link = f"http://{HOST}:{port}/?token={token}"
        guarded = Guard(application(root), token=token, port=port)
        super().__init__(
            uvicorn.Config(
                guarded,
                log_level="warning",
                access_log=False,
                server_header=False,
                limit_concurrency=MOST_CONNECTIONS,
                timeout_keep_alive=IDLE,
                timeout_graceful_shutdown=3,
                lifespan="on",
            )
        )

    def serve_until_ended(self) -> None:
        """Serve until Ctrl-C."""
        self.run(sockets=[self.socket])
