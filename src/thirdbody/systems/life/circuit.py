r"""An oil circuit: what brings particles into the oil, and what takes them out.

.. math:: \frac{d(V n_{km})}{dt} = r_{km} + q_{in} n^{in}_{km} - L_{km} n_{km}, \qquad
          L_{km} = q_{out} + \sum_f Q_f \bar P_{f,k} + A_s w_{km}
"""

from __future__ import annotations

from dataclasses import dataclass

from ...quantities.value import Value, quantity, several
from ..oil_filter import Filter
from .ingress import Ingress
from .oil_dirt import OilDirt
from .size_classes import SizeClasses

__all__ = ["OilCircuit"]


@dataclass(frozen=True, slots=True, kw_only=True)
class OilCircuit(Value):
    """Oil that goes round, with its filters, what enters it and what leaves it.

    Parameters
    ----------
    volume : float
        Of the oil V [m³].
    start : OilDirt or tuple of OilDirt
        Particles in it when the history begins; () for none.
    ingress : Ingress or tuple of Ingress
        Particles that enter it; () for none. Nobody can predict it.
    filters : Filter or tuple of Filter, optional
        Each with its flow. Filters of one ``line`` stand one behind the other.
    viscosity, density : float, optional
        η [Pa s] and ρ [kg/m³]; needed where particles settle.
    settling_area : float, optional
        Floor on which particles settle A_s [m²].
    make_up, leak : float, optional
        Oil that comes in q_in and goes out q_out [m³/s].
    fresh_oil : OilDirt or tuple of OilDirt, optional
        Particles in the oil that comes in, with ``make_up`` and at a change; () for none.
    oil_changes : tuple of float, optional
        Times at which all the oil is changed [s].
    classes : SizeClasses, optional
        Of size; by default edges a factor 2^⅓ apart that hold all particles.
    """

    volume: float = quantity("V", "m^3", "volume of the oil", gt=0, hint="200 L is 0.2")
    start: tuple[OilDirt, ...]
    ingress: tuple[Ingress, ...]
    filters: tuple[Filter, ...] = ()
    viscosity: float | None = quantity("η", "Pa s", "viscosity of the oil", default=None, gt=0)
    density: float | None = quantity("ρ", "kg/m^3", "density of the oil", default=None, gt=0)
    settling_area: float = quantity("A_s", "m^2", "floor to settle on", default=0.0, ge=0)
    make_up: float = quantity("q_in", "m^3/s", "oil that comes in", default=0.0, ge=0)
    leak: float = quantity("q_out", "m^3/s", "oil that goes out", default=0.0, ge=0)
    fresh_oil: tuple[OilDirt, ...] | None = None
    oil_changes: tuple[float, ...] = several("s", "times of oil changes", default=())
    classes: SizeClasses | None = None
