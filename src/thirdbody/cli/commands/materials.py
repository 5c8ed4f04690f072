"""``thirdbody materials``: the bodies there are, with range and source."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from ...errors import InvalidValue, Mistake
from ...quantities.say import number
from ...quantities.tables import Table
from ..options import AsJson
from ..show import terminal
from ..streams import print_json

__all__ = ["command"]


def command(
    query: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="WORD",
            help="Words of name, kind or description, e.g. bearing steel; all materials without.",
            show_default=False,
        ),
    ] = None,
    files: Annotated[
        list[Path] | None,
        typer.Option(
            "--file",
            metavar="FILE.toml",
            help="A file of your own materials; may be repeated.",
            show_default=False,
        ),
    ] = None,
    as_json: AsJson = False,
    as_table: Annotated[
        bool, typer.Option("--markdown", help="Print the tables of the page docs/materials.md.")
    ] = False,
) -> None:
    """The materials of the library, with range and source.

    Words choose among them: thirdbody materials bearing steel
    """
    from ...populations.materials import materials

    if as_json and as_table:
        raise typer.BadParameter("--json and --markdown exclude each other; run the command twice")
    library = materials.load(*files) if files else materials
    search_words = " ".join(query or [])
    every = library.entries()
    entries = {name: every[name] for name in library.search(search_words)}
    if as_json:
        print_json(entries)
        return
    if not entries:
        kinds = dict.fromkeys(entry.get("kind", "") for entry in every.values())
        raise InvalidValue(
            f"no material has {search_words!r} in its name or description; "
            f"there are kinds {', '.join(filter(None, kinds))}",
            code=Mistake.UNKNOWN,
        )
    if as_table:
        print(_materials_in_markdown(entries))
        return
    heads = ("name", "what", "E", "nu", "H", "standing", "source")
    drop = ("source", "standing", "what")
    legend = {"E": "Young's modulus", "nu": "Poisson ratio, no unit", "H": "hardness"}
    table = Table(heads, words=heads[1:], drop=drop, more="--json has all of it", legend=legend)
    for name, entry in entries.items():
        doi = f", doi:{entry['doi']}" if entry.get("doi") else ""
        table.add_row(
            name,
            entry.get("about", ""),
            _in_range(entry, "E", 1e9, " GPa"),
            _in_range(entry, "nu", 1.0, ""),
            _in_range(entry, "H", 1e9, " GPa"),
            entry.get("standing", ""),
            entry["source"] + doi,
        )
    terminal().print(table)


def _in_range(entry: dict[str, Any], key: str, scale: float, unit: str) -> str:
    """A value and, where sources differ, the range between them."""
    if key not in entry:
        return "-"
    low, high = entry.get("range", {}).get(key, (entry[key], entry[key]))
    spread = f" ({number(low / scale, 5)} to {number(high / scale, 5)})" if low < high else ""
    return f"{number(entry[key] / scale, 5)}{unit}{spread}"


def _materials_in_markdown(entries: dict[str, dict[str, Any]]) -> str:
    """Two tables: the numbers, and where each comes from."""
    numbers = {
        "E": ("E [GPa]", 1e9),
        "nu": ("ν", 1.0),
        "H": ("H [GPa]", 1e9),
        "density": ("ρ [kg/m³]", 1.0),
        "thermal_conductivity": ("κ [W/(m K)]", 1.0),
        "specific_heat": ("c_p [J/(kg K)]", 1.0),
        "resistivity": ("ρ_e [nΩ m]", 1e-9),
        "K_c": ("K_c [MPa √m]", 1e6),
    }
    lines = [
        "| name | what | " + " | ".join(title for title, _ in numbers.values()) + " |",
        "| --- " * (2 + len(numbers)) + "|",
    ]
    for name, entry in entries.items():
        cells = (_in_range(entry, key, scale, "") for key, (_, scale) in numbers.items())
        lines.append(f"| `{name}` | {entry.get('about', '')} | {' | '.join(cells)} |")
    lines += ["", "| name | standing | source | numbers from elsewhere |", "| --- " * 4 + "|"]
    for name, entry in entries.items():
        doi = entry.get("doi")
        source = entry["source"] + (f", [{doi}](https://doi.org/{doi})" if doi else "")
        elsewhere = "; ".join(
            f"**{key}** {origin}" for key, origin in entry.get("sources", {}).items()
        )
        lines.append(f"| `{name}` | {entry.get('standing', '')} | {source} | {elsewhere} |")
    return "\n".join(lines)
