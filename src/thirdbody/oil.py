"""Oil and its dirt over time: what `life` takes, of a dry contact too.

- `OilCircuit`: oil that goes round, with its filters, what enters it and what leaves it
- `OilDirt`: particles of one material in an oil
- `Ingress`: particles of one material that enter an oil
- `Filter`: a filter by its β ratios at sizes
- `SizeClasses`: classes of size in which particles are counted
- `Debris`: sizes and hardness of what wear leaves behind
- `RunningIn`: roughness that falls with wear
- `oil_reports`: dirt that enters an oil, from reports of it
- `entry_ratio_from_dents`: the entry ratio of its particles, from dents counted in a surface
- `until`: what a history waits for (a module)

The oil of a film, by viscosity, is `thirdbody.films.Oil`.
"""

from .systems.life import until
from .systems.life.circuit import OilCircuit
from .systems.life.debris import Debris
from .systems.life.entry import entry_ratio_from_dents
from .systems.life.ingress import Ingress
from .systems.life.oil_dirt import OilDirt
from .systems.life.reports import oil_reports
from .systems.life.size_classes import SizeClasses
from .systems.life.surfaces import RunningIn
from .systems.oil_filter import Filter

__all__ = [
    "Debris",
    "Filter",
    "Ingress",
    "OilCircuit",
    "OilDirt",
    "RunningIn",
    "SizeClasses",
    "entry_ratio_from_dents",
    "oil_reports",
    "until",
]
