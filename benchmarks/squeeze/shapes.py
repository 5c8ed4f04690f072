"""What is squeezed, the boundaries of the two bodies, where they touch, and sizes of triangles.

Upper half, lengths over the particle's radius: the plane z = 0 rests, the surface comes down at
speed 1, so time is the squeeze ε.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from . import curves, mesh

Array = NDArray[np.float64]

START = 0.002
"""Squeeze at which the bodies are first put together, undeformed and cut where they overlap."""
TOUCH = 5e-4
"""Gap below which two boundaries touch [R]."""
SHUT = 0.015
"""Height of the void between flank, collar and z = 0 below which it counts as filled [R]."""


@dataclass(frozen=True)
class Case:
    """What is squeezed, and how finely it is followed."""

    rho: float
    """Yield stress of the particle over the surface's; inf: rigid particle, 0: rigid surface."""
    m: float = 1.0
    """Friction factor of faces that touch: shear stress over that of the weaker body."""
    modulus: float = math.inf
    """Young's modulus of what deforms over the surface's yield stress; inf: rigid-plastic."""
    both: bool = True
    """Two surfaces, so that their collars meet in z = 0; else one, and no plane."""
    fine: float = 1.0
    """Divides all sizes of triangles."""
    domain: float = 8.0
    """Width and height of the surface's part that is followed [R]."""
    step: float = 0.008
    """Largest step of the squeeze."""
    edge: float = 0.008
    """Size of triangles at the edge of the contact [R]."""
    rest: float = 1e-3
    """Strain rate below which bodies are all but rigid, over that of the contact."""
    tolerance: float = 2e-3
    """Change of the velocities, over the largest, at which a flow counts as solved."""

    @property
    def particle_deforms(self) -> bool:
        return math.isfinite(self.rho)

    @property
    def surface_deforms(self) -> bool:
        return self.rho > 0

    @property
    def yields(self) -> tuple[float, float]:
        """Yield stresses of particle and surface, over the surface's or the one that deforms."""
        return (self.rho if self.surface_deforms else 1.0, 1.0)

    @property
    def strength(self) -> float:
        """Shear stress of the faces."""
        return self.m * (min(self.rho, 1.0) if self.surface_deforms else 1.0) / math.sqrt(3)


@dataclass(frozen=True)
class Shape:
    """Two bodies at one squeeze."""

    squeeze: float
    face: Array
    """Where they touch, from the axis to the edge: (n, 2)."""
    flank: Array
    """The particle's free boundary from the edge to z = 0."""
    free: Array
    """The surface's free boundary from the edge to the outer wall."""

    @property
    def edge(self) -> Array:
        return self.face[-1]

    @property
    def area(self) -> float:
        """Contact area over π R²."""
        return float(self.face[:, 0].max() ** 2)

    @property
    def sink(self) -> float:
        """Depth of the particle's top below the surface's plane far away [R]."""
        return float(self.face[0, 1]) - (1.0 - self.squeeze)

    @property
    def particle(self) -> Array:
        """The particle's boundary from its top to z = 0."""
        return np.concatenate([self.face, self.flank[1:]])

    @property
    def surface(self) -> Array:
        """The surface's boundary from the axis to the outer wall."""
        return np.concatenate([self.face, self.free[1:]])


def sphere(case: Case, n: int) -> Array:
    """The undeformed particle from its top on: to z = 0, or to its bottom with one surface."""
    angle = np.linspace(0, np.pi / 2 if case.both else np.pi, n + 1)
    x = np.stack([np.sin(angle), np.cos(angle)], 1)
    x[0, 0] = 0.0
    x[-1, 1 if case.both else 0] = 0.0
    return x


def first_shape(case: Case) -> Shape:
    """Sphere and plane at START, cut where they overlap."""
    r = np.concatenate([np.linspace(0, 1, 800), np.geomspace(1, case.domain, 200)[1:]])
    plane = np.stack([r, np.full_like(r, 1.0 - START)], 1)
    return meet(case, sphere(case, 1200), plane, 0, START)


def sources(case: Case, shape: Shape) -> Array:
    """Sizes of triangles on the boundaries: (r, z, s)."""
    x = np.concatenate([shape.face, shape.flank[1:], shape.free[1:]])
    n, k = len(shape.face), len(shape.face) + len(shape.flank) - 1
    a, thick = float(shape.edge[0]), max(float(shape.face[0, 1]), 0.02)
    s = min(case.edge, 2.3 * case.edge * a, 0.4 * thick) + mesh.GRADE * case.fine * np.hypot(
        *(x - shape.edge).T
    )
    s[:n] = np.minimum(s[:n], min(0.12, 0.25 * a))
    s[n:k] = np.minimum(s[n:k], 0.1)
    if case.particle_deforms:
        s[:n] = np.minimum(s[:n], np.maximum(0.6 * np.abs(x[:n, 1]), 0.004))
        low = 0.25 * float(shape.edge[1]) + 0.004
        s[n:k] = np.minimum(s[n:k], np.maximum(0.6 * np.abs(x[n:k, 1]), low))
    near = x[k:, 0] < 2.2 + a
    s[k:][near] = np.minimum(s[k:][near], 0.15)
    if case.both:
        s[k:] = np.minimum(s[k:], np.maximum(0.05, 0.5 * x[k:, 1]))
    return np.column_stack([x, s / case.fine])


def meet(case: Case, particle: Array, surface: Array, touched: int, squeeze: float) -> Shape:
    """Shape from two boundaries of many points that may overlap.

    Bodies that touch go on touching: the contact goes from the axis to the first place where the
    gap is above TOUCH. Where they overlap, both give way by half; a rigid one does not.

    Parameters
    ----------
    particle, surface : ndarray, shape (N, 2)
        Boundaries from the axis on.
    touched : int
        Points of the surface that touched before.
    """
    surface = surface.copy()
    if not case.surface_deforms:
        surface[:, 1] = 1.0 - squeeze
    elif case.both:
        surface[surface[:, 1] < TOUCH, 1] = 0.0
    if case.both and case.particle_deforms:
        down = 1 + int(np.argmax(particle[1:, 1] < 1e-6))  # a flank that has folded onto z = 0
        particle = particle[: down + 1].copy()
        particle[-1, 1] = 0.0
    gap, place, _ = curves.nearest(surface, particle)
    within = mesh.inside(surface, np.concatenate([particle, np.zeros((1, 2))]))
    gap = np.where(within, -np.abs(gap), np.abs(gap))
    near = gap < np.where(np.arange(len(surface)) < touched, 4 * TOUCH, TOUCH)
    near[surface[:, 0] > 1.5 * particle[:, 0].max() + 0.1] = False
    apart = np.flatnonzero(~near)
    last = int(apart[0]) - 1
    deep = np.flatnonzero(near & (gap < -2 * TOUCH))
    if len(deep):
        last = max(last, int(deep[-1]))  # a pocket that has shut
    end = float(last)
    if gap[last + 1] > TOUCH > gap[last]:
        end += float((TOUCH - gap[last]) / (gap[last + 1] - gap[last]))
    place = np.maximum.accumulate(place)
    at = np.append(place[: last + 1], np.interp(end, np.arange(len(place)), place))
    above = np.concatenate([surface[: last + 1], curves.along(surface, np.array([end]))])
    share = 1.0 if not case.particle_deforms else 0.5 if case.surface_deforms else 0.0
    face = share * curves.along(particle, at) + (1 - share) * above
    face[0, 0] = 0.0
    face = curves.trimmed(face, 1e-9)
    flank = curves.trimmed(np.concatenate([face[-1:], particle[math.floor(at[-1]) + 1 :]]), 1e-5)
    free = curves.trimmed(np.concatenate([face[-1:], surface[last + 1 :]]), 1e-5)
    if case.both and case.surface_deforms and face[-1, 1] < SHUT:
        face, flank, free = _shut(face, flank, free)
    return _respaced(case, Shape(squeeze, face, flank, free))


def _shut(face: Array, flank: Array, free: Array) -> tuple[Array, Array, Array]:
    """The same boundaries with the edge let down to z = 0 along the flank."""
    foot = np.array([max(flank[-1, 0], face[-1, 0]), 0.0])
    face = np.concatenate([face[face[:, 1] > 0], foot[None]])
    free = np.concatenate([foot[None], free[1:][free[1:, 0] > foot[0] + 1e-3]])
    free[(free[:, 0] < foot[0] + SHUT) & (free[:, 1] < SHUT), 1] = 0.0
    return face, foot[None], free


def _respaced(case: Case, shape: Shape) -> Shape:
    """The same shape with nodes spaced for triangles."""
    source = sources(case, _thinned(shape))

    def nodes(x: Array, least: int) -> Array:
        return x if len(x) < 2 else curves.respaced(x, mesh.sizes(x, source), least)

    ends = ground(shape.free) if case.both else [0, len(shape.free) - 1]
    pieces = [nodes(shape.free[a : b + 1], 1) for a, b in zip(ends, ends[1:], strict=False)]
    free = np.concatenate([pieces[0], *[p[1:] for p in pieces[1:]]])
    return Shape(shape.squeeze, nodes(shape.face, 3), nodes(shape.flank, 1), free)


def respaced_again(case: Case, shape: Shape, finer: float) -> Shape:
    """The same shape with nodes spaced anew, by sizes that many times finer."""
    face, flank, free = (
        curves.refined(x, marks) if len(x) > 1 else x
        for x, marks in ((shape.face, [0]), (shape.flank, [0]), (shape.free, ground(shape.free)))
    )
    finer_case = replace(case, fine=case.fine * finer)
    return _respaced(finer_case, Shape(shape.squeeze, face, flank, free))


def _thinned(shape: Shape) -> Shape:
    """The shape with at most some hundred points a curve, for sizes."""

    def some(x: Array) -> Array:
        step = max(1, len(x) // 120)
        return x[np.unique(np.append(np.arange(0, len(x), step), len(x) - 1))]

    return replace(shape, face=some(shape.face), flank=some(shape.flank), free=some(shape.free))


def ground(x: Array) -> list[int]:
    """Ends of the pieces of a free boundary: its own, and where it lies down on z = 0."""
    on = x[:, 1] <= 1e-9
    change = np.flatnonzero(on[1:] != on[:-1])
    return sorted({0, len(x) - 1, *(int(i + 1 if on[i + 1] else i) for i in change)})


def filled(case: Case, x: Array, edge: int) -> tuple[Array, float]:
    """The particle's boundary, its free part moved so that the volume is a sphere's; by how much.

    Finite steps lose some 1e-4 of the volume at a time.
    """
    if edge >= len(x) - 1 or math.isfinite(case.modulus):
        return x, 0.0
    lost = 2 * math.pi / 3 - curves.volume(x)
    s = curves.arc(x[edge:])
    ramp = np.minimum(1.0, s / (0.3 * s[-1]))
    side = np.gradient(x[edge:], axis=0)
    normal = np.stack([-side[:, 1], side[:, 0]], 1) / np.hypot(*side.T)[:, None]
    normal[-1] = (1.0, 0.0)
    area = float(np.trapezoid(2 * math.pi * x[edge:, 0] * ramp, s))
    x = x.copy()
    x[edge:] += lost / area * ramp[:, None] * normal
    return x, abs(lost) / (2 * math.pi / 3)


def outline(case: Case, shape: Shape, part: str, source: Array) -> tuple[Array, NDArray[np.int64]]:
    """Closed boundary of the particle or the surface, and the numbers of its face's nodes."""
    n = len(shape.face)

    def side(a: Array, b: Array) -> Array:
        fine = np.linspace(a, b, 400)
        return curves.respaced(fine, mesh.sizes(fine, source))[1:-1]

    if part == "particle":
        line = shape.particle[::-1]
        origin = np.zeros(2)
        parts = [line, side(line[-1], origin), origin[None], side(origin, line[0])]
        return np.concatenate(parts), np.arange(len(line) - 1, len(line) - 1 - n, -1)
    line = shape.surface
    top = 1 - shape.squeeze + case.domain
    corner, axis = np.array([case.domain, top]), np.array([0.0, top])
    parts = [line, side(line[-1], corner), corner[None], side(corner, axis), axis[None]]
    return np.concatenate([*parts, side(axis, line[0])]), np.arange(n)
