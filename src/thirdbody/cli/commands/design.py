"""``thirdbody design``: the best inputs over a range of loads, under limits."""

from __future__ import annotations

import sys
from contextlib import nullcontext
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...errors import InvalidValue, Mistake, Problem
from ...quantities.progress import heartbeat
from ...quantities.say import concentration_of, join_words, number, percent, value_of
from ...quantities.tables import Table, WordTable
from ..options import Force, JsonFile, ParquetFile, Settings, XlsxFile, argument, option, read_study
from ..show import MOST_ROWS, some, terminal
from ..streams import STDOUT, TableFiles, figure_format, tell_written, warn_of, write_figure

if TYPE_CHECKING:
    from rich.console import Console

    from ...analysis.design.design import Best
    from ...study import Study
    from ...views.workbook import Sheet

__all__ = ["command"]


@dataclass(frozen=True, kw_only=True)
class Options:
    """Options of the command."""

    study: Path = argument("A study file with a table [design], or [life.design].", "STUDY.toml")
    json: JsonFile = None
    csv: Path | None = option(
        "--csv", "Write a table, one row per point tried, e.g. a.csv.", "FILE"
    )
    xlsx: XlsxFile = None
    parquet: ParquetFile = None
    force: Force = False
    figure: Path | None = option(
        "--figure", "Draw the points tried, as .png, .svg or .pdf.", "FILE"
    )
    settings: Settings = None


def command(options: Options) -> None:
    """The best size, concentration or roughness, under limits.

    Over a range of loads.
    """
    from ...study.analyses import design_study
    from ...study.life_design import asks_for_design

    if asks_for_design(options.study, options.settings or ()):
        _choose_for_oil(options)
        return
    files = TableFiles(options.csv, options.xlsx, options.parquet, options.json)
    study = read_study(options.study, options.settings, writes=[*files.paths, options.figure])
    files.need(options.figure, force=options.force)
    if options.figure is not None:
        figure_format(options.figure)  # refused before long work
    bar = sys.stderr.isatty()
    with nullcontext() if bar else heartbeat("design"):
        best = design_study(study, progress=bar)
    warn_of(best.warnings)
    columns = {name: column.array.tolist() for name, column in best.of_points.items()}
    units = {name: column.unit for name, column in best.of_points.items()}
    files.write(
        columns,
        units,
        sheets=partial(_sheets, study, best, columns, units),
        data=lambda: {"title": study.title, **best.to_dict()},
    )
    tell_written(*files.paths)
    if options.figure is not None:
        from ...views.plot.design import plot_trials

        write_figure(options.figure, plot_trials(best))
    if options.json != STDOUT:
        _page(study, best)


def _choose_for_oil(options: Options) -> None:
    """The smallest filter for a code, or the choice with the longest time to an event."""
    from ...study.run_life import load_oil
    from ...study.run_life_design import design_life
    from ...views import life_design_words as words
    from ..answers import give_answer, read_question

    if options.figure is not None:
        raise InvalidValue(
            Problem(
                "--figure",
                "draws the points of [design]; [life.design] has none",
                code=Mistake.MISSING,
            )
        )
    files = TableFiles(options.csv, options.xlsx, options.parquet, options.json)
    question = read_question(load_oil, options.study, options.settings, files, force=options.force)
    with heartbeat("design"):
        result = design_life(question)
    give_answer(
        result,
        files,
        settings=options.settings,
        answer=words.answer(result),
        table=WordTable(words.heads(result), words.rows(result), words.MEANS),
        last=words.last_words(result),
    )


def _sheets(
    study: Study, best: Best, columns: dict[str, list[object]], units: dict[str, str]
) -> list[Sheet]:
    from ...contact.citations import cite
    from ...contact.evaluation import bodies_of
    from ...study.toml import heading_of
    from ...views.question_sheets import inputs_of, question_sheets

    said = _Words(study, best)
    return question_sheets(
        heading_of(study.title or "design", study.settings),
        said.answer(),
        said.chosen_rows(),
        [f"limits in force: {said.limits('; '.join(best.active)) or 'none'}"],
        states=(columns, units),
        meanings={name: column.meaning for name, column in best.of_points.items()},
        inputs=inputs_of({"": best.contact}, bodies_of(best.contact)),
        warnings=best.warnings,
        citations=cite(best.contact).splitlines(),
    )


def _page(study: Study, best: Best) -> None:
    from ...analysis.design.design import FLAT
    from ...study.toml import heading_of

    out = terminal()
    out.print(heading_of(study.title or "design", study.settings))
    said = _Words(study, best)
    for sentence in said.answer():
        out.print(sentence)
    front = best.of_points["front"].array.tolist()
    several = len(best.objectives) > 1
    out.print("\none of the best" if several else "\nbest")
    heads, rows = said.chosen_rows()
    table = Table(heads, right=True, words=["chosen"])
    for row in rows:
        table.add_row(*row)
    out.print(table)
    for name, (low, high) in best.plateau.items():
        ends = f"{said.amount(name, low)} to {said.amount(name, high)}"
        out.print(f"{said.name(name)}: from {ends}, equal within {percent(FLAT)}.")
    for label, value in best.objectives.items():
        out.print(said.result_of(label, value))
    out.print(f"limits in force: {said.limits('; '.join(best.active)) or 'none'}")
    _against_load(out, best, said)
    if best.slopes:
        out.print(
            "change of a number for a relative change of an input, d/d ln, at "
            f"{said.middle_load()}; units as above"
        )
        inputs = {name: said.name(name) for name in next(iter(best.slopes.values()))}
        table = Table(("change of", *inputs.values()), right=True, words=["change of"], wrap=True)
        for column, slopes in best.slopes.items():
            table.add_row(column, *map(number, slopes.values()))
        out.print(table)
    if several:
        out.print(f"{sum(front)} of {len(front)} points are beaten by none in every objective")
        every, first = best.of_points, next(iter(best.objectives))
        on_front = [i for i, on in enumerate(front) if on]
        chosen = sorted(on_front, key=lambda i: every[first].array[i].item())
        names = [*map(said.name, best.values), *map(said.objective, best.objectives)]
        table = Table(names, right=True, wrap=True)
        for i in some(len(chosen)):
            one = {name: points.array[chosen[i]].item() for name, points in every.items()}
            cells = [said.amount(name, one[name]) for name in best.values]
            cells += [said.metric(name, one[name]) for name in best.objectives]
            table.add_row(*cells)
        out.print(table)


class _Words:
    """Names and amounts of a design as its reader knows them."""

    def __init__(self, study: Study, best: Best) -> None:
        from ...study.analyses import arguments

        self.contact, self.best = best.contact, best
        keywords = arguments(study)
        self.fluid, self.study_limits = keywords.get("suspension"), keywords.get("limits", ())
        self.study_objectives = {objective.label: objective for objective in keywords["objective"]}

    def name(self, name: str) -> str:
        from ...analysis.inputs import words_of

        return words_of(self.contact, name)

    def amount(self, name: str, value: Any) -> str:
        """A value of a variable."""
        from ...analysis.design.search import AMOUNT
        from ...analysis.inputs import declared_quantity

        if name == AMOUNT and self.fluid is not None:
            return concentration_of(float(value), self.fluid.by)
        if not isinstance(value, (int, float)):
            return value if isinstance(value, str) else str(value.name)
        return value_of(value, declared_quantity(self.contact, name.split("+")[0])["unit"], 3)

    def answer(self) -> list[str]:
        """What to take, or why nothing obeys the limits."""
        best = self.best
        if best.feasible:
            return [self.sentence()]
        why = self.limits(best.reason)
        return [f"Nothing tried obeys the limits. Nearest is what follows: {why}", self.sentence()]

    def chosen_rows(self) -> tuple[tuple[str, ...], list[list[str]]]:
        """Heads, and a row for each variable: its value and how far it may be off."""
        rows = []
        for name, value in self.best.values.items():
            band = self.best.tolerance.get(name)
            ends = [self.amount(name, end) for end in band] if band else ["", ""]
            rows.append([self.name(name), self.amount(name, value), *ends])
        return ("chosen", "value", "within 5 % from", "to"), rows

    def sentence(self) -> str:
        """Sentence on the best inputs, their tolerance, and the results there."""
        chosen = []
        for name, value in self.best.values.items():
            band = self.best.tolerance.get(name)
            within = ""
            if band:
                low, high = (self.amount(name, end) for end in band)
                within = f" (within 5 % of the best from {low} to {high})"
            chosen.append(f"{self.name(name)} {self.amount(name, value)}{within}")
        gives = [
            self.aim(label) + self.result_of(label, value)
            for label, value in self.best.objectives.items()
        ]
        best = "Best" if len(gives) == 1 else "One of the best"
        best = best if self.best.feasible else "Nearest"
        return f"{best}: {join_words(chosen)}, for {join_words(gives)}."

    def aim(self, label: str) -> str:
        """What is sought of an objective, before its name; nothing where nothing is reached."""
        aim = self.study_objectives[label].aim
        return f"the {aim} " if self.best.feasible and aim != "window" else ""

    def result_of(self, label: str, value: float) -> str:
        """An objective, its value, and of which of several loads it is."""
        objective = self.study_objectives[label]
        one = len(self.best.loads) == 1 or objective.aim == "window"
        of = {"mean": " (mean over the loads)", "worst": " (at the worst of the loads)"}
        over = "" if one else of[objective.over_loads]
        return f"{self.objective(label)} = {self.metric(label, value)}{over}"

    def middle_load(self) -> str:
        """The load at which slopes are taken."""
        middle = value_of(self.best.middle_load, "Pa" if self.best.load == "pressure" else "1")
        return f"{self.best.load} = {middle}"

    def about(self, of: str) -> tuple[str, str]:
        """Unit and meaning of a number of the states."""
        if of in self.best.of_states:
            about = self.best.of_states[of]
            return about.unit, about.meaning
        return "1", of

    def objective(self, label: str) -> str:
        objective = self.study_objectives[label]
        how = " ".join(label.split(":")[1:])
        return f"{self.about(objective.of)[1]} {objective.of}" + (f" ({how})" if how else "")

    def metric(self, label: str, value: float) -> str:
        objective = self.study_objectives[label]
        unit = "1" if objective.aim == "window" else self.about(objective.of)[0]
        return value_of(value, unit)

    def limits(self, text: str) -> str:
        """Limits in words, in the order in which they stand."""
        for limit in self.study_limits:
            unit, meaning = self.about(limit.of)
            said = [
                f"{word} {value_of(value, unit)}"
                for word, value in (("at least", limit.least), ("at most", limit.most))
                if value is not None
            ]
            text = text.replace(str(limit), f"{meaning} {' and '.join(said)}")
        return text.replace("A_t <", "real contact area over the nominal area <")


def _against_load(out: Console, best: Best, said: _Words) -> None:
    """Numbers against the loads."""
    units = {name: column.unit for name, column in best.of_states.items()}
    legend = {
        name: said.about(name)[1] + (", no unit" if unit == "1" else "")
        for name, unit in units.items()
    }
    head, unit = ("pressure", "Pa") if best.load == "pressure" else ("F*", "1")
    legend[head] = "nominal pressure p" if best.load == "pressure" else "load F/(A_n E_ss), no unit"
    table = Table((head, *units), right=True, legend=legend, wrap=True)
    count = len(best.loads)
    for i in some(count):
        columns = best.of_states.items()
        cells = (value_of(column.array[i].item(), units[name]) for name, column in columns)
        table.add_row(value_of(float(best.loads[i]), unit), *cells)
    out.print(table)
    if count > MOST_ROWS:
        out.print(f"{MOST_ROWS} of {count} loads shown; --json has all of it\n")
