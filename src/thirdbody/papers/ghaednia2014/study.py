"""The study: its words, claims and figures."""

from __future__ import annotations

from ..panels import Line, Panel
from ..report import Study
from ..trends import (
    MEASURES,
    PRESSURE,
    area_panel,
    changes_panel,
    exponent_panel,
    ratio_panel,
)
from .claims import CLAIMS
from .model import (
    PRESSURES,
    READINGS,
    conductance_ratio,
    flattening,
    largest_conductance_ratio,
    pressure_over_hardness,
)

__all__ = ["STUDY", "reproduce"]


def conductance_panel(name: str) -> Panel:
    """Conductance of the spots over that of bare surfaces."""
    curves = (
        ("insulating, elastic", conductance_ratio("elastic", PRESSURES)),
        ("insulating, elastic-plastic", conductance_ratio("elastic-plastic", PRESSURES)),
        ("conducting, elastic", conductance_ratio("elastic", PRESSURES, conducting=True)),
    )
    return Panel(
        name,
        "conductance of the contact spots over that without particles",
        PRESSURE,
        "$h/h_{bare}$ [1]",
        ("pressure_Pa", "conductance_ratio"),
        tuple(Line(label, PRESSURES, y, i, i) for i, (label, y) in enumerate(curves)),
        ylog=True,
        ylim=(1e-3, 3),
        levels=((1.0, "no effect"),),
        note="Clean spots, electrical or thermal; no gas, no interference of spots. "
        "Conducting: without resistance of their own.",
    )


STUDY = Study(
    "ghaednia2014",
    "What can be reproduced of Ghaednia, Jackson and Gao 2014",
    "Ghaednia, Jackson, Gao 2014, IEEE Holm Conference on Electrical Contacts (citation recalled)",
    (
        "Read: one sentence of Horng et al. 2022, who report that the paper extends the model of "
        "Greenwood and Williamson to three bodies and applies it to electrical contacts, and that "
        "particles can lower real area and thermal conduction. Nothing else could be obtained.",
        "Reconstructed: all of it. Asperities are elastic as in Greenwood and Williamson, "
        "particles are two contacts in series between parallel planes, loads and areas add. Only "
        "the sum of the two terms is what “extends” must mean; seat, sizes, densities, materials "
        "and the law of a particle were chosen here. The stacked reading takes the surfaces of "
        "the multi-scale model instead.",
        "When particles lower the area: while they carry the load, A/A_bare is the mean pressure "
        "of bare asperities over that of particles. The asperities press with 0.15 to 0.24 of the "
        "hardness, Jackson–Green particles with half of it, elastic ones with more than all of "
        "it, so the area falls. It does not with soft particles, with asperities too sharp to be "
        "elastic, or with particles that do not reach across the gap.",
        "When the area is proportional to the load: nearly so with particles alone and nearly so "
        "without. In between it must rise from the small area of particles to that of asperities, "
        "and there it grows faster than the load.",
    ),
    READINGS,
    CLAIMS,
    MEASURES
    | {
        one.__name__: one for one in (largest_conductance_ratio, pressure_over_hardness, flattening)
    },
    (
        lambda: area_panel(READINGS, "1"),
        lambda: ratio_panel(READINGS, "2"),
        lambda: exponent_panel(
            READINGS,
            "3",
            "Bend near 50 MPa: at d = 0 every elastic particle has reached its great circle.",
        ),
        lambda: changes_panel(
            READINGS["elastic-plastic"],
            "4",
            "size",
            {0.5: "$x_a$ = 100 nm", 0.75: "150 nm", 1.0: "200 nm", 1.5: "300 nm", 2.0: "400 nm"},
            "effect of the particle size",
            ylog=False,
            note="Kinks: all particles have reached their great circle and carry no more.",
        ),
        lambda: changes_panel(
            READINGS["elastic-plastic"],
            "5",
            "density",
            {0.1: r"$\eta_a = 10^9$ m$^{-2}$", 1.0: "$10^{10}$", 10.0: "$10^{11}$"},
            "effect of the particle density",
            ylog=False,
        ),
        lambda: changes_panel(
            READINGS["elastic-plastic"],
            "6",
            "stiffness",
            {
                0.03: "$E_a$, $H_a$: 0.03 × silica",
                0.1: "0.1 × silica",
                0.3: "0.3 × silica",
                1.0: "silica",
                5.0: "5 × silica",
            },
            "effect of stiffness and hardness of the particles",
        ),
        lambda: conductance_panel("7"),
    ),
)

reproduce = STUDY.reproduce
