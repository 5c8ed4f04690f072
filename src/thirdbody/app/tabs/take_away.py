"""Take it away: the study as a file, a script, a table, pictures, a link."""

from __future__ import annotations

from collections.abc import Callable

from nicegui import events, ui

from ...errors import InvalidValue, Mistake
from ..address import query_of
from ..cross_section import section, to_svg
from ..exports import FIGURES, figure_of, to_csv, to_json
from ..python_text import to_python
from ..state import Answer, State
from ..text import LONGEST_STUDY, from_toml, to_toml
from ..widgets import set_attributes, upload
from ..work import Work

__all__ = ["TITLE", "build"]

TITLE = "Take away"


FILES = (
    ("study.toml", "application/toml", "Study file"),
    ("study.py", "text/x-python", "Python"),
    ("states.csv", "text/csv", "CSV"),
    ("states.json", "application/json", "JSON"),
    ("section.svg", "image/svg+xml", "Section SVG"),
)
"""What can be downloaded: name, kind, and what the button says."""


def build(state: State, again: Callable[[], None]) -> Callable[[], None]:
    """Everything that leaves the page, and the study that comes back."""
    return TakeAway(state, again).draw


class TakeAway:
    """Downloads, a link, and the study as a text that can be changed."""

    def __init__(self, state: State, again: Callable[[], None]) -> None:
        self.state, self.again = state, again
        self.edited_study = state.study
        """The study that stands in the editor, or from which its text began."""
        self._downloads()
        self.said = ui.label().classes("problem").props('role=alert data-said="take away"')
        self._link()
        with ui.element("div").classes("figures w-full"):
            with ui.column().classes("w-full"):
                self._study()
            with ui.column().classes("w-full"):
                ui.label("The same numbers in Python").classes("subhead")
                self.script = ui.label().classes("w-full listing")
                self.script.props('data-path="python" tabindex=0 role=group aria-label="Python"')
                ui.label("On the command line: thirdbody solve study.toml").classes("hint")

    # ------------------------------------------------------------------ what there is
    def _downloads(self) -> None:
        with ui.row().classes("w-full gap-2 items-center"):
            for name, kind, label in FILES:
                button = ui.button(
                    label, icon="download", on_click=lambda _, n=name, k=kind: self._send(n, k)
                )
                set_attributes(button.props("no-caps outline"), {"data-download": name})
        state = self.state
        Work(
            "report",
            "Report to hand on (HTML)",
            lambda: {"study": state.study, "folder": str(state.folder)},
            lambda result: ui.download.content(result["html"], "report.html", "text/html"),
        )
        with ui.row().classes("w-full gap-2 items-center"):
            self.which = ui.select(list(FIGURES), value="area", label="figure").props("dense")
            for suffix in ("png", "svg"):
                button = ui.button(
                    suffix.upper(), icon="image", on_click=lambda _, s=suffix: self._picture(s)
                )
                set_attributes(button.props("no-caps outline"), {"data-download": suffix})

    def _link(self) -> None:
        ui.label("A link that reopens this page on this machine").classes("subhead")
        with ui.row().classes("w-full items-center no-wrap"):
            self.link = ui.input().props('readonly dense data-path="link" aria-label="link"')
            self.link.classes("grow")
            copy = ui.button(icon="content_copy", on_click=self._copy_link)
            copy.props('flat aria-label="copy the link"')

    def _study(self) -> None:
        ui.label("The study file").classes("subhead")
        self.editor = ui.textarea(value=to_toml(self.state.study)).classes("w-full code")
        self.editor.props('outlined autogrow data-path="toml" aria-label="study file"')
        with ui.row().classes("items-center"):
            ui.button("Use this text", icon="input", on_click=self._use_edited_text).props(
                'no-caps data-take="toml"'
            )
            self.chooser = upload(
                "study",
                "Open a study file",
                LONGEST_STUDY,
                self._take_study,
                refused=lambda: self.said.set_text("the file is too large for a study"),
            ).props('accept=".toml,text/plain"')
        self.problems = ui.column().classes("w-full")

    # ------------------------------------------------------------------ what happens
    def _use(self, study: dict[str, object]) -> None:
        self.state.replace(study)
        self.again()

    async def _take_study(self, event: events.UploadEventArguments) -> None:
        self.said.set_text("")
        self.chooser.reset()
        try:
            if event.file.size() > LONGEST_STUDY:
                raise InvalidValue("the file is too large for a study", code=Mistake.TOO_LARGE)
            self._use(from_toml((await event.file.read()).decode("utf-8-sig")))
        except UnicodeDecodeError:
            self.said.set_text("the file is not UTF-8 text, so it is no study file")
        except InvalidValue as error:
            self.said.set_text("; ".join(error.problems))

    def _use_edited_text(self) -> None:
        self.said.set_text("")
        try:
            self._use(from_toml(str(self.editor.value or "")))
        except InvalidValue as error:
            self.said.set_text("; ".join(error.problems))

    def _copy_link(self) -> None:
        ui.clipboard.write(str(self.link.value))

    async def _send(self, name: str, kind: str) -> None:
        state = self.state
        if state.answer is None:
            return
        try:
            whole = name == "study.toml"
            content = (
                to_toml(state.study)
                if whole
                else await state.ask(_content, name, state.operating_load)
            )
            ui.download.content(content, name, kind)
        except InvalidValue as error:
            self.said.set_text("; ".join(error.problems))

    async def _picture(self, suffix: str) -> None:
        if self.state.answer is None:
            return
        name = str(self.which.value)
        try:
            content = await self.state.ask(figure_of, name, suffix)
            ui.download.content(content, f"{name}.{suffix}")
        except InvalidValue as error:
            self.said.set_text("; ".join(error.problems))

    def draw(self) -> None:
        state = self.state
        if state.study is not self.edited_study:  # else what is being written stays
            self.edited_study = state.study
            self.editor.set_value(to_toml(state.study))
        if state.answer is not None:
            self.script.set_text(to_python(state.answer.study, state.operating_load))
        at = state.wanted if state.answer is None else state.operating_load
        self.link.set_value(f"{_origin()}/?{query_of(state, at)}")
        self.problems.clear()
        with self.problems:
            for text in state.problems:
                ui.label(text).classes("problem")


def _content(answer: Answer, name: str, at: float) -> str:
    """What goes into a file of this name."""
    made: dict[str, Callable[[], str]] = {
        "study.py": lambda: to_python(answer.study, at),
        "states.csv": lambda: to_csv(answer.study),
        "states.json": lambda: to_json(answer.study),
        "section.svg": lambda: to_svg(
            section(answer.contact, answer.solve(at), held=answer.particles_held)
        ),
    }
    return made[name]()


def _origin() -> str:
    request = ui.context.client.request
    return f"{request.url.scheme}://{request.headers.get('host', '127.0.0.1')}"
