"""The press against exact solutions: Hertz, Westergaard, waves, punches, one particle."""

import numpy as np
import pytest
from scipy import optimize

import thirdbody as tb
from thirdbody.explicit.bodies import Bodies, LawTable
from thirdbody.explicit.half_space import HalfSpace, lattice_constant
from thirdbody.explicit.press import HARDEST, contact_share, press

E, SPACING = 112e9, 1e-7
STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]
PAIR = tb.MaterialPair(STEEL, STEEL)


def never(shape):
    return np.full(shape, HARDEST)


def one_body(x, y, diameter, particle=SILICA, law=None, surfaces=PAIR):
    law = law or tb.particle.Series(deep="off")
    return Bodies(
        x=np.array([x]), y=np.array([y]), diameter=np.array([diameter]), lift=np.zeros(1),
        kind=np.zeros(1, np.int64), laws=(LawTable(law.one(surfaces=surfaces, particle=particle)),),
    )  # fmt: skip


# ---------------------------------------------------------------- the half-space
def test_the_lattice_constant_is_that_of_the_square_lattice():
    assert lattice_constant((1.0, 1.0)) == pytest.approx(3.900264920, abs=1e-9)
    assert lattice_constant((2e-5, 2e-5)) == pytest.approx(3.900264920 / 2e-5, rel=1e-9)
    assert lattice_constant((1.0, 3.0)) == pytest.approx(lattice_constant((3.0, 1.0)), rel=1e-12)


@pytest.mark.parametrize("shape", [(256, 256), (128, 256)])
def test_a_lone_pixel_has_the_potential_of_the_lattice(shape):
    """Far from its pixel, u is 1/r less the lattice constant, but for the shape of the pixel."""
    space = HalfSpace(shape, SPACING, E)
    r = 24 * SPACING
    u = 0.25 * sum(space.green()[i, j] for i, j in ((24, 0), (-24, 0), (0, 24), (0, -24)))
    # images have no monopole here; the next term is of second order in r over the side
    point = SPACING**2 / (np.pi * E * r) - space.lattice
    assert u == pytest.approx(point, rel=0.03)


# ---------------------------------------------------------------- elastic contacts
@pytest.mark.parametrize(("per_radius", "peak", "profile"), [(4, 0.012, 0.025), (16, 0.001, 0.005)])
def test_hertz(per_radius, peak, profile):
    """A sphere off the points of the grid; a = L/16."""
    n, R, a = 16 * per_radius, 1e-4, per_radius * SPACING
    load = 4 / 3 * E * a**3 / R
    x = (np.arange(n) - n / 2 + 0.3) * SPACING
    y = (np.arange(n) - n / 2 - 0.2) * SPACING
    r2 = x[:, None] ** 2 + y**2
    z = -r2 / (2 * R)
    state = press(z, SPACING, E, c=never(z.shape), load=load, tol=1e-9)
    assert state.converged
    approach = -state.h + load / (np.pi * E) * lattice_constant((n * SPACING, n * SPACING))
    assert approach == pytest.approx(a**2 / R, rel=1.5e-3)
    highest = 1.5 * load / (np.pi * a**2)
    exact = highest * np.sqrt(np.maximum(1 - r2 / a**2, 0))
    assert state.p.max() == pytest.approx(highest, rel=peak)
    assert np.abs(state.p - exact).sum() < profile * exact.sum()


@pytest.mark.parametrize("ratio", [0.05, 0.2, 0.5, 0.9])
def test_westergaard(ratio):
    n, height = 256, 1e-7
    x = np.arange(n) / n
    z = np.repeat(height * np.cos(2 * np.pi * x)[:, None], n, axis=1)
    full = np.pi * E * height / (n * SPACING)
    state = press(z, SPACING, E, c=never(z.shape), load=ratio * full * (n * SPACING) ** 2, tol=1e-9)
    share = 2 / np.pi * np.arcsin(np.sqrt(ratio))
    assert np.mean(state.p > 0) == pytest.approx(share, abs=2 / n)
    near = (x + 0.5) % 1 - 0.5
    under = np.maximum(ratio - np.sin(np.pi * near) ** 2, 0)
    exact = 2 * full * np.cos(np.pi * near) * np.sqrt(under)
    assert np.abs(state.p - exact[:, None]).sum() < 3e-3 * exact.sum() * n


@pytest.mark.parametrize(
    ("ratio", "area", "within"),
    [(0.005, 0.0223, 8e-4), (0.2, 0.346, 1e-3), (0.8, 0.898, 1e-3), (0.99, 1 - 0.0048, 4e-4)],
)
def test_a_wave_in_two_directions(ratio, area, within):
    """Hertz for small loads, 1 − A = 3/2π (1 − p/p*) near full contact, published between."""
    n, height = 256, 1e-7
    wave = np.cos(2 * np.pi * np.arange(n) / n)
    z = height * wave[:, None] * wave
    full = np.sqrt(2) * np.pi * E * height / (n * SPACING)
    state = press(z, SPACING, E, c=never(z.shape), load=ratio * full * (n * SPACING) ** 2, tol=1e-9)
    assert np.mean(state.p > 0) == pytest.approx(area, abs=within)


def test_beyond_full_contact_the_pressure_is_that_of_the_wave():
    n, height = 64, 1e-7
    wave = np.cos(2 * np.pi * np.arange(n) / n)
    z = height * wave[:, None] * wave
    full = np.sqrt(2) * np.pi * E * height / (n * SPACING)
    state = press(z, SPACING, E, c=never(z.shape), load=1.5 * full * (n * SPACING) ** 2, tol=1e-12)
    np.testing.assert_allclose(state.p, full * (1.5 + wave[:, None] * wave), rtol=1e-6)


@pytest.mark.parametrize(("per_radius", "most"), [(4, 1.025), (16, 1.009)])
def test_a_flat_punch(per_radius, most):
    """δ = F/2E*a, the round edge of pixels a little softer."""
    n = 16 * per_radius
    r = np.hypot(*np.meshgrid(*2 * [np.arange(n) - n / 2 + 0.5]))
    c = np.where(r < per_radius, HARDEST, 0.0)
    a, load = per_radius * SPACING, 1e-3
    state = press(np.zeros((n, n)), SPACING, E, c=c, load=load, tol=1e-11)
    side = n * SPACING
    depth = -state.h + load / (np.pi * E) * lattice_constant((side, side))
    assert 1.0 < depth / (load / (2 * E * a)) < most


# ---------------------------------------------------------------- to a separation, without a cap
def test_hertz_to_a_separation():
    """The load of Hertz at his approach, the images taken off."""
    n, R, a = 128, 1e-4, 8 * SPACING
    load = 4 / 3 * E * a**3 / R
    x = (np.arange(n) - n / 2 + 0.3) * SPACING
    r2 = x[:, None] ** 2 + (x - 0.2 * SPACING) ** 2
    h = load / (np.pi * E) * lattice_constant((n * SPACING, n * SPACING)) - a**2 / R
    state = press(-r2 / (2 * R), SPACING, E, c=never(r2.shape), h=h, tol=1e-9)
    assert state.converged
    assert state.p.sum() * SPACING**2 == pytest.approx(load, rel=3e-3)
    exact = 1.5 * load / (np.pi * a**2) * np.sqrt(np.maximum(1 - r2 / a**2, 0))
    assert np.abs(state.p - exact).sum() < 0.012 * exact.sum()


@pytest.mark.parametrize("ratio", [0.05, 0.5, 0.9])
def test_westergaard_to_a_separation(ratio):
    """h = Δ₀ (1 − ψ + ψ ln ψ) of pressure ψp*, from the wave of the mean gap (Johnson 1985, 13.2)."""
    n, height = 256, 1e-7
    z = np.repeat(height * np.cos(2 * np.pi * np.arange(n) / n)[:, None], n, axis=1)
    full = np.pi * E * height / (n * SPACING)
    h = height * (1 - ratio + ratio * np.log(ratio))
    state = press(z, SPACING, E, c=never(z.shape), h=h, tol=1e-9)
    assert state.converged
    assert np.mean(state.p) == pytest.approx(ratio * full, rel=2e-3)


@pytest.mark.parametrize("load", [1e-5, 1e-3, 3e-2])
def test_a_load_gives_the_separation_that_gives_the_load(load):
    z = rough()
    side = z.shape[0] * SPACING
    there = press(z, SPACING, E, c=never(z.shape), load=load * E * side**2, tol=1e-10)
    back = press(z, SPACING, E, c=never(z.shape), h=there.h, tol=1e-10)
    assert there.converged
    assert back.converged
    assert np.mean(back.p) == pytest.approx(load * E, rel=1e-6)
    assert np.count_nonzero(back.p) == np.count_nonzero(there.p)


def test_no_pressure_is_no_answer_below_the_summits():
    """Cut short, or begun from the answer of another separation, a state does not pass."""
    z = rough()
    none, all_of_it = 1.01 * z.max(), 0.6 * z.max()
    held = {"c": never(z.shape), "tol": 1e-6}
    apart = press(z, SPACING, E, h=none, **held)
    assert apart.converged
    assert not np.any(apart.p)
    cut = press(z, SPACING, E, h=all_of_it, **(held | {"max_iterations": 1}))
    assert not cut.converged
    fresh = press(z, SPACING, E, h=all_of_it, **held)
    near = press(z, SPACING, E, h=0.65 * z.max(), **held)
    again = press(z, SPACING, E, h=all_of_it, start=(near.p, near.f), **held)
    assert np.sum(near.p) < 0.9 * np.sum(fresh.p)
    assert np.sum(again.p) == pytest.approx(np.sum(fresh.p), rel=1e-5)


def test_without_a_cap_the_answer_is_that_of_least_squares():
    """Ten by ten points: ½|√K p − K^(−½)z|² + hΣp is a square but for ½δ(Σp)², which lowers h."""
    rng = np.random.default_rng(7)
    n = 10
    z = rng.normal(0, 2e-9, (n, n))
    z -= z.mean()
    green = HalfSpace((n, n), SPACING, E).green()
    i, j = (each.ravel() for each in np.indices((n, n)))
    values, vectors = np.linalg.eigh(green[(i[:, None] - i) % n, (j[:, None] - j) % n])
    root = np.sqrt(values[1:])  # without that of a constant, which is 0
    assert abs(values[0]) < 1e-9 * values[-1]
    soft = 1e-3 * root.min()
    for h in (3e-9, 1e-9):
        A = np.vstack([root[:, None] * vectors[:, 1:].T, np.full(n * n, soft)])
        b = np.append(vectors[:, 1:].T @ z.ravel() / root, -h / soft)
        scale = np.max(values) ** 0.5
        expected, _ = optimize.nnls(A / scale, b / scale, maxiter=20 * n * n)
        state = press(z, SPACING, E, c=never(z.shape), h=h + soft**2 * expected.sum(), tol=1e-12)
        assert state.converged
        assert 0.02 < np.mean(expected > 0) < 0.9
        assert np.abs(state.p.ravel() - expected).sum() < 1e-5 * expected.sum()


def test_to_a_separation_the_certificate_bounds_the_energy_too():
    """Φ falls by no more than ε σ Σp, from wherever the iteration is cut."""
    z = rough()
    space = HalfSpace(z.shape, SPACING, E)
    for h in (2.5e-7, 7e-7):
        best = press(z, SPACING, E, c=never(z.shape), h=h, tol=1e-12, max_iterations=1000)

        def energy(state, h=h):
            return np.sum(state.p * (0.5 * space.displacement(state.p) - z + z.mean() + h))

        for most in (1, 2, 3, 5, 8):
            state = press(z, SPACING, E, c=never(z.shape), h=h, tol=1e-12, max_iterations=most)
            bound = state.certificate * np.std(z) * np.sum(state.p)
            assert 0 < energy(state) - energy(best) <= bound


# ---------------------------------------------------------------- caps
def rough(points=128, seed=0, sigma=300e-9):
    return tb.surfaces.self_affine(
        sigma=sigma, hurst=0.8, shortest=1.2e-6, longest=6e-6, spacing=SPACING, points=points,
        seed=seed,
    ).heights  # fmt: skip


def test_a_soft_body_carries_its_hardness_on_its_bearing_area():
    """H/E* → 0: the area is that above the flat, the load hardness times area, from below."""
    z = rough()
    h = 2.0 * np.std(z)
    bearing = np.mean(z > h)
    ratios = []
    for hardness in (4.5e-2, 4.5e-3, 4.5e-4, 4.5e-5):
        state = press(z, SPACING, E, c=np.full(z.shape, hardness * E), h=h, tol=1e-10)
        ratios.append((np.mean(state.p > 0) / bearing, np.mean(state.p) / (hardness * E * bearing)))
    areas, loads = np.array(ratios).T
    assert np.all(np.diff(areas) >= 0)
    assert np.all(np.diff(loads) >= 0)
    assert np.all(loads < 1 + 1e-12)
    assert areas[-1] == pytest.approx(1, abs=1e-3)
    assert loads[-1] == pytest.approx(1, abs=1e-3)
    assert loads[0] < 0.95


def test_the_answer_is_that_of_a_general_programme():
    """Twelve by twelve points against least squares with bounds: K is symmetric and positive."""
    rng = np.random.default_rng(3)
    n = 12
    z = rng.normal(0, 2e-9, (n, n))
    c = np.where(rng.random((n, n)) < 0.1, 0.0, 2e9)
    h = -1e-9
    green = HalfSpace((n, n), SPACING, E).green()
    i, j = (each.ravel() for each in np.indices((n, n)))
    K = green[(i[:, None] - i) % n, (j[:, None] - j) % n]
    # the constant pressure has no energy: h is held, and a little is added to bound it
    free = c.ravel() > 0
    scale = 1e9 * K.max()

    def energy(p):
        u = K @ p
        return (0.5 * p @ u - p @ (z.ravel() - h)) / scale / 1e9, (u - z.ravel() + h) / scale

    found = optimize.minimize(
        lambda q: (lambda v, g: (v, g[free]))(*energy(_filled(q, free))), np.zeros(free.sum()),
        jac=True, method="L-BFGS-B", bounds=[(0, 2.0)] * int(free.sum()),
        options={"ftol": 1e-16, "gtol": 1e-12, "maxiter": 20000, "maxfun": 40000},
    )  # fmt: skip
    state = press(z, SPACING, E, c=c, h=h, tol=1e-12)
    expected = _filled(found.x, free)
    assert np.abs(state.p.ravel() - expected).sum() < 1e-4 * expected.sum()


def _filled(q, free):
    out = np.zeros(free.shape)
    out[free] = 1e9 * q
    return out


# ---------------------------------------------------------------- areas
def between(z, k):
    """The same waves on a grid k times as fine."""
    n = z.shape[0]
    at, more = np.fft.fftshift(np.fft.fft2(z)), (n * k - n) // 2
    return k**2 * np.fft.ifft2(np.fft.ifftshift(np.pad(at, more))).real


@pytest.mark.parametrize("hardness", [0.0045, 0.018, 0.0446, 0.1, 0.3, None])
def test_an_area_is_that_of_a_finer_grid(hardness):
    """Plastic, elastic and between: where the cap acts no rim is taken off, elsewhere it is."""
    n, coarse = 64, 4e-7
    z = tb.surfaces.self_affine(
        sigma=300e-9, hurst=0.8, shortest=3.2e-6, longest=8e-6, spacing=coarse, points=n, seed=1
    ).heights
    H = None if hardness is None else hardness * E
    load = (n * coarse) ** 2 * (2e-3 * E if H is None else 0.03 * H)
    counts, areas = [], []
    for k in (2, 4, 8):
        fine = between(z, k)
        c = np.full(fine.shape, H or HARDEST)
        state = press(fine, coarse / k, E, c=c, load=load, tol=1e-7, max_iterations=1000)
        counts.append(np.mean(state.p > 0))
        areas.append(np.mean(contact_share(state.p, c, H)))
        if H is not None:
            assert areas[-1] >= np.mean(state.p) / H
    assert areas[:2] == pytest.approx([areas[2]] * 2, rel=0.02)
    assert areas[1] == pytest.approx(areas[2], rel=0.0075)
    # the count comes from above, the slower
    assert abs(areas[0] - areas[2]) < abs(counts[0] - counts[2])
    assert np.all(np.diff(counts) < 0)


def test_a_bearing_area_has_no_rim_and_a_sphere_has():
    """πa² of Hertz at 8 pixels to a; all of the bearing area; what is covered is not touched."""
    z = rough()
    h, H = 2 * np.std(z), 1e-6 * E
    c = np.full(z.shape, H)
    soft = press(z, SPACING, E, c=c, h=h, tol=1e-10)
    assert np.array_equal(contact_share(soft.p, c, H), soft.p / H)
    assert np.mean(contact_share(soft.p, c, H)) == pytest.approx(np.mean(z > h), rel=1e-3)
    n, R, a = 128, 1e-4, 8 * SPACING
    x = (np.arange(n) - n / 2 + 0.3) * SPACING
    r2 = x[:, None] ** 2 + (x - 0.2 * SPACING) ** 2
    c = never(r2.shape)
    state = press(-r2 / (2 * R), SPACING, E, c=c, load=4 / 3 * E * a**3 / R, tol=1e-9)
    exact = np.pi * (a / SPACING) ** 2
    assert np.sum(contact_share(state.p, c, None)) == pytest.approx(exact, rel=0.025)
    assert np.count_nonzero(state.p) > 1.03 * exact
    # a punch ends where its pixels do; half of a pixel under a particle is half a pixel
    inside = r2 < a**2
    assert np.sum(contact_share(1.0 * inside, np.where(inside, HARDEST, 0.0), None)) == inside.sum()
    half = np.full((8, 8), 0.5 * H)
    assert np.all(contact_share(half, half, H) == 0.5)


# ---------------------------------------------------------------- the certificate
@pytest.mark.parametrize("cap", [5e9, HARDEST])
def test_the_certificate_bounds_the_energy_of_the_error(cap):
    z = rough(256)
    c, side = np.full(z.shape, cap), 256 * SPACING
    load = 2e-3 * E * side**2
    best = press(z, SPACING, E, c=c, load=load, tol=1e-12, max_iterations=1000)
    space = HalfSpace(z.shape, SPACING, E)
    for tol in (1e-3, 1e-4, 1e-5):
        state = press(z, SPACING, E, c=c, load=load, tol=tol)
        assert state.converged
        assert state.certificate < tol
        error = state.p - best.p
        energy = 0.5 * np.sum(error * space.displacement(error))
        assert energy <= state.certificate * np.std(z) * np.sum(state.p) * (1 + 1e-9)


def test_a_run_that_is_cut_short_says_so():
    z = rough(128)
    state = press(z, SPACING, E, c=np.full(z.shape, 5e9), h=2.3e-7, tol=1e-10, max_iterations=2)
    assert not state.converged
    assert state.certificate > 1e-10


# ---------------------------------------------------------------- particles
@pytest.mark.parametrize("side", [2e-6, 5e-6, 2e-5])
@pytest.mark.parametrize("share", [0.01, 0.4, 0.9])
def test_one_particle_on_a_flat_follows_its_law(side, share):
    """For any side: the displacement by itself is taken off, that by its images is not."""
    n = 64
    bodies = one_body(0.37 * side, 0.71 * side, 3e-7)
    load = share * float(bodies.limit[0])
    nothing = np.zeros((n, n))
    state = press(nothing, side / n, PAIR.E_star, c=nothing, bodies=bodies, load=load, tol=1e-11)
    images = lattice_constant((side, side)) * load / (np.pi * PAIR.E_star)
    law = tb.particle.Series(deep="off").single(
        3e-7, state.h - images, surfaces=PAIR, particle=SILICA
    )
    assert float(law["force"]) == pytest.approx(load, rel=3e-5)


def test_the_table_of_a_law_is_the_law_and_its_own_inverse():
    soft = STEEL.replace(H=1e9)
    for law, particle in (
        (tb.particle.Series(deep="off"), SILICA),
        (tb.particle.Series(deep="off"), STEEL),
    ):
        one = law.one(surfaces=tb.MaterialPair(STEEL, soft), particle=particle)
        table = LawTable(one)
        eps = np.geomspace(1e-2 * one.kinks[0], 0.999 * one.kinks[-1], 777)
        load = table.force(eps)
        assert load == pytest.approx(one.at(eps).load, rel=3e-5)
        assert table.squeeze(load) == pytest.approx(eps, rel=1e-9)
        assert table.force(np.array([0.0, -1.0])).tolist() == [0.0, 0.0]
        assert table.force(np.array([1e3]))[0] == table.limit
