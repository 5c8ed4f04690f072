"""The panels of Figs. 3 to 12, as data."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .measures import critical_load_1, critical_load_2
from .readings import RANGE, SILICA, STEEL, Curve, Curves

__all__ = ["PANELS", "Line", "Mark", "Panel", "table"]

Array = NDArray[np.float64]

BOTH = (SILICA, STEEL)
ROUGHNESSES = (50, 100, 300, 500)
SEPARATION_LOAD = 1e-5
"""Load of Fig. 11, which the paper does not state; its note says it."""

LOAD = r"load $F_t^* = F_t/(A_n E_{ss})$ [1]"
AREA = r"real area $A_t^* = A_t/A_n$ [1]"
SHARE_SS = r"asperities $A_{ss}/A_t$ [%]"
SHARE_SA = r"particles $A_{sa}/A_t$ [%]"


@dataclass(frozen=True)
class Line:
    """One curve: what it stands for, abscissa, and one ordinate for each axes of the panel."""

    material: str
    sigma: float
    x_a: float
    x: Array
    ys: tuple[Array, ...]
    by: float
    """The size or roughness that colour and marker tell."""
    thin: bool = False


@dataclass(frozen=True)
class Mark:
    """A number quoted in the paper: a load, a range of loads, or a point."""

    label: str
    x: float | tuple[float, float]
    y: float | None = None
    by: float | None = None
    dashed: bool = False
    """A dashed line, or an upright cross: steel debris, or the second of two."""
    left: bool = False
    """Write the number towards the left of the line."""


@dataclass(frozen=True)
class Panel:
    """One panel of a figure."""

    name: str
    about: str
    columns: tuple[str, ...]
    """Names of abscissa and ordinates in the table."""
    xlabel: str
    ylabels: tuple[str, ...]
    lines: list[Line]
    by: str = "size"
    """What colour and marker tell: "size" or "roughness"."""
    xlog: bool = True
    ylog: bool = True
    percent: bool = False
    xlim: tuple[float, float | None] = (4e-7, 3e-4)
    ylim: tuple[float, float | None] | None = None
    marks: list[Mark] = field(default_factory=list)
    levels: list[tuple[float, str]] = field(default_factory=list)
    """Quoted ordinates."""
    band: tuple[Array, Array, Array, str] | None = None
    """A quoted range about a curve: abscissa, lower and upper limit, label."""
    note: str = ""


# ------------------------------------------------------------------ what each panel shows
Ordinate = Callable[[Curve], Array]


def _over_load(
    curves: Curves,
    sigma: float,
    sizes: Sequence[float],
    *ordinates: Ordinate,
    materials: Sequence[str] = BOTH,
) -> list[Line]:
    """Lines over the loads of the paper, for sizes in nm; 0 is drawn once."""
    out = []
    for x_a in sizes:
        for material in materials if x_a else ("",):
            curve = curves(material, sigma, x_a)
            in_range = (curve.F >= RANGE[0]) & (curve.F <= RANGE[1] * (1 + 1e-9))
            ys = tuple(ordinate(curve)[in_range] for ordinate in ordinates)
            out.append(Line(material, sigma, x_a, curve.F[in_range], ys, by=x_a))
    return out


Maker = Callable[[str, Curves], Panel]
"""Makes a panel of this name."""
AREAS: dict[str, tuple[str, Ordinate]] = {"A_t": (AREA, lambda c: c.A_t)}
SHARES: dict[str, tuple[str, Ordinate]] = {
    "A_ss_t": (SHARE_SS, lambda c: c.asperity_share),
    "A_sa_t": (SHARE_SA, lambda c: c.particle_share),
}


def _loads(
    about: str,
    sigma: float,
    sizes: Sequence[float],
    columns: dict[str, tuple[str, Ordinate]] = AREAS,
    *,
    materials: Sequence[str] = BOTH,
    **more: Any,
) -> Maker:
    """A panel over the loads: label and ordinate of each column of its table."""
    labels, ordinates = zip(*columns.values(), strict=True)
    title = f"{about}{', SiO₂' * (len(materials) == 1)}, σ = {sigma:g} nm"
    if columns is AREAS:
        more = {"ylim": (3e-6, 3e-2)} | more
    if all("%" in label for label in labels):
        more = {"ylog": False, "percent": True} | more

    def panel(name: str, curves: Curves) -> Panel:
        lines = _over_load(curves, sigma, sizes, *ordinates, materials=materials)
        return Panel(name, title, ("F_star", *columns), LOAD, labels, lines, **more)

    return panel


SIZES_100 = (25, 100, 300, 500, 1000)
SIZES_300 = (100, 150, 200, 300, 500, 1000)
SIZES_500 = (100, 200, 250, 300, 500, 1000)
SIZES_10 = (0, 25, 100, 200, 300, 1000)
SIZES_12 = (0, 100, 300, 500, 1000)
CRITICAL_300 = [
    Mark("$F_{cr1}^*$, SiO$_2$ 300 nm", 7.5e-6, by=300),
    Mark("$F_{cr2}^*$, SiO$_2$ 300 nm", 5.1e-5, by=300),
]
AREA_100 = _loads("real contact area", 100, (0, *SIZES_100), marks=CRITICAL_300)


def _area_100(name: str, curves: Curves) -> Panel:
    bare = curves.two_body(100)
    band = (bare.F, 0.15 * bare.A_t, 0.22 * bare.A_t, "15–22 % of bare, 1000 nm")
    return replace(AREA_100(name, curves), band=band)


def _two_sizes(name: str, curves: Curves) -> Panel:
    lines = [
        replace(line, by=sigma, thin=x_a == 25)
        for sigma in ROUGHNESSES
        for x_a in (25, 1000)
        for line in _over_load(curves, sigma, (x_a,), lambda c: c.A_t)
    ]
    return Panel(
        name,
        "real contact area at 25 nm and 1000 nm",
        ("F_star", "A_t"),
        LOAD,
        (AREA,),
        lines,
        by="roughness",
        ylim=(3e-6, 3e-2),
        marks=[
            Mark("1000 nm begins to rise", 3e-5, left=True),
            Mark("1000 nm: all $\\sigma$ alike below", 6e-5, dashed=True),
        ],
    )


TPCA_300 = Mark("turning point, 200 nm", 1.9e-6, by=200)
TPCA_500 = Mark("turning point, 300 nm", 3.0e-6, by=300)

CRITICAL_SIZES = (100, 300, 500, 1000)
CRITICAL_ROUGHNESSES = (50, 75, 100, 150, 200, 300, 400, 500)


def _nowhere(lines: Sequence[Line]) -> str:
    """A line that names the particles of which no point is drawn; "" where each has one."""
    empty: dict[float, list[str]] = {}
    for line in lines:
        if np.isnan(line.ys[0]).all():
            empty.setdefault(line.x_a, []).append(line.material.replace("2", "₂"))
    if not empty:
        return ""
    sizes = (
        f"{x_a:g} nm" + f" {names[0]}" * (len(names) < len(BOTH)) for x_a, names in empty.items()
    )
    return f"\nNone at all for {', '.join(sizes)}."


def _critical(
    critical: Callable[[Curve], float],
    number: str,
    words: str,
    marks: list[Mark],
    name: str,
    curves: Curves,
) -> Panel:
    lines = []
    for x_a in CRITICAL_SIZES:
        for material in BOTH:
            loads = np.array(
                [critical(curves(material, sigma, x_a)) for sigma in CRITICAL_ROUGHNESSES]
            )
            # a load at the first grid point only says that the mode was there from the start
            loads = np.where(np.isfinite(loads) & (loads > RANGE[0]), loads, np.nan)
            sigmas = np.array(CRITICAL_ROUGHNESSES, dtype=float)
            lines.append(Line(material, np.nan, x_a, sigmas, (loads,), by=x_a))
    return Panel(
        name,
        f"{words} critical load",
        ("sigma_nm", f"F_cr{number}"),
        "roughness $\\sigma$ [nm]",
        (rf"{words} critical load $F_{{cr{number}}}^*$ [1]",),
        lines,
        xlog=False,
        xlim=(25, 525),
        ylim=(4e-7, 5e-4),
        marks=marks,
        note=f"No point: no such load between 4.8 × 10⁻⁷ and 4 × 10⁻⁴.{_nowhere(lines)}",
    )


CRITICAL_10 = Mark("$F_{cr1}^*$, SiO$_2$ 300 nm", 7.4e-6, by=300)


def _regime(regime: str, words: str, marks: Sequence[Mark] = (), **more: Any) -> Maker:
    return _loads(
        f"{words} share of the contact area",
        100,
        SIZES_10,
        {f"A_{regime}_t": (rf"{words} share $A_{{{regime}}}/A_t$ [%]", lambda c: c.share(regime))},
        note="The paper does not state σ; 100 nm is taken.",
        marks=[CRITICAL_10, *marks],
        **more,
    )


SEPARATION_SIZES = (*range(0, 300, 25), *range(300, 1001, 50))


def _separation(starred: bool, name: str, curves: Curves) -> Panel:
    lines = []
    for sigma in ROUGHNESSES:
        for material in BOTH:
            states = [
                curves.state_at(SEPARATION_LOAD, material, sigma, x) for x in SEPARATION_SIZES
            ]
            y = np.array([s.d_star[0] if starred else 1e9 * s.d[0] for s in states])
            x = np.array(SEPARATION_SIZES, dtype=float)
            lines.append(Line(material, sigma, np.nan, x, (y,), by=sigma))
    label = r"separation $d^* = d/\sigma$ [1]" if starred else "separation $d$ [nm]"
    note = "At F* = 10⁻⁵; the paper does not state the load."
    if starred:
        note += " The paper reads d*(SiO₂)/d*(S45C) ≈ 2.5 at 1000 nm."
    return Panel(
        name,
        "separation" if not starred else "separation over roughness",
        ("x_a_nm", "d_star" if starred else "d_nm"),
        "particle size $x_a$ [nm]",
        (label,),
        lines,
        by="roughness",
        xlog=False,
        ylog=False,
        xlim=(-20, 1020),
        note=note,
    )


def _area_over_separation(name: str, curves: Curves) -> Panel:
    lines = [
        replace(line, x=line.ys[0], ys=line.ys[1:])
        for line in _over_load(curves, 100, SIZES_12, lambda c: c.d_star, lambda c: c.A_t)
    ]
    return Panel(
        name,
        "real contact area over separation, σ = 100 nm",
        ("d_star", "A_t"),
        r"separation $d^* = d/\sigma$ [1]",
        (AREA,),
        lines,
        xlog=False,
        xlim=(0, None),
        ylim=(3e-6, 3e-2),
        note="The paper does not state σ; 100 nm is taken. It reads 30 % more d* for 9 % less area "
        "in the hybrid mode of 500 nm SiO₂.",
    )


_MAKERS: dict[str, Maker] = {
    "3a": _area_100,
    "3b": _loads(
        "shares of the contact area",
        100,
        SIZES_100,
        SHARES,
        marks=[
            *CRITICAL_300,
            Mark("$F_{cr1}^*$, S45C 300 nm", 2.0e-6, by=300, dashed=True),
            Mark("$F_{cr2}^*$, S45C 300 nm", 4.0e-5, by=300, dashed=True, left=True),
        ],
    ),
    "4a": _loads(
        "area on asperities",
        100,
        (0, *SIZES_100),
        {"A_ss_n": (r"area on asperities $A_{ss}/A_n$ [1]", lambda c: c.A_ss)},
        ylim=(1e-7, 3e-2),
        marks=[Mark("asperities touch, SiO$_2$ 1000 nm", 1.5e-4, by=1000, left=True)],
    ),
    "4b": _loads(
        "area on particles",
        100,
        SIZES_100,
        {"A_sa_n": (r"area on particles $A_{sa}/A_n$ [1]", lambda c: c.A_sa)},
        ylim=(1e-9, 3e-2),
        marks=[Mark("25 nm touch", 5.1e-5, by=25)],
    ),
    "5": _two_sizes,
    "6a": _loads(
        "shares of the contact area", 100, SIZES_100, SHARES, materials=[SILICA], marks=CRITICAL_300
    ),
    "6b": _loads(
        "shares of the contact area",
        300,
        SIZES_300,
        SHARES,
        materials=[SILICA],
        marks=[TPCA_300, Mark("200 nm shares the load", (4.5e-7, 4.5e-6), by=200)],
    ),
    "6c": _loads("real contact area", 300, (0, *SIZES_300), materials=[SILICA], marks=[TPCA_300]),
    "7a": _loads(
        "shares of the contact area", 500, SIZES_500, SHARES, materials=[SILICA], marks=[TPCA_500]
    ),
    "7b": _loads("real contact area", 500, (0, *SIZES_500), materials=[SILICA], marks=[TPCA_500]),
    "8": _loads(
        "share of asperities",
        300,
        (100, 150, 200, 300, 500),
        {"A_ss_t": SHARES["A_ss_t"]},
        marks=[Mark("turning point, SiO$_2$ 200 nm", 1.9e-6, by=200)],
    ),
    "9a": partial(
        _critical,
        critical_load_1,
        "1",
        "first",
        [
            Mark("SiO$_2$ 300 nm", 100, 7.5e-6, by=300),
            Mark("S45C 300 nm", 100, 2.0e-6, by=300, dashed=True),
            Mark("SiO$_2$ 1000 nm", 100, 1.5e-4, by=1000),
        ],
    ),
    "9b": partial(
        _critical,
        critical_load_2,
        "2",
        "second",
        [
            Mark("SiO$_2$ 300 nm", 100, 5.1e-5, by=300),
            Mark("S45C 300 nm", 100, 4.0e-5, by=300, dashed=True),
        ],
    ),
    "10a": _regime("e", "elastic", ylim=(-0.01, 0.25), levels=[(0.2, "upper limit 20 %")]),
    "10b": _regime("ep", "elastoplastic", levels=[(0.8, "lower limit 80 %, $x_a$ < 100 nm")]),
    "10c": _regime("p", "plastic", [Mark("turning point, 200 nm", (1.86e-6, 6.0e-6), by=200)]),
    "11a": partial(_separation, False),
    "11b": partial(_separation, True),
    "12a": _loads(
        "separation under load",
        100,
        SIZES_12,
        {"d_star": (r"separation $d^* = d/\sigma$ [1]", lambda c: c.d_star)},
        ylog=False,
        ylim=(0, None),
        marks=[
            Mark("SiO$_2$ 500 nm", 5e-7, 9.15, by=500),
            Mark("SiO$_2$ 500 nm", 7e-6, 8.52, by=500),
            Mark("SiO$_2$ 500 nm", 3e-5, 2.62, by=500),
        ],
        note="The paper does not state σ; 100 nm is taken. It reads d* up to 5.8 (1000 nm) and 2 "
        "times (500 nm)\nthat of bare surfaces; 9.15 follows from 8.52 and −6.89 %.",
    ),
    "12b": _area_over_separation,
}
PANELS: dict[str, Callable[[Curves], Panel]] = {
    name: partial(maker, name) for name, maker in _MAKERS.items()
}
"""The twenty panels by the name the paper gives them."""


def table(panel: Panel) -> str:
    """The panel's numbers as CSV: one row a point, sizes and roughness in nm."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    columns = panel.columns
    line_names = [name for name in ("sigma_nm", "x_a_nm") if name not in columns]
    writer.writerow(["material", *line_names, *columns])
    for line in panel.lines:
        value = {"sigma_nm": line.sigma, "x_a_nm": line.x_a}
        about = [line.material or "none", *(f"{value[name]:g}" for name in line_names)]
        for row in zip(line.x, *line.ys, strict=True):
            writer.writerow([*about, *("" if np.isnan(v) else f"{v:.8g}" for v in row)])
    return out.getvalue()
