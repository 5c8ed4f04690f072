"""Who may talk to the page, what it may send, and what its answers may do in the browser."""

from __future__ import annotations

import secrets
from collections.abc import Awaitable, Callable, Iterable, MutableMapping
from typing import Any
from urllib.parse import urlsplit

__all__ = ["LARGEST_UPLOAD", "LOOPBACK", "Guard", "Headers", "allowed_hosts"]

LOOPBACK = ("127.0.0.1", "localhost", "::1")
LARGEST_UPLOAD = 25 * 2**20
"""Bytes of a file that may be dropped on the page."""
SPARE = 2**16
"""Bytes of a form around the file."""

Message = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Message]]
Send = Callable[[Message], Awaitable[None]]
Application = Callable[[Message, Receive, Send], Awaitable[None]]


def allowed_hosts(host: str) -> tuple[str, ...]:
    """Names under which a page that listens on ``host`` may be asked for; none means any.

    >>> allowed_hosts("127.0.0.1")
    ('127.0.0.1', 'localhost', '::1')
    >>> allowed_hosts("0.0.0.0")
    ()
    """
    if host in LOOPBACK:
        return LOOPBACK
    return () if host in ("0.0.0.0", "::", "") else (*LOOPBACK, host)


class Guard:
    """ASGI middleware that refuses other hosts, other origins and large bodies.

    A page of another site that the same browser shows could otherwise reach the loopback address
    under a name of its own (DNS rebinding), or open a socket to it.
    """

    def __init__(
        self, app: Application, hosts: Iterable[str], largest: int = LARGEST_UPLOAD
    ) -> None:
        self.app, self.hosts, self.largest = app, frozenset(hosts), largest + SPARE

    async def __call__(self, scope: Message, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        headers = {
            key.decode("latin-1"): value.decode("latin-1") for key, value in scope["headers"]
        }
        if not self._is_own_request(headers, scope):
            await _refuse(scope, send, 400, "this page is not served under that name")
            return
        if _is_embedded(headers):
            await _refuse(scope, send, 403, "another site may link to this page, not embed it")
            return
        length = headers.get("content-length", "0")
        if not length.isdecimal() or int(length) > self.largest:
            await _refuse(scope, send, 413, f"more than {self.largest} bytes are not taken")
            return
        await self.app(scope, self._count_body(receive), send)

    def _is_own_request(self, headers: dict[str, str], scope: Message) -> bool:
        """Asked for under a name of its own, by nobody else than itself."""
        secure = scope.get("scheme", "http") in ("https", "wss")
        origin = _origin(f"{'https' if secure else 'http'}://{headers.get('host', '')}")
        if self.hosts and (origin is None or origin[1] not in self.hosts):
            return False
        return "origin" not in headers or _origin(headers["origin"]) == origin

    def _count_body(self, receive: Receive) -> Receive:
        """Ends a body that goes on beyond the limit without having said so."""
        taken = 0

        async def count_message() -> Message:
            nonlocal taken
            message = await receive()
            if message["type"] == "http.request":
                taken += len(message.get("body", b""))
                if taken > self.largest:
                    return {"type": "http.disconnect"}
            return message

        return count_message


def _origin(text: str) -> tuple[str, str, int] | None:
    """Scheme, host and port; None for what is no address of a page."""
    try:
        parts = urlsplit(text)
        port = parts.port or {"http": 80, "https": 443}[parts.scheme]
    except (ValueError, KeyError):
        return None
    return (parts.scheme, parts.hostname, port) if parts.hostname else None


def _is_embedded(headers: dict[str, str]) -> bool:
    """Whether the page of another site asks, other than by a link that is followed."""
    if headers.get("sec-fetch-site") not in ("cross-site", "same-site"):
        return False
    follows = headers.get("sec-fetch-mode") == "navigate"
    return not (follows and headers.get("sec-fetch-dest") == "document")


POLICY = "; ".join(
    (
        "default-src 'none'",
        "script-src 'self' 'nonce-{nonce}' 'unsafe-eval'",
        "style-src 'self' 'unsafe-inline'",
        "img-src 'self' data: blob:",
        "font-src 'self' data:",
        "connect-src 'self'",
        "base-uri 'none'",
        "form-action 'none'",
        "frame-ancestors 'none'",
    )
)
"""What an answer may do. No script but that of the server runs, none in attributes, and nothing is
loaded from elsewhere. NiceGUI evaluates its event handlers and Vue compiles templates, hence
'unsafe-eval'; both, and Plotly, write styles into the page, hence 'unsafe-inline' for those."""
KEPT_TO_ITSELF = (
    (b"x-content-type-options", b"nosniff"),
    (b"x-frame-options", b"DENY"),
    (b"referrer-policy", b"same-origin"),
    (b"cross-origin-opener-policy", b"same-origin"),
    (b"cross-origin-resource-policy", b"same-origin"),
)


class Headers:
    """ASGI middleware that tells the browser what answers may do; scripts of a page get a nonce."""

    def __init__(self, app: Application) -> None:
        self.app = app

    async def __call__(self, scope: Message, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        nonce = secrets.token_urlsafe(16)
        held: list[Message] = []

        async def with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                policy = POLICY.format(nonce=nonce).encode()
                more = [*KEPT_TO_ITSELF, (b"content-security-policy", policy)]
                message["headers"] = [*message.get("headers", []), *more]
                kinds = [v for k, v in message["headers"] if k.lower() == b"content-type"]
                if kinds and kinds[0].startswith(b"text/html"):
                    held.append(message)  # until its body is there, which gets longer
                    return
            elif held:
                held.append(message)
                if message.get("more_body"):
                    return
                start, *parts = held
                held.clear()
                body = b"".join(chunk.get("body", b"") for chunk in parts)
                # texts of a study stand in it as data, in which < is escaped
                body = body.replace(b"<script", f'<script nonce="{nonce}"'.encode())
                start["headers"] = [
                    (k, str(len(body)).encode() if k.lower() == b"content-length" else v)
                    for k, v in start["headers"]
                ]
                await send(start)
                message = {"type": "http.response.body", "body": body}
            await send(message)

        await self.app(scope, receive, with_headers)


async def _refuse(scope: Message, send: Send, status: int, why: str) -> None:
    if scope["type"] == "websocket":
        await send({"type": "websocket.close", "code": 1008, "reason": why})
        return
    head = [(b"content-type", b"text/plain; charset=utf-8"), (b"connection", b"close")]
    await send({"type": "http.response.start", "status": status, "headers": head})
    await send({"type": "http.response.body", "body": why.encode()})
