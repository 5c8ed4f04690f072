"""Sweeps and explicit surfaces on a Dask cluster: a scheduler and worker processes on the loopback."""

import contextlib
import json
import os
import signal
import socket
import sys
import threading
import warnings
from pathlib import Path

import numpy as np
import pytest
from command_line import refused
from numpy.testing import assert_array_equal
from refusals import Mistake, refuses
from steel_and_dust import DUSTY as CONTACT
from typer.testing import CliRunner

import thirdbody as tb
from thirdbody.cli import app
from thirdbody.quantities.sharing import connect_client

distributed = pytest.importorskip(
    "distributed", reason="needs the extra: pip install 'thirdbody[cluster]'"
)
pytest.importorskip("zarr", reason="needs the extra: pip install 'thirdbody[sweep]'")

pytestmark = pytest.mark.check
EXAMPLE = Path(__file__).parents[2] / "examples" / "sweep.toml"
POINTS = EXAMPLE.with_name("explicit.toml")
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
    with connect_client(cluster.scheduler_address) as one:
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
    identical(found, tb.sweep(CONTACT, **ASKED))


def test_a_mistake_comes_back_as_itself(client):
    """Some of the diameters are too large for so many particles."""
    wide = CONTACT.replace(**{"particles.areal_density": 1e12})
    sizes = np.geomspace(1e-7, 2e-6, 5000)
    with pytest.raises(tb.errors.InvalidValue, match="jammed"):
        tb.sweep(wide, F_star=1e-5, vary={"particles.diameter.mean": sizes}, client=client)


def stamps(folder):
    """When each file was written, but the lock."""
    return {
        path: path.stat().st_mtime_ns
        for path in folder.rglob("*")
        if path.is_file() and path.name != "lock"
    }


def test_command(cluster, tmp_path):
    def run(*arguments):
        return CliRunner().invoke(app, ["sweep", str(EXAMPLE), "--out", str(tmp_path), *arguments])

    done = run("--scheduler", cluster.scheduler_address, "--set", "sweep.chunk=64")
    assert done.exit_code == 0, done.stderr
    assert "192 states" in done.stderr
    before = stamps(tmp_path)
    again = run("--set", "sweep.chunk=64")
    assert again.exit_code == 0, again.stderr
    assert stamps(tmp_path) == before  # nothing was left to do


def test_surfaces_survive_a_killed_worker(cluster, client, tmp_path):
    """Byte for byte the local run; a finished surface is kept before the next one comes."""
    asked = dict(surfaces=8, F_star=[3e-4, 2e-3], size=64, spacing=2e-7, seed=3)
    told, killed = [], []

    def progress(done):
        told.append((done, len(list((tmp_path / "there").glob("surface_*.json")))))
        if done == 2:
            killed.append(processes(client)[0])
            os.kill(killed[0], getattr(signal, "SIGKILL", signal.SIGTERM))

    def pressed(name, **how):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", tb.errors.RangeWarning)
            found = tb.explicit.ensemble(CONTACT, **asked, folder=tmp_path / name, **how)
        return json.dumps(found.to_dict()), json.dumps(found.states)

    address = cluster.scheduler_address
    there = pressed("there", scheduler=address, progress=progress)
    assert there == pressed("here")
    assert written(tmp_path / "there") == written(tmp_path / "here")
    assert told == [(done, done) for done in range(1, 9)]
    client.wait_for_workers(2, timeout=60)
    assert killed[0] not in processes(client)


def test_command_with_surfaces(cluster, tmp_path):
    def run(name, *arguments):
        small = ("--surfaces", "3", "--size", "64", "--spacing", "300 nm", "--json")
        out = ("--out", str(tmp_path / name))
        return CliRunner().invoke(app, ["explicit", str(POINTS), *small, *out, *arguments])

    there = run("there", "--scheduler", cluster.scheduler_address)
    assert there.exit_code == 0, there.stderr
    assert there.stdout == run("here").stdout
    surfaces = [written(tmp_path / name / "surfaces") for name in ("there", "here")]
    assert surfaces[0] == surfaces[1]
    assert len(surfaces[0]) == 3


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:9", "nowhere", "tcp://127.0.0.1:no", ""])
@pytest.mark.parametrize("command", ["sweep", "explicit"])
def test_a_bad_address_has_one_message(command, address, tmp_path, monkeypatch):
    monkeypatch.setattr("thirdbody.quantities.sharing.TIMEOUT", 1.0)
    study = {"sweep": EXAMPLE, "explicit": POINTS}[command]
    arguments = [command, str(study), "--out", str(tmp_path), "--scheduler", address]
    done = refused(*arguments)
    (line,) = (line for line in done.stderr.splitlines() if not line.startswith("warning: "))
    assert done.problems[0].code is Mistake.ABSENT
    assert address in line


def test_nobody_there(tmp_path):
    with refuses(Mistake.ABSENT, "", says="tcp://127.0.0.1:9"):
        connect_client("tcp://127.0.0.1:9", timeout=1)


@pytest.mark.parametrize("address", ["nowhere", "tcp://127.0.0.1:no", "foo://127.0.0.1:9", ""])
def test_no_client_is_made_for_what_is_no_address(address, monkeypatch):
    """It would end the process with a traceback of its own after the message."""
    made = []
    monkeypatch.setattr(distributed, "Client", lambda *_, **__: made.append(1))
    with refuses(Mistake.ABSENT, ""):
        connect_client(address)
    assert made == []


@pytest.mark.parametrize(
    ("answer", "timeout", "why"),
    [
        (b"", 1, "no answer within 1 s"),
        (b"HTTP/1.1 400 Bad Request\r\n\r\n", 60, "is no scheduler"),
    ],
    ids=["silent", "http"],
)
def test_who_listens_there_may_be_no_scheduler(answer, timeout, why):
    """A client would wait for it without an end, or ask for exbibytes."""
    with socket.create_server(("127.0.0.1", 0)) as server:

        def serve():
            with contextlib.suppress(OSError):
                while True:
                    one, _ = server.accept()
                    callers.append(one)
                    if answer:
                        one.recv(1000)
                        one.sendall(answer)

        callers = []
        threading.Thread(target=serve, daemon=True).start()
        with refuses(Mistake.ABSENT, "", says=why):
            connect_client(f"tcp://127.0.0.1:{server.getsockname()[1]}", timeout=timeout)
    for one in callers:
        one.close()


def test_missing_package_has_one_message(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with refuses(Mistake.ABSENT, "", says="'thirdbody[cluster]'"):
        connect_client("tcp://127.0.0.1:8786")
