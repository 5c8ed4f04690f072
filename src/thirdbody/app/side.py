"""The entries at the side, in sections that stay folded or open."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from nicegui import ui

from ..study.tables import TABLES
from .fields import Field
from .inputs import FORMED, Inputs
from .state import State

__all__ = ["Side"]

MORE = "More tables, as text"
ELSEWHERE = "Outputs have a tab of their own; the whole study file stands under Take away."
TITLE = Field(name="title", kind="string", label="title", about="a line of text")


class Side:
    """The drawer with an entry for everything a study file can say."""

    def __init__(self, state: State) -> None:
        self.inputs = Inputs(state, self.again)
        self.open = {"Load", "Particles"}
        """Sections that are open."""
        self.drawer = ui.left_drawer(value=None, bordered=True)
        with self.drawer.props("width=340 breakpoint=900 aria-label=inputs"):
            self._panel()

    def again(self) -> None:
        """Show other entries than before."""
        self._panel.refresh()

    @ui.refreshable_method
    def _panel(self) -> None:
        inputs = self.inputs
        inputs.shown.clear()
        with ui.column().classes("w-full gap-1"):
            inputs.rest = ui.column().classes("w-full")
            inputs.field((), TITLE)
            sections: dict[str, Callable[[], None]] = {
                "Load": inputs.load,
                "Particles": inputs.particles,
                "Roughness": inputs.roughness,
                "Surfaces": inputs.surfaces,
                "Asperity law": inputs.asperity_law,
                MORE: self._tables,
            }
            for name, build in sections.items():
                self._section(name, build)
            ui.label(ELSEWHERE).classes("hint")
        inputs.show_mistakes()

    def _tables(self) -> None:
        for table in TABLES:
            if table.name not in FORMED:
                self._section(f"[{table.name}] as text", partial(self.inputs.as_text, table.name))

    def _section(self, name: str, build: Callable[[], None]) -> None:
        fold = ui.expansion(name, value=name in self.open).classes("w-full")
        fold.on_value_change(lambda e: self._remember_fold(name, e.value))
        with fold, ui.column().classes("w-full gap-2"):
            build()

    def _remember_fold(self, name: str, is_open: bool) -> None:
        (self.open.add if is_open else self.open.discard)(name)
