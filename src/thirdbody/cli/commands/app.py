"""``thirdbody app``: the page in the browser."""

from __future__ import annotations

import importlib.util
import socket
import sys
from pathlib import Path
from typing import Annotated

import typer

from ...errors import InvalidValue, Mistake

__all__ = ["command"]


def command(
    study: Annotated[
        Path | None,
        typer.Argument(metavar="[STUDY.toml]", help="A study file to open with; else an example."),
    ] = None,
    port: Annotated[
        int,
        typer.Option(
            "--port",
            min=0,
            max=65535,
            metavar="NUMBER",
            help="Port of the page; 0 takes a free one.",
        ),
    ] = 8765,
    host: Annotated[
        str,
        typer.Option(
            "--host",
            metavar="ADDRESS",
            help="Address to listen on; 0.0.0.0 lets other machines in.",
        ),
    ] = "127.0.0.1",
    browser: Annotated[
        bool, typer.Option("--browser/--no-browser", help="Open the page in the browser.")
    ] = True,
) -> None:
    """The page in the browser, where sliders move the answer."""
    if importlib.util.find_spec("nicegui") is None:
        raise InvalidValue(
            "thirdbody app needs NiceGUI, which is not installed: pip install 'thirdbody[app]'",
            code=Mistake.ABSENT,
        )
    from ...study.toml import read

    data = None if study is None else read(study)
    port = _free(host, port)
    from ...app.server import serve

    shown = f"[{host}]" if ":" in host else host
    print(f"thirdbody: http://{shown}:{port} (Ctrl-C stops it)", file=sys.stderr, flush=True)
    serve(data, None if study is None else study.parent, host=host, port=port, browser=browser)


def _free(host: str, port: int) -> int:
    """The port, a free one for 0; a clear sentence where it is taken."""
    kind = socket.AF_INET6 if ":" in host else socket.AF_INET
    with socket.socket(kind, socket.SOCK_STREAM) as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((host, port))
        except OSError as error:
            raise InvalidValue(
                f"cannot listen on {host}, port {port}: {(error.strerror or str(error)).lower()}; "
                "choose another with --port, or --port 0 for a free one",
                code=Mistake.UNWRITABLE,
            ) from None
        return int(probe.getsockname()[1])
