"""The lubricated contact: friction, load shares and film thickness over speed."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from typing import NamedTuple

import numpy as np
from nicegui import ui

from ...errors import ThirdBodyError
from ...quantities.say import value_of
from ...study import FilmResult
from ...study.dirty_oil import dirty_oil, read_filter
from ...study.film import SHAPES, SPEED
from ...study.run import MOST_SPEEDS, run_film_curve
from ...systems.film_conditions import Entrainment, FilmConditions
from ...systems.film_formulas import Oil as OilProperties
from ...views import oil_words
from ...views.film_regimes import OF_PARTICLES, bands_of
from ...views.film_words import point, summary
from ..fields import Field, engineering, fields_of, number_field
from ..figures import GREY, Figure, band, figure, line, log_title, mark
from ..inputs import Inputs
from ..sliders import Slider
from ..solver import ask_for_page
from ..soon import Soon
from ..state import Answer, State, look, surface_key
from ..text import as_shown
from ..widgets import Facts, Plot, set_attributes, show_figures
from ..widgets import table as shown_table

__all__ = ["START", "TITLE", "build", "film_figures"]

TITLE = "Film"
START: dict[str, object] = {
    "load": "20 N",
    "speed": {"from": "5 mm/s", "to": "20 m/s", "points": 60, "spacing": "log"},
    "conjunction": {"shape": "point", "R": "9.5 mm"},
    "oil": {"eta": "20 mPa s", "alpha": "20 / GPa"},
}
BEGUN = (
    "Shown for a ball of 9.5 mm radius under 20 N in oil of 20 mPa s. A film carries the load "
    "together with asperities and particles; add it to set bodies, oil and speed."
)
RANGE = START["speed"]
BODIES = {
    "point": {"shape": "point", "R": "9.5 mm"},
    "line": {"shape": "line", "R": "9.5 mm", "length": "10 mm"},
}
DIRT = {"concentration": 1e-6, "entry_ratio": 1.0, "friction": 0.1}
FILTER_OF_STUDY = "that of film.filter in the study, unless another stands here, e.g. 5=75, 10=1000"
FILTER = "as on a data sheet, e.g. 5=75, 10=1000; left out: the oil as it is"
UNKNOWN = "not known"
"""A number that is not there: it is left out."""
SHADE = {"boundary": 0.35, "mixed": 0.15, "full film": 0.0}
CURVES: dict[str, dict[str, tuple[str, int]]] = {
    "film friction": {
        "mu": ("sum", 3),
        "mu_film": ("film", 0),
        "mu_ss": ("asperities", 1),
        "mu_sa": ("particles", 2),
    },
    "film shares": {
        "film_share": ("film", 0),
        "ss_share": ("asperities", 1),
        "sa_share": ("particles", 2),
    },
    "film thickness": {
        "lambda_ratio": ("film over roughness λ", 0),
        "h_over_x": ("gap over particle", 2),
    },
}
"""Columns of each figure, what they are called, and which ink draws them."""
AXES = {
    "film friction": ("friction coefficient μ", "Friction"),
    "film shares": ("share of the load [%]", "Who carries the load"),
    "film thickness": ("thickness ratio", "How thick the film is"),
}


def _solve_film_curve(answer: Answer) -> tuple[FilmResult, int]:
    return run_film_curve(answer.study)


class Oil(NamedTuple):
    """What the particles of the oil do: sentences, and a table with its heads."""

    sentences: list[str]
    heads: tuple[str, ...]
    rows: list[list[str]]


def oil_of(answer: Answer, fine: str) -> Oil | None:
    """What the particles of a study's oil do, before and after a filter where one is written."""
    oil = dirty_oil(answer.study)
    if oil is None:
        return None
    if not fine and answer.study.filter is None:
        return Oil(oil_words.answer(oil), tuple(oil_words.HEADS), oil_words.rows(oil))
    filter = read_filter(fine) if fine else answer.study.filter
    filtered = dirty_oil(answer.study, filter=filter)
    assert filtered is not None
    sentences = [oil_words.filter_answer(oil, filtered), *oil_words.answer(oil)]
    return Oil(sentences, ("", "before", "after the filter"), oil_words.filter_rows(oil, filtered))


def film_figures(result: FilmResult, i: int) -> dict[str, Figure]:
    """Three figures over speed, with the regimes behind the curves and the speed i marked."""
    states = result.states
    u = np.asarray(states["speed"], float)
    shapes, notes = [], []
    for low, high, word in bands_of(u, result.regime_speeds):
        shapes.append(band(low, high, GREY, SHADE[word]) | {"layer": "below"})
        notes.append(log_title(mark(float(np.sqrt(low * high)), word)[1]))
    shapes.append(mark(float(u[i]), "", dash="solid")[0])
    out = {}
    for name, curves in CURVES.items():
        traces = []
        for column, (label, number) in curves.items():
            if column in OF_PARTICLES and not result.passing:
                continue
            y = np.asarray(states[column], float)
            style = {"color": GREY, "dash": "solid"} if column == "mu" else {}
            scaled = 100 * y if name == "film shares" else y
            traces.append(line(u, scaled, label, number, line=style))
        y_title, title = AXES[name]
        out[name] = figure(
            traces,
            x="entrainment speed [m/s]",
            y=y_title,
            title=title,
            ylog=name == "film thickness",
            shapes=shapes,
            annotations=notes,
        )
        out[name]["layout"]["margin"]["t"] = 64
    out["film shares"]["layout"]["yaxis"]["range"] = [-2, 102]
    out["film friction"]["layout"]["yaxis"]["rangemode"] = "tozero"
    return out


def build(state: State, again: Callable[[], None]) -> Callable[[], Awaitable[None]]:
    """Entries, a slider over the speed, facts, three figures."""
    return Film(state).draw


class Film:
    """The table [film] and what it says at one speed."""

    def __init__(self, state: State) -> None:
        self.state = state
        self.inputs = Inputs(state, self._refresh_form)
        self.answer: Answer | None = None
        """Whose film is shown."""
        self.start: tuple[Answer, Answer | None] | None = None
        """A study without a film, and its answer with one to begin with."""
        self.result: FilmResult | None = None
        """What was found for the answer."""
        self.i = 0
        """The speed that is shown."""
        self.shown_entries: object = None
        """What decides which entries the form has."""
        self.plots: dict[str, Plot] = {}
        self.spoken: tuple[FilmResult, list[str]] | None = None
        """What the sentences are of."""
        self.soon = Soon(self._show)
        self.wrong = ui.label().classes("problem").props('role=alert data-said="film"')
        self.words = ui.column().classes("w-full gap-1 headline-place")
        self.dents = ui.column().classes("w-full gap-1")
        self.dents.set_visibility(False)  # until there is an oil with particles
        with self.dents:
            self.oil_rows = ui.column().classes("w-full scroll-x")
            self.fine = ui.input("a filter: its β ratio at sizes").classes("w-full narrow")
            set_attributes(self.fine, {"data-path": "film.filter", "hint": FILTER})
            self.fine.props("dense debounce=400").on_value_change(self._show_filter)
        with ui.element("div").classes("figures w-full") as self.grid:
            with ui.column().classes("w-full gap-1") as self.beside:
                self._results()
            with ui.column().classes("w-full entries"):
                self._form()

    def _refresh_form(self) -> None:
        self._form.refresh()

    @ui.refreshable_method
    def _form(self) -> None:
        self.shown_entries = _kind_of_entries(self.state)
        self.inputs.shown.clear()
        with ui.column().classes("w-full gap-2 narrow"):
            _entries(self.inputs, self.state)
            self.inputs.rest = ui.column().classes("w-full")

    def _results(self) -> None:
        self.said = ui.label().classes("hint").props('data-fact="film speed"')
        self.slider = Slider(min=0, max=MOST_SPEEDS, step=1, value=0)
        self.slider.props('aria-label="speed" data-slider="film.speed"').classes("q-px-sm")
        self.slider.on_value_change(self._follow_slider)
        self.facts = Facts(kind="film: ")
        with ui.element("div").classes("pair w-full"):
            self.plots = {name: Plot(name) for name in CURVES}
        with ui.expansion("More about the film").classes("w-full").props("dense"):
            self.more = ui.column().classes("w-full gap-1")

    async def _show(self) -> None:
        """Facts and figures at the speed of the slider."""
        result, i = self.result, self.i
        if result is None:
            return
        said = f"speed {value_of(result.states['speed'][i], 'm/s')}"
        self.said.set_text(said)
        self.slider.speak(said)
        every = point(result, i).items()
        self.facts.show((name, said) for name, said in every if said != UNKNOWN)
        has_friction = bool(np.isfinite(result.states["mu"][i]))
        self.plots["film friction"].widget.set_visibility(has_friction)
        made = film_figures(result, i)
        await show_figures((plot, made[name]) for name, plot in self.plots.items())

    def _follow_slider(self) -> None:
        i = int(self.slider.value or 0)
        if self.result is not None and i != self.i:
            self.i = i
            self.soon()

    async def draw(self) -> None:
        if _kind_of_entries(self.state) != self.shown_entries:  # undone, or another study
            self._refresh_form()
        has_entries = isinstance(self.state.get("film"), dict)
        self.grid.classes(**{"remove" if has_entries else "add": "alone"})
        self.inputs.show_mistakes()
        answer = await self._with_film()
        for element in (self.words, self.beside):
            element.set_visibility(answer is not None)
        if answer is None:
            self.dents.set_visibility(False)
        if answer is None or answer is self.answer:
            return
        before = self.result
        result, middle = await ask_for_page(_solve_film_curve, answer)
        kept = before is not None and np.array_equal(before.states["speed"], result.states["speed"])
        self.answer, self.result = answer, result
        self.i = self.i if kept else middle
        set_attributes(self.slider, {"max": len(result.states["speed"]) - 1})
        self.slider.set_value(self.i)
        if not self.dents.visible:  # the oil had no particles, and hardly has now
            self._say(result, [])
        drawing = asyncio.ensure_future(self._show())  # while the oil is asked for
        try:
            await self._show_answer(answer, result)
        finally:
            await drawing

    async def _with_film(self) -> Answer | None:
        """The answer of the study, or of the study with a film to begin with."""
        state, answer = self.state, self.state.answer
        assert answer is not None
        self.wrong.set_text("")
        if answer.study.film is not None:
            return answer
        if self.start is None or self.start[0] is not answer:
            study, surface = state.study | {"film": START}, state.surfaces
            measured = surface.get(surface_key(study, state.folder))
            begun, problems, _ = await ask_for_page(look, study, state.folder, measured)
            self.start = (answer, begun)
            self.wrong.set_text(as_shown("; ".join(problems)))
        return self.start[1]

    async def _show_answer(self, answer: Answer, result: FilmResult) -> None:
        """The answer in sentences: what the particles of the oil do, then the film."""
        wrong = ""
        try:
            oil = await ask_for_page(oil_of, answer, str(self.fine.value or ""))
        except ThirdBodyError as error:
            oil, wrong = None, "; ".join(getattr(error, "problems", None) or [str(error)])
            self.wrong.set_text(wrong)
        if answer is not self.answer:
            return
        hint = FILTER if answer.study.filter is None else FILTER_OF_STUDY
        set_attributes(self.fine, {"hint": hint})
        # a filter with a mistake stays where it can be mended
        self.dents.set_visibility(oil is not None or bool(self.fine.value and wrong))
        self.state.note("film", result.run_warnings)
        self._say(result, [] if oil is None else oil.sentences)
        self.oil_rows.clear()
        if oil is not None:
            with self.oil_rows:
                heads = {f"c{i}": head for i, head in enumerate(oil.heads)}
                rows = [dict(zip(heads, row, strict=True)) for row in oil.rows]
                shown_table("oil", heads, rows)

    def _say(self, result: FilmResult, sentences: list[str]) -> None:
        """The answer: what is said of the oil, and of the film the rest; else of the film."""
        if self.spoken == (result, sentences):
            return
        self.spoken = result, sentences
        said, more = sentences, summary(result)
        if not said:
            said, more = more[:1], more[1:]
        self.words.clear()
        with self.words:
            for i, text in enumerate(said):
                style = "whole-contact" if i == 0 else ""
                set_attributes(
                    ui.label(as_shown(text)).classes(style), {"data-fact": f"film: answer {i}"}
                )
        self.more.clear()
        with self.more:
            for text in more:
                ui.label(as_shown(text)).classes("hint")

    async def _show_filter(self) -> None:
        if self.answer is not None and self.result is not None:
            self.wrong.set_text("")
            await self._show_answer(self.answer, self.result)


class _Kind(NamedTuple):
    """Which entries the table [film] needs; none of it changes while a number is typed."""

    own_bodies: str | None
    """The shape of bodies that the film has for itself; None for those at the side."""
    own_speed: bool
    speed_range: bool
    entrainment: bool


def _kind_of_entries(state: State) -> _Kind | None:
    """Which entries there are, None where there is no film."""
    table = state.get("film")
    if not isinstance(table, dict):
        return None
    bodies = table.get("conjunction")
    shape = str(bodies.get("shape")) if isinstance(bodies, dict) else "point"
    return _Kind(
        own_bodies=shape if bodies is not None or state.get("body") is None else None,
        own_speed="speed" in table or state.get("body", "shaft_speed") is None,
        speed_range=isinstance(table.get("speed"), dict),
        entrainment=isinstance(table.get("entrainment"), dict),
    )


def _entries(inputs: Inputs, state: State) -> None:
    """The table [film], entry by entry."""
    kind = _kind_of_entries(state)
    if kind is None:
        ui.label(BEGUN).classes("hint")
        ui.button("Add a film", icon="add", on_click=lambda: inputs.change("film", START)).props(
            'no-caps data-path="film.add"'
        )
        return
    fields = {field.name: field for field in fields_of(FilmConditions)}
    if kind.own_bodies is not None:
        inputs.field(("film",), fields["load"])
        _bodies(inputs, kind.own_bodies)
    else:
        ui.label("Bodies and load are those at the side.").classes("hint")
    if kind.own_speed:
        _speed(inputs, kind.speed_range)
    inputs.field(("film",), fields["slide_roll"])
    ui.label("oil").classes("subhead")
    for field in fields_of(OilProperties):
        inputs.field(("film", "oil"), field)
    with ui.expansion("more").classes("w-full"), ui.column().classes("w-full gap-2"):
        for name in ("hertz", "few", "most"):
            inputs.field(("film",), fields[name])
        if kind.entrainment:
            for field in fields_of(Entrainment):
                inputs.field(("film", "entrainment"), field)
        else:
            ui.button(
                "What the oil carries", on_click=lambda: inputs.change("film", "entrainment", DIRT)
            ).props("flat dense no-caps")
    ui.button("Remove the film", icon="delete", on_click=lambda: _remove_film(inputs, state)).props(
        'flat dense no-caps data-path="film.remove"'
    )


def _bodies(inputs: Inputs, shape: str) -> None:
    """The bodies of a film that has its own."""
    ui.label("bodies").classes("subhead")
    words = {"point": "point: a ball, a crowned roller", "line": "line: a roller, a gear tooth"}
    inputs.select(
        ("film", "conjunction", "shape"),
        words,
        shape,
        "kind of contact",
        lambda word: inputs.change("film", "conjunction", BODIES[word]),
    )
    for field in fields_of(SHAPES.get(shape, SHAPES["point"])):
        inputs.field(("film", "conjunction"), field)


def _speed(inputs: Inputs, is_range: bool) -> None:
    """One speed, or a range."""
    if not is_range:
        said = "one value with its unit, or several with commas between"
        inputs.field(("film",), Field(name="speed", kind="text", label="speed u [m/s]", about=said))
        ui.button("A range", on_click=lambda: inputs.change("film", "speed", RANGE)).props(
            "flat dense no-caps"
        )
        return
    for end in ("from", "to"):
        inputs.field(("film", "speed"), number_field(end, SPEED))
    points = Field(name="points", kind="text", label="points", about="how many speeds")
    inputs.field(("film", "speed"), points)


def _remove_film(inputs: Inputs, state: State) -> None:
    """The study without a film; it keeps a load."""
    answer = state.answer
    if state.get("load") is None and answer is not None:
        pressure = engineering(float(answer.study.values[0]), "Pa")
        state.replace({**state.study, "load": {"pressure": pressure}})
    inputs.change("film", None)
