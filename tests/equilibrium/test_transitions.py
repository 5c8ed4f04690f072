"""Critical loads and turning points against their definitions, applied to a dense scan."""

import json

import numpy as np
import oracle
import pytest
from twins import base, series_twin, sizes

import thirdbody as tb

pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
WINDOW = (1e-8, 1e-2)
LOADS = np.geomspace(*WINDOW, 6001)
STEP = LOADS[1] / LOADS[0]


def contact(
    seat="rough", x=3e-7, sigma=1e-7, density=1e11, dust=oracle.SILICA, width=0.1, **options
):
    interface = oracle.Interface(rough=oracle.Rough(sigma, 2.8e-6))
    diameter = sizes("gaussian", x, width)
    return series_twin(interface, dust, diameter, density, x, seat=seat, **options).contact


def paper(preset: str, x=3e-7, sigma=1e-7, dust=oracle.SILICA):
    base_contact = contact(x=x, sigma=sigma, dust=dust, width=0.2)
    return base_contact.replace(particle_law=tb.particle.Horng2022(preset=preset))


CASES = {
    "rough 300": contact(),
    "rough 100": contact(x=1e-7),
    "rough 1000": contact(x=1e-6),
    "rough sparse": contact(density=1e9),
    "rough many": contact(x=3e-7, density=2e12),
    "plane 300": contact("plane"),
    "plane narrow": contact("plane", x=2.6e-7, width=0.05),
    "plane 1000 sparse": contact("plane", x=1e-6, density=1e8),
    "offset": contact("offset", x=2e-7, sigma=3e-7, density=1e9, h_0=7.5e-7),
    "soft dust": contact(dust=oracle.Body(20e9, 0.3, 3e8)),
    "published 300": paper("published"),
    "window 300": paper("window"),
    "window 1000": paper("window", x=1e-6),
    "all_terms 200": paper("all_terms", x=2e-7, sigma=3e-7),
    "bare": base(oracle.Interface()),
}


@pytest.fixture(scope="module")
def scans():
    """Particle share of area or load over the window, by brute force."""
    memory = {}

    def scan(name: str, basis: str = "area"):
        if name not in memory:
            memory[name] = tb.solve(CASES[name], F_star=LOADS)
        states = memory[name]
        assert np.all(np.isfinite(states.A_t)), "choose a window that the contact can carry"
        return states.particle_area_share if basis == "area" else states.particle_load_share

    return scan


def expected_cr1(S: np.ndarray, eps: float) -> tuple[str, float | None]:
    """Smallest load at which the particle share falls below 1 − ε_1."""
    below = np.flatnonzero(S < 1 - eps)
    if not len(below):
        return "always p-s", None
    if below[0] == 0:
        return "never p-s", None
    i = below[0]
    return "found", float(np.sqrt(LOADS[i - 1] * LOADS[i]))


def expected_cr2(S: np.ndarray, eps: float) -> tuple[str, float | None]:
    """Load above which the particle share stays below ε_2."""
    above = np.flatnonzero(S >= eps)
    if not len(above):
        return "always s-s", None
    if above[-1] == len(S) - 1:
        return "never s-s", None
    i = above[-1]
    return "found", float(np.sqrt(LOADS[i] * LOADS[i + 1]))


@pytest.mark.parametrize("basis", ["area", "load"])
@pytest.mark.parametrize("name", CASES)
def test_critical_loads(name, basis, scans):
    S = scans(name, basis)
    found = tb.transitions(CASES[name], window=WINDOW, basis=basis)
    for critical, (status, value), threshold in (
        (found.F_cr1, expected_cr1(S, 0.02), 0.98),
        (found.F_cr2, expected_cr2(S, 0.05), 0.05),
    ):
        if critical.status == "jump":
            assert status == "found"
            assert jumps(name, basis, critical.value, threshold)
        else:
            assert critical.status == status
        if status == "found":
            # within one step of the scan
            assert abs(np.log(critical.value / value)) < np.log(STEP)
            if critical.status == "found":
                state = tb.solve(CASES[name], F_star=critical.value)
                share = getattr(state, f"particle_{basis}_share")
                assert share == pytest.approx(threshold, abs=1e-6)
        elif status != "always s-s":
            assert critical.value is None or critical.value in WINDOW
    if found.F_cr1.status == found.F_cr2.status == "found":
        assert found.F_cr1.value <= found.F_cr2.value


def jumps(name: str, basis: str, F: float, threshold: float) -> bool:
    """The share passes the threshold without taking its value, however close one looks."""
    pair = tb.solve(CASES[name], F_star=F * np.array([1 - 1e-7, 1 + 1e-7]))
    shares = getattr(pair, f"particle_{basis}_share")
    return (
        shares[0] > threshold + 1e-4
        or shares[1] < threshold - 1e-4
        or abs(shares[0] - shares[1]) > 1e-4
    )


def test_the_cases_show_every_status():
    """Otherwise some branch of the definitions goes untested."""
    statuses = {1: set(), 2: set()}
    for each in CASES.values():
        result = tb.transitions(each, window=WINDOW)
        statuses[1].add(result.F_cr1.status)
        statuses[2].add(result.F_cr2.status)
    assert {"found", "never p-s", "jump"} <= statuses[1]
    assert {"found", "always s-s", "never s-s"} <= statuses[2]


def test_always_p_s():
    """In a window of light loads, large particles carry everything."""
    light = tb.transitions(contact("plane", x=1e-6), window=(1e-8, 1e-6))
    assert light.F_cr1.status == "always p-s"
    assert light.F_cr2.status == "never s-s"


@pytest.mark.parametrize("name", CASES)
def test_turning_point_by_largest_share(name, scans):
    """Definition A: the interior maximum of the share, when both sides fall below 0.9 of it."""
    S = scans(name)
    i = int(np.argmax(S))
    recurrent = S[i] > 1e-9 and S[:i].min(initial=np.inf) < 0.9 * S[i]
    recurrent = recurrent and S[i:].min() < 0.9 * S[i]
    A = tb.transitions(CASES[name], window=WINDOW).F_tpca.A
    if not recurrent:
        assert A.status == "none"
        assert A.value is None
        return
    assert A.status in ("found", "jump")
    share = tb.solve(CASES[name], F_star=A.value).particle_area_share
    assert share == pytest.approx(S[i], abs=2e-3 * S[i])
    assert share >= S[i] * (1 - 1e-6) or A.status == "jump"


@pytest.mark.parametrize("name", CASES)
def test_turning_point_by_equal_loads(name, scans):
    """Definition B: asperities and particles carry the same."""
    S = scans(name, "load")
    crossings = np.flatnonzero((S[:-1] - 0.5) * (S[1:] - 0.5) < 0)
    B = tb.transitions(CASES[name], window=WINDOW).F_tpca.B
    if not len(crossings):
        assert B.status == "none"
        assert B.value is None
        return
    near = [abs(np.log(B.value / LOADS[i])) for i in crossings]
    assert min(near) < 1.5 * np.log(STEP)
    if B.status == "found":
        state = tb.solve(CASES[name], F_star=B.value)
        assert state.particle_load_share == pytest.approx(0.5, abs=1e-6)


def test_turning_points_exist_somewhere():
    offset = tb.transitions(CASES["offset"], window=WINDOW).F_tpca
    assert offset.A.status == "found"
    sparse = tb.transitions(CASES["rough 300"], window=WINDOW).F_tpca
    assert sparse.B.status == "found"


@pytest.mark.parametrize("name", ["rough 300", "offset", "all_terms 200"])
def test_turning_point_by_curvature(name, scans):
    """Definition C: an extremum of the curvature of log A_t over log F, in the hybrid range."""
    C = tb.transitions(CASES[name], window=WINDOW).F_tpca.C
    assert C.status == "found"
    S = scans(name)
    hybrid = LOADS[(S > 0.05) & (S < 0.98)]
    assert hybrid[0] * 0.99 <= C.value <= hybrid[-1] * 1.01
    x = np.log(C.value) + np.linspace(-0.6, 0.6, 61)
    y = np.log(tb.solve(CASES[name], F_star=np.exp(x)).A_t)
    slope = np.gradient(y, x)
    curvature = np.gradient(slope, x) / (1 + slope**2) ** 1.5
    window = np.abs(curvature[10:-10])
    # as sharp, within a few hundredths, as the sharpest place nearby
    assert window[len(window) // 2] >= 0.9 * window.max()


@pytest.mark.parametrize(("eps_1", "eps_2"), [(0.01, 0.02), (0.1, 0.2), (0.3, 0.3)])
def test_thresholds(eps_1, eps_2, scans):
    found = tb.transitions(CASES["rough 300"], window=WINDOW, eps_1=eps_1, eps_2=eps_2)
    S = scans("rough 300")
    for critical, (status, value) in (
        (found.F_cr1, expected_cr1(S, eps_1)),
        (found.F_cr2, expected_cr2(S, eps_2)),
    ):
        assert critical.status == status
        if value:
            assert abs(np.log(critical.value / value)) < np.log(STEP)


def test_narrower_window():
    wide = tb.transitions(CASES["rough 300"], window=WINDOW).F_cr1.value
    assert tb.transitions(CASES["rough 300"], window=(wide / 3, 1e-2)).F_cr1.value == pytest.approx(
        wide, rel=1e-6
    )
    assert tb.transitions(CASES["rough 300"], window=(wide * 2, 1e-2)).F_cr1.status == "never p-s"


def test_as_json():
    table = json.loads(json.dumps(tb.transitions(CASES["rough 300"]).to_dict()))
    assert set(table["F_cr1"]) >= {"value", "status"}
    assert set(table["F_tpca"]) >= {"A", "B", "C"}
    assert table["F_cr1"]["value"] == tb.transitions(CASES["rough 300"]).F_cr1.value


@pytest.mark.parametrize(
    "bad",
    [
        {"window": (1e-2, 1e-8)},
        {"window": (0.0, 1e-2)},
        {"window": (1e-8, float("nan"))},
        {"eps_1": -0.1},
        {"eps_2": 1.5},
        {"basis": "volume"},
    ],
)
def test_bad_questions(bad):
    with pytest.raises(tb.errors.InvalidValue):
        tb.transitions(CASES["rough 300"], **bad)
