"""``thirdbody laws``: what one asperity or particle may do."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...quantities.tables import Table
from ..options import AsJson
from ..show import terminal, usual

if TYPE_CHECKING:
    from ...study.fields import Declaration

from ..streams import print_json

__all__ = ["command"]

JSON = "--json has all of it"


def command(
    as_json: AsJson = False,
    as_page: Annotated[
        bool, typer.Option("--markdown", help="Print the page of asperity laws, docs/laws.md.")
    ] = False,
) -> None:
    """The laws of asperities and particles, with their sources."""
    from ...laws import asperity, particle

    if as_json and as_page:
        raise typer.BadParameter("--json and --markdown exclude each other; run the command twice")
    if as_page:
        from ...views.laws_page import laws_page

        print(laws_page(), end="")
        return

    kinds = {"asperity": asperity.REGISTRY, "particle": particle.REGISTRY}
    laws = {
        kind: [_about_law(law) for law in registry.values()] for kind, registry in kinds.items()
    }
    if as_json:
        print_json(laws)
        return
    console = terminal()
    for kind, entries in laws.items():
        heads = ("name", "law", "valid range", "citation")
        table = Table(heads, words=heads[1:], drop=["citation", "valid range"], more=JSON)
        for entry in entries:
            doi = f", doi:{entry['doi']}" if entry["doi"] else ""
            table.add_row(
                entry["name"],
                f"{entry['title']} ({entry['year']})",
                entry["valid_range"],
                f"{entry['citation']}{doi} ({entry['provenance']})",
            )
        console.print(f"[{kind}_law]")
        console.print(table)
        for entry in filter(lambda entry: entry["options"], entries):
            heads = (f"options of {entry['name']}", "default", "allowed", "meaning")
            table = Table(heads, words=[*heads[:1], *heads[2:]], drop=["allowed"], more=JSON)
            for option in entry["options"]:
                default = usual(option["default"], option["unit"])
                table.add_row(option["key"], default, option["allowed"], option["meaning"])
            console.print(table)


def _about_law(law: type) -> dict[str, Any]:
    from ...study.fields import declarations

    about = ("name", "title", "year", "citation", "doi", "provenance", "valid_range")
    usual = law()
    options = [
        _about_option(declaration, getattr(usual, declaration.name))
        for declaration in declarations(law)
    ]
    return {key: getattr(law, key) for key in about} | {"options": options}


def _about_option(declaration: Declaration, default: object) -> dict[str, object]:
    from ...quantities.units import say

    default = getattr(default, "name", default)
    about = declaration.quantity or {"symbol": "", "unit": ""}
    allowed = declaration.allowed or ", ".join(map(say, declaration.options))
    if declaration.kind == "switch":
        allowed = "true, false"
    elif declaration.declared == "AbstractAsperityLaw":
        allowed = "name of an asperity law, or a table with its options"
    return {
        "key": declaration.name,
        "default": default,
        "allowed": allowed,
        "unit": about["unit"],
        "meaning": f"{declaration.meaning} {about['symbol']}".rstrip(),
    }
