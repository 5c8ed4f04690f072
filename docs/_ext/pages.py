"""Parts of pages that are made from the program: keys of study files, commands, columns.

A page writes a fence ``{generated} NAME`` where a part shall stand.
"""

import re

__all__ = ["FENCE", "GENERATED", "insert_generated"]

FENCE = re.compile(r"^```\{generated\} ([\w-]+)\n```$", re.M)
RANGE = {"from", "to", "points", "spacing"}
MATERIAL = {"E", "nu", "H", "thermal_conductivity"}
# what a key with these properties refers to, instead of a table of its own
SHARED = {"range": RANGE, "material": MATERIAL}
# for which question a table of a study file is written; a new one must be named here, too
PURPOSE = {
    "surfaces": "the two materials",
    "roughness": "roughness, from a drawing or a measured surface",
    "asperity_law": "law of the asperities",
    "particles": "dust, debris or an additive",
    "particle_law": "law of the particles and where they lie",
    "outputs": "friction, heat, conductance, wear, dents",
    "body": "ball, roller or flat: from newtons to pressure",
    "load": "pressure, force or separation",
    "film": "lubricant film and Stribeck curve",
    "connector": "contacts that close on dust",
    "plate": "wafer or plate over a particle",
    "sweep": "many states",
    "uncertainty": "what is not known exactly",
    "design": "which input may be chosen, and for what",
    "explicit": "particles one by one on a map of heights",
}
# where a table of a study file is explained
EXPLAINED = {
    "surfaces": "materials.md",
    "roughness": "surfaces.md",
    "asperity_law": "choose-a-law.md",
    "particles": "dust.md",
    "particle_law": "choose-a-seat.md",
    "outputs": "outputs.md",
    "body": "bodies.md",
    "load": "bodies.md",
    "film": "lubrication.md",
    "connector": "connector.md",
    "plate": "wafer.md",
    "sweep": "big-sweeps.md",
    "uncertainty": "uncertainty.md",
    "design": "design.md",
    "explicit": "explicit.md",
}


def cell(text):
    """Text for a cell of a table in Markdown."""
    parts = re.split(r"(`[^`]*`)", " ".join(text.split()))
    parts[::2] = [re.sub(r"([|*_<>$\[\]{}])", r"\\\1", part) for part in parts[::2]]
    return "".join(parts)


def code(text):
    return f"`{text}`" if text else ""


def number(value):
    return f"{value:g}" if isinstance(value, int | float) else str(value)


def written(schema):
    """What may stand under a key, in words."""
    ways = schema.get("anyOf", [schema])
    out = []
    for way in ways:
        if "enum" in way:
            words = [f'"{word}"' for word in way["enum"]]
            shown = words if len(words) <= 12 else [*words[:3], "…"]
            out.append(", ".join(map(code, shown)))
        elif "properties" in way:
            continue
        elif way.get("type") == "boolean":
            out.append("true or false")
        elif way.get("type") == "array":
            out.append("a list")
        elif way.get("type") == "string":
            out.append("text")
        elif "number" in way.get("type", ()) or way.get("type") in ("integer", "number"):
            out.append(f"a{' whole' if way['type'] == 'integer' else ''} number{allowed(way)}")
    return "; ".join(dict.fromkeys(out))


def allowed(way):
    words = {"minimum": "from", "exclusiveMinimum": "above", "maximum": "to",
             "exclusiveMaximum": "below"}  # fmt: skip
    limits = [f"{word} {number(way[key])}" for key, word in words.items() if key in way]
    return f" {' '.join(limits)}" if limits else ""


def tables_in(schema):
    """Schemas of the tables that may stand under a key, or in a list under it."""
    for way in (schema, *schema.get("anyOf", [])):
        if "properties" in way:
            yield way
        if "items" in way:
            yield from tables_in(way["items"])


def label(path):
    return "study-" + re.sub(r"\W+", "-", path)


class StudyFile:
    """Walks through the schema of study files and writes a table of keys for each table."""

    def __init__(self, schema):
        self.schema = schema
        self.seen = {}
        self.shared = {}
        self.lines = []

    def text(self):
        for name, each in self.schema["properties"].items():
            tables = list(tables_in(each))
            if not tables:
                continue
            title = f"## `[{name}]`: {PURPOSE[name]}"
            intro = [f"Explained in [{EXPLAINED[name].removesuffix('.md')}]({EXPLAINED[name]})."]
            if about := each.get("description"):
                intro.insert(0, f"{cell(about)}.".replace("..", "."))
            self.section(name, title, tables[0], " ".join(intro))
        for path, title, intro in (
            ("material", "## A material", "By its name in the library, or as a table."),
            ("range", "## A range of values", "Wherever a load, a force or a speed stands."),
        ):
            self.section(path, title, self.shared[path], intro)
        return "\n".join(self.lines)

    def section(self, path, title, table, intro=""):
        self.seen[frozenset(table["properties"])] = path
        self.lines += [f"({label(path)})=", title, ""]
        self.lines += [intro, ""] if intro else []
        self.lines += ["| key | what it is | what stands there | default | example |", "|---|---|---|---|---|"]
        later = []
        for key, each in table["properties"].items():
            what, _, example = each.get("description", "").partition("e.g. ")
            values = [written(each)] if written(each) else []
            for inner in tables_in(each):
                names = set(inner["properties"])
                known = next((f"a [{kind}](#study-{kind})" for kind, some in SHARED.items() if some <= names), None)
                for kind, some in SHARED.items():
                    if some <= names:
                        self.shared.setdefault(kind, inner)
                if known is None and (place := self.seen.get(frozenset(names))):
                    known = f"a table as [{place}](#{label(place)})"
                if known is None:
                    known = f"a table [{path}.{key}](#{label(f'{path}.{key}')})"
                    later.append((f"{path}.{key}", inner))
                    self.seen[frozenset(names)] = f"{path}.{key}"
                values.append(known)
            needed = key in table.get("required", [])
            default = "needed" if needed else code(number(each["default"])) if "default" in each else ""
            if isinstance(each.get("default"), bool):
                default = code(str(each["default"]).lower())
            if what.startswith("one of ") and values:
                what = ""
            row = [code(key), cell(what.rstrip(" ,")), "; ".join(values), default, code(example.strip().replace("|", "/"))]
            self.lines.append("| " + " | ".join(row) + " |")
        self.lines.append("")
        for inner_path, inner in later:
            self.section(inner_path, f"### `{inner_path}`", inner)


def study_file():
    """Every table and key of a study file."""
    from thirdbody.study.schema import study_schema

    return StudyFile(study_schema()).text()


def commands():
    """Every command with its arguments and options."""
    import click
    import typer

    from thirdbody.cli import app

    group = typer.main.get_command(app)
    lines = []
    for name, command in group.commands.items():
        context = click.Context(command, info_name=name)
        usage = " ".join(["thirdbody", name, *command.collect_usage_pieces(context)])
        lines += [f"## `thirdbody {name}`", "", cell(command.help or ""), ""]
        lines += ["```", usage, "```", ""]
        rows = []
        for item in command.get_params(context):
            if getattr(item, "hidden", False):
                continue
            record = item.get_help_record(context) if hasattr(item, "get_help_record") else None
            record = record or (item.make_metavar(context), getattr(item, "help", "") or "")
            rows.append("| " + " | ".join([code(record[0].replace("|", "/")), cell(record[1])]) + " |")
        lines += ["| argument or option | what it does |", "|---|---|", *rows, ""]
    return "\n".join(lines)


GENERATED = {"study-file": study_file, "commands": commands}


def insert_generated(text):
    """The text of a page with its generated parts in place."""
    return FENCE.sub(lambda found: GENERATED[found[1]](), text)
