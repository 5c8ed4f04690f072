"""Codes of what became of a state: one enumeration, the same in every engine, file and sentence."""

import os
from unittest import mock

import numpy as np
import oracle
import pytest
from refusals import balances_not
from twins import base, material

import thirdbody as tb
from thirdbody.equilibrium import states
from thirdbody.equilibrium.compiled import batch as engine
from thirdbody.equilibrium.crowding import chi_of, is_crowded
from thirdbody.equilibrium.states import state_columns
from thirdbody.equilibrium.status import FIELD_SENTENCES, SENTENCES, WORDS, Status
from thirdbody.errors import code_of
from thirdbody.papers import seats

pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")


def rough(H: float = 3e9, E: float = 2e11) -> tb.Contact:
    body = tb.Material(E=E, nu=0.3, H=H)
    return tb.Contact(
        surfaces=tb.MaterialPair(body, body), roughness=tb.Roughness(sigma=3e-7, R=3e-6)
    )


def dusty(**changes) -> tb.Contact:
    particles = tb.Particles(
        material=material(oracle.SILICA),
        diameter=tb.TruncatedGaussian(mean=3e-7, std=2.4e-8),
        areal_density=1e11,
    )
    return base(oracle.Interface(), particles, tb.particle.Series(deep="off", **changes))


def test_every_code_has_a_word_and_a_sentence():
    """Files keep the codes: the first five are those of folders that were written before."""
    assert WORDS[:5] == (
        "ok",
        "no_equilibrium_above",
        "no_equilibrium_below",
        "no_equilibrium",
        "jump",
    )
    assert (
        [status.value for status in Status]
        == list(range(len(WORDS)))
        == list(range(len(SENTENCES)))
    )
    assert len(set(WORDS)) == len(set(SENTENCES)) == len(Status)
    assert all(" " not in status.word and status.sentence for status in Status)


def test_the_engine_has_these_codes():
    pytest.importorskip("numba")
    from thirdbody.equilibrium.compiled import balance

    for name in ("OK", "TOO_MUCH", "TOO_LITTLE", "UNSOLVED"):
        assert getattr(balance, name) == Status[name]


class TestBelowOneField:
    """Separations under the table of one field of heights: said as such, by each engine."""

    @staticmethod
    def dusty_field() -> tb.Contact:
        dust = dusty()
        return dust.replace(
            roughness=tb.Roughness(sigma=1e-7, R=2.8e-6, alpha=10.0),
            asperity_law=tb.asperity.Field(),
        )

    @pytest.mark.parametrize("count", [2, pytest.param(30, marks=pytest.mark.slow)])
    def test_the_table_ends(self, count):
        alphas = np.linspace(25, 30, count)
        found = state_columns(self.dusty_field(), d=-1e-5, vary={"roughness.alpha": alphas})
        assert set(found["status_code"]) == {Status.TOO_DEEP}
        assert set(found["status"]) == {FIELD_SENTENCES[Status.TOO_DEEP]}

    @pytest.mark.slow
    def test_an_unknown_bandwidth_is_refused_however_deep(self):
        alphas = np.linspace(25, 31, 30)
        for d in (-1e-5, 3e-7):
            with pytest.raises(tb.errors.InvalidValue):
                state_columns(self.dusty_field(), d=d, vary={"roughness.alpha": alphas})


class TestEveryDoor:
    """The same code for the same load from `solve`, `solve_states` and `sweep`, by each engine."""

    LOADS = np.array([1e-6, 1e-3, 8e-3, 1.4e-2, 1.0])
    CODES = (*3 * (Status.OK,), Status.CROWDED, Status.TOO_MUCH)

    @pytest.mark.parametrize("which", ["numpy", ""])
    @pytest.mark.parametrize("door", ["solve", "states", "varied", "sweep", "stored"])
    def test_codes(self, door, which, tmp_path):
        contact, loads, code = rough(), self.LOADS, list(self.CODES)
        off = mock.patch.dict(os.environ, THIRDBODY_ENGINE=which)
        with off, mock.patch.object(engine, "FEWEST", 1), mock.patch.object(states, "FEWEST", 2):
            if door == "solve":
                found = tb.solve(contact, F_star=loads)
                got, said, A_t = found.status_code, found.status, found.A_t
            elif door in ("states", "varied"):
                own = {"roughness.R": 3e-6 * np.linspace(1, 1 + 1e-9, len(loads))}
                data = tb.equilibria.solve_states(
                    contact, F_star=loads, vary=own if door == "varied" else None
                )
                got, said, A_t = data.status_code.values, data.status.values, data.A_t.values
                words = data.status_code.attrs["flag_meanings"].split()
                assert [words[i] for i in got] == [Status(one).word for one in code]
            elif door == "sweep":
                data = tb.sweep(contact, F_star=loads)
                got, said, A_t = data.status_code.values, data.status.values, data.A_t.values
                words = data.status_code.attrs["flag_meanings"].split()
                assert [words[i] for i in got] == [Status(one).word for one in code]
            else:
                pytest.importorskip("zarr")
                data = tb.sweep(contact, F_star=loads, out=tmp_path / "out")
                got, said, A_t = data.status_code.values, data.status.values, data.A_t.values
                words = data.status_code.attrs["flag_meanings"].split()
                assert [words[i] for i in got] == [Status(one).word for one in code]
        if got is not None:
            assert list(got) == code
        if said is not None:
            start = [Status(one).sentence.split(":")[0] for one in code]
            assert [str(text).split(":")[0] for text in said] == start
        # crowded states hold what the model says, the others that are not ok hold nothing
        assert np.isfinite(A_t).tolist() == [Status(one).has_numbers for one in code]
        assert A_t[3] > 0.5 > A_t[2]


def test_one_crowded_load_is_told_and_not_ok():
    """One load: its numbers are there, its status is no answer, and it does not raise."""
    state = tb.solve(rough(), F_star=1.4e-2)
    assert state.A_t > 0.5
    assert state.status_code == Status.CROWDED


def test_real_areas_above_one_are_not_ok():
    """Copper at a few yields: the sum over summits counts more area than there is."""
    contact = rough(H=3e8)
    found = tb.solve(contact, d=np.linspace(-4, 3, 60) * contact.roughness.sigma_s)
    assert found.A_t.max() > 1
    assert np.array_equal(found.status == "ok", found.A_t <= 0.5)
    assert np.array_equal(is_crowded(contact, found.A_t), found.A_t > 0.5)


def test_the_laws_give_no_number_is_no_large_load(tmp_path):
    """Its sentence holds "pressed beyond", which is not "load beyond the most"."""
    pytest.importorskip("zarr")
    contact = rough().replace(asperity_law=tb.asperity.GW())
    fields = states.Interface.fields

    def broken(self, d):
        return {name: np.full_like(values, np.nan) for name, values in fields(self, d).items()}

    with mock.patch.object(states.Interface, "fields", broken):
        found = tb.solve(contact, F_star=[1e-6, 1e-4])
        stored = tb.sweep(contact, F_star=[1e-6, 1e-4], out=tmp_path / "out")
    assert all("beyond" in text for text in found.status)
    assert found.status_code.tolist() == [Status.BEYOND_LAWS] * 2
    assert stored.status_code.values.tolist() == [Status.BEYOND_LAWS] * 2
    assert stored.status.values.tolist() == [Status.BEYOND_LAWS.sentence] * 2


def test_states_with_a_hardness_of_their_own():
    """Half of the states above half the area, half below: as `solve` says of each."""
    contact, F_star, H = rough(), 1.1e-2, np.linspace(1e9, 4e9, 40)
    got = state_columns(contact, F_star=F_star, vary={"surfaces.first.H": H})
    each = [
        tb.solve(contact.replace(**{"surfaces.first.H": float(one)}), F_star=[F_star]) for one in H
    ]
    assert got["status_code"].tolist() == [int(one.status_code[0]) for one in each]
    assert len(set(got["status_code"].tolist())) > 1


class TestChi:
    """The warning about crowded areas follows H/(E* g)."""

    @pytest.mark.parametrize(
        ("ratio", "chi"), [(0.01798, 0.0737), (0.04464, 0.1827), (0.1, 0.4097)]
    )
    def test_its_value(self, ratio, chi):
        """Of three pressed contacts, σ = 0.3 µm, R = 3 µm, α = 5; the g of that table is 0.2 % more."""
        contact = rough(E=2e11, H=1.0)
        hard = rough(E=2e11, H=ratio * contact.E_ss)
        assert chi_of(hard) == pytest.approx(chi, rel=3e-3)

    @pytest.mark.parametrize("alpha", [1.6, 5.0, 60.0])
    def test_the_slope_gives_back_the_radius(self, alpha):
        """McCool's R = (3/8)√(π/m4), with m4 = α m2²/m0 and m2 = g²/2."""
        one = tb.Roughness(sigma=2e-7, R=4e-6, alpha=alpha)
        m4 = alpha * (0.5 * one.slope**2) ** 2 / one.sigma**2
        assert 3 / 8 * np.sqrt(np.pi / m4) == pytest.approx(one.R, rel=1e-13)

    def test_it_has_no_unit(self):
        one = rough()
        twice = one.replace(**{"roughness.sigma": 6e-7, "roughness.R": 6e-6})
        assert chi_of(twice) == pytest.approx(chi_of(one), rel=1e-14)

    @pytest.mark.parametrize(("F_star", "warns"), [(5e-5, False), (7e-4, True)])
    def test_hard_rough_surfaces_are_told_early(self, F_star, warns):
        """At χ = 0.41 the share is 29 % high at a real area of 0.006 already."""
        contact = dusty().replace(
            roughness=tb.Roughness(sigma=3e-7, R=3e-6), surfaces=rough(H=1.1e10).surfaces
        )
        state = tb.solve(contact, F_star=F_star)
        assert (state.A_t > 0.005) == warns
        told = [note for note in state.warnings if code_of(note) == "area.hard"]
        assert bool(told) == warns
        if warns:
            assert state.A_t < 0.05
            assert told[0].effect == 0.3
            assert "19 to 30 %" in told[0]
            assert "0.05 to 0.72 sigma" in told[0]

    def test_the_numbers_of_hard_surfaces_are_of_the_record(self):
        """χ of 0.4 and 0.7 with α of 3 and 5: what was pressed beside the model."""
        hard = [
            s for s in seats.comparison() if s["group"] == "hard" and "alpha15" not in s["case"]
        ]
        less = sorted(round(100 * (1 - s["share"] / s["share_statistical"])) for s in hard)
        assert (less[0], less[-1]) == (19, 30)
        apart = sorted(s["h_over_sigma"] - s["h_over_sigma_statistical"] for s in hard)
        assert [round(each, 2) for each in (apart[0], apart[-1])] == [0.05, 0.72]

    def test_plastic_surfaces_as_before(self):
        contact = dusty().replace(
            roughness=tb.Roughness(sigma=3e-7, R=3e-6), surfaces=rough(H=4e9).surfaces
        )
        state = tb.solve(contact, F_star=1e-3)
        assert 0.005 < state.A_t < 0.05
        assert not any(code_of(text).startswith("area") for text in state.warnings)

    def test_a_sweep_looks_at_all_its_contacts(self):
        """χ of the contact that the sweep starts from is small; that of the hard ones is not."""
        contact = dusty().replace(
            roughness=tb.Roughness(sigma=3e-7, R=3e-6), surfaces=rough(H=4e9).surfaces
        )
        vary = {"surfaces.first.H": [4e9, 1.2e10], "surfaces.second.H": [4e9, 1.2e10]}
        data = tb.sweep(contact, F_star=[1e-3], vary=vary)
        assert float(data.A_t.max()) < 0.05
        assert "chi = H/(E* g)" in data.attrs["warnings"]
        alone = tb.sweep(contact, F_star=[1e-3])
        assert "chi = H/(E* g)" not in alone.attrs["warnings"]


def test_a_pressure_below_hardness_is_no_wrong_unit():
    """Hertz pressures of hard bodies are more than summits carry, and less than the hardness."""
    contact = rough(H=7e9)
    with balances_not(Status.TOO_MUCH, says="hardness, 7 GPa"):
        tb.solve(contact, pressure=6.5e9)
    with balances_not(Status.TOO_MUCH, says="hardness, 7 GPa; check the unit"):
        tb.solve(contact, pressure=6.5e12)
