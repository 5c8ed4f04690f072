"""Parts of pages that are made from the program: keys of study files, commands, columns.

A page writes a fence ``{generated} NAME`` where a part shall stand.
"""

import dataclasses
import enum
import inspect
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
    "life": "what enters an oil, and what its filters hold",
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
    "life": "life.md",
    "sweep": "big-sweeps.md",
    "uncertainty": "uncertainty.md",
    "design": "design.md",
    "explicit": "explicit.md",
}
# keys whose reader says no more than what may stand there
MEANING = {
    "asperity_law.name": "which law; [every law](laws.md)",
    "asperity_law.unloading": "pull the surfaces apart instead of pressing them",
    "asperity_law.remainder": "count the fitted remainder ε of the law `field`",
    "body.kind": "which bodies touch",
    "chunk": "states solved at a time",
    "concentration": "particles in a fluid, by weight or volume; needs `gap`, or comes with a film",
    "conjunction.shape": "point or line contact",
    "design.limits": "columns that must stay above or below a value",
    "design.objective": "the column to make smallest or largest",
    "design.points": "points of the search over one input",
    "design.samples": "samples of [uncertainty] for each candidate",
    "design.scatter": "judge candidates with the scatter of [uncertainty]",
    "distribution": "which distribution of sizes",
    "exceed": "how often a column exceeds a value",
    "extrema": "smallest and largest value",
    "fit": "a distribution to fit to the sizes of a file",
    "film.oil": "the oil",
    "formula.name": "which film formula",
    "heights.name": "which distribution of heights",
    "iso14644": "class of a clean room, whose particles settle during `exposure`",
    "iso4406": 'cleanliness code of an oil, "18/16/13"',
    "as4059": "cleanliness class of an oil after SAE AS4059",
    "nas1638": "cleanliness class of an oil after NAS 1638",
    "law.law": "law of the contact on each side of a particle",
    "particle_law.law": "law of the contact on each side of a particle",
    "line": "filters of one line stand one behind the other, others side by side",
    "level": "which end of the range of each code number",
    "limit": "which limit of the range that the standard allows for the dust",
    "max_iterations": "iterations after which a state counts as not converged",
    "mean": "mean value",
    "name": "which law or distribution; of a material or population a label",
    "normalise": "divide the truncated density by its mass (`horng2022`)",
    "plastic": "keep the second integral (`horng2022`)",
    "process": "how the face was finished",
    "quantiles": "quantiles of each column",
    "ratios": "ratios of the radii R′/R″, one for each class",
    "rear": "support of the rear half of a ploughing contact over that of the front half",
    "reduce": "what to keep of the states instead of all of them",
    "rule": "where particles lie",
    "samples": "how many samples",
    "seed": "seed of the random numbers; the same seed gives the same result",
    "shape.kind": "round or with faces",
    "sizes": "a file of counted or sieved sizes",
    "source": "where the numbers are from",
    "spacing": "even steps of the value or of its logarithm",
    "sweep.design": "all combinations, in pairs, or drawn",
    "test_dust": 'standard test dust, "A2"',
    "vary": "inputs and the values they take",
    "weighting": "what the file counts",
}


def meaning_of(path, key, what):
    """What a key is: its own words, else those for its place or its name."""
    if what and not what.startswith("one of "):
        return what
    last = path.rpartition(".")[2]
    return MEANING.get(f"{last}.{key}") or MEANING.get(key, "")


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


HEAD = (
    "| key | what it is | what stands there | default | example |",
    "|---|---|---|---|---|",
)


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
        """The keys of one table, and after it the tables that may stand in it."""
        self.seen[frozenset(table["properties"])] = path
        self.lines += [f"({label(path)})=", title, "", *([intro, ""] if intro else []), *HEAD]
        later = []
        for key, each in table["properties"].items():
            what, _, example = each.get("description", "").partition("e.g. ")
            what = meaning_of(path, key, what.rstrip(" ,"))
            cells = [
                code(key),
                what if "](" in what else cell(what),
                "; ".join([*filter(None, [written(each)]), *self.inner(path, key, each, later)]),
                default_of(key, each, table.get("required", [])),
                code(example.strip().replace("|", "/")),
            ]
            self.lines.append(f"| {' | '.join(cells)} |")
        self.lines.append("")
        for inner_path, inner in later:
            self.section(inner_path, f"### `{inner_path}`", inner)

    def inner(self, path, key, schema, later):
        """Links to the tables that may stand under a key; new ones are put off until later."""
        for table in tables_in(schema):
            names = frozenset(table["properties"])
            shared = next((kind for kind, some in SHARED.items() if some <= names), None)
            if shared:
                self.shared.setdefault(shared, table)
                yield f"a [{shared}](#study-{shared})"
            elif place := self.seen.get(names):
                yield f"a table as [{place}](#{label(place)})"
            else:
                place = self.seen[names] = f"{path}.{key}"
                later.append((place, table))
                yield f"a table [{place}](#{label(place)})"


def default_of(key, schema, needed):
    """What counts where a key is left out."""
    if key in needed:
        return "needed"
    if "default" not in schema:
        return ""
    default = schema["default"]
    return code(str(default).lower() if isinstance(default, bool) else number(default))


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
            name_of, what = record
            rows.append(f"| {code(name_of.replace('|', '/'))} | {cell(what)} |")
        lines += ["| argument or option | what it does |", "|---|---|", *rows, ""]
    return "\n".join(lines)


def attributes_of(kind):
    """What the fields of a class hold: its section Attributes, else the text below each field."""
    from sphinx.pycode import ModuleAnalyzer

    text = inspect.cleandoc(kind.__doc__ or "")
    section = re.search(r"^Attributes\n-+\n(.*?)(?=^\w[\w ]*\n-{3,}\n|\Z)", text, re.S | re.M)
    entries = re.findall(
        r"^(\S.*)\n((?:[ ].*\n?|\n)*)", (section[1] if section else "") + "\n", re.M
    )
    out = {}
    for head, body in entries:
        names, _, type_of = head.partition(" : ")
        out[names] = " ".join(body.split()) or type_of
    below = ModuleAnalyzer.for_module(kind.__module__).find_attr_docs()
    for (owner, name), lines in below.items():
        if owner == kind.__name__:
            out.setdefault(name, " ".join(" ".join(lines).split()))
    return out


def columns():
    """Every result, its columns and what else it holds."""
    import thirdbody as tb
    from thirdbody.quantities.record import declared_columns

    lines = []
    for name in tb.results.__all__:
        kind = getattr(tb.results, name)
        if not inspect.isclass(kind):
            continue
        declared = declared_columns(kind) if dataclasses.is_dataclass(kind) else {}
        others = {key: say for key, say in attributes_of(kind).items() if key not in declared}
        if issubclass(kind, enum.Enum):
            others = {member.name: f"{member.value}: {member.sentence}" for member in kind}
        first = inspect.cleandoc(kind.__doc__).splitlines()[0]
        lines += [f"## `{name}`", "", markdown_of(first), ""]
        if declared:
            lines += ["| column | symbol | unit | meaning |", "|---|---|---|---|"]
            lines += [
                f"| {code(key)} | {' | '.join(map(cell, about))} |"
                for key, about in declared.items()
            ]
            lines.append("")
        if others:
            lines += ["| holds | what it is |", "|---|---|"]
            lines += [
                f"| {', '.join(map(code, key.split(', ')))} | {markdown_of(say)} |"
                for key, say in others.items()
            ]
            lines.append("")
    return "\n".join(lines)


def markdown_of(text):
    """A sentence of a docstring, in Markdown: names in backticks stay code."""
    return cell(re.sub(r":\w+:`([^`]*)`", r"`\1`", text).replace("``", "`"))


def explicit_tables():
    """Load shares that were pressed point by point, beside those of the model."""
    from thirdbody.papers import seats
    from thirdbody.papers.explicit import page

    return page.markdown(seats.comparison()).strip()


GENERATED = {
    "study-file": study_file,
    "commands": commands,
    "columns": columns,
    "explicit-tables": explicit_tables,
}


def insert_generated(text):
    """The text of a page with its generated parts in place."""
    return FENCE.sub(lambda found: GENERATED[found[1]](), text)
