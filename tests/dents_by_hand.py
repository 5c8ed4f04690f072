"""Dents of a contact by brute force: what the fast sums over sizes, seats and squeezes must give.

Written from the formulas that the docstrings of `thirdbody.outputs.Dents` and of
`thirdbody.effects.single.dent` state. Of the library only a law's answer for one particle is taken,
its sizes' density, and where its seats lie. One particle over its squeeze is split wherever any of
its formulas changes, the sizes by an adaptive rule that halves panels until nothing changes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

import thirdbody as tb
from thirdbody.laws.particle.squashed import widest_disc

Array = np.ndarray
REACH = 9.0
"""Widths of the seat beyond which nothing is counted."""
FAR = 1e4
"""Largest squeeze at which formulas are looked at: particles in gaps that are long closed."""

# ------------------------------------------------------------------------------ quadrature
K15 = np.array([0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
                0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
                0.586087235467691130294144691693357, 0.405845151377397166906606412076961,
                0.207784955007898467600689403773245, 0.0])  # fmt: skip
W15 = np.array([0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
                0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
                0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
                0.204432940075298892414161999234649, 0.209482141084727828012999174891714])  # fmt: skip
W7 = np.array([0.0, 0.129484966168869693270611432679082, 0.0, 0.279705391489276667901467771423780,
               0.0, 0.381830050505118944950369775488975, 0.0, 0.417959183673469387755102040816327])  # fmt: skip
NODES = np.concatenate([-K15, K15[-2::-1]])
KRONROD, GAUSS = (np.concatenate([w, w[-2::-1]]) for w in (W15, W7))


def integrate(f: Callable[[Array], Array], edges: Sequence[float], rtol: float = 1e-11) -> Array:
    """∫f over increasing edges, f(x) (n, k) of sizes (n,): panels are halved until they agree."""
    edges = np.unique(edges)
    a, b, total = edges[:-1], edges[1:], 0.0
    scale = None
    for _ in range(60):
        half, middle = 0.5 * (b - a), 0.5 * (b + a)
        x = middle[:, None] + half[:, None] * NODES
        values = f(x.ravel()).reshape(*x.shape, -1)
        fine = half[:, None] * np.einsum("pnk,n->pk", values, KRONROD)
        coarse = half[:, None] * np.einsum("pnk,n->pk", values, GAUSS)
        whole = total + np.abs(fine).sum(axis=0)
        scale = whole if scale is None else np.maximum(scale, np.abs(whole))
        good = np.all(np.abs(fine - coarse) <= rtol * scale, axis=1)
        good |= half <= 1e-15 * np.abs(middle)
        total = total + fine[good].sum(axis=0)
        if good.all():
            break
        a, b, middle = a[~good], b[~good], middle[~good]
        a, b = np.concatenate([a, middle]), np.concatenate([middle, b])
    return np.atleast_1d(total)


# ------------------------------------------------------------------------------ one particle
@dataclass(frozen=True)
class One:
    """What one particle of unit size leaves in one surface, over its squeeze ε."""

    law: tb.particle.Series
    surfaces: tb.MaterialPair
    particle: tb.Material
    side: int
    debris: str

    def raw(self, eps: Array) -> dict[str, Array]:
        spots = self.law.probe(np.ravel(eps), surfaces=self.surfaces, particle=self.particle)
        pick = lambda q: q[self.side][:, 0]  # noqa: E731
        out = {"delta": pick(spots.depths), "sink": pick(spots.sinks), "area": pick(spots.areas)}
        out |= {"load": spots.load[:, 0], "tip": spots.radius[:, 0], "half": spots.half[:, 0]}
        out["first"] = np.full_like(out["load"], spots.yields[self.side])
        out["knows"] = np.full(len(out["load"]), spots.knows_sink[self.side])
        out["round"] = np.full(len(out["load"]), spots.shape is None or spots.shape.round)
        out["eps"] = np.ravel(eps)
        return out

    @cached_property
    def flat(self) -> bool:
        """Whether depth and volume are not known."""
        body = (self.surfaces.first, self.surfaces.second)[self.side]
        knows = bool(self.raw(np.array([0.1]))["knows"][0])
        if self.debris == "hard":
            return False
        if self.debris == "ductile":
            return True
        return not (knows or self.particle.H > min(self.particle.H, body.H))

    @cached_property
    def squashed(self) -> bool:
        body = (self.surfaces.first, self.surfaces.second)[self.side]
        form = self.law.forms(self.surfaces, self.particle)[self.side]
        return form is not None and (not self.law.follows_table or self.particle.H <= body.H)

    @cached_property
    def widest(self) -> float:
        if self.squashed:
            return math.inf
        H = (self.surfaces.first, self.surfaces.second)[self.side].H
        m_f = self.law.friction_factor
        return widest_disc(min(self.particle.H, H), H, friction_factor=m_f)

    def of(self, eps: Array) -> dict[str, Array]:
        """Depth left, width, volume and sink of unit size; which formulas hold, as rows of bools."""
        raw = self.raw(eps)
        kinds = [raw["load"] > 0]
        if self.flat:
            zero = np.zeros_like(raw["load"])
            if self.squashed:
                width = 2 * np.sqrt(raw["area"] / math.pi)
            else:
                gap = np.maximum(1 - np.ravel(eps), 1e-3)
                disc = np.sqrt(np.maximum(2 / (3 * gap), 1.0))
                kinds += [2 / (3 * gap) > 1, np.ravel(eps) > 1 - 1e-3, disc > self.widest]
                width = np.where(raw["load"] > 0, np.minimum(disc, self.widest), 0.0)
            return {"depth": zero, "width": width, "volume": zero, "deep": zero, "kinds": kinds,
                    "half": raw["half"]}  # fmt: skip
        deep = np.minimum(raw["delta"] if self.debris == "hard" else raw["sink"], 1.0)
        a = np.sqrt(raw["area"] / math.pi)
        r = raw["tip"]
        if self.debris != "hard" and raw["knows"][0]:
            d = raw["sink"]
            with np.errstate(all="ignore"):
                cap = np.where(d < a, (a * a + d * d) / (2 * d), a)
            r = np.maximum(r, np.where(d > 0, cap, 0.0))
            kinds += [r > raw["tip"], d > a]
        s = np.maximum(deep / raw["first"], 1.0)
        left = deep * (1 - s**-0.28) * (1 - s**-0.69)
        pressed = np.minimum(deep, r)
        width = 2 * np.sqrt(2 * r * pressed - pressed**2)
        cap = np.minimum(left, r)
        volume = math.pi / 6 * cap * (0.75 * width**2 + cap**2)
        volume += math.pi * r * r * np.maximum(left - r, 0.0)
        kinds += [deep > raw["first"], deep > r, left > r, deep >= 1, 2 * deep > raw["half"]]
        there = left > 0
        return {"depth": left, "width": there * width, "volume": there * volume, "deep": deep,
                "kinds": kinds, "half": raw["half"]}  # fmt: skip

    @cached_property
    def splits(self) -> Array:
        """Squeezes at which a formula changes: those of the law, and those found by halving."""
        one = self.law.one(surfaces=self.surfaces, particle=self.particle)
        own = [float(e) for e in (*one.kinks, *one.sink_bends)]
        own += [e * (1 + s) for e in own for s in (-1e-13, 1e-13)]
        grid = np.unique([*np.geomspace(1e-9, FAR, 20_000), *np.linspace(1e-4, 3, 20_000), *own])
        kinds = np.array(self.of(grid)["kinds"])
        found = set()
        for row in range(len(kinds)):
            at = np.flatnonzero(kinds[row, 1:] != kinds[row, :-1])
            a, b, first = grid[at], grid[at + 1], kinds[row, at]
            for _ in range(60):
                middle = 0.5 * (a + b)
                if not len(middle):
                    break
                same = np.array(self.of(middle)["kinds"])[row] == first
                a, b = np.where(same, middle, a), np.where(same, b, middle)
            found |= set(b.tolist())
        return np.array(sorted({*map(float, one.kinks), *map(float, one.sink_bends), *found}))

    def stretches(self, name: str, values: Array) -> list[list[tuple[float, float]]]:
        """Between which ε f of a unit size exceeds each value: by halving between dense ε."""
        grid, f, across = self._table(name)
        values = np.asarray(values, dtype=float)
        above = f > values[:, None]
        row, at = np.nonzero(np.diff(above, axis=1))
        low, high, first = grid[at], grid[at + 1], above[row, at]
        for _ in range(56 if len(row) else 0):
            middle = 0.5 * (low + high)
            same = (self._f(name, middle) > values[row]) == first
            same |= across[at]  # across a split it is the jump itself
            low, high = np.where(same, middle, low), np.where(same, high, middle)
        roots = 0.5 * (low + high)
        out = []
        for i in range(len(values)):
            ends = [0.0] * bool(above[i, 0]) + roots[row == i].tolist()
            ends += [math.inf] * bool(above[i, -1])
            out.append(list(zip(ends[::2], ends[1::2], strict=True)))
        return out

    def _f(self, name: str, eps: Array) -> Array:
        values = self.of(eps)
        return (
            2 * values["deep"] / values["half"] * (values["depth"] > 0)
            if name == "sunk"
            else values[name]
        )

    def _table(self, name: str) -> tuple[Array, Array, Array]:
        kept = self.__dict__.setdefault("tables", {})
        if name not in kept:
            edges = np.array([1e-9, *self.splits[(self.splits > 1e-9) & (self.splits < FAR)], FAR])
            grid = []
            for a, b in zip(edges, edges[1:], strict=False):
                if b - a <= 1e-12 * b:
                    continue
                off = 1e-15 * b
                s = np.unique(
                    np.concatenate([np.geomspace(1e-9, 0.5, 40), 1 - np.geomspace(1e-9, 0.5, 40)])
                )
                s = np.concatenate([[0.0], s, [1.0]])
                grid.append(np.unique((a + off) + s * (b - a - 2 * off)))
            cross = np.concatenate([np.append(np.zeros(len(g) - 1, bool), True) for g in grid])[:-1]
            grid = np.concatenate(grid)
            kept[name] = (grid, self._f(name, grid), cross)
        return kept[name]


# ------------------------------------------------------------------------------ a contact
@dataclass(frozen=True)
class ByHand:
    """Dents of one population in one surface at a separation d."""

    contact: tb.Contact
    d: float
    side: int

    @cached_property
    def one(self) -> One:
        population = self.contact.populations[0]
        law = self.contact.law_of(population)
        debris = self.contact.outputs[0].debris
        return One(law, self.contact.surfaces, population.material, self.side, debris)

    @property
    def dents(self):
        return self.contact.outputs[0]

    @property
    def mean(self) -> float:
        law, rough = self.one.law, self.contact.roughness
        if law.seat == "plane":
            return self.d
        return self.d + rough.y_s - law.zeta_mean * rough.sigma

    @property
    def width(self) -> float:
        law = self.one.law
        return 0.0 if law.seat == "plane" else law.zeta_std * self.contact.roughness.sigma

    def average(self, of: Callable[[Array, Array, Array], Array], inner: Callable[[Array], list[list[float]]],
                more: Sequence[float] = ()) -> Array:  # fmt: skip
        """Sum over particles or their fragments of q(x, ε) (n, k), split at ε ``inner(x)``."""
        more = list(more)
        if self.width == 0 and self.mean != 0:
            here = [e for e in (0.0, *self.one.splits) if (e < 1) == (self.mean > 0) and e != 1]
            more += [self.mean / (1 - e) for e in here]
        return self._over_sizes(lambda x: self._seats(of, inner, x), more)

    def _seats(self, of, inner, x: Array) -> Array:
        """Mean over seats of q (n, k) for sizes (n,)."""
        if self.width == 0:
            eps = 1 - self.mean / x
            values = of(x, eps)
            return np.where(eps[:, None] > 0, values, 0.0)
        node, weight = np.polynomial.legendre.leggauss(16)
        rows, at, w = [], [], []
        for i, (size, more) in enumerate(zip(x, inner(x), strict=True)):
            low = max(1 - (self.mean + REACH * self.width) / size, 0.0)
            high = 1 - (self.mean - REACH * self.width) / size
            if high <= low:
                continue
            ends = [e for e in more if low < e < high]
            ends = np.array(sorted({low, *ends, high}))
            step = 1.0 * self.width / size
            parts = []
            for a, b in zip(ends, ends[1:], strict=False):
                if b - a < 1e-15 * b:
                    continue
                cuts = np.linspace(a, b, max(1, math.ceil((b - a) / step)) + 1)
                # dense near where a formula sets in
                grade = a + (b - a) * np.array([1e-6, 1e-4, 1e-3, 1e-2, 0.05, 0.2])
                parts.append(np.unique([*cuts, *grade]))
            for cuts in parts:
                half, middle = 0.5 * np.diff(cuts), 0.5 * (cuts[1:] + cuts[:-1])
                e = (middle[:, None] + half[:, None] * node).ravel()
                z = (size * (1 - e) - self.mean) / self.width
                p = np.exp(-0.5 * z * z) / math.sqrt(2 * math.pi) * size / self.width
                at.append(e)
                w.append((half[:, None] * weight).ravel() * p)
                rows.append(np.full(len(e), i))
        if not at:
            return np.zeros((len(x), of(x[:1], np.array([0.1])).shape[1]))
        rows, at, w = np.concatenate(rows), np.concatenate(at), np.concatenate(w)
        values = of(x[rows], at) * w[:, None]
        return np.stack(
            [np.bincount(rows, values[:, k], len(x)) for k in range(values.shape[1])], axis=1
        )

    # ------------------------------------------------------------------ numbers
    def number_above(self, name: str, value: float) -> float:
        """Dents per area of which "depth", "width" or "sunk" exceeds a value and that count."""
        from scipy.special import ndtr

        power = 0 if name == "sunk" else 1
        least = 0.0 if self.one.flat else self.dents.shallowest

        def share(x: Array) -> Array:
            out = np.zeros((len(x), 1))
            of_value = self.one.stretches(name, value / x**power)
            of_depth = self.one.stretches("depth", least / x) if least > 0 else None
            for i, size in enumerate(x):
                for a, b in of_value[i]:
                    for c, d in of_depth[i] if of_depth else [(a, b)]:
                        lo, hi = max(a, c), min(b, d)
                        if lo >= hi:
                            continue
                        if self.width == 0:
                            out[i] += lo < 1 - self.mean / size <= hi
                        else:
                            out[i] += ndtr((size * (1 - lo) - self.mean) / self.width)
                            if hi < math.inf:
                                out[i] -= ndtr((size * (1 - hi) - self.mean) / self.width)
            return out

        return float(self._over_sizes(share, self._special_sizes(name, value, least))[0])

    def _special_sizes(self, name: str, value: float, least: float) -> list[float]:
        out = []
        for who, v in ((name, value), ("depth", least)):
            if v > 0 and who != "sunk":
                f = self.one._table(who)[1]
                cross = self.one._table(who)[2]
                at = np.flatnonzero(cross)
                f = np.concatenate([f[at], f[at + 1], f[-1:]])
                out += (v / f[f > 0]).tolist()
        if self.width == 0:
            # where the value is passed in the one gap: found by halving between dense sizes
            support = self.contact.populations[0].diameter.support
            grid = np.linspace(max(support[0], 1e-6 * support[1]), support[1], 4001)
            if self.mean > 0:
                ends = [self.mean / (1 - e) for e in self.one.splits if e < 1]
                grid = np.unique([*grid, *(x * (1 + s) for x in ends for s in (-1e-12, 1e-12))])

            def inside(x: Array) -> Array:
                eps = np.maximum(1 - self.mean / x, 1e-300)
                out = x ** (name != "sunk") * self.one._f(name, eps) > value
                if least > 0:
                    out &= x * self.one._f("depth", eps) > least
                return out & (self.mean < x)

            here = inside(grid)
            at = np.flatnonzero(here[1:] != here[:-1])
            a, b, first = grid[at], grid[at + 1], here[at]
            for _ in range(60 if len(at) else 0):
                middle = 0.5 * (a + b)
                same = inside(middle) == first
                a, b = np.where(same, middle, a), np.where(same, b, middle)
            out += b.tolist()
        return out

    def _over_sizes(self, share: Callable[[Array], Array], more: Sequence[float]) -> Array:
        population = self.contact.populations[0]
        sizes, density = population.diameter, population.areal_density
        cut, support = self.dents.fragment or math.inf, sizes.support
        if isinstance(sizes, tb.distributions.Monodisperse):
            x = min(sizes.mean, cut)
            return density * (sizes.mean / x) ** 3 * share(np.array([x]))[0]
        edges = [
            x for x in (*sizes.pieces, *sizes.kinks, *more) if support[0] < x < min(support[1], cut)
        ]
        edges = np.array(sorted({support[0], *edges, min(support[1], cut)}))
        total = 0.0
        if support[0] < cut:
            if edges[0] == 0:  # roots of x near 0 too
                edges = np.unique([*edges, *(edges[1] * 0.3 ** np.arange(40))])
            total = integrate(lambda x: sizes.pdf(x)[:, None] * share(x), edges)
        if cut < support[1]:
            third = [
                x for x in (*sizes.pieces, *sizes.kinks) if max(cut, support[0]) < x < support[1]
            ]
            third = [max(cut, support[0]), *third, support[1]]
            pieces = (
                float(integrate(lambda x: (sizes.pdf(x) * x**3)[:, None], third, 1e-13)[0]) / cut**3
            )
            total = total + pieces * share(np.array([cut]))[0]
        return density * total

    def sums(self) -> dict[str, float]:
        """Number, mean depth and width, volume and number of the embedded."""
        one, least = self.one, 0.0 if self.one.flat else self.dents.shallowest

        def of(x: Array, eps: Array) -> Array:
            v = one.of(eps)
            counts = v["width"] > 0
            if least > 0:
                counts &= x * v["depth"] >= least
            return np.stack([counts * 1.0, counts * x * v["depth"], counts * x * v["width"],
                             counts * x**3 * v["volume"],
                             counts & (v["depth"] > 0) & (2 * v["deep"] > v["half"])], axis=1)  # fmt: skip

        def inner(x: Array) -> list[list[float]]:
            split = one.splits.tolist()
            if least == 0:
                return [split] * len(x)
            return [
                [*split, *(end for ends in stretches for end in ends)]
                for stretches in one.stretches("depth", least / x)
            ]

        more = self._special_sizes("depth", least, least) if least > 0 else []
        n, depth, width, volume, embedded = self.average(of, inner, more)
        with np.errstate(all="ignore"):
            return {
                "n": n,
                "depth": depth / n,
                "width": width / n,
                "volume": volume,
                "embedded": embedded,
            }
