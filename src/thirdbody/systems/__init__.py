"""Systems around a contact: films, oil, bodies, waves, bearings; one module for each.

- `mixed_film`: a film, asperities and particles that carry one load together
- `film_conditions`: a film under its operating conditions, and what it drags in
- `oil_filter`: what a filter lets through
- `oil_particles`: dents that the particles of an oil leave in a film
- `life`: an oil and a contact in it over time
- `bearing_life`: contamination factor and life factor of ISO 281
- `bearing_sizes`: what a designation of a ball bearing stands for
- `load_sharing`: how rolling bodies share a radial load
- `rough_body`: rough spheres and cylinders
- `waviness`: waviness under the roughness
- `fractal`: surfaces without a single scale
- `interaction`: asperities that feel each other
- `coupled`: states that agree with the friction and heat that they make
- `feedback`: what friction and heat change, for `coupled`
- `plate_over_particle`: a plate pressed on a flat with one particle under it
- `chuck`: a plate on a chuck with dust under it
- `connector`: how often contacts fail to close because of dust
- `contact_probability`: whether metal touches metal where dust lies
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from . import bearing_life as bearing_life
    from . import bearing_sizes as bearing_sizes
    from . import chuck as chuck
    from . import connector as connector
    from . import contact_probability as contact_probability
    from . import coupled as coupled
    from . import feedback as feedback
    from . import film_conditions as film_conditions
    from . import fractal as fractal
    from . import interaction as interaction
    from . import life as life
    from . import load_sharing as load_sharing
    from . import mixed_film as mixed_film
    from . import oil_filter as oil_filter
    from . import oil_particles as oil_particles
    from . import plate_over_particle as plate_over_particle
    from . import rough_body as rough_body
    from . import waviness as waviness

__all__ = [
    "bearing_life",
    "bearing_sizes",
    "chuck",
    "connector",
    "contact_probability",
    "coupled",
    "feedback",
    "film_conditions",
    "fractal",
    "interaction",
    "life",
    "load_sharing",
    "mixed_film",
    "oil_filter",
    "oil_particles",
    "plate_over_particle",
    "rough_body",
    "waviness",
]


def __getattr__(name: str) -> Any:
    """A module of this one, imported when it is first asked for: few commands need many."""
    from importlib import import_module

    if name in (*__all__, "machine_elements"):
        return import_module(f".{name}", __name__)
    from ..quantities.nearest import no_attribute

    raise no_attribute(__name__, name, __all__)


def __dir__() -> list[str]:
    return sorted(__all__)
