"""Contacts and oils that the tests of a contact over time share."""

import thirdbody as tb
from thirdbody.systems.life.debris import Debris
from thirdbody.systems.life.size_classes import SizeClasses
from thirdbody.systems.oil_filter import Filter

STEEL = tb.materials["S45C"].replace(density=7850.0)
SOFT = STEEL.replace(H=2.5e9)
QUARTZ = tb.materials["quartz"]
CLASSES = SizeClasses.covering(smallest=1e-6, largest=16e-6, per_octave=2)
FRICTION = tb.outputs.Friction(tau_ss=580e6, tau_sa=200e6)
WEAR = dict(K_ss=1e-6, K_sa=0.0, f_ab=0.1, f_roll=0.001, renewal=1.0)
NO_WEAR = dict(K_ss=0.0, K_sa=0.0, f_ab=0.0, f_roll=0.0, renewal=1.0)
DEBRIS = Debris(diameter=tb.LogNormal(median=2e-6, gsd=1.3), hardness=9e9)


def contact(first=STEEL, second=STEEL, *, sigma=100e-9, R=2.8e-6, **wear):
    return tb.Contact(
        surfaces=tb.MaterialPair(first, second),
        roughness=tb.Roughness(sigma=sigma, R=R),
        outputs=(FRICTION, tb.outputs.Wear(**(WEAR | wear))),
    )


def oil(**changes):
    given = dict(
        volume=0.2,
        start=tb.oil.OilDirt.from_iso4406("18/16/13", material=QUARTZ, largest=16e-6),
        ingress=tb.oil.Ingress.from_counts(
            sizes=[4e-6, 6e-6, 14e-6], counts=[1e6, 3e5, 1e4], material=QUARTZ, largest=16e-6
        ),
        filters=Filter(sizes=(5e-6, 10e-6), betas=(2.0, 75.0), flow=1e-3, capacity=0.15),
        viscosity=0.03,
        density=870.0,
        settling_area=0.5,
        classes=CLASSES,
    )
    return tb.oil.OilCircuit(**(given | changes))


FILM = dict(
    conjunction=tb.films.Point(R=9.5e-3),
    lubricant=tb.films.Oil(eta=0.02, alpha=2e-8),
    load=20.0,
    speed=0.5,
    slide_roll=0.05,
    contacts=20.0,
    entry_ratio=0.01,
    worn_area=(1e-3, 1e-3),
)
DRY = dict(
    pressure=5e6,
    sliding_speed=0.1,
    length=1e-2,
    area=1e-4,
    loss=0.3,
    moving=1,
    arrivals=tb.oil.Ingress(
        material=QUARTZ,
        diameter=tb.distributions.PowerLaw(edges=(1e-6, 4e-6), counts=(1,), slopes=(3,)),
        rate=1e4,
    ),
    worn_area=(1e-3, 1e-4),
    classes=CLASSES,
)
