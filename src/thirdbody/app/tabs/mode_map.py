"""Contact mode over particle size and load; a click goes there."""

from __future__ import annotations

from collections.abc import Awaitable, Callable

import numpy as np
from nicegui import ui
from nicegui.events import GenericEventArguments

from ...contact.contact import Contact
from ...equilibrium.words import MODES, mode_of
from ..figures import MODE_FILLS, Figure, Part, figure
from ..sizing import size_of, with_size
from ..state import Answer, State
from ..widgets import Plot
from ..work import Asked, Work
from ..worker import ModeMap

__all__ = ["TITLE", "build", "map_figure"]

TITLE = "Map"
RATIOS, LOADS = (0.1, 10.0), (1e-7, 1e-3)
"""What a map reaches over at least."""
AROUND = {"ratio": 3.0, "load": 10.0}
"""It goes so many times below and above the study."""
POINTS = 60
LITTLE = 3
"""A preview has every third of both."""


ABOUT = "Sizes are scaled as a whole, everything else stays. Every point is a solved state."


ON = {"p-s": "on particles", "hybrid": "on both", "s-s": "on asperities"}
"""What the real contact is on, beside the names of the modes."""
HALF = 7
"""Radius of the point that is the study, in pixels."""
NM, MPA = 1e9, 1e-6
"""A map is drawn in these."""


def axes_of(mode_map: ModeMap) -> tuple[np.ndarray, np.ndarray]:
    """Sizes [m] and pressures [Pa] of a map."""
    sizes = mode_map["sigma"] * np.array(mode_map["sizes"], float)
    return sizes, mode_map["E_ss"] * np.array(mode_map["loads"], float)


def map_figure(mode_map: ModeMap, here: tuple[float, float] | None) -> Figure:
    """The map as plain data, and where the study is: its mean size [m] and pressure [Pa]."""
    sizes, loads = (
        (scale * axis).tolist() for scale, axis in zip((NM, MPA), axes_of(mode_map), strict=True)
    )
    colours = [MODE_FILLS[name] for name in MODES]
    scale = []
    for number, colour in enumerate(colours):
        scale += [[number / 3, colour], [(number + 1) / 3, colour]]
    index = [[None if v < 0 else v for v in row] for row in mode_map["mode"]]
    names = [[None if v < 0 else MODES[v] for v in row] for row in mode_map["mode"]]
    flipped = [list(column) for column in zip(*index, strict=True)]
    traces: list[Part] = [
        {
            "type": "heatmap",
            "x": sizes,
            "y": loads,
            "z": flipped,
            "text": [list(column) for column in zip(*names, strict=True)],
            "zmin": -0.5,
            "zmax": 2.5,
            "colorscale": scale,
            "colorbar": {
                "tickvals": [0, 1, 2],
                "ticktext": [f"{mode}<br>{ON[mode]}" for mode in MODES],
                "thickness": 14,
                "len": 0.6,
            },
            "hovertemplate": "%{x:.3g} nm<br>%{y:.3g} MPa<br>%{text}<extra></extra>",
        },
        {
            "type": "contour",
            "x": sizes,
            "y": loads,
            "z": [list(column) for column in zip(*mode_map["share"], strict=True)],
            "contours": {"start": 0.5, "end": 0.5, "size": 1, "coloring": "none"},
            "line": {"color": "#222222", "dash": "dash", "width": 2},
            "showscale": False,
            "hoverinfo": "skip",
            "name": "equal loads on particles and asperities",
            "showlegend": True,
        },
    ]
    return figure(
        traces,
        shapes=[] if here is None else [_mark_study(NM * here[0], MPA * here[1])],
        x="mean particle size [nm]",
        y="nominal pressure [MPa]",
        title="Contact mode; a click goes there",
        ylog=True,
        height=520,
        hovermode="closest",
    )


def _mark_study(size: float, load: float) -> Part:
    """The study as a point of the map: a shape moves without a new picture of the map."""
    return {
        "type": "circle",
        "xsizemode": "pixel",
        "ysizemode": "pixel",
        "xanchor": size,
        "yanchor": load,
        "x0": -HALF,
        "x1": HALF,
        "y0": -HALF,
        "y1": HALF,
        "fillcolor": "#ffffff",
        "line": {"color": "#000000", "width": 3},
        "name": "this study",
        "showlegend": True,
    }


def reach(here: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    """Sizes over σ and loads F* of a map, with the study well inside.

    >>> sizes, loads = reach((5.0, 0.01))
    >>> [f"{v:.3g}" for v in (sizes[0], sizes[-1], loads[0], loads[-1])]
    ['0.1', '15', '1e-07', '0.1']
    """
    made = []
    for least, value, around in zip((RATIOS, LOADS), here, AROUND.values(), strict=True):
        ends = min(least[0], value / around), max(least[1], value * around)
        made.append(np.geomspace(*ends, POINTS))
    return made[0], made[1]


def lies_inside(mode_map: ModeMap, here: tuple[float, float] | None) -> bool:
    """Whether the study lies on the map."""
    if here is None:
        return True
    axes = zip(axes_of(mode_map), here, strict=True)
    return all(axis[0] <= value <= axis[-1] for axis, value in axes)


def about_map(modes: list[list[int]]) -> str:
    """What is said of a map of one colour, and of one with empty places.

    >>> about_map([[2, 2], [2, -1]])[:60]
    'Everywhere on this map nearly all real contact is on asperit'
    """
    every = [index for row in modes for index in row]
    met, said = set(every) - {-1}, []
    if len(met) == 1:
        said.append(f"Everywhere on this map {mode_of(MODES[met.pop()])}.")
    if -1 in every:
        said.append("Where it is empty no state is solved.")
    return " ".join(said)


def build(state: State, again: Callable[[], None]) -> Callable[[], Awaitable[None]]:
    """The map of this study."""
    shown: ModeMap | None = None

    async def ask() -> Asked | None:
        await state.settle()  # what is shown belongs to the study as it is asked for
        answer = state.answer
        if answer is None or len(answer.contact.populations) != 1:
            work.fail("the map needs exactly one population of particles")
            return None
        place = await find_study()
        if place is None or not (place[0] > 0 and place[1] > 0):
            work.fail("the map needs a state of the study that is solved")
            return None
        contact = answer.contact
        sizes, loads = reach((place[0] / contact.roughness.sigma, place[1] / contact.E_ss))
        return {
            "study": state.study,
            "folder": str(state.folder),
            "sizes": sizes.tolist(),
            "loads": loads.tolist(),
        }

    async def find_study() -> tuple[float, float] | None:
        """Where the study is on a map: its mean size [m] and pressure [Pa]."""
        assert state.answer is not None
        contact = state.answer.contact
        if len(contact.populations) != 1:
            return None
        return size_of(contact), await state.ask(_pressure, state.operating_load)

    async def show(result: ModeMap) -> None:
        nonlocal shown
        shown = result
        await draw()

    def contact() -> Contact | None:
        return None if state.answer is None else state.answer.contact

    work = Work("map", "Draw the map", ask, show, key=contact, same=_same_map, little=_little)
    plot = Plot("map", 520)
    ui.label(ABOUT).classes("hint")
    only = ui.label().classes("hint").props('data-fact="map"')

    async def draw_tab() -> None:
        await work.update_preview(state)
        plot.widget.set_visibility(shown is not None or work.trying)
        await draw()

    async def draw() -> None:
        if shown is None or state.answer is None:
            return
        plot.widget.set_visibility(True)
        place = await find_study()
        if not lies_inside(shown, place):
            await work.again(state)  # a map contains its study
            place = None
        only.set_text(about_map(shown["mode"]))
        await plot.show(map_figure(shown, place))

    def go_to_point(event: GenericEventArguments) -> None:
        points = (event.args or {}).get("points") or []
        if not points or state.answer is None:
            return
        contact = state.answer.contact
        F_star = float(points[0]["y"]) / (MPA * contact.E_ss)
        size = float(points[0]["x"]) / NM
        at = {"F_star": F_star, "pressure": F_star * contact.E_ss}.get(state.answer.load)
        state.replace(with_size(state.study, size), at=at)

    plot.widget.on("plotly_click", go_to_point)
    return draw_tab


def _little(request: Asked) -> Asked:
    few = {}
    for name in ("sizes", "loads"):
        every = np.array(request[name], float)
        few[name] = np.geomspace(every[0], every[-1], POINTS // LITTLE).tolist()
    return request | few


def _pressure(answer: Answer, at: float) -> float:
    return float(answer.solve(at).pressure)


def _same_map(one: object, other: object) -> bool:
    """Whether two contacts have one map: sizes are scaled in it."""
    if one == other:
        return True
    if not (isinstance(one, Contact) and isinstance(other, Contact)):
        return False
    if {len(c.populations) for c in (one, other)} != {1}:
        return False
    (a,), (b,) = one.populations, other.populations
    scaled = b.diameter.scaled(a.diameter.mean_diameter / b.diameter.mean_diameter)
    near = abs(scaled.moment(2) / a.diameter.moment(2) - 1) < 1e-3
    return (
        near
        and one.replace(particles=None) == other.replace(particles=None)
        and (a.replace(diameter=b.diameter) == b)
    )
