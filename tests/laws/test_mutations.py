"""Slips planted one at a time: each must break the battery, without the second implementation."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import Any

import battery
import numpy as np
import pytest
from subjects import CASE, FIRST

from thirdbody.laws.asperity import AbstractAsperityLaw, Branch, Jump, elliptic

pytestmark = pytest.mark.check
Law = AbstractAsperityLaw
CHECKS = tuple(check for check in battery.CHECKS if check is not battery.same_as_plain)
ROUND = {name: FIRST[name].law for name in ("gw", "ceb", "zmc", "hermite", "ke", "jg")}
OVAL = {name: FIRST[name].law for name in ("elliptic-ceb", "elliptic-zmc")}
STICKY = {name: FIRST[name].law for name in ("dmt", "jkr")}
EVERY = {**ROUND, **OVAL, **STICKY}
counter = itertools.count()


def slipped(law: Law, **members: Any) -> Law:
    """The law as an instance of a subclass with some members replaced."""
    kind = type(law)
    name = f"Slipped{kind.__name__}{next(counter)}"
    changed: Any = type(name, (kind,), {"__slots__": (), **members})
    return changed(**{field: getattr(law, field) for field in law.__dataclass_fields__})


def onset(law: Law, change: Callable[..., Any]) -> Law:
    """Another yield interference, from the true one and the inputs."""
    true = type(law).yield_interference

    def yield_interference(self, *, R, E_star, H):
        return change(
            lambda **kw: true(self, **{"R": R, "E_star": E_star, "H": H, **kw}), R, E_star
        )

    return slipped(law, yield_interference=yield_interference)


def branch(law: Law, index: int, **changes: Callable[[Branch], Callable[[Any], Any]]) -> Law:
    """One branch with some of its formulas replaced."""
    true = type(law).branches.fget

    def branches(self):
        all_of_them = list(true(self))
        old = all_of_them[index]
        all_of_them[index] = old._replace(**{name: make(old) for name, make in changes.items()})
        return tuple(all_of_them)

    return slipped(law, branches=property(branches))


def times(name: str, factor: float) -> Callable[[Branch], Callable[[Any], Any]]:
    return lambda old: lambda y: factor * getattr(old, name)(y)


def scaled(law: Law, index: int, factor: float) -> Law:
    """Load and stiffness of one branch by a factor: a wrong pressure."""
    return branch(law, index, force=times("force", factor), stiffness=times("stiffness", factor))


def bend(name: str, exponent: float) -> Callable[[Branch], Callable[[Any], Any]]:
    return lambda old: lambda y: getattr(old, name)(1.0) * y**exponent


def jg_constants(law: Law, change: Callable[[float, float, float], tuple]) -> Law:
    true = type(law)._constants
    return slipped(law, _constants=lambda self: change(*true(self)))


def jg_hertz_radius(law: Law) -> Law:
    """H_G with the radius of the Hertz contact."""
    true = type(law)._hardness

    def branches(self):
        C, _, _ = self._constants()
        first, second = type(law).branches.fget(self)

        def force(y):
            unit = 2 / 3 * C / self.hardness_ratio
            soft, _ = true(np.sqrt(self._omega_R * y))
            early = np.exp(-(y ** (5 / 12)) / 4) * y**1.5
            return unit * (early + 4 / C * soft * -np.expm1(-(y ** (5 / 9)) / 25) * y)

        return first, second._replace(force=force)

    return slipped(law, branches=property(branches))


def zmc_area(law: Law) -> Law:
    """3s² − s³ for 3s² − 2s³."""

    def factor(self, y):
        s = (y - 1) / (self.rho - 1)
        return 1 + s * s * (3 - s), 3 * s * (2 - s) / (self.rho - 1)

    return slipped(law, _area_factor=factor)


def later(law: Law, breakpoints: tuple[float, ...]) -> Law:
    return slipped(law, breakpoints=property(lambda self: breakpoints))


def jkr_root(law: Law) -> Law:
    """A root that has not converged near the pull-off."""
    true = type(law)._root
    return slipped(law, _root=staticmethod(lambda y: true(y) * (1 + 0.1 / (1 + np.abs(y)))))


def hermite_slope(law: Law, factor: float) -> Law:
    """Another slope m_0 of the pressure at yield: load and area still join."""
    return slipped(law, _slope=property(lambda self: factor * type(law)._slope.fget(self)))


def declares(law: Law, **members: Any) -> Law:
    """The formulas as they are, and something else said of them."""
    return slipped(law, **{name: property(lambda self, v=v: v) for name, v in members.items()})


SLIPS: dict[str, Callable[[], Law]] = {}
for name, law in EVERY.items():
    SLIPS[f"R for √R, or ω_c without R: {name}"] = lambda law=law: onset(
        law, lambda true, R, E: true(R=1.0)
    )
    SLIPS[f"R² for R: {name}"] = lambda law=law: onset(law, lambda true, R, E: true(R=R * R / 1e-6))
    SLIPS[f"E′ = 2E* for E*: {name}"] = lambda law=law: onset(
        law, lambda true, R, E: true(E_star=2 * E)
    )
    SLIPS[f"stiffness without its factor: {name}"] = lambda law=law: branch(
        law, 0, stiffness=times("stiffness", 2 / 3)
    )
for name, law in {**ROUND, **OVAL}.items():
    SLIPS[f"exponent 1.4 for 1.5: {name}"] = lambda law=law: branch(
        law,
        0,
        force=bend("force", 1.4),
        stiffness=lambda old: lambda y: 1.4 * old.force(1.0) * y**0.4,
    )
    SLIPS[f"elastic area doubled: {name}"] = lambda law=law: branch(law, 0, area=times("area", 2.0))
for name in ("zmc", "hermite", "elliptic-zmc"):
    law = EVERY[name]
    SLIPS[f"ρ = 6 for 54: {name}"] = lambda law=law: law.replace(rho=6.0)
    SLIPS[f"K formula with k: {name}"] = lambda law=law: onset(
        law, lambda true, R, E: true() * 4 / 9
    )
    SLIPS[f"area polynomial: {name}"] = lambda law=law: zmc_area(law)
    SLIPS[f"plastic area 4πRω: {name}"] = lambda law=law: branch(
        law, 2, area=times("area", 2.0), force=times("force", 2.0)
    )
for name in ("ceb", "ke", "elliptic-ceb"):
    law = EVERY[name]
    SLIPS[f"k formula with K: {name}"] = lambda law=law: onset(
        law, lambda true, R, E: true() * 9 / 4
    )
SLIPS |= {
    "H for KH: ceb": lambda: scaled(EVERY["ceb"], 1, 1 / 0.6),
    "H for KH: elliptic-ceb": lambda: scaled(EVERY["elliptic-ceb"], 1, 1 / 0.6),
    "R_A for R_g above yield: elliptic-ceb": lambda: slipped_rule("elliptic-ceb"),
    "R_A for R_g above yield: elliptic-zmc": lambda: slipped_rule("elliptic-zmc"),
    "3x for 3x/K: ke": lambda: scaled(EVERY["ke"], 3, 0.454 + 0.41 * 0.29),
    "1.43 for 1.40: ke": lambda: scaled(EVERY["ke"], 2, 1.43 / 1.40),
    "0.93 in the last area: ke": lambda: branch(EVERY["ke"], 2, area=times("area", 0.93 / 0.94)),
    "54 for 110: ke": lambda: later(EVERY["ke"], (1.0, 6.0, 54.0)),
    "1 for 1.9: jg": lambda: later(EVERY["jg"], (1.0,)),
    "2.3 for 23: jg": lambda: jg_constants(
        EVERY["jg"], lambda C, B, e: (C, 0.14 * math.exp(2.3 * e), e)
    ),
    "E′ for E* in S_y/E*: jg": lambda: jg_constants(
        EVERY["jg"], lambda C, B, e: (C, 0.14 * math.exp(11.5 * e), e / 2)
    ),
    "C without ν: jg": lambda: jg_constants(EVERY["jg"], lambda C, B, e: (1.295, B, e)),
    "radius of Hertz in H_G: jg": lambda: jg_hertz_radius(EVERY["jg"]),
    "H_G of 2.8: jg": lambda: slipped(
        EVERY["jg"],
        _hardness=staticmethod(
            lambda a: tuple(2.80 / 2.84 * v for v in type(EVERY["jg"])._hardness(a))
        ),
    ),
    "an undeclared jump: zmc": lambda: scaled(EVERY["zmc"], 1, 1.001),
    "a jump smoothed away: ceb": lambda: scaled(EVERY["ceb"], 1, 1 / 1.5),
    "πwR for 2πwR: dmt": lambda: branch(
        EVERY["dmt"], 0, force=lambda old: lambda y: 0.5 * (old.force(y) + y**1.5)
    ),
    "root of JKR: jkr": lambda: jkr_root(EVERY["jkr"]),
    "an undeclared jump of the stiffness: hermite": lambda: hermite_slope(EVERY["hermite"], 0.8),
    "an undeclared jump of the area: zmc": lambda: branch(
        EVERY["zmc"], 1, area=times("area", 1.0001)
    ),
    "8πwE* without its 2: jkr": lambda: scaled(EVERY["jkr"], 0, 0.5),
}


def slipped_rule(name: str) -> Law:
    """The volume rule with the elastic radius in the plastic area."""
    law, rule = EVERY[name], "doubling"

    def branches(self):
        return type(law).branches.fget(law.replace(ratio=self.ratio, area_rule=rule))

    return slipped(law, branches=property(branches))


@pytest.mark.parametrize("slip", SLIPS)
def test_the_battery_finds(slip):
    assert battery.failures(SLIPS[slip](), CHECKS, first=True), slip


def without(law: Law, y: float, name: str) -> Law:
    """One of the declared jumps left out."""
    jumps = law.bound(**CASE).jumps
    return declares(law, jumps=jumps | {y: jumps[y]._replace(**{name: 0.0})})


STATEMENTS: dict[str, Callable[[], Law]] = {
    "ke of ν = 0.35 with the last jump of 0.29": lambda: declares(
        EVERY["ke"].replace(nu=0.35), jumps=EVERY["ke"].bound(**CASE).jumps
    ),
    "a jump where none is": lambda: declares(EVERY["gw"], jumps={1.0: Jump(stiffness=0.1)}),
    "a pull that is not there": lambda: declares(EVERY["gw"], onset=-0.1),
    "DMT with the pull of JKR": lambda: declares(
        EVERY["dmt"], onset=EVERY["jkr"].bound(**CASE).onset
    ),
    "JKR parts and forms alike": lambda: declares(
        EVERY["jkr"].replace(unloading=True), onset=EVERY["jkr"].bound(**CASE).onset
    ),
    "a range without a sentence": lambda: declares(EVERY["zmc"], valid_to=100.0),
    "an elastic law for ever": lambda: declares(EVERY["gw"], valid_to=math.inf),
    **{
        f"{name} without its jump of the {what} at {y:g}": lambda name=name, y=y, what=what: (
            without(EVERY[name], y, what)
        )
        for name in ("ceb", "zmc", "ke", "jg", "elliptic-ceb", "elliptic-zmc")
        for y, jump in EVERY[name].bound(**CASE).jumps.items()
        for what, step in jump._asdict().items()
        if step
    },
}
"""What a law says of itself, wrongly."""


@pytest.mark.parametrize("slip", STATEMENTS)
def test_the_battery_finds_a_false_statement(slip):
    said = (
        battery.jumps_are_declared,
        battery.onset_is_declared,
        battery.the_range_ends_where_it_says,
    )
    assert battery.failures(STATEMENTS[slip](), said), slip


@pytest.mark.parametrize("name", EVERY)
def test_the_battery_passes_the_same_law_unplanted(name):
    """Planting nothing breaks nothing: the way of planting is not what the battery finds."""
    assert battery.failures(slipped(EVERY[name]), CHECKS) == []


# the exact ellipse is a function of its own: slips are planted there
def wrong_ellipse(**changes: Callable[[Any, float], float]) -> Callable[[float], Any]:
    true = elliptic.elliptic_hertz

    def hertz(ratio: float) -> Any:
        one = true(ratio)
        return one._replace(**{name: change(one, ratio) for name, change in changes.items()})

    return hertz


ELLIPSES: dict[str, Callable[[], Callable[[float], Any]]] = {
    "R_g for R_A": lambda: wrong_ellipse(R_A=lambda one, ratio: 1.0),
    "R″ for R′": lambda: wrong_ellipse(
        R_A=lambda one, ratio: one.R_A / ratio, yield_factor=lambda one, r: one.yield_factor / r
    ),
    "yield of the circle": lambda: wrong_ellipse(
        yield_factor=lambda one, ratio: 9 * math.pi**2 / 16
    ),
    "k without its square": lambda: wrong_ellipse(
        yield_factor=lambda one, ratio: one.yield_factor / one.k
    ),
    "modulus for parameter": lambda: wrong_ellipse(
        R_A=lambda one, ratio: one.R_A * one.K / modulus(one)
    ),
}


def modulus(one: Any) -> float:
    from scipy.special import ellipk

    return float(ellipk(math.sqrt(1 - one.k**2)))


@pytest.mark.parametrize("law", OVAL.values(), ids=OVAL)
@pytest.mark.parametrize("slip", ELLIPSES)
def test_the_battery_finds_a_wrong_ellipse(slip, law, monkeypatch):
    planted = slipped(law)  # a class of its own: no cached sums
    monkeypatch.setattr(elliptic, "elliptic_hertz", ELLIPSES[slip]())
    assert battery.failures(planted, CHECKS, first=True), slip


def test_what_finds_what():
    """Several checks see a gross slip; a fine one is seen by the check that was made for it."""
    rough = battery.failures(SLIPS["E′ = 2E* for E*: ceb"](), CHECKS)
    assert {"elastic_limit", "pressure_at_yield", "hard_is_elastic"} <= set(rough)
    for slip in SLIPS:
        if "undeclared jump" in slip:
            assert battery.failures(SLIPS[slip](), (battery.jumps_are_declared,)), slip
    assert "published" in battery.failures(SLIPS["2.3 for 23: jg"](), CHECKS)
    assert "plastic_limit" in battery.failures(SLIPS["H for KH: ceb"](), CHECKS)
    assert "any_units" in battery.failures(SLIPS["R for √R, or ω_c without R: gw"](), CHECKS)


def test_the_second_implementation_finds_them_too():
    """And alone: what it would say of the slips, were the rest of the battery not there."""
    silent = {
        slip
        for slip, plant in SLIPS.items()
        if not battery.failures(plant(), (battery.same_as_plain, battery.stiffness_is_the_slope))
    }
    assert silent == set()
