"""Thermal resistance of one glass sphere on a glass plate."""

from __future__ import annotations

from thirdbody.effects.single.heat import spot_resistance

from .row import ABSTRACT, CHOSEN, Band, Input, Row, statement

__all__ = ["ROW"]

RADII, CONDUCTIVITIES = (32e-9, 36e-9, 40e-9), (1.0, 1.05, 1.1)


def _resistance() -> Band:
    return Band.of(
        [float(spot_resistance(r, rho_1=1 / k, rho_2=1 / k)) for r in RADII for k in CONDUCTIVITIES]
    )


ROW = Row(
    "doumouro2020",
    "Heat through one glass sphere on glass",
    "Doumouro et al. 2020, arXiv:2012.04291",
    "A glass microsphere on a heated probe brought to a glass plate in vacuum.",
    (
        Input("radius of the contact", "36 ± 4 nm", ABSTRACT),
        Input("conductivity of glass", "1.0 to 1.1 W/(m K)", CHOSEN),
    ),
    (
        statement(
            "resistance",
            "The resistance of the contact is (1.4 ± 0.18)·10⁷ K/W",
            ABSTRACT,
            "resistance of the spot [K/W]",
            {"kind": "absolute", "value": 1.4e7, "of": 0.36e7},
            _resistance,
            remark="Within two of their errors",
            undecided="the radius was itself inferred from the resistance",
        ),
    ),
    "Agrees, and proves nothing: a test needs the size of the sphere and the force on it.",
)
