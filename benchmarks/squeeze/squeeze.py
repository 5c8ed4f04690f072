"""One particle between two equal surfaces that come together: flow, motion, load.

Flow of least power (`flow`) at each moment on triangles made anew (`mesh`); boundaries move with
it in short steps and meet where they meet (`shapes`), so piling up, folding and collars that touch
need no further care. With an elastic modulus, stresses go from mesh to mesh with the material.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import LinearNDInterpolator, NearestNDInterpolator
from scipy.spatial import cKDTree

from . import curves, flow, mesh, shapes
from .shapes import Case, Shape

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

POISSON = 0.3
"""Poisson's ratio of elastic bodies."""
TRIES = 4
"""Shorter steps tried where no triangles fit a shape."""


@dataclass(frozen=True)
class State:
    """One solved moment."""

    squeeze: float
    load: float
    """Load through the middle plane over Y R², of the surface (of the particle between platens)."""
    area: float
    """Contact area over π R²."""
    sink: float
    """Depth of the particle's top below the surface's plane [R]."""
    collar: float
    """Part of the load through the surfaces' collars."""
    top_load: float
    """The same load, summed over the far boundary or the platen."""
    power: float
    """Plastic power and friction: an upper bound of a rigid-plastic load."""
    mended: float
    """Volume of the particle that finite steps lost and `filled` gave back, summed up."""
    nodes: int
    steps: int


@dataclass(frozen=True)
class Moment:
    """A shape, its triangles and its flow."""

    shape: Shape
    problem: flow.Problem
    found: flow.Flow
    names: dict[str, Ints]
    """Numbers of nodes: `particle` and `surface` boundaries, `plane`, `far`, `collar`."""
    body: Ints
    """0 for the particle's triangles, 1 for the surface's: (T,)."""


class Squeezing:
    """A particle and a surface in motion."""

    def __init__(self, case: Case):
        self.case = case
        self.shape = shapes.first_shape(case)
        self.mended = 0.0
        self._rates: tuple[cKDTree, Array] | None = None
        self._stress: tuple[Array, Array, Ints] | None = None

    def moment(self, step: float) -> Moment:
        """The flow of the present shape, for elastic bodies over the step that follows."""
        for finer in (1.15, 1.3, 0.85, 1.6):
            try:
                return self._moment(step)
            except mesh.MeshError:
                self.shape = shapes.respaced_again(self.case, self.shape, finer)
        return self._moment(step)

    def _moment(self, step: float) -> Moment:
        case, shape = self.case, self.shape
        source = shapes.sources(case, shape)
        n = len(shape.face)
        x, triangles, body, names = [], [], [], {}
        pairs = {"particle": np.full(2 * n - 1, -1), "surface": np.full(2 * n - 1, -1)}
        count = 0
        for number, (part, deforms) in enumerate(
            (("particle", case.particle_deforms), ("surface", case.surface_deforms))
        ):
            if not deforms:
                continue
            boundary, order = shapes.outline(case, shape, part, source)
            made = mesh.build(boundary, source, len(getattr(shape, part)))
            nodes = np.empty(2 * n - 1, dtype=np.int64)
            nodes[::2] = order
            nodes[1::2] = [
                made.middle[(min(i, j), max(i, j))] for i, j in zip(order, order[1:], strict=False)
            ]
            pairs[part] = nodes + count
            names[part] = np.arange(count, count + len(made.x))
            x.append(made.x)
            triangles.append(made.triangles + count)
            body.append(np.full(len(made.triangles), number))
            count += len(made.x)
        places, bodies = np.concatenate(x), np.concatenate(body)
        problem = self._problem(places, np.concatenate(triangles), bodies, names, pairs, step)
        points = np.einsum("qi,tik->tqk", flow.POINTS, places[problem.triangles[:, :3]]).reshape(
            -1, 2
        )
        labelled = np.column_stack([points, 50.0 * np.repeat(bodies, flow.Q)])
        guess = None
        if self._rates is not None:
            guess = self._rates[1][self._rates[0].query(labelled)[1]].reshape(-1, flow.Q)
        found = flow.solve(problem, guess, case.tolerance)
        self._rates = (cKDTree(labelled), found.rate.ravel())
        return Moment(shape, problem, found, names, bodies)

    def _problem(
        self, x: Array, triangles: Ints, body: Ints, names: dict[str, Ints],
        pairs: dict[str, Ints], step: float,
    ) -> flow.Problem:  # fmt: skip
        """What is held, and what touches; adds names of nodes."""
        case, shape = self.case, self.shape
        held, velocity = np.zeros((len(x), 2), dtype=bool), np.zeros((len(x), 2))
        held[x[:, 0] < 1e-9, 0] = True
        if case.particle_deforms:
            names["plane"] = names["particle"][x[names["particle"], 1] < 1e-9]
            held[names["plane"], 1] = True
        if case.surface_deforms:
            part = x[names["surface"]]
            top = 1 - shape.squeeze + case.domain
            far = (part[:, 0] > case.domain - 1e-9) | (part[:, 1] > top - 1e-9)
            names["far"] = names["surface"][far]
            held[names["far"]] = True
            velocity[names["far"], 1] = -1.0
            if case.both:
                names["collar"] = names["surface"][part[:, 1] < 1e-9]
                held[names["collar"], 1] = True
        length = float(shape.edge[0])
        if case.particle_deforms:
            length = max(min(length, float(shape.face[0, 1])), 0.05)
        face = _face(shape.face, pairs["surface"], pairs["particle"], case.strength)
        return flow.Problem(
            x, triangles, np.array(case.yields)[body], self._elastic(x, triangles, body, step),
            held, velocity, face, (0.0, -1.0), case.rest / length, 1e-3,
        )  # fmt: skip

    def _elastic(
        self, x: Array, triangles: Ints, body: Ints, step: float
    ) -> tuple[Array, Array, Array]:
        """Stiffnesses over a step, and stresses brought along from the last mesh."""
        old = np.zeros((len(triangles), flow.Q, 5))
        if not math.isfinite(self.case.modulus):
            return np.zeros(len(triangles)), np.zeros(len(triangles)), old
        shear = self.case.modulus / (1 + POISSON) * step
        bulk = self.case.modulus / (3 * (1 - 2 * POISSON)) * step
        if self._stress is not None:
            points, values, owner = self._stress
            for number in np.unique(body):
                mine, its = body == number, owner == number
                corners = x[triangles[mine, :3]]
                at = np.einsum("qi,tik->tqk", flow.POINTS, corners).reshape(-1, 2)
                new = LinearNDInterpolator(points[its], values[its])(at)
                lost = np.isnan(new[:, 0])
                new[lost] = NearestNDInterpolator(points[its], values[its])(at[lost])
                old[mine] = new.reshape(-1, flow.Q, 5)
        return np.full(len(triangles), shear), np.full(len(triangles), bulk), old

    def state(self, moment: Moment) -> State:
        """Loads, area and sink of a solved moment."""
        found, names, shape = moment.found, moment.names, moment.shape
        collar = float(found.force[names["collar"], 1].sum()) if "collar" in names else 0.0
        own = float(found.force[names["plane"], 1].sum()) if "plane" in names else found.lower_force
        top = -float(found.force[names["far"], 1].sum()) if "far" in names else found.upper_force
        load = own + collar
        return State(
            shape.squeeze, load, shape.area, shape.sink, collar / load, top, found.power,
            self.mended, len(found.u), found.steps,
        )  # fmt: skip

    def advance(self, moment: Moment, step: float) -> None:
        """Boundaries and stresses moved with the flow over a step."""
        case, shape, u = self.case, moment.shape, moment.found.u
        n = len(shape.face)
        squeeze = shape.squeeze + step
        if case.particle_deforms:
            line = u[moment.names["particle"][: len(shape.particle)]][::-1]
            particle = curves.refined(shape.particle + step * line, [0, n - 1])
            particle, mended = shapes.filled(case, particle, (n - 1) * curves.FINE)
            self.mended += mended
        else:
            particle = shapes.sphere(case, 1200)
        surface = np.tile([0.0, -1.0], (len(shape.surface), 1))
        if case.surface_deforms:
            surface = u[moment.names["surface"][: len(surface)]]
        marks = [0, *(n - 1 + i for i in shapes.ground(shape.free)[:-1])]
        surface = curves.refined(shape.surface + step * surface, marks)
        particle[0, 0] = surface[0, 0] = 0.0
        if math.isfinite(case.modulus):
            self._carry(moment, step)
        self.shape = shapes.meet(case, particle, surface, (n - 1) * curves.FINE + 1, squeeze)

    def _carry(self, moment: Moment, step: float) -> None:
        """Stresses, turned by the spin, at the places to which the material has come."""
        problem, found = moment.problem, moment.found
        corners = problem.x[problem.triangles[:, :3]]
        points = np.einsum("qi,tik->tqk", flow.POINTS, corners) + step * found.turn[..., :2]
        s = found.stress.copy()
        spin = 0.5 * step * found.turn[..., 2]
        s[..., 0] += 2 * spin * found.stress[..., 3]
        s[..., 1] -= 2 * spin * found.stress[..., 3]
        s[..., 3] += spin * (found.stress[..., 1] - found.stress[..., 0])
        owner = np.repeat(moment.body, flow.Q)
        self._stress = (points.reshape(-1, 2), s.reshape(-1, 5), owner)

    def run(self, until: float) -> Iterator[State]:
        """States from the start to a squeeze, one a step.

        A shape that no triangles fit is left for the one after a shorter step.
        """
        moment, tries = None, 0
        while True:
            e = self.shape.squeeze
            step = min(self.case.step, 0.2 * e, max(until - e, 1e-4))
            if self.case.both:
                step = min(step, 0.12 * (1 - e))
            try:
                moment, tries = self.moment(step), 0
            except mesh.MeshError:
                if moment is None or tries == TRIES:
                    raise
                tries += 1
                self.advance(moment, 0.6**tries * (e - moment.shape.squeeze))
                continue
            yield self.state(moment)
            if e > until - 1e-9:
                return
            self.advance(moment, step)


def _face(x: Array, upper: Ints, lower: Ints, strength: float) -> flow.Face:
    """Pairs of nodes on the face, with normals up from the particle, and Simpson's areas."""
    side = np.diff(x, axis=0)
    length = np.hypot(*side.T)
    flat = np.stack([-side[:, 1], side[:, 0]], 1)
    n = len(x)
    normal, weight, r = np.zeros((2 * n - 1, 2)), np.zeros(2 * n - 1), np.empty(2 * n - 1)
    normal[1::2] = flat
    normal[:-1:2] += flat
    normal[2::2] += flat
    normal /= np.hypot(*normal.T)[:, None]
    normal[0] = (0.0, 1.0)
    r[::2], r[1::2] = x[:, 0], (x[1:, 0] + x[:-1, 0]) / 2
    weight[1::2] = 4 * length / 6
    weight[:-1:2] += length / 6
    weight[2::2] += length / 6
    grip = 2 * math.pi * np.maximum(r, 0.3 * length[0]) * weight  # on the axis too
    return flow.Face(upper, lower, normal, 2 * math.pi * r * weight, grip, strength)
