"""The server of the page: on this machine, for this machine, unless asked otherwise."""

from __future__ import annotations

import logging
from pathlib import Path
from typing import Any

from fastapi import Request
from nicegui import app, ui

from .guard import Guard, Headers, allowed_hosts
from .page import Start, page

__all__ = ["serve"]


def serve(
    study: dict[str, Any] | None = None,
    folder: Path | None = None,
    *,
    host: str = "127.0.0.1",
    port: int = 8765,
    browser: bool = True,
) -> None:
    """Serve the page until interrupted.

    Parameters
    ----------
    study : dict, optional
        A parsed study file to open with.
    folder : Path, optional
        Where the files lie that it names.
    host : str, optional
        Address to listen on; every other than loopback lets other machines in.
    port : int, optional
    browser : bool, optional
        Open it in the browser.
    """
    start = Start(study, folder)

    @ui.page("/", title="thirdbody", response_timeout=30)
    def index(request: Request) -> None:
        page(start, request)

    app.add_middleware(Guard, hosts=allowed_hosts(host))
    app.add_middleware(Headers)
    app.on_startup(_warm)
    logging.getLogger("nicegui").setLevel(logging.ERROR)
    ui.run(
        host=host,
        port=port,
        title="thirdbody",
        reload=False,
        show=browser,
        show_welcome_message=False,
        language="en-US",
        dark=None,
        reconnect_timeout=60.0,
        storage_secret=None,
        on_air=None,
    )


async def _warm() -> None:
    """Compile what is compiled on first use while the browser opens."""
    from nicegui import run

    from .examples import example
    from .state import State

    def solve() -> None:
        answer = State(example(), Path()).answer
        assert answer is not None
        assert answer.curves is not None

    await run.io_bound(solve)
