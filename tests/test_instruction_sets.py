"""The same numbers from every set of instructions that NumPy, OpenBLAS and numba can be told to use.

What may differ is the rounding of exp, log, powers and sums; bounds are stated below for each kind
of number. Bits are promised on one kind of processor only.
"""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[1]

# by the names of all versions of NumPy
BEYOND_AVX2 = "X86_V4 AVX512F AVX512CD AVX512_SKX AVX512_CLX AVX512_CNL AVX512_ICL AVX512_SPR"
BEYOND_SSE4 = f"X86_V3 AVX F16C FMA3 AVX2 {BEYOND_AVX2}"
SETTINGS = {
    "numpy AVX2": {"NPY_DISABLE_CPU_FEATURES": BEYOND_AVX2},
    "numpy SSE4": {"NPY_DISABLE_CPU_FEATURES": BEYOND_SSE4},
    "OpenBLAS Haswell": {"OPENBLAS_CORETYPE": "Haswell"},
    "OpenBLAS SkylakeX": {"OPENBLAS_CORETYPE": "SkylakeX"},
    "OpenBLAS Nehalem": {"OPENBLAS_CORETYPE": "Nehalem"},
    "numba generic": {"NUMBA_CPU_NAME": "generic"},
}
NEEDED = {"OpenBLAS Haswell": "AVX2", "OpenBLAS SkylakeX": "AVX512_SKX"}
"""What the processor must have."""

STATES = """
import json, sys, warnings
import numpy as np
import thirdbody as tb
from thirdbody.equilibrium.states import state_columns
from thirdbody.study import load_study
warnings.simplefilter("ignore")
out = {"laws": {}, "heights": {}, "sizes": {}, "states": {}, "separations": {}}
def keep(kind, name, values):
    out[kind][name] = np.ravel(np.asarray(values, dtype=float)).tolist()
for name, kind in sorted(tb.asperity.REGISTRY.items()):
    y = np.geomspace(1e-3, 1e3, 61)
    try:
        law = kind()
        found = [law.reduced(what, y) for what in ("force", "area")]
    except (TypeError, tb.errors.InvalidValue):
        continue  # asks for numbers of its own
    keep("laws", name, found)
z = np.linspace(-3, 6, 37)
for law in (tb.heights.GaussianHeights(), tb.heights.ExponentialHeights(), tb.heights.WeibullHeights(shape=1.8),
            tb.heights.JohnsonHeights(skewness=-0.7, kurtosis=4.2),
            tb.heights.JohnsonHeights(skewness=-0.9, kurtosis=3.3)):
    keep("heights", repr(law), np.concatenate([law.pdf(z), law.sf(z), law.ppf([0.1, 0.9])]))
for law in (tb.LogNormal(median=3e-7, gsd=1.5), tb.distributions.Weibull(scale=3e-7, shape=4.0),
            tb.TruncatedGaussian(mean=3e-7, std=2.4e-8)):
    keep("sizes", repr(law), [law.partial_moment(n, 1e-7, 4e-7) * 3e-7**-n for n in range(4)])
for path in sys.argv[1:]:
    contact = load_study(path).contact.replace(outputs=())
    for key, given in (("pressure", np.geomspace(1e4, 1e8, 25)), ("d", np.linspace(5e-8, 5e-7, 25))):
        state = tb.solve(contact, **{key: given})
        for column, values in sorted(state.columns().items()):
            if values.dtype.kind == "f" and column != "residual":
                kind = "separations" if column.startswith("d") else "states"
                keep(kind, f"{path} {key} {column}", values)
    # by the compiled engine
    H = np.linspace(4e9, 6e9, 64)
    vary = {"surfaces.first.H": H, "surfaces.second.H": H}
    states = state_columns(contact, pressure=np.geomspace(1e4, 1e8, 64), vary=vary)
    for column in ("d", "A_t", "F_ss_star"):
        keep("separations" if column == "d" else "states", f"{path} varied {column}", states[column])
print(json.dumps(out))
"""

RTOL = {
    # one power and a logarithm each; a difference of neighbouring branches loses two digits
    "laws": 1e-13,
    # a power and an exp, off by up to 4 units in the last place each, whose argument counts up
    # to 20 times in a tail exp(-20): 4 * (20 + 20) units of 2.2e-16
    "heights": 4e-14,
    # differences of distribution functions
    "sizes": 1e-13,
    # a balance is kept to 1e-13 of the load, and a load falls by e in a third of σ
    "separations": 1e-13,
    # sums over heights and sizes, which docs/validation.md states to 1e-12
    "states": 1e-12,
}
"""Relative differences allowed, and as much again of the largest value."""


def environment(setting, cache):
    clean = {
        key: value
        for key, value in os.environ.items()
        if key not in ("NPY_DISABLE_CPU_FEATURES", "OPENBLAS_CORETYPE", "NUMBA_CPU_NAME")
    }
    # code compiled for one processor in a folder of its own
    folder = {"NUMBA_CACHE_DIR": str(cache)} if "NUMBA_CPU_NAME" in setting else {}
    return clean | setting | folder | {"MPLBACKEND": "Agg"}


def ran(setting, cache, *command):
    return subprocess.run(
        [sys.executable, "-W", "ignore", *command],
        env=environment(setting, cache),
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )


def needs(name):
    """Skip what this processor, or this NumPy, does not have."""
    from numpy._core import _multiarray_umath as umath

    setting = SETTINGS[name]
    if sys.platform == "win32" or not umath.__cpu_features__.get("SSE42"):
        pytest.skip("sets of instructions are named as on x86-64")
    if name in NEEDED and not umath.__cpu_features__.get(NEEDED[name]):
        pytest.skip(f"this processor has no {NEEDED[name]}")
    asked = setting.get("NPY_DISABLE_CPU_FEATURES")
    if asked:
        there = [
            word
            for word in asked.split()
            if umath.__cpu_features__.get(word) and word in umath.__cpu_dispatch__
        ]
        if not there:
            pytest.skip(f"NumPy uses none of {asked} here")
        setting = {"NPY_DISABLE_CPU_FEATURES": " ".join(there)}
    return setting


EXAMPLES = ("examples/dusty_ball_screw.toml", "examples/two_body_reference.toml")


@pytest.fixture(scope="module")
def usual(tmp_path_factory):
    done = ran({}, tmp_path_factory.mktemp("usual"), "-c", STATES, *EXAMPLES)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def hold(found, usual):
    for kind, columns in usual.items():
        assert columns
        assert list(found[kind]) == list(columns)
        for name, want in columns.items():
            want, got = np.array(want), np.array(found[kind][name])
            tolerance = {"rtol": RTOL[kind], "atol": RTOL[kind] * np.nanmax(np.abs(want))}
            np.testing.assert_allclose(got, want, **tolerance, err_msg=f"{kind} {name}")


@pytest.mark.slow
@pytest.mark.parametrize("name", SETTINGS)
def test_states_and_laws(name, usual, tmp_path):
    done = ran(needs(name), tmp_path, "-c", STATES, *EXAMPLES)
    assert done.returncode == 0, done.stderr
    hold(json.loads(done.stdout), usual)


FAST = (
    "tests/laws/test_heights.py",
    "tests/populations/test_sizes.py",
    "tests/study/test_study.py",
)


@pytest.mark.slow
def test_the_tests_themselves_pass(tmp_path):
    """A set of tests that compare numbers closely, under the oldest instructions."""
    words = "(density or johnson or histogram or weibull or heights or moments) and not edge"
    done = ran(
        needs("numpy SSE4"),
        tmp_path,
        "-m",
        "pytest",
        "-q",
        "-x",
        "-p",
        "no:xdist",
        "-k",
        words,
        *FAST,
    )
    assert done.returncode == 0, done.stdout[-3000:]
