"""What results say of themselves: status, the path taken, and equality."""

import os
from contextlib import suppress
from unittest import mock

import numpy as np
import oracle
import pytest
from refusals import Status, balances_not, warns_of
from twins import base, material

import thirdbody as tb
from thirdbody.contact.interface import interface
from thirdbody.equilibrium import states
from thirdbody.equilibrium.compiled import batch as engine
from thirdbody.equilibrium.compiled import rows
from thirdbody.equilibrium.load_scan import load_scan
from thirdbody.equilibrium.states import state_columns
from thirdbody.errors import NotCompiled

pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")


def dusty(law=None, sizes=None, density: float = 1e11) -> tb.Contact:
    particles = tb.Particles(
        material=material(oracle.SILICA),
        diameter=sizes or tb.TruncatedGaussian(mean=3e-7, std=2.4e-8),
        areal_density=density,
    )
    return base(oracle.Interface(), particles, law or tb.particle.Series(deep="off"))


# ------------------------------------------------------------------------ the path taken
class TestPath:
    """Which engine found the states, and why not the compiled one."""

    def test_many_loads(self):
        pytest.importorskip("numba")
        loads = np.geomspace(1e-8, 1e-5, 20)
        with mock.patch.object(engine, "FEWEST", 1):
            assert tb.solve(dusty(), F_star=loads).engine == "compiled"
            other = tb.solve(dusty(tb.particle.Horng2022()), F_star=loads).engine
        assert other == "numpy: particles that are not Series"
        assert tb.solve(dusty(), F_star=loads).engine.startswith("numpy: fewer than")
        assert tb.solve(dusty(), d=2e-7).engine == "numpy: the separations are given"

    def test_switched_off(self):
        loads = np.geomspace(1e-8, 1e-5, 20)
        off = mock.patch.dict(os.environ, THIRDBODY_ENGINE="numpy")
        with mock.patch.object(engine, "FEWEST", 1), off:
            assert "THIRDBODY_ENGINE" in tb.solve(dusty(), F_star=loads).engine

    def test_states_with_inputs_of_their_own(self):
        """Roughness and a law that vary, for which the states share no nodes, are compiled too."""
        pytest.importorskip("numba")
        k = np.where(np.arange(40) < 20, 0.4, 0.35)
        sigma = 1e-7 * np.linspace(1, 1.2, 40)
        vary = {"asperity_law.k": k, "roughness.sigma": sigma}
        with mock.patch.object(states, "FEWEST", 2):
            found = state_columns(dusty(), F_star=1e-6, vary=vary)["engine"]
        assert set(found) == {"compiled"}

    @pytest.mark.parametrize("out", [None, "sweep"])
    def test_sweep(self, out, tmp_path):
        pytest.importorskip("zarr")
        data = tb.sweep(
            dusty(),
            F_star=[1e-6],
            vary={"roughness.sigma": [1e-7, 2e-7]},
            out=out and tmp_path / out,
        )
        assert data.attrs["engine"] == "numpy: fewer than 5000 loads of one contact (2 states)"

    @pytest.mark.parametrize("where", ["_add_asperities", "_add_particles"])
    def test_a_type_error_is_an_error(self, where):
        """A mistake in the library is not taken for an input that the engine does not know."""
        pytest.importorskip("numba")
        vary = {"roughness.sigma": 1e-7 * np.linspace(1, 1.2, 40)}
        broken = {"side_effect": TypeError("a mistake")}
        with mock.patch.object(rows.StateRows, where, **broken), pytest.raises(TypeError):
            state_columns(dusty(), F_star=1e-6, vary=vary)
        loads = np.geomspace(1e-8, 1e-5, 20)
        few = mock.patch.object(engine, "FEWEST", 1)
        broken_there = mock.patch.object(rows.InterfaceRows, where, **broken)
        with few, broken_there, pytest.raises(TypeError):
            tb.solve(dusty(), F_star=loads)

    def test_the_refusal_is_no_type_error(self):
        assert not issubclass(NotCompiled, (TypeError, tb.errors.ThirdBodyError))


# ------------------------------------------------------------------------------ jumps
ONE_SIZE = tb.distributions.Monodisperse(mean=3e-7)
MIXED = tb.distributions.Mixture(
    parts=(ONE_SIZE, tb.TruncatedGaussian(mean=2e-7, std=1.6e-8)), weights=(0.5, 0.5)
)


def sides(contact: tb.Contact, d: float) -> tuple[float, float]:
    """Loads F* just below and just above a separation."""
    low, high = tb.solve(contact, d=np.array([d * (1 - 1e-12), d * (1 + 1e-12)])).F_star
    return float(low), float(high)


class TestJump:
    """Where the load jumps, a load in between is not carried."""

    def test_a_load_beside_what_has_no_number_is_no_jump(self):
        """Where one side of a bracket has no load, no sentence names a jump to it."""
        contact_interface = interface(dusty())
        scan, load = load_scan(contact_interface), contact_interface.load
        target = np.array([1e-5 * contact_interface.contact.E_ss])
        root = scan.solve(target, "loading")[0][0]

        def known_above(d):
            return np.where(np.atleast_1d(d)[:, None] < root * (1 + 1e-7), np.nan, load(d))

        with mock.patch.object(type(contact_interface), "load", lambda _, d: known_above(d)):
            d, _, status = scan.solve(target, "loading")
        assert np.isnan(d[0])
        assert status.codes[0] == Status.UNSOLVED

    @pytest.fixture(params=[ONE_SIZE, MIXED], ids=["one size", "mixture"])
    def printed(self, request) -> tb.Contact:
        return dusty(tb.particle.Horng2022(), request.param)

    def test_a_load_in_a_jump(self, printed):
        """A particle is caught at d = x + h_e and carries all at once."""
        caught = 3e-7 + 3.11e-7
        most, least = sides(printed, caught)
        assert most > 100 * least
        inside = np.sqrt(most * least)
        with balances_not(Status.JUMP, says="6.11e-07 m"):
            tb.solve(printed, F_star=inside)
        loads = np.array([0.5 * least, inside, 2 * most])
        found = tb.solve(printed, F_star=loads)
        assert [word.split(":")[0] for word in found.status] == ["ok", "jump", "ok"]
        for name in ("d", "h", "A_t", "F_sa_star", "particle_area_share", "residual"):
            values = getattr(found, name)
            assert np.array_equal(np.isnan(values), [False, True, False]), name
        assert found.mode[1] == ""

    def test_every_path_says_so(self, printed, tmp_path):
        most, least = sides(printed, 3e-7 + 3.11e-7)
        inside = np.sqrt(most * least)
        alike = state_columns(printed, F_star=[inside, 2 * most])
        assert alike["status"][0].startswith("jump")
        assert alike["status"][1] == "ok"
        own = state_columns(
            printed, F_star=inside, vary={"roughness.R": 2.8e-6 * np.linspace(1, 1.001, 30)}
        )
        assert all(word.startswith("jump") for word in own["status"])
        data = tb.sweep(printed, F_star=[inside, 2 * most])
        assert str(data.status.values[0]).startswith("jump")
        pytest.importorskip("zarr")
        stored = tb.sweep(printed, F_star=[inside, 2 * most], out=tmp_path / "out")
        assert [word.split(":")[0] for word in stored.status.values] == ["jump", "ok"]

    def test_command_line_keeps_its_place(self, tmp_path):
        from thirdbody.study import load_study, run_study

        study = tmp_path / "study.toml"
        study.write_text(
            """
            [surfaces]
            first = "S45C"
            second = "S45C"
            [roughness]
            sigma = "100 nm"
            R = "2.8 um"
            [particles]
            material = "SiO2"
            distribution = "monodisperse"
            mean = "300 nm"
            areal_density = "1e11 / m^2"
            [particle_law]
            name = "horng2022"
            [load]
            F_star = [1e-7, 1e-5]
            """
        )
        states = run_study(load_study(study))["states"]
        assert states["status"][0].startswith("jump")
        assert states["status"][1] == "ok"
        assert states["d"][0] is None
        assert states["d"][1] > 0

    def test_roots_are_no_jumps(self, printed):
        """A jump among the crossings is left out, and alone it is an error."""
        with balances_not(Status.JUMP):
            tb.equilibria.roots(dusty(tb.particle.Horng2022(), ONE_SIZE), F_star=3.2e-5)
        most, least = sides(printed, 3e-7 + 3.11e-7)
        for F in np.geomspace(1.01 * least, 0.99 * most, 12):
            found = []
            with suppress(tb.errors.NoEquilibrium):
                found = tb.equilibria.roots(printed, F_star=F)
            for state, _ in found:
                assert tb.solve(printed, d=state.d).F_star == pytest.approx(F, rel=1e-9)

    @pytest.mark.parametrize("shadow", ["projected", "footprint"])
    @pytest.mark.parametrize("law", ["ke", "jg", "hermite"])
    def test_residuals(self, law, shadow):
        """Laws that jump, seats that shade at once: ok means carried, and else there is no ok."""
        series = tb.particle.Series(
            deep="off",
            law=tb.asperity.REGISTRY[law](**({"nu": 0.3} if law != "hermite" else {})),
            seat="plane",
            shadow=shadow,
        )
        contact = dusty(series, ONE_SIZE, 4e12)
        loads = np.geomspace(1e-9, 1e-2, 3_000)
        with mock.patch.object(engine, "FEWEST", 1):
            fast = tb.solve(contact, F_star=loads)
        slow = tb.solve(contact, F_star=loads)
        for found in (fast, slow):
            ok = found.status == "ok"
            assert ok.any()
            again = tb.solve(contact, d=found.d[ok]).F_star
            np.testing.assert_allclose(again, loads[ok], rtol=1e-9)
            assert np.isnan(found.d[~ok]).all()
        assert [s.split(":")[0] for s in fast.status] == [s.split(":")[0] for s in slow.status]

    def test_steep_for_floats_is_no_jump(self):
        """So few and so small loads that an ulp of d changes them: they are carried."""
        contact = dusty(
            tb.particle.Series(deep="off", seat="plane"),
            tb.distributions.Monodisperse(mean=5e-6),
            1e9,
        )
        F = tb.solve(contact, d=5e-6 * (1 - np.geomspace(2e-8, 1e-6, 50))).F_star
        found = tb.solve(contact, F_star=F * 1.01)
        assert set(found.status) == {"ok"}
        assert found.residual.max() > 1e-9
        one, other = (tb.solve(contact, d=np.nextafter(found.d, end)).F_star for end in (0, 1))
        assert np.all((other <= F * 1.01) & (F * 1.01 <= one))

    def test_nothing_is_ok_that_does_not_balance(self):
        """One place stands before every result, whoever found the separation."""
        contact, loads = dusty(), np.array([1e-6, 1e-5, 1e-4])
        from thirdbody.equilibrium.load_scan import LoadScan

        def wrong(self, target, branch):
            d, n, status = honest(self, target, branch)
            d[1] *= 1.01
            return d, n, status

        honest = LoadScan.solve
        with mock.patch.object(LoadScan, "solve", wrong):
            found = tb.solve(contact, F_star=loads)
        assert found.status[0] == found.status[2] == "ok"
        assert "do not balance the load" in found.status[1]
        assert np.isnan(found.d[1])
        assert np.isnan(found.A_t[1])

    @pytest.mark.parametrize("slip", [1.01, np.nan])
    def test_what_the_compiled_engine_leaves_goes_to_the_other(self, slip):
        pytest.importorskip("numba")
        contact, loads = dusty(), np.geomspace(1e-7, 1e-5, 40)
        vary = {"roughness.sigma": 1e-7 * np.linspace(1, 1.2, 40)}
        honest = engine._Batch.solve

        def wrong(self, which, target, h=None):
            h, n, fate, columns = honest(self, which, target, h)
            if target is not None and len(target) > 3:
                columns = {name: values.copy() for name, values in columns.items()}
                for values in columns.values():
                    values[3] *= slip
            return h, n, fate, columns

        few = mock.patch.object(engine, "FEWEST", 1), mock.patch.object(states, "FEWEST", 2)
        want = tb.solve(contact, F_star=loads), state_columns(contact, F_star=loads, vary=vary)
        slipping = mock.patch.object(engine._Batch, "solve", wrong)
        with few[0], slipping:
            many = tb.solve(contact, F_star=loads)
        with few[1], slipping:
            own = state_columns(contact, F_star=loads, vary=vary)
        for found, right in ((many.columns(), want[0].columns()), (own, want[1])):
            assert set(found["status"]) == {"ok"}
            assert found["residual"].max() < 1e-9
            np.testing.assert_allclose(found["A_t"], right["A_t"], rtol=1e-9)
        assert own["engine"][3] == "compiled"  # by the engine of own laws


# ------------------------------------------------------------------- several separations
def soft_dust(
    sizes: tb.distributions.Distribution | None = None,
    shadow: str = "footprint",
    coverage: float = 0.4,
) -> tb.Contact:
    """Spheres softer than the pressure: on approach they take more load than they carry."""
    sizes = sizes or tb.TruncatedGaussian(mean=3e-8, std=3e-9)
    soft = tb.Material(E=2e9, nu=0.3, H=50e6)
    density = coverage / (np.pi / 4 * sizes.moment(2))
    particles = tb.Particles(material=soft, diameter=sizes, areal_density=density)
    law = tb.particle.Series(deep="off", soft="sphere", seat="plane", shadow=shadow)
    return base(oracle.Interface(), particles, law)


class TestSeveralSeparations:
    """A load that several separations carry, in the consistent model."""

    @pytest.mark.spread(2)
    @pytest.mark.parametrize("sizes", [None, tb.distributions.Monodisperse(mean=3e-8)])
    @pytest.mark.parametrize("shadow", ["footprint", "projected"])
    def test_all_of_them(self, sizes, shadow):
        """Every crossing of a dense scan is a root, jumps aside."""
        contact = soft_dust(sizes, shadow)
        d = np.linspace(-1e-7, 2e-7, 300_001)
        F = tb.solve(contact, d=d).pressure
        several = 0
        for p in np.geomspace(1.0e8, 2.2e8, 45):
            at = np.flatnonzero((F[1:] >= p) != (F[:-1] >= p))
            steep = np.abs(F[at + 1] - F[at]) > 0.02 * p  # where the shadow sets in at once
            found = sorted(state.d for state, _ in tb.equilibria.roots(contact, pressure=p))
            np.testing.assert_allclose(found, 0.5 * (d[at] + d[at + 1])[~steep], atol=2e-12)
            several += len(found) > 1
        assert several > 2

    def test_the_branch_has_a_name(self):
        contact = soft_dust()
        with warns_of("branches", effect=1, says="3 separations"):
            loading = tb.solve(contact, pressure=1.7e8)
        with warns_of("branches", effect=1, says="unloading branch"):
            unloading = tb.solve(contact, pressure=1.7e8, branch="unloading")
        found = [state.d for state, _ in tb.equilibria.roots(contact, pressure=1.7e8)]
        assert [stable for _, stable in tb.equilibria.roots(contact, pressure=1.7e8)] == [
            True,
            False,
            True,
        ]
        assert loading.d == pytest.approx(max(found), rel=1e-12)
        assert unloading.d == pytest.approx(min(found), rel=1e-12)
        with warns_of("branches", effect=1, says="2 of the 3 loads"):
            tb.solve(contact, pressure=[1e7, 1.7e8, 1.75e8])
        assert not any("separations carry" in s for s in tb.solve(dusty(), pressure=1e7).warnings)

    def test_both_engines(self):
        """The compiled one declines, for loads of one contact and for contacts of their own."""
        pytest.importorskip("numba")
        contact = soft_dust()
        loads = np.geomspace(1.2e8, 2.4e8, 60)
        want = np.array(
            [max(s.d for s, _ in tb.equilibria.roots(contact, pressure=p)) for p in loads]
        )
        vary = {"roughness.R": np.full(60, contact.roughness.R) * np.linspace(1, 1 + 1e-9, 60)}
        few = mock.patch.object(engine, "FEWEST", 1), mock.patch.object(states, "FEWEST", 2)
        with few[0], few[1]:
            many = tb.solve(contact, pressure=loads)
            own = state_columns(contact, pressure=loads, vary=vary)
        assert many.engine == f"numpy: {engine.NOT_MONOTONE}"
        assert set(own["engine"]) == {many.engine}
        np.testing.assert_allclose(many.d, want, rtol=1e-9)
        np.testing.assert_allclose(own["d"], want, rtol=1e-6)

    @pytest.mark.parametrize("seat", ["plane", "rough"])
    @pytest.mark.parametrize("shadow", ["footprint", "projected", "covered", "none"])
    def test_what_the_compiled_engine_takes_is_monotone(self, seat, shadow):
        """The sufficient condition asked of states holds for the scan of each of them."""
        pytest.importorskip("numba")
        from thirdbody.contact.interface import interface
        from thirdbody.equilibrium.states import vary_contact

        rng = np.random.default_rng(7)
        count = 60
        x = 1e-7 * 10 ** rng.uniform(-1, 1, count)
        cover = 10 ** rng.uniform(-2, -0.1, count)
        contact = soft_dust(tb.TruncatedGaussian(mean=1e-7, std=1e-8), coverage=0.1)
        contact = contact.replace(
            particle_law=tb.particle.Series(deep="off", seat=seat, shadow=shadow),
            particles=contact.particles.replace(material=material(oracle.SILICA)),
        )
        moment = contact.particles.diameter.moment(2) / 1e-14
        vary = {
            "particles.diameter.mean": x,
            "particles.diameter.std": 0.1 * x,
            "particles.areal_density": cover / (np.pi / 4 * moment * x**2),
        }
        with mock.patch.object(states, "FEWEST", 2):
            found = state_columns(contact, F_star=1e-4, vary=vary)["engine"]
        fast = np.flatnonzero(found == "compiled")
        assert len(fast) > 10
        for i in fast:
            one = vary_contact(contact, {name: float(values[i]) for name, values in vary.items()})
            assert load_scan(interface(one)).monotone, i


# --------------------------------------------------------------------------- equality
class TestEquality:
    """What is equal is equal in every field, and caches take what carries load."""

    def test_outputs_count(self):
        from thirdbody.contact.interface import interface

        plain = dusty()
        told = plain.replace(outputs=tb.outputs.Friction(tau_ss=1e8, tau_sa=1e8))
        assert told != plain
        assert len({told, plain}) == 2
        assert told == plain.replace(outputs=tb.outputs.Friction(tau_ss=1e8, tau_sa=1e8))
        assert interface(told) is interface(plain)
        assert told.replace(outputs=()) == plain

    def test_stand_ins_with_arrays_are_no_values(self):
        plain = dusty()
        vary = {"roughness.sigma": np.array([1e-7, 2e-7])}
        one, two = plain.with_arrays(vary), plain.with_arrays(vary)
        for this, other in ((one, two), (one.roughness, two.roughness)):
            assert this == this
            assert this != other
            with pytest.raises(TypeError, match="unhashable type"):
                hash(this)
        assert isinstance(one.roughness, tb.Roughness)
        assert tb.Roughness.from_dict(plain.roughness.to_dict()) == plain.roughness
        assert hash(plain.roughness) == hash(plain.roughness.replace())


class TestResults:
    """What holds arrays is equal to itself alone; comparing two of them raised."""

    def test_results_with_arrays_can_be_compared_and_kept(self):
        loads = np.array([1e-6, 1e-5])
        one, two, other = (tb.solve(dusty(), F_star=loads * factor) for factor in (1, 1, 2))
        assert one == two
        assert one != other
        assert len({one, two, other}) == 2


def test_stones_among_dust_hide_no_root():
    """The scan of the load resolves fine dust beside sizes that reach to kilometres."""
    steel = tb.materials["S45C"]
    dust = tb.Particles(
        material=tb.materials["SiO2"],
        diameter=tb.TruncatedGaussian(mean=50e-6, std=2e-6),
        areal_density=1e4,
    )
    fine = dust.replace(diameter=tb.TruncatedGaussian(mean=20e-6, std=1e-6))
    stones = dust.replace(diameter=tb.LogNormal(median=2.7e-3, gsd=3.8), areal_density=1e-3)
    contact = tb.Contact(
        surfaces=tb.MaterialPair(steel, steel),
        roughness=tb.Roughness(sigma=1e-6, R=28e-6),
        particles=(dust, fine, stones),
        particle_law=tb.particle.Horng2022(preset="window"),
    )
    d = np.linspace(0, 100e-6, 20_001)
    for load in (1e-11, 1e-10, 1e-9, 3e-9):
        more = interface(contact).load(d)[:, 0] > load * contact.E_ss
        crossed = np.flatnonzero(more[1:] != more[:-1])
        with warns_of("branches", effect=1, says="5 separations"):
            state = tb.solve(contact, F_star=load)
        assert state.d == pytest.approx(d[crossed[-1]], abs=6e-9)
        roots = tb.equilibria.roots(contact, F_star=load)
        assert len(roots) == len(crossed) == 5
