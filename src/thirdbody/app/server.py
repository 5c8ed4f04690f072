"""The server of the page: on this machine, for this machine, unless asked otherwise."""

from __future__ import annotations

import contextlib
import logging
from pathlib import Path

from fastapi import Request
from nicegui import app, run, ui

from ..errors import InvalidValue
from .folders import Folders, remove_left
from .guard import Guard, Headers, allowed_hosts
from .jobs import RUNNING
from .page import Start, page
from .solver import solver
from .warm import warm

__all__ = ["serve"]


def serve(
    study: dict[str, object] | None = None,
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
    remove_left()
    folders = Folders()
    start = Start(study, folder, folders)

    @ui.page("/", title="thirdbody", response_timeout=30)
    async def index(request: Request) -> None:
        # a long link takes a while to unpack
        opened = await run.io_bound(start.state, dict(request.query_params))
        if opened is not None:  # as it is when the server ends
            page(*opened, start)

    def end() -> None:
        for job in list(RUNNING):
            job.cancel()
        solver().close()
        folders.close()

    app.add_middleware(Guard, hosts=allowed_hosts(host))
    app.add_middleware(Headers)
    app.on_startup(_warm)
    app.on_shutdown(end)
    logging.getLogger("nicegui").setLevel(logging.ERROR)
    try:
        _run(host, port, browser)
    finally:
        end()


def _run(host: str, port: int, browser: bool) -> None:
    ui.run(
        host=host,
        port=port,
        title="thirdbody",
        reload=False,
        show=browser,
        show_welcome_message=False,
        language="en-US",
        dark=None,
        tailwind=False,
        ws_per_message_deflate=False,
        reconnect_timeout=60.0,
        storage_secret=None,
        on_air=None,
        timeout_graceful_shutdown=3,
    )


async def _warm() -> None:
    """Compile what is compiled on first use while the browser opens."""
    with contextlib.suppress(InvalidValue):
        await solver(warm).ask(_nothing)


def _nothing() -> None:
    """What a process answers that has only to be ready."""
