"""Take it away: the study as a file, a script, a table, pictures, a link."""

from __future__ import annotations

from collections.abc import Callable

from nicegui import events, ui

from ...errors import InvalidValue
from ..cross_section import section, to_svg
from ..exports import FIGURES, figure_of, to_csv, to_json
from ..python_text import to_python
from ..state import Answer, State
from ..text import LONGEST_STUDY, from_toml, to_link, to_toml
from ..widgets import put, upload
from ..work import Work

__all__ = ["TITLE", "build"]

TITLE = "Take away"


def build(state: State, again: Callable[[], None]) -> Callable[[], None]:
    """Everything that leaves the page, and the study that comes back."""

    def shown(study: dict) -> None:
        state.replace(study)
        again()

    async def uploaded(event: events.UploadEventArguments) -> None:
        said.set_text("")
        chooser.reset()
        try:
            if event.file.size() > LONGEST_STUDY:
                raise InvalidValue("the file is too large for a study")
            shown(from_toml((await event.file.read()).decode("utf-8-sig")))
        except UnicodeDecodeError:
            said.set_text("the file is not UTF-8 text, so it is no study file")
        except InvalidValue as error:
            said.set_text("; ".join(error.problems))

    def edited() -> None:
        said.set_text("")
        try:
            shown(from_toml(str(editor.value or "")))
        except InvalidValue as error:
            said.set_text("; ".join(error.problems))

    async def send(name: str, kind: str) -> None:
        if state.answer is None:
            return
        try:
            content = (
                to_toml(state.study)
                if name == "study.toml"
                else await state.ask(_content, name, state.at)
            )
            ui.download.content(content, name, kind)
        except InvalidValue as error:
            said.set_text("; ".join(error.problems))

    async def picture(suffix: str) -> None:
        if state.answer is None:
            return
        name = str(which.value)
        try:
            ui.download.content(await state.ask(figure_of, name, suffix), f"{name}.{suffix}")
        except InvalidValue as error:
            said.set_text("; ".join(error.problems))

    with ui.row().classes("w-full gap-2 items-center"):
        for name, kind, label in (
            ("study.toml", "application/toml", "Study file"),
            ("study.py", "text/x-python", "Python"),
            ("states.csv", "text/csv", "CSV"),
            ("states.json", "application/json", "JSON"),
            ("section.svg", "image/svg+xml", "Section SVG"),
        ):
            button = ui.button(
                label, icon="download", on_click=lambda _, n=name, k=kind: send(n, k)
            )
            put(button.props("no-caps outline"), {"data-download": name})
    Work(
        "report",
        "Report to hand on (HTML)",
        lambda: {"study": state.study, "folder": str(state.folder)},
        lambda result: ui.download.content(result["html"], "report.html", "text/html"),
    )
    with ui.row().classes("w-full gap-2 items-center"):
        which = ui.select(list(FIGURES), value="area", label="figure").props("dense")
        for suffix in ("png", "svg"):
            button = ui.button(
                suffix.upper(), icon="image", on_click=lambda _, s=suffix: picture(s)
            )
            put(button.props("no-caps outline"), {"data-download": suffix})
    said = ui.label().classes("problem").props('role=alert data-said="take away"')
    ui.label("A link that reopens this page on this machine").classes("subhead")
    with ui.row().classes("w-full items-center no-wrap"):
        link = ui.input().props('readonly dense data-path="link" aria-label="link"')
        link.classes("grow")
        ui.button(icon="content_copy", on_click=lambda: ui.clipboard.write(str(link.value))).props(
            'flat aria-label="copy the link"'
        )
    with ui.element("div").classes("figures w-full"):
        with ui.column().classes("w-full"):
            ui.label("The study file").classes("subhead")
            editor = ui.textarea().classes("w-full code")
            editor.props('outlined autogrow data-path="toml" aria-label="study file"')
            with ui.row().classes("items-center"):
                ui.button("Use this text", icon="input", on_click=edited).props(
                    'no-caps data-take="toml"'
                )
                chooser = upload(
                    "study",
                    "Open a study file",
                    max_file_size=LONGEST_STUDY,
                    max_files=1,
                    on_upload=uploaded,
                    on_rejected=lambda: said.set_text("the file is too large for a study"),
                ).props('accept=".toml,text/plain"')
            problems = ui.column().classes("w-full")
        with ui.column().classes("w-full"):
            ui.label("The same numbers in Python").classes("subhead")
            script = ui.label().classes("w-full listing")
            script.props('data-path="python" tabindex=0 role=group aria-label="Python"')
            ui.label("On the command line: thirdbody solve study.toml").classes("hint")

    def draw() -> None:
        answer = state.answer
        assert answer is not None
        editor.set_value(to_toml(state.study))
        script.set_text(to_python(answer.study, state.at))
        link.set_value(f"{_origin()}/?{to_link(state.study, state.at)}")
        problems.clear()
        with problems:
            for text in state.problems:
                ui.label(text).classes("problem")

    return draw


def _content(answer: Answer, name: str, at: float) -> str:
    """What goes into a file of this name."""
    made: dict[str, Callable[[], str]] = {
        "study.py": lambda: to_python(answer.study, at),
        "states.csv": lambda: to_csv(answer.study),
        "states.json": lambda: to_json(answer.study),
        "section.svg": lambda: to_svg(section(answer.contact, answer.solve(at))),
    }
    return made[name]()


def _origin() -> str:
    request = ui.context.client.request
    return f"{request.url.scheme}://{request.headers.get('host', '127.0.0.1')}"
