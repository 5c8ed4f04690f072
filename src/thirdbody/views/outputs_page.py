"""What outputs there are, read off their classes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..contact.output import AbstractOutput
from ..study.fields import Declaration, declarations

if TYPE_CHECKING:
    from collections.abc import Iterable

__all__ = ["entries", "outputs_page"]

HEAD = """# Table of outputs

Every output that ships: what a contact does besides carrying load. Numbers without a default are
yours to give: nobody can predict them. In Python `outputs=tb.outputs.Friction(tau_ss=...)` goes
into the `Contact`; in a study file each is a table, `[outputs.friction]`. Their columns stand
beside those of the state in `solve`, sweeps, CSV and JSON, and sensitivities, error bars and
designs know them by the same names.

This page is made from the classes: `thirdbody outputs --markdown > docs/outputs.md`.
"""


def entries() -> list[dict[str, Any]]:
    """Every output with its source, numbers and columns, ready for JSON.

    Examples
    --------
    >>> entries()[0]["name"]
    'counts'
    """
    return [_entry(kind) for _, kind in sorted(AbstractOutput.registry.items())]


def _entry(kind: Any) -> dict[str, object]:
    about = ("name", "title", "year", "citation", "doi", "provenance", "valid_range")
    return {
        **{key: getattr(kind, key) for key in about},
        "class": kind.__name__,
        "needs": list(kind.needs),
        "options": [_option(declaration) for declaration in declarations(kind)],
        "columns": {name: column._asdict() for name, column in kind.columns.items()},
    }


def _option(declaration: Declaration) -> dict[str, object]:
    about = declaration.quantity or {"symbol": "", "unit": ""}
    return {
        "key": declaration.name,
        "required": declaration.needed,
        "default": declaration.default,
        "symbol": about["symbol"],
        "unit": about["unit"],
        "allowed": declaration.allowed or ", ".join(declaration.options),
        "meaning": declaration.meaning,
    }


def outputs_page() -> str:
    """The page docs/outputs.md."""
    parts = [HEAD]
    for entry in entries():
        doi = f", doi:{entry['doi']}" if entry["doi"] else ""
        needs = "".join(f" Needs `[outputs.{name}]` beside it." for name in entry["needs"])
        parts.append(
            f"## `{entry['name']}`: {entry['title']}\n\n"
            f"`tb.outputs.{entry['class']}`. {entry['citation']}{doi} ({entry['provenance']}). "
            f"Valid: {entry['valid_range']}.{needs}\n"
        )
        rows = [
            [
                f"`{option['key']}`",
                option["symbol"],
                option["unit"],
                "**yours**" if option["required"] else _default_text(option["default"]),
                option["allowed"],
                option["meaning"],
            ]
            for option in entry["options"]
        ]
        if rows:
            parts.append(_table(("key", "symbol", "unit", "default", "allowed", "meaning"), rows))
        rows = [[f"`{name}`", *column.values()] for name, column in entry["columns"].items()]
        parts.append(_table(("column", "symbol", "unit", "meaning"), rows))
    return "\n".join(parts)


def _default_text(default: object) -> str:
    return "" if default is None else f"{default:g}" if isinstance(default, float) else str(default)


def _table(head: tuple[str, ...], rows: list[list[str]]) -> str:
    def line(cells: Iterable[object]) -> str:
        return "| " + " | ".join(str(cell).replace("|", "\\|") for cell in cells) + " |"

    return "\n".join([line(head), line("---" for _ in head), *map(line, rows), ""])
