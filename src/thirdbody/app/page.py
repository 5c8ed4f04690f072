"""The page: fields at the side, sliders on top, a tab for every question."""

from __future__ import annotations

import asyncio
import shutil
import time
from collections import deque
from collections.abc import Awaitable, Callable, Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

from nicegui import events, run, ui
from starlette.datastructures import QueryParams

from ..errors import InvalidValue, ThirdBodyError
from .address import FOLLOW, TRAVELLED, Address, beside_in, files_in, surface_in
from .examples import EXAMPLES, example
from .folders import Folders
from .look import LOOK, RESIZE
from .new_study import NewStudy
from .side import Side
from .sliders import Sliders
from .solver import Died, note_waits, solver
from .soon import Soon
from .state import State, files_of
from .tabs import GROUPS, LINES, TABS
from .text import as_shown, from_link
from .verdict import Verdict
from .widgets import set_attributes, skeleton
from .work import when_left

__all__ = ["Start", "page"]

SKIP = """event => {
  event.preventDefault();
  document.querySelector(event.currentTarget.getAttribute("href")).focus();
}"""


TURN = '() => setDark(!document.body.classList.contains("body--dark"))'
"""The framework's element for it would set the colours anew at every change of the page."""


GETTING = "Getting ready: the page loads and compiles what it needs, once after its start."
LEAST = 0.5
"""Seconds of starting that are told of."""
MOST_WAITS = 40
"""Calls of a page of which it is known how long they waited."""
LOOKS = 0.02
"""Seconds after which it is looked whether a tab that is drawn is still in sight."""
WITHOUT_ANSWER = ("surface", "dust", "take_away")
"""Tabs that a study with mistakes may need: there files are dropped, and its text stands."""


class Start:
    """What a page opens with.

    Parameters
    ----------
    study : dict, optional
        A parsed study file; the first of the examples when left out.
    folder : Path, optional
        Where the files lie that it names.
    """

    def __init__(
        self, study: dict[str, object] | None, folder: Path | None, folders: Folders
    ) -> None:
        self.study = example() if study is None else study
        self.folder = folder
        self.folders = folders

    def state(self, query: Mapping[str, str]) -> tuple[State, str]:
        """The state of a new page: that of the link, or the start; and what to tell."""
        page_folder = self.folders.new()
        study, at, tab, message = self.read(query)
        opened, kept, chosen = beside_in(query) if "study" in query else (None, None, "")
        named = [
            name for one_study in (study, opened or {}, kept or {}) for name in files_of(one_study)
        ]
        if self.folder is not None:
            for name in files_of(self.study):
                beside = self.folder / name
                if Path(name).name in named and beside.is_file():
                    shutil.copyfile(beside, page_folder / Path(name).name)
        state = State(study, page_folder, at, later=True)
        state.tab = tab
        state.opened, state.kept, state.beside = opened or study, kept, chosen
        state.shelf = self.folders.shelf
        self.give(state, query)
        return state, message

    def give(self, state: State, query: Mapping[str, str]) -> None:
        """What the address tells of files, and those that are still here."""
        state.surface = surface_in(query)
        for name, key in files_in(query).items():
            if state.files.get(name) == key:
                continue
            if self.folders.shelf.give(key, state.folder / name):
                state.files[name] = key
                state.read = None

    def read(self, query: Mapping[str, str]) -> tuple[dict[str, object], float | None, str, str]:
        """Study, operating load and tab of an address, and what to tell."""
        tab = query.get("tab", "")
        tab = tab if tab in TABS else TABS[0]
        if "study" not in query:
            return _plain_names(self.study), None, tab, ""
        try:
            at = float(query["at"]) if "at" in query else None
            return from_link(query["study"]), at, tab, ""
        except (InvalidValue, ValueError) as error:
            message = "; ".join(getattr(error, "problems", ["the link has no number after at="]))
            return example(), None, tab, f"{message}; here is the example instead"


def _plain_names(study: object) -> Any:
    """The study with files by their last names, as they lie in the folder of the page."""
    if isinstance(study, dict):
        out = {}
        for key, value in study.items():
            if key in ("topography", "sizes", "materials") and isinstance(value, (str, list)):
                one = isinstance(value, str)
                names = [
                    Path(v).name if isinstance(v, str) else v for v in ([value] if one else value)
                ]
                out[key] = names[0] if one else names
            else:
                out[key] = _plain_names(value)
        return out
    return [_plain_names(item) for item in study] if isinstance(study, list) else study


def _time_words(seconds: float, since: float) -> str:
    """How long the answer took, and how long before it a process was being started."""
    starting = solver().starting_seconds(since)
    text = f"answered in {_time(max(seconds - starting, 0.0))}"
    if starting < LEAST:
        return text
    return f"{text}, after {starting:.0f} s in which the page was getting ready"


def _time(seconds: float) -> str:
    """A time as it is told.

    >>> _time(0.084), _time(1.2345), _time(31.2)
    ('84 ms', '1.2 s', '31 s')
    """
    if seconds < 1:
        return f"{max(1e3 * seconds, 1):.0f} ms"
    return f"{seconds:.1f} s" if seconds < 10 else f"{seconds:.0f} s"


def page(state: State, message: str, start: Start) -> None:
    """Put everything on the page of one visitor; what is computed follows."""

    def close_state() -> None:
        state.close()
        shutil.rmtree(state.folder, ignore_errors=True)

    ui.context.client.on_delete(close_state)
    when_left(state.close)
    ui.add_css(LOOK)
    ui.add_body_html(RESIZE + FOLLOW)
    ui.colors(primary="#0072B2", accent="#D55E00", positive="#009E73", negative="#b3261e")
    Page(state, message, start)


class Page:
    """Header, entries at the side, sliders and tabs; and what happens between them."""

    def __init__(self, state: State, message: str, start: Start) -> None:
        self.state, self.message, self.start = state, message, start
        self.waits: deque[tuple[float, float]] = deque(maxlen=MOST_WAITS)
        """When calls of this page waited for a process."""
        self.waiting: dict[str, ui.element] = {}
        """What stands in the place of each tab until it is drawn."""
        self.draws: dict[str, Callable[[], Awaitable[None] | None]] = {}
        """How each tab that was opened is drawn."""
        self.drawing: dict[str, asyncio.Future[None]] = {}
        """Tabs that are being drawn: that in sight, and those that were left meanwhile."""
        self.client = ui.context.client
        self.travels = 0
        """How often back or forward was pressed."""
        skip = self._header()
        self.side = Side(state)
        whole = ui.column().classes("whole gap-2")
        set_attributes(skip, {"href": f"#{whole.html_id}"})
        with whole.props('tabindex=-1 role=region aria-label="the answer"'):
            with ui.row().classes("w-full items-center gap-3"):
                self.banner = ui.label(message).classes("problem")
                self.banner.props('role=alert data-said="page"')
                self.retry = ui.button("Try again", icon="refresh", on_click=self._try_again)
                self.retry.props('flat dense no-caps data-path="again"').set_visibility(False)
            self.getting = ui.label(GETTING).classes("hint")
            self.getting.props('role=status data-said="getting ready"').set_visibility(False)
            self.sliders = Sliders(state)
            with ui.element("div").classes("answer"):
                self._tabs()
            self.address = Address(state)
        self.new = NewStudy(state, self._show_new_study)
        self.soon = Soon(self._refresh)
        state.changed.append(self.soon)
        self.tabs.on_value_change(self._show_tab)
        ui.on(TRAVELLED, self._go_to_address)
        self.soon()

    # ------------------------------------------------------------------ what there is
    def _header(self) -> ui.element:
        """The bar on top; its first link skips the entries."""
        with ui.header(elevated=False).classes("items-center q-py-xs gap-2 no-wrap"):
            skip = ui.element("a").classes("skip")
            with skip:
                ui.label("Skip to the answer")
            skip.on("click", js_handler=SKIP)
            menu = ui.button(icon="tune", on_click=lambda: self.side.drawer.toggle())
            menu.props('flat dense color=white aria-label="inputs"')
            ui.html("thirdbody", sanitize=False, tag="h1").classes("name")
            ui.space()
            fresh = ui.button("New study", icon="add", on_click=lambda: self.new.open())
            fresh.props('flat dense no-caps color=white aria-label="a new study, from a drawing"')
            set_attributes(fresh.classes("fresh"), {"data-path": "new"})
            self.undo = ui.button(icon="undo", on_click=self._undo_change)
            self.undo.props('flat dense color=white aria-label="undo" data-path="undo"')
            self.names = ui.select(
                list(EXAMPLES),
                label="open an example",
                on_change=lambda e: self._open_example(e.value),
            )
            self.names.props('dense dark options-dense standout data-path="example"')
            self.names.classes("w-56 examples")
            with self.names.add_slot("prepend"):
                ui.icon("menu_book").classes("when-narrow")
            shade = ui.button(icon="contrast").on("click", js_handler=TURN)
            shade.props('flat dense color=white aria-label="light or dark"')
        return skip

    def _tabs(self) -> None:
        """A tab for every question, empty until it is opened."""
        self.tabs = ui.tabs().props("dense no-caps align=left outside-arrows mobile-arrows")
        with self.tabs.classes("w-full grouped"):
            for group, names in GROUPS.items():
                if group in LINES:
                    ui.element("span").classes("tab-line")
                set_attributes(ui.label(group).classes("tab-group"), {"aria-hidden": "true"})
                for name in names:
                    ui.tab(name, label=import_module(f".tabs.{name}", __package__).TITLE)
        self.verdict = Verdict(self.state)
        panels = ui.tab_panels(self.tabs, value=self.state.tab, animated=False)
        self.places = {}
        with panels.classes("w-full bg-transparent"):
            for name in TABS:
                with ui.tab_panel(name).classes("q-px-none"):
                    self.waiting[name] = skeleton()
                    self.places[name] = ui.column().classes("w-full gap-3")
                    self.places[name].set_visibility(False)

    # ------------------------------------------------------------------ what is shown
    async def _refresh(self) -> None:
        """Show the study as it is now; where no process lives to say what it is, say that."""
        note_waits(self.waits)
        self.getting.set_visibility(solver().preparing)
        try:
            await self._show_study()
        except Died as error:
            self.banner.set_text("; ".join(error.problems))
            self.retry.set_visibility(True)
            self.verdict.clock.set_text("")
        finally:
            self.getting.set_visibility(False)

    def _try_again(self) -> None:
        self.state.began = time.perf_counter()
        self.soon()

    async def _show_study(self) -> None:
        """Fields, sliders, the tab in sight."""
        state, library = self.state, self.state.library
        if state.study is not state.read and self.drawing:  # no tab is drawn of two studies
            await asyncio.wait(list(self.drawing.values()))
        await state.settle()
        if state.library != library:
            self.side.again()
        self.side.inputs.show_mistakes()
        self.sliders.show_study()
        self.undo.set_enabled(bool(state.past))
        remark = self.address.follow_study()
        if state.answer is None:
            self._say("; ".join(state.problems))
            if state.tab in WITHOUT_ANSWER:
                await self._draw_in_sight(state.tab)
            return
        wrong = self._wrong()
        if not self.retry.visible:  # mistakes that are mended are not told while the tab is drawn
            self._say(wrong or self.message)
        try:
            if not await self._draw_in_sight(state.tab):
                return  # another tab is asked for
        except Died:
            raise
        except ThirdBodyError as error:
            wrong = "; ".join(getattr(error, "problems", None) or [str(error)])
        self._say(wrong or self.message)
        self.verdict.clock.set_text(_time_words(time.perf_counter() - state.began, state.began))
        await self.verdict.show_sentence()
        self.verdict.note(remark)

    def _say(self, text: str) -> None:
        """What is told above the answer, where processes answer again."""
        self.banner.set_text(as_shown(text))
        self.retry.set_visibility(False)

    def _wrong(self) -> str:
        """What is told of a study with mistakes."""
        problems = self.state.problems
        if not problems:
            return ""
        if self.state.current:
            return "Outputs with mistakes, told beside their fields, are left out."
        return (
            f"The study has {len(problems)} mistake(s), shown beside the fields; "
            "shown is the last study without one."
        )

    async def _draw_in_sight(self, name: str) -> bool:
        """Draw a tab; whether it is still in sight then. One that is left ends beside the next."""
        while (drawing := self.drawing.get(name)) is not None:
            await asyncio.wait([drawing], timeout=LOOKS)
            if self.state.tab != name:
                return False
        self._build(name)
        self.drawing[name] = drawing = asyncio.ensure_future(self._draw(name))
        while not drawing.done():
            if self.state.tab != name:
                return False
            await asyncio.wait([drawing], timeout=LOOKS)
        drawing.result()
        return True

    def _build(self, name: str) -> None:
        """Build a tab when it is opened first, and show it."""
        if name not in self.draws:
            with self.places[name]:
                module = import_module(f".tabs.{name}", __package__)
                self.draws[name] = module.build(self.state, self.side.again)
        self._unveil(name)

    async def _draw(self, name: str) -> None:
        """Draw a tab to its end; what is wrong is told where it is still in sight."""
        try:
            with self.client:
                drawing = self.draws[name]()
                if drawing is not None:
                    await drawing
        except ThirdBodyError:
            if self.state.tab == name:
                raise
        finally:
            del self.drawing[name]

    def _unveil(self, name: str) -> None:
        """Show a tab in the place of what waits for it."""
        if name in self.waiting:
            self.waiting.pop(name).delete()
            self.places[name].set_visibility(True)

    # ------------------------------------------------------------------ what happens
    def _open_example(self, name: str | None) -> None:
        if name:
            self.names.set_value(None)
            self.state.open(example(name))
            self.side.again()

    def _show_new_study(self, tab: str) -> None:
        """A new study: the tab that answers it first."""
        self.tabs.set_value(tab)
        self.side.again()

    def _undo_change(self) -> None:
        self.state.undo()
        self.side.again()

    async def _go_to_address(self, event: events.GenericEventArguments) -> None:
        query = QueryParams(str(event.args).removeprefix("?"))
        self.travels = mine = self.travels + 1
        read = await run.io_bound(self.start.read, query)
        # None as the server ends; of several in a row the last counts, whichever is read first
        if read is None or mine != self.travels:
            return
        state = self.state
        self.start.give(state, query)
        study, at, state.tab, wrong = read
        if wrong:
            ui.notify(wrong)
        now = (state.study, state.wanted, self.tabs.value)
        if (study, at, state.tab) == now and state.read is not None:
            return
        state.travel(study, at)
        self.address.follow_browser()
        self.tabs.set_value(state.tab)
        self.side.again()

    def _show_tab(self) -> None:
        self.state.tab = str(self.tabs.value or TABS[0])
        self.verdict.turn()
        self.verdict.clock.set_text("")
        self.state.began = time.perf_counter()
        self.soon()
