"""``thirdbody outputs``: what a contact may tell besides load, area and mode."""

from __future__ import annotations

from typing import Annotated

import typer

from ...quantities.say import unit_of
from ...quantities.tables import Table
from ..options import AsJson
from ..show import terminal, usual
from ..streams import print_json

__all__ = ["command"]

JSON = "--json has all of it"


def command(
    as_json: AsJson = False,
    as_page: Annotated[
        bool, typer.Option("--markdown", help="Print the page of outputs, docs/outputs.md.")
    ] = False,
) -> None:
    """What else a contact can tell: friction, heat, wear, dents ...

    Its outputs, each with the keys of its table in a study file.
    """
    from ...views.outputs_page import entries, outputs_page

    if as_json and as_page:
        raise typer.BadParameter("--json and --markdown exclude each other; run the command twice")
    if as_page:
        print(outputs_page(), end="")
        return
    if as_json:
        print_json(entries())
        return
    console = terminal()
    for entry in entries():
        console.print(f"[outputs.{entry['name']}]  {entry['title']} ({entry['provenance']})")
        if entry["options"]:
            table = Table(("key", "unit", "default", "meaning"), words=["meaning"], more=JSON)
            for option in entry["options"]:
                default = usual(option["default"], option["unit"])
                cells = ("required" if option["required"] else default, option["meaning"])
                table.add_row(option["key"], unit_of(option["unit"]), *cells)
            console.print(table)
        table = Table(("column", "unit", "meaning"), words=["meaning"], more=JSON)
        for name, column in entry["columns"].items():
            table.add_row(name, unit_of(column["unit"]), column["meaning"])
        console.print(table)
