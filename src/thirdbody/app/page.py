"""The page: fields at the side, sliders on top, a tab for every question."""

from __future__ import annotations

import asyncio
import shutil
import time
from collections.abc import Awaitable, Callable, Mapping
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any

from nicegui import background_tasks, events, run, ui
from starlette.datastructures import QueryParams

from ..errors import InvalidValue, ThirdBodyError
from ..study.tables import TABLES
from .address import FOLLOW, TRAVELLED, Address
from .examples import EXAMPLES, example
from .fields import Field
from .folders import Folders
from .inputs import FORMED, Inputs
from .look import LOOK, RESIZE
from .sliders import Sliders
from .state import State, files_of
from .tabs import TABS
from .text import from_link, with_micro, without_paths
from .widgets import put
from .work import when_left

__all__ = ["Start", "page"]

MORE = "More tables, as text"
SKIP = """event => {
  event.preventDefault();
  document.querySelector(event.currentTarget.getAttribute("href")).focus();
}"""


TURN = '() => setDark(!document.body.classList.contains("body--dark"))'
"""The framework's element for it would set the colours anew at every change of the page."""


class Start:
    """What a page opens with.

    Parameters
    ----------
    study : dict, optional
        A parsed study file; the first of the examples when left out.
    folder : Path, optional
        Where the files lie that it names.
    """

    def __init__(self, study: dict[str, Any] | None, folder: Path | None, folders: Folders) -> None:
        self.study = example() if study is None else study
        self.folder = folder
        self.folders = folders

    def state(self, query: Mapping[str, str]) -> tuple[State, str]:
        """The state of a new page: that of the link, or the start; and what to tell."""
        own = self.folders.new()
        study, at, tab, told = self.read(query)
        named = files_of(study)
        if self.folder is not None:
            for name in files_of(self.study):
                beside = self.folder / name
                if Path(name).name in named and beside.is_file():
                    shutil.copyfile(beside, own / Path(name).name)
        state = State(study, own, at, later=True)
        state.tab = tab
        return state, told

    def read(self, query: Mapping[str, str]) -> tuple[dict[str, Any], float | None, str, str]:
        """Study, operating load and tab of an address, and what to tell."""
        tab = query.get("tab", "")
        tab = tab if tab in TABS else TABS[0]
        if "study" not in query:
            return _plain_names(self.study), None, tab, ""
        try:
            at = float(query["at"]) if "at" in query else None
            return from_link(query["study"]), at, tab, ""
        except (InvalidValue, ValueError) as error:
            told = "; ".join(getattr(error, "problems", ["the link has no number after at="]))
            return example(), None, tab, f"{told}; here is the example instead"


def _plain_names(study: Any) -> Any:
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


class Soon:
    """Calls a function once for many requests that come together, and never twice at a time."""

    def __init__(self, call: Callable[[], Awaitable[None]]) -> None:
        self.call, self.asked, self.running = call, False, False
        self.client = ui.context.client

    def __call__(self) -> None:
        self.asked = True
        if not self.running:
            self.running = True
            background_tasks.create(self._run())

    async def _run(self) -> None:
        try:
            while self.asked and not self.client._deleted:
                await asyncio.sleep(0.005)
                self.asked = False
                with self.client:
                    await self.call()
        finally:
            self.running = False


def page(state: State, told: str, start: Start) -> None:
    """Put everything on the page of one visitor; what is computed follows."""
    client = ui.context.client

    def closed() -> None:
        state.close()
        shutil.rmtree(state.folder, ignore_errors=True)

    client.on_delete(closed)
    when_left(state.close)
    ui.add_css(LOOK)
    ui.add_body_html(RESIZE + FOLLOW)
    ui.colors(primary="#0072B2", accent="#D55E00", positive="#009E73", negative="#b3261e")

    def again() -> None:
        panel.refresh()

    inputs = Inputs(state, again)
    draws: dict[str, Callable[[], Awaitable[None] | None]] = {}
    opened_sections = {"Load", "Particles"}
    drawer: Any

    def folded(name: str, is_open: bool) -> None:
        (opened_sections.add if is_open else opened_sections.discard)(name)

    with ui.header(elevated=False).classes("items-center q-py-xs gap-2 no-wrap"):
        skip = ui.element("a").classes("skip")
        with skip:
            ui.label("Skip to the answer")
        skip.on("click", js_handler=SKIP)
        menu = ui.button(icon="tune", on_click=lambda: drawer.toggle())
        menu.props('flat dense color=white aria-label="inputs"')
        ui.html("thirdbody", sanitize=False, tag="h1").classes("name")
        ui.space()
        undo = ui.button(icon="undo", on_click=lambda: undone())
        undo.props('flat dense color=white aria-label="undo" data-path="undo"')
        names = ui.select(
            list(EXAMPLES), label="open an example", on_change=lambda e: opened(e.value)
        )
        names.props('dense dark options-dense standout data-path="example"').classes("w-56")
        shade = ui.button(icon="contrast").on("click", js_handler=TURN)
        shade.props('flat dense color=white aria-label="light or dark"')

    with ui.left_drawer(value=None, bordered=True).props(
        "width=340 breakpoint=900 aria-label=inputs"
    ) as drawer:

        def section(name: str, build: Callable[[], Any]) -> None:
            fold = ui.expansion(name, value=name in opened_sections).classes("w-full")
            fold.on_value_change(lambda e: folded(name, e.value))
            with fold, ui.column().classes("w-full gap-2"):
                build()

        @ui.refreshable
        def panel() -> None:
            inputs.shown.clear()
            with ui.column().classes("w-full gap-1"):
                inputs.rest = ui.column().classes("w-full")
                title = Field(name="title", kind="string", label="title", about="a line of text")
                inputs.field((), title)
                sections: dict[str, Callable[[], None]] = {
                    "Load": inputs.load,
                    "Particles": inputs.particles,
                    "Roughness": inputs.roughness,
                    "Surfaces": inputs.surfaces,
                    "Asperity law": inputs.asperity_law,
                }
                more = {
                    f"[{table.name}] as text": partial(inputs.as_text, table.name)
                    for table in TABLES
                    if table.name not in FORMED
                }
                for name, build in sections.items():
                    section(name, build)

                def tables() -> None:
                    for name, build in more.items():
                        section(name, build)

                section(MORE, tables)
                ui.label(
                    "Outputs have a tab of their own; the whole study file stands under Take away."
                ).classes("hint")
            inputs.tell()

        panel()

    whole = ui.column().classes("whole gap-2")
    put(skip, {"href": f"#{whole.html_id}"})
    with whole.props('tabindex=-1 role=region aria-label="the answer"'):
        banner = ui.label(told).classes("problem").props('role=alert data-said="page"')
        sliders = Sliders(state)
        with (
            ui.tabs()
            .props("dense no-caps align=left outside-arrows mobile-arrows")
            .classes("w-full") as tabs
        ):
            for name in TABS:
                ui.tab(name, label=import_module(f".tabs.{name}", __package__).TITLE)
        with ui.tab_panels(tabs, value=state.tab, animated=False).classes("w-full bg-transparent"):
            places = {}
            for name in TABS:
                with ui.tab_panel(name).classes("q-px-none"):
                    places[name] = ui.column().classes("w-full gap-3")
        notes = ui.column().classes("w-full gap-1")
        said: list[str] = []
        address = Address(state)
        clock = ui.label().classes("hint").props('data-fact="time"')

    async def refresh() -> None:
        """Show the study as it is now: fields, sliders, the tab in sight."""
        library = state.library
        await state.settle()
        if state.library != library:
            again()
        inputs.tell()
        sliders.tell()
        name = state.tab
        undo.set_enabled(bool(state.past))
        remark = address.tell()
        wrong = ""
        if state.problems and state.answer is not None:
            if state.current:
                wrong = "Outputs with mistakes, told beside their fields, are left out."
            else:
                wrong = (
                    f"The study has {len(state.problems)} mistake(s), told beside the fields; "
                    "shown is the last study without one."
                )
        if state.answer is None:
            banner.set_text(with_micro("; ".join(state.problems)))
            return
        try:
            if name not in draws:
                with places[name]:
                    draws[name] = import_module(f".tabs.{name}", __package__).build(state, again)
            drawing = draws[name]()
            if drawing is not None:
                await drawing
        except ThirdBodyError as error:
            wrong = "; ".join(getattr(error, "problems", None) or [str(error)])
        banner.set_text(with_micro(wrong or told))
        known = [f"Note: {text}" for text in state.answer.notes[:6]]
        known = [with_micro(without_paths(text)) for text in known] + [remark] * bool(remark)
        if known != said:
            said[:] = known
            notes.clear()
            with notes:
                for text in known:
                    ui.label(text).classes("hint")
        clock.set_text(f"answered in {1e3 * (time.perf_counter() - state.began):.0f} ms")

    def opened(name: str | None) -> None:
        if name:
            names.set_value(None)
            state.open(example(name))
            again()

    def undone() -> None:
        state.undo()
        again()

    async def travelled(event: events.GenericEventArguments) -> None:
        query = QueryParams(str(event.args).removeprefix("?"))
        read = await run.io_bound(start.read, query)
        if read is None:  # as it is when the server ends
            return
        study, at, state.tab, wrong = read
        if wrong:
            ui.notify(wrong)
        if (study, at, state.tab) == (state.study, state.wanted, tabs.value):
            return
        state.travel(study, at)
        address.travelled()
        tabs.set_value(state.tab)
        again()

    soon = Soon(refresh)
    state.changed.append(soon)

    def turned() -> None:
        state.tab = str(tabs.value or TABS[0])
        state.began = time.perf_counter()
        soon()

    tabs.on_value_change(turned)
    ui.on(TRAVELLED, travelled)
    soon()
