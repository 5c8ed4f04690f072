r"""A dry or greased contact: particles arrive, stay as long as the motion keeps them, and leave.

.. math:: \frac{d\eta_{km}}{dt} = j_{km} + \varphi_k\sum_i \frac{A_{w,i}}{A_n v_k}\frac{dw_i}{dt}
          - (1-\rho_r)\frac{\eta_{km}}{\tau_{km}} + \text{breaking} - \text{embedding}

Kinematics gives the residence time: what rolls, or lies loose, goes at half the sliding speed,
τ = 2L/v_s; what is held in the moving surface goes with it, τ = L/v_s; what is held in the other
stays, τ = ∞. Who does what is the verdict of `Friction`. This is the circuit of the third body of
Godet and Berthier: source, internal and wear flow, recirculation.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .contact_tables import ContactTables, Pressed
from .loop import FINER, Gap, Loop, Rates, Setting

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["DryLoop"]

ARRIVED, LEFT = "arrivals", "left"


class DryLoop(Loop):
    """A contact under a pressure that slides.

    Parameters
    ----------
    tables : ContactTables
    setting : Setting
    pressure : float
        p [Pa].
    length : float
        L of the contact along the motion [m].
    arrivals : array (J,)
        Particles that arrive in the whole contact per time [1/s].
    loss : float
        1 − ρ_r, part of what leaves the contact that does not come round again [1].
    moving : {1, 2}
        The surface that carries what is held in it out of the contact.
    """

    pool = "contact"

    def __init__(
        self,
        tables: ContactTables,
        setting: Setting,
        *,
        pressure: float,
        length: float,
        arrivals: Array,
        loss: float,
        moving: int,
    ):
        super().__init__(tables, setting, (ARRIVED, LEFT))
        self.pressure, self.length, self.loss, self.moving = pressure, length, loss, moving
        self.arrivals = arrivals
        self.last = 0.0

    def find_gap(self, y: Array) -> Gap:
        sigma = self.sigma_of(y)
        eta = self.shape_numbers(self.present(y, self.last))
        d = self.tables.find_gap(self.pressure, eta=eta, sigma=sigma, start=self.last)
        self.last = d
        return Gap(d, 0.0)

    def gap_slopes(self, y: Array, gap: Gap) -> Array:
        sigma = self.sigma_of(y)
        eta = self.shape_numbers(self.present(y, gap.d))
        slope = self.tables.load(gap.d, eta=eta, sigma=sigma)[1]
        state = self.tables.press_at(gap.d, eta=eta, sigma=sigma)
        return -self.slope_over_unknowns(y, state) / slope

    def standing(self, y: Array, d: float) -> Array:
        return np.eye(len(self.volumes)) / self.setting.area

    def in_contact(self, y: Array, d: float) -> Array:
        return y[self.layout[self.pool]] / self.setting.area

    def passes(self, side: int) -> float:
        return 0.0

    def leaving(self, state: Pressed) -> Array:
        """1/τ of each number [1/s]: (J,)."""
        loose = np.maximum(1 - self.columns(state, "loaded"), 0.0)
        slow = loose + self.columns(state, "rolling")
        return (
            self.setting.sliding_speed
            / self.length
            * (0.5 * slow + self.columns(state, f"in_{self.moving}"))
        )

    def add_exchange(self, out: Rates, y: Array, state: Pressed) -> None:
        pool = self.layout[self.pool]
        pieces = self.pieces(state.d, state.sigma)
        arrived = pieces @ self.arrivals
        self.add_source(out, ARRIVED, arrived)
        lost = self.shape_numbers(self.volumes * (self.arrivals - arrived)).sum(axis=1)
        out.constant[self.layout[f"flow {ARRIVED}"]] += lost  # as volume it arrives
        out.constant[self.layout[f"flow {FINER}"]] += lost
        passing = self.leaving(state)
        staying = self.add_retention(out, passing, state)
        free = passing * (1 - staying)
        mine = np.arange(pool.start, pool.stop)
        out.matrix[mine, mine] -= self.loss * free
        self.add_flow(out, LEFT, pool, self.loss * free)
        self.add_passage(out, (1 - self.loss) * free, pieces=pieces)
