"""Who may talk to the page: browsers on its own host, with uploads of a decent size."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Iterable, MutableMapping
from typing import Any
from urllib.parse import urlsplit

__all__ = ["LARGEST_UPLOAD", "LOOPBACK", "Guard", "allowed_hosts"]

LOOPBACK = ("127.0.0.1", "localhost", "::1")
LARGEST_UPLOAD = 25 * 2**20
"""Bytes of a file that may be dropped on the page."""
SPARE = 2**16
"""Bytes of a form around the file."""

Message = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Message]]
Send = Callable[[Message], Awaitable[None]]


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

    def __init__(self, app: Any, hosts: Iterable[str], largest: int = LARGEST_UPLOAD) -> None:
        self.app, self.hosts, self.largest = app, frozenset(hosts), largest + SPARE

    async def __call__(self, scope: Message, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        headers = {
            key.decode("latin-1"): value.decode("latin-1") for key, value in scope["headers"]
        }
        if self.hosts and not self._known(headers):
            await _refuse(scope, send, 400, "this page is not served under that name")
            return
        length = headers.get("content-length", "0")
        if not length.isdecimal() or int(length) > self.largest:
            await _refuse(scope, send, 413, f"more than {self.largest} bytes are not taken")
            return
        await self.app(scope, self._counted(receive), send)

    def _known(self, headers: dict[str, str]) -> bool:
        host = urlsplit(f"//{headers.get('host', '')}").hostname
        origin = headers.get("origin")
        return host in self.hosts and (origin is None or urlsplit(origin).hostname in self.hosts)

    def _counted(self, receive: Receive) -> Receive:
        """Ends a body that goes on beyond the limit without having said so."""
        taken = 0

        async def counted() -> Message:
            nonlocal taken
            message = await receive()
            if message["type"] == "http.request":
                taken += len(message.get("body", b""))
                if taken > self.largest:
                    return {"type": "http.disconnect"}
            return message

        return counted


async def _refuse(scope: Message, send: Send, status: int, why: str) -> None:
    if scope["type"] == "websocket":
        await send({"type": "websocket.close", "code": 1008, "reason": why})
        return
    head = [(b"content-type", b"text/plain; charset=utf-8"), (b"connection", b"close")]
    await send({"type": "http.response.start", "status": status, "headers": head})
    await send({"type": "http.response.body", "body": why.encode()})
