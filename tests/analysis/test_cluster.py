"""Sweeps on a Dask cluster: a scheduler and worker processes on the loopback."""

import os
import signal
import sys
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from steel_and_dust import DUSTY as CONTACT
from typer.testing import CliRunner

import thirdbody as tb
from thirdbody.analysis.sweep.cluster import connected
from thirdbody.cli import app

distributed = pytest.importorskip(
    "distributed", reason="needs the extra: pip install 'thirdbody[cluster]'"
)
pytest.importorskip("zarr", reason="needs the extra: pip install 'thirdbody[sweep]'")

pytestmark = pytest.mark.check
EXAMPLE = Path(__file__).parents[2] / "examples" / "sweep.toml"
ASKED = dict(
    pressure=(1e6, 1e8),
    vary={
        "particles.areal_density": [0.0, 1e10, 1e11],
        "roughness.R": (2e-6, 4e-6),
        "roughness.sigma": (8e-8, 1.2e-7),
    },
    design="latin",
    samples=100,
    chunk=10,
)


@pytest.fixture(scope="module")
def cluster():
    with distributed.LocalCluster(
        n_workers=2,
        threads_per_worker=1,
        processes=True,
        host="127.0.0.1",
        dashboard_address=None,
        silence_logs="CRITICAL",
        env={"PYTHONHASHSEED": "7"},  # not that of this process
    ) as running:
        yield running


@pytest.fixture
def client(cluster):
    with connected(cluster.scheduler_address) as one:
        one.wait_for_workers(2, timeout=60)
        yield one


def identical(one, other):
    assert list(one.data_vars) == list(other.data_vars)
    for name in (*one.data_vars, *one.coords):
        assert_array_equal(one[name], other[name], err_msg=name)


def written(folder):
    """Every file of a finished sweep; its lock names the process."""
    paths = [path for path in folder.rglob("*") if path.is_file() and path.name != "lock"]
    return {path.relative_to(folder): path.read_bytes() for path in paths}


def processes(client):
    found = client.run(os.getpid)
    assert len(set(found.values()) | {os.getpid()}) == len(found) + 1
    return list(found.values())


def test_a_worker_killed_in_mid_run_leaves_no_trace(client, tmp_path):
    """Bit for bit the local run, to the last byte of its files; every block is written once."""
    told, killed = [], []

    def progress(done):
        told.append(done)
        if done >= 50 and not killed:
            killed.append(processes(client)[0])
            os.kill(killed[0], getattr(signal, "SIGKILL", signal.SIGTERM))

    there = tb.sweep(CONTACT, **ASKED, out=tmp_path / "there", client=client, progress=progress)
    here = tb.sweep(CONTACT, **ASKED, out=tmp_path / "here")
    identical(there, here)
    assert written(tmp_path / "there") == written(tmp_path / "here")
    assert killed
    assert told == list(range(10, 301, 10))
    assert killed[0] not in processes(client)


def test_in_memory_and_reduced_alike(client):
    reduce = {"mean": True, "extrema": True, "quantiles": [0.5], "exceed": {"A_t": 1e-3}}
    identical(tb.sweep(CONTACT, **ASKED, client=client), tb.sweep(CONTACT, **ASKED))
    identical(
        tb.sweep(CONTACT, **ASKED, reduce=reduce, client=client),
        tb.sweep(CONTACT, **ASKED, reduce=reduce),
    )


def test_stopped_here_goes_on_there(client, tmp_path):
    def stop(done):
        if done >= 100:
            raise KeyboardInterrupt

    asked = ASKED | {"out": tmp_path}
    with pytest.raises(KeyboardInterrupt):
        tb.sweep(CONTACT, **asked, client=client, progress=stop)
    told = []
    found = tb.sweep(CONTACT, **asked, progress=told.append)
    assert told[0] == 110
    codes = ["mode", "status"]
    identical(found.drop_vars(codes), tb.sweep(CONTACT, **ASKED).drop_vars(codes))


def test_a_mistake_comes_back_as_itself(client):
    """Some of the diameters are too large for so many particles."""
    wide = CONTACT.replace(**{"particles.areal_density": 1e12})
    sizes = np.geomspace(1e-7, 2e-6, 5000)
    with pytest.raises(tb.InvalidValue, match="jammed"):
        tb.sweep(wide, F_star=1e-5, vary={"particles.diameter.mean": sizes}, client=client)


def test_command(cluster, tmp_path):
    def run(*arguments):
        return CliRunner().invoke(app, ["sweep", str(EXAMPLE), "--out", str(tmp_path), *arguments])

    done = run("--scheduler", cluster.scheduler_address, "--set", "sweep.chunk=64")
    assert done.exit_code == 0, done.stderr
    assert "192 states" in done.stderr
    assert "nothing to do" in run("--set", "sweep.chunk=64").stderr


def test_nobody_there(tmp_path):
    with pytest.raises(tb.InvalidValue, match=r"no Dask scheduler answers at tcp://127\.0\.0\.1:9"):
        connected("tcp://127.0.0.1:9", timeout=1)


def test_missing_package_has_one_message(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(tb.InvalidValue, match=r"pip install 'thirdbody\[cluster\]'"):
        connected("tcp://127.0.0.1:8786")
