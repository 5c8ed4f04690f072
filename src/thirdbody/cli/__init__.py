"""The command line: ``thirdbody solve STUDY.toml`` and its neighbours.

Each command is a file in `commands`; what several share is in `options`, what they print in `show`,
and `streams` says what goes to which stream with which exit status.
"""

from __future__ import annotations

# first of all: Ctrl-C while the rest loads ends the command without a traceback
from . import interrupt as interrupt  # isort: skip

import io
import os
import sys
from importlib import import_module
from typing import Annotated

import typer

from .commands import COMMANDS
from .options import OwnCode, load_own_code, with_common_options
from .streams import (
    EXIT_STATUS,
    Command,
    Commands,
    open_closed_streams,
    refuse_full_output,
    without_output,
)

__all__ = ["app", "main"]

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
"""Variables that say how many threads share the algebra of one matrix."""
RUN_ON = ("app", "reproduce")
"""Commands whose notes wait for no answer."""

app = typer.Typer(
    cls=Commands,
    name="thirdbody",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    help="Contact of rough surfaces with particles between them.",
    epilog=EXIT_STATUS,
)


def main() -> None:
    """Entry point of the command ``thirdbody``."""
    share_no_matrix()
    open_closed_streams()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")
    try:
        refuse_full_output()
        try:
            app()
        finally:
            sys.stdout.flush()
    except OSError as error:  # --help and --version end before a command begins
        sys.exit(without_output(error))


def share_no_matrix() -> None:
    """Let one thread do the algebra of a matrix, where the user says nothing else.

    The matrices are small: threads that wait for each other cost more than they save, on a busy
    machine ten times the whole, and the last digits of a sum would hang on how many there are.
    NumPy reads the variables when it loads, which is after this.
    """
    if not any(name in os.environ for name in THREADS):
        os.environ.update(dict.fromkeys(THREADS[1:], "1"))


def _version(wanted: bool) -> None:
    if wanted:
        from ..version import __version__

        print(f"thirdbody {__version__}")
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version.")
    ] = False,
    own_code: OwnCode = None,
) -> None:
    """Contact of rough surfaces with particles between them."""
    load_own_code(own_code)


for name in COMMANDS:
    module = import_module(f".commands.{name}", __name__)
    run = with_common_options(
        module.command, warns=hasattr(module, "warn_of"), waits=name not in RUN_ON
    )
    app.command(name, cls=Command)(run)
