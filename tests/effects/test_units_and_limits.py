"""One battery for every output: change of units, swapped surfaces, no particles, more nodes.

A change of the five base units scales every input by the dimension that its field declares, and
must scale every column by the dimension that it declares: a hidden length or stress would show.
"""

import dataclasses
import warnings
from functools import cache, reduce

import numpy as np
import pint
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import thirdbody as tb
from thirdbody.contact.evaluation import Solved, spots_of
from thirdbody.contact.interface import interface
from thirdbody.contact.output import column
from thirdbody.quantities.value import Value

UNITS = pint.get_application_registry()
BASES = ("[length]", "[mass]", "[time]", "[temperature]", "[current]")
BODY = dict(thermal_conductivity=50, density=7850, specific_heat=480, resistivity=2e-7)
STEEL = tb.materials["S45C"].replace(**BODY)
SOFT = STEEL.replace(H=3e9, thermal_conductivity=30, resistivity=5e-7)
GLASS = tb.materials["SiO2"].replace(
    thermal_conductivity=1.4, density=2200, specific_heat=740, resistivity=1e-3
)
OUTPUTS = {
    "counts": tb.outputs.Counts(),
    "friction": tb.outputs.Friction(tau_ss=580e6, tau_sa=200e6),
    "static_friction": tb.outputs.StaticFriction(),
    "flash_temperature": tb.outputs.FlashTemperature(v=0.7, A_n=1e-6),
    "thermal_conductance": tb.outputs.ThermalConductance(k_gap=0.03, M=0.4e-6, film=1e-9),
    "electrical_conductance": tb.outputs.ElectricalConductance(
        particles="conduct", film=1e-13, mean_free_path=40e-9
    ),
    "wear": tb.outputs.Wear(K_ss=1e-4, K_ss_e=1e-6, K_sa=1e-4, f_ab=0.1, f_roll=0.01),
    "dents": tb.outputs.Dents(),
}


def contact(x_a=300e-9, density=1e10, first=STEEL, second=SOFT, outputs=tuple(OUTPUTS.values())):
    sizes = tb.TruncatedGaussian(mean=x_a, std=0.2 * x_a)
    dust = tb.Particles(material=GLASS, diameter=sizes, areal_density=density)
    return tb.Contact(
        surfaces=tb.MaterialPair(first, second),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=dust if density else None,
        particle_law=tb.particle.Series(deep="off"),
        outputs=outputs,
    )


def solved(case, **load):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tb.errors.RangeWarning)
        return tb.solve(case, **load)


@cache
def dimension(unit):
    powers = UNITS.parse_units(unit.replace("^", "**")).dimensionality if unit != "1" else {}
    return tuple(float(powers.get(base, 0)) for base in BASES)


def factor(unit, scales):
    return float(np.prod(np.asarray(scales) ** np.asarray(dimension(unit))))


def in_other_units(value, scales):
    """The same thing, every number in other base units."""
    if isinstance(value, tuple):
        return tuple(in_other_units(each, scales) for each in value)
    if not isinstance(value, Value):
        return value
    changes = {}
    for item in dataclasses.fields(value):
        part = getattr(value, item.name)
        if about := item.metadata.get("quantity"):
            if part is not None:
                changes[item.name] = part * factor(about["unit"], scales)
        elif isinstance(part, (Value, tuple)):
            changes[item.name] = in_other_units(part, scales)
    return value.replace(**changes)


BREAKING = {"crushing": tb.outputs.Crushing()}
"""Outputs of particles that break."""


def test_every_output_is_here():
    assert {*OUTPUTS, *BREAKING} == set(tb.outputs.REGISTRY)


ratios = st.floats(-0.7, 0.7).map(lambda power: 10.0**power)


def rounding(name):
    """How closely a column is known: percentiles and extremes of dents are interpolated."""
    return 1e-3 if name.startswith("dent_") and ("_p95" in name or "_max" in name) else 1e-6


@pytest.mark.check
@settings(max_examples=5, deadline=None)
@given(
    scales=st.tuples(ratios, ratios, ratios, ratios, ratios),
    pressure=st.floats(6, 7.7).map(lambda power: 10.0**power),
    x_a=st.floats(150e-9, 500e-9),
)
def test_change_of_units(scales, pressure, x_a):
    case = contact(x_a)
    here = solved(case, pressure=pressure)
    there = solved(in_other_units(case, scales), pressure=pressure * factor("Pa", scales))
    for name, value in here.outputs.items():
        unit = column(name).unit
        other = there.outputs[name] / factor(unit, scales)
        rel = rounding(name)
        assert other == pytest.approx(value, rel=rel, abs=1e-300, nan_ok=True), (name, unit)


@pytest.mark.slow
@settings(max_examples=4, deadline=None)
@given(scales=st.tuples(ratios, ratios, ratios, ratios, ratios), gap=st.floats(0.05, 0.9))
def test_change_of_units_where_particles_break(scales, gap):
    case = contact(20e-6, density=1e7, outputs=())
    strength = tb.grains.WeibullStrength(
        sigma_0=80e6, x_0=1e-3, m=3.0, size_exponent=0.55, x_c=1e-6
    )
    dust = case.particles.replace(strength=strength)
    case = case.replace(particles=dust, outputs=tuple(BREAKING.values()))
    here = solved(case, d=gap * 20e-6)
    there = solved(in_other_units(case, scales), d=gap * 20e-6 * factor("m", scales))
    for name, value in here.outputs.items():
        other = there.outputs[name] / factor(column(name).unit, scales)
        counted = name in ("fragment_size", "survivor_max")  # read from counts at levels
        rel = 1e-3 if counted else 1e-6
        assert other == pytest.approx(value, rel=rel, abs=1e-300, nan_ok=True), name


# columns of surface 1 and of surface 2, and those that a swap leaves
def swapped(name):
    for one, two in (("_1", "_2"), ("_2", "_1")):
        if name.endswith(one):
            return name.removesuffix(one) + two
    return name


@pytest.mark.slow
@settings(max_examples=4, deadline=None)
@given(
    pressure=st.floats(6, 7.7).map(lambda power: 10.0**power),
    x_a=st.floats(150e-9, 500e-9),
    hardness=st.floats(2.5e9, 9e9),
)
def test_swapped_surfaces(pressure, x_a, hardness):
    other = STEEL.replace(H=hardness)
    heat = OUTPUTS["flash_temperature"]
    mirrored = heat.replace(spots_on="first")
    here = solved(contact(x_a, second=other), pressure=pressure)
    outputs = tuple(mirrored if each == heat else each for each in OUTPUTS.values())
    there = solved(contact(x_a, first=other, second=STEEL, outputs=outputs), pressure=pressure)
    # areas, mean pressure and pull of particles are told of surface 1
    one_sided = {"p_sa"}
    for name, value in here.outputs.items():
        if name not in one_sided:
            rel = rounding(name)
            assert there.outputs[swapped(name)] == pytest.approx(value, rel=rel, nan_ok=True), name


def test_few_particles_are_no_particles():
    bare = solved(contact(density=0), pressure=5e6).outputs
    few = solved(contact(density=1.0), pressure=5e6).outputs
    for name, value in bare.items():
        if np.isfinite(value) and np.isfinite(few[name]) and "peak" not in name:
            # what single particles do stays, how much there is of it goes
            scale = {"mu": 1.0}.get(name.split("_")[0], abs(value))
            if value != 0:
                assert few[name] == pytest.approx(value, rel=1e-4, abs=1e-12 * scale), name


def test_finer_nodes():
    """Sums do not depend on how the particles were binned."""
    case = contact()
    state = solved(case, pressure=np.array([2e6, 2e7]))
    bound = interface(case)
    asperities, particles = spots_of(case, bound, state.d, state.shadow)
    (response,) = bound.populations
    splits = reduce(
        set.union,
        (
            set(
                each.splits(
                    lambda eps: dataclasses.replace(
                        case.particle_law.probe(eps, surfaces=case.surfaces, particle=GLASS),
                        material=GLASS,
                    )
                )
            )
            for each in case.outputs
        ),
    )
    finer = [
        dataclasses.replace(spots, population=case.particles, material=GLASS)
        for spots in response.spots(state.d, sorted({*splits, *np.geomspace(1e-3, 0.4, 11)}))
    ]
    given_state = dict(contact=case, d=state.d, h=state.h, pressure=state.pressure, A_t=state.A_t)
    for output in case.outputs:
        coarse = output.of(Solved(**given_state, asperities=asperities, particles=particles))
        fine = output.of(Solved(**given_state, asperities=asperities, particles=finer))
        for name, value in coarse.items():
            counted = any(word in name for word in ("_p50", "_p95", "_p99", "_peak", "_max", "T_"))
            allowed = 2e-2 if counted else 1e-6
            np.testing.assert_allclose(fine[name], value, rtol=allowed, atol=1e-300, err_msg=name)
