"""States a second of `solve_states` for every law, seat and size, whatever input varies.

    python benchmarks/engine_matrix.py                        # all rows, one thread
    python benchmarks/engine_matrix.py --only "plane, hard"   # rows whose name holds these words
    python benchmarks/engine_matrix.py --seconds 0.3 --json found.json --beside before.json
    python benchmarks/engine_matrix.py --seconds 0.3 --page   # and its part of results.md

One input varies by ±8 %, the load from F* = 1e-6 to 1e-4. Processor time of one thread.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import time
import warnings
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

import thirdbody as tb
from thirdbody.equilibrium.states import state_columns

SPREAD, LOADS = 0.08, (1e-6, 1e-4)
"""Of the input that varies, and F*."""
FEWEST, FIRST, MOST = 24, 256, 200_000
"""States of a block: at least, at first, at most."""
SLOW = 1e5
"""States a second below which a row is told of."""
TITLE = "## One input that varies, for every law, seat and size"
ABOUT = (
    "States a second of one thread, by `benchmarks/engine_matrix.py`: one input varies by ±8 %, "
    f"the load from F* = {LOADS[0]:g} to {LOADS[1]:g}; every state has its own."
)


@dataclass
class Row:
    """One combination and what was measured of it."""

    case: str
    varied: str
    rate: float
    states: int
    failed: int
    engine: str

    @property
    def name(self) -> str:
        return f"{self.case}: {self.varied}"


ROUGHNESS = ("roughness.sigma", "roughness.R", "roughness.alpha")
DENSITY = "particles.areal_density"
SIZES = tuple(f"particles.diameter.{name}" for name in ("mean", "std", "n"))
BODY = tuple(f"particles.material.{name}" for name in ("H", "E", "nu"))
SURFACE = ("surfaces.first.H", "surfaces.first.E")
FRICTION = "particle_law.friction_factor"
SERIES = (*ROUGHNESS, DENSITY, *SIZES, *BODY, *SURFACE)
SOME = ("roughness.sigma", SIZES[0], SIZES[1], BODY[0])


def pieces() -> tuple[tb.Contact, tb.Particles, tb.Material]:
    """Two-body contact, hard particles, and the material of soft ones."""
    steel = tb.materials["S45C"]
    bare = tb.Contact(
        surfaces=tb.MaterialPair(steel, steel),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6, alpha=5.0),
    )
    hard = tb.Particles(
        material=tb.materials["SiO2"],
        areal_density=1e11,
        diameter=tb.TruncatedGaussian(mean=300e-9, std=30e-9, n=3.0),
    )
    return bare, hard, steel.replace(H=1e9)


def of_particles() -> Iterator[tuple[str, tb.Contact, tuple[str, ...]]]:
    """Contacts with particles between round asperities, and the inputs that vary in turn."""
    bare, hard, soft_body = pieces()
    soft = hard.replace(material=soft_body)

    def contact(particles=hard, law=None, **options) -> tb.Contact:
        law = law or tb.particle.Series(**options)
        return bare.replace(particles=particles, particle_law=law)

    for kind, particles, more in (("hard", hard, ()), ("squashed", soft, (FRICTION,))):
        for seat in ("rough", "plane"):
            inputs = SERIES + (more if seat == "rough" else ())
            yield f"Series {seat}, {kind}", contact(particles, seat=seat), inputs
    for name, law, more in (("KE", tb.asperity.KE(), ()), ("ZMC", tb.asperity.ZMC(), ("k",))):
        own = tuple(f"particle_law.law.{each}" for each in more)
        inputs = (*SOME, SURFACE[1], *own)
        yield f"Series rough, law={name}", contact(law=tb.particle.Series(law=law)), inputs
    for seat in ("rough", "plane"):
        deep = contact(soft, seat=seat, deep="table")
        yield f"Series {seat}, deep", deep, (*SOME, BODY[1], *SURFACE, FRICTION)
    yield (
        "Flakes rough",
        contact(law=tb.particle.Flakes(aspect=2.0)),
        (*SOME, BODY[1], SURFACE[1], "particle_law.aspect"),
    )
    printed = (*ROUGHNESS[:2], DENSITY, *SIZES[:2], BODY[0], *SURFACE)
    yield "Horng2022", contact(law=tb.particle.Horng2022()), printed
    grit = tb.grains.Angular(roundness=0.25, angle=math.radians(35))
    angle, roundness = "particles.shape.angle", "particles.shape.roundness"
    for seat, inputs in (
        ("rough", (*SOME, BODY[1], SURFACE[0], angle, roundness)),
        ("plane", (*SOME, angle)),
    ):
        yield f"angular {seat}", contact(hard.replace(shape=grit), seat=seat), inputs
    strength = tb.grains.WeibullStrength(
        sigma_0=67e6, x_0=1e-3, m=3.0, size_exponent=0.55, x_c=50e-9
    )
    names = tuple(f"particles.strength.{each}" for each in ("sigma_0", "m", "size_exponent"))
    for seat, inputs in (
        ("rough", (ROUGHNESS[0], DENSITY, *SIZES[:2], BODY[0], SURFACE[0], *names)),
        ("plane", (ROUGHNESS[0], SIZES[0], *names[:2])),
    ):
        yield f"breaking {seat}", contact(hard.replace(strength=strength), seat=seat), inputs
    wide = hard.replace(diameter=tb.LogNormal(median=300e-9, gsd=1.3))
    median, gsd = "particles.diameter.median", "particles.diameter.gsd"
    for seat, inputs in (
        ("rough", (ROUGHNESS[0], median, gsd, BODY[0], SURFACE[1])),
        ("plane", (ROUGHNESS[0], median, gsd, BODY[0])),
    ):
        yield f"LogNormal {seat}", contact(wide, seat=seat), inputs
    edges, counts = (4e-6, 6e-6, 14e-6, 70e-6), (1350.0, 396.0, 56.6)  # of an oil 18/16/13
    dirt = tb.distributions.PowerLaw(edges=edges, counts=counts, slopes=(3.41, 2.45, 3.34))
    for kind, particles in (("hard", hard), ("squashed", soft)):
        oil = contact(particles.replace(diameter=dirt, areal_density=1e6))
        yield f"dirt of an oil, {kind}", oil, (ROUGHNESS[0], DENSITY, BODY[0], *SURFACE, FRICTION)
    one = hard.replace(diameter=tb.distributions.Monodisperse(mean=300e-9))
    inputs = (ROUGHNESS[0], SIZES[0], BODY[0])
    field = contact().replace(asperity_law=tb.asperity.Field())
    yield "field, Series rough", field, (*ROUGHNESS, DENSITY, SIZES[0], BODY[0], SURFACE[0])
    yield "Monodisperse plane", contact(one, seat="plane"), inputs
    both = (hard, soft.replace(areal_density=5e10))
    yield "two populations", contact(both), (ROUGHNESS[0], *SURFACE)


def of_asperities() -> Iterator[tuple[str, tb.Contact, tuple[str, ...]]]:
    """Two-body contacts by the law of their asperities and by their heights."""
    bare, _, _ = pieces()
    law = tb.asperity
    three = (ROUGHNESS[0], *SURFACE)
    for name, made, own in (
        ("gw", law.GW(), ()),
        ("jkr", law.JKR(w=0.05), ("w",)),
        ("dmt", law.DMT(w=0.05), ("w",)),
        ("ceb", law.CEB(), ()),
        ("coated", law.Coated(E_1=3e11, nu_1=0.25, t=50e-9), ("E_1", "nu_1", "t")),
        ("zmc", law.ZMC(), ("k", "rho")),
        ("elliptic-ceb", law.EllipticCEB(ratio=2.0), ("ratio",)),
        ("elliptic-zmc", law.EllipticZMC(ratio=2.0), ("k", "rho", "ratio")),
        ("hermite", law.Hermite(), ("k", "rho")),
        ("jg", law.JG(), ("hardness_ratio",)),
        ("ke", law.KE(), ()),
    ):
        inputs = (*three, *(f"asperity_law.{each}" for each in own))
        yield f"asperity {name}", bare.replace(asperity_law=made), inputs
    for heights in (tb.heights.WeibullHeights(shape=3.0), tb.heights.ExponentialHeights()):
        name = type(heights).__name__.removesuffix("Heights")
        rough = bare.roughness.replace(heights=heights)
        yield f"heights {name}", bare.replace(roughness=rough), three[:2]
    field = bare.replace(asperity_law=law.Field())
    yield "asperity field", field, (*ROUGHNESS, *SURFACE)
    shapes = tb.surfaces.Ellipticity(ratios=(1.0, 3.0))
    rough = bare.roughness.replace(ellipticity=shapes)
    elliptic = bare.replace(roughness=rough, asperity_law=law.EllipticCEB())
    yield "elliptic population", elliptic, (ROUGHNESS[0],)


def cases() -> list[tuple[str, tb.Contact, str]]:
    """Every row: its case, the contact and the input that varies."""
    return [
        (name, contact, varied)
        for source in (of_particles(), of_asperities())
        for name, contact, inputs in source
        for varied in inputs
    ]


def inputs_of(contact: tb.Contact, varied: str, count: int) -> tuple[np.ndarray, np.ndarray]:
    """F* and the values of the varied input of so many states."""
    rng = np.random.default_rng(3)
    value: object = contact
    for part in varied.split("."):
        value = getattr(value, part)
    spread = rng.uniform(1 - SPREAD, 1 + SPREAD, count)
    return np.geomspace(*LOADS, count)[rng.permutation(count)], float(str(value)) * spread


def measured(case: str, contact: tb.Contact, varied: str, seconds: float) -> Row:
    """The rate of one row: blocks grow until one takes long enough."""
    count, spent = FEWEST, 0.0
    loads, values = inputs_of(contact, varied, count)
    state_columns(contact, F_star=loads, vary={varied: values})  # what is compiled is read in
    while True:
        loads, values = inputs_of(contact, varied, count)
        start = time.process_time()
        found = state_columns(contact, F_star=loads, vary={varied: values})
        spent = time.process_time() - start
        if spent >= 0.25 * seconds or count >= MOST:
            break
        more = int(count * min(0.8 * seconds / max(spent, 1e-9), 16.0))
        count = min(max(more, FIRST), MOST)
    engines, each = np.unique(found["engine"].astype(str), return_counts=True)
    engine = str(engines[np.argmax(each)])
    if len(engines) > 1:
        engine += f" ({each.max() / count:.1%})"
    return Row(case, varied, count / spent, count, int(np.sum(found["status"] != "ok")), engine)


def told(rows: list[Row], before: dict[str, float]) -> str:
    """The table, how many rows are fast, and the slowest ten."""
    head = "| case | input varied | states/s | before | n | failed | engine |"
    lines = [head, "|---|---|---|---|---|---|---|"]
    for row in rows:
        old = f"{before[row.name]:.3g}" if row.name in before else ""
        lines.append(
            f"| {row.case} | {row.varied} | {row.rate:.3g} | {old} | {row.states} | {row.failed} "
            f"| {row.engine} |"
        )
    fast = sum(row.rate >= SLOW for row in rows)
    poor = sum(row.rate < 1e3 for row in rows)
    middle = len(rows) - fast - poor
    lines += [
        "",
        f"Of {len(rows)} rows {fast} reach 1e5 states/s, {middle} lie between 1e3 and 1e5, "
        f"{poor} below 1e3.",
        "",
        "The slowest ten:",
        "",
    ]
    for row in sorted(rows, key=lambda row: row.rate)[:10]:
        lines.append(f"- {row.name}: {row.rate:.3g} ({row.engine})")
    return "\n".join(lines) + "\n"


def write_part(text: str) -> None:
    """Put the matrix at the end of results.md, in place of the one there."""
    page = Path(__file__).parent / "results.md"
    rest = page.read_text("utf-8") if page.exists() else ""
    page.write_text(f"{rest.partition(TITLE)[0].rstrip()}\n\n{TITLE}\n\n{ABOUT}\n\n{text}", "utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", default="", help="rows whose name holds these words")
    parser.add_argument("--seconds", type=float, default=2.0, help="of a block")
    parser.add_argument("--json", type=Path, help="file for what is found, which keeps other rows")
    parser.add_argument("--beside", type=Path, help="such a file, for the rates before")
    parser.add_argument("--page", action="store_true", help="write it into results.md")
    asked = parser.parse_args()
    os.environ["THIRDBODY_THREADS"] = "1"
    warnings.simplefilter("ignore")
    before, kept = {}, {}
    if asked.beside:
        data = json.loads(asked.beside.read_text("utf-8"))
        before = {name: each["rate"] for name, each in data.items()}
    if asked.json and asked.json.exists():
        kept = json.loads(asked.json.read_text("utf-8"))
    rows = []
    for case, contact, varied in cases():
        if asked.only not in f"{case}: {varied}":
            continue
        row = measured(case, contact, varied, asked.seconds)
        rows.append(row)
        print(f"{row.rate:9.3g}  {row.name}  ({row.engine})", flush=True)
        if asked.json:
            kept[row.name] = asdict(row)
            asked.json.write_text(json.dumps(kept, indent=1) + "\n", "utf-8")
    print("\n" + told(rows, before))
    if asked.page:
        write_part(told(rows, before))


if __name__ == "__main__":
    main()
