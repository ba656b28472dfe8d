"""Who may ask the page anything: this machine's browser with the token, from the page itself, in bounds."""

from __future__ import annotations

import contextlib
import hmac
from collections.abc import Awaitable, Callable, MutableMapping
from http import HTTPStatus
from typing import Any
from urllib.parse import parse_qs

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
"""Only own files; no inline script. Plotly writes styles of its own, which cannot run anything."""

HEADERS = {
    "content-security-policy": POLICY,
    "x-content-type-options": "nosniff",
    "x-frame-options": "DENY",
    "referrer-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "cross-origin-opener-policy": "same-origin",
}
"""On every response."""


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
            words = "Open the link that `separatrix app` printed in the terminal: it holds a token."
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
