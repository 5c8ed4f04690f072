"""Widgets that several tabs show: named numbers, tables, what is told of a file."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from nicegui import ui

__all__ = ["facts", "put", "table"]


def put(element: Any, props: Mapping[str, Any]) -> Any:
    """Set attributes of an element by their values, and give it back.

    A text written into ``element.props("...")`` is parsed there, so that it could add attributes.
    """
    for name, value in props.items():
        element.props[name] = value
    return element


def facts(pairs: Iterable[tuple[str, str]], kind: str = "") -> None:
    """Named numbers side by side."""
    for name, value in pairs:
        with ui.column().classes("fact gap-0"):
            ui.label(name).classes("hint")
            put(ui.label(value).classes("value"), {"data-fact": f"{kind}{name}"})


def table(name: str, heads: dict[str, str], rows: list[dict[str, Any]], **more: Any) -> None:
    """Rows under heads, by their keys."""
    columns = [
        {"name": key, "label": label, "field": key, "align": "left"} for key, label in heads.items()
    ]
    made = ui.table(columns=columns, rows=rows, **more).classes("w-full")
    put(made.props("dense flat wrap-cells"), {"data-figure": name})
