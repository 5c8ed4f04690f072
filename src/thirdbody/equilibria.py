"""Equilibria beside the one that `solve` gives: of many contacts, of one load, with heat.

- `solve_states`: N states, each with its own load and inputs
- `critical_loads`: loads at which N contacts change their mode
- `roots`: every separation that carries one load, and whether it is stable
- `pull_off`: the largest tension that adhesion holds
- `equal_share_size`: the size at which particles carry a given share of the load
- `coupled`: states that agree with the heat of their own friction
"""

from .analysis.design.equal_share import equal_share_size
from .equilibrium.critical_loads import critical_loads
from .equilibrium.solve import pull_off, roots
from .equilibrium.states import solve_states
from .systems.coupled import coupled

__all__ = [
    "coupled",
    "critical_loads",
    "equal_share_size",
    "pull_off",
    "roots",
    "solve_states",
]
