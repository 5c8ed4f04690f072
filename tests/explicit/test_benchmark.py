"""The benchmark solves what it says, on a small scale; how fast, it measures itself."""

import importlib.util
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow
FILE = Path(__file__).parents[2] / "benchmarks" / "explicit.py"


def test_the_benchmark_solves_what_it_says():
    spec = importlib.util.spec_from_file_location("explicit_benchmark", FILE)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # a class with types looks itself up
    spec.loader.exec_module(module)
    rows = module.rows(128)
    assert len(rows) == 7
    assert all(row.certificate < module.TOL for row in rows)
    # the convolutions that are promised up to 15 % contact
    assert all(row.convolutions <= 40 for row in rows if row.area < 0.15)
    areas = [row.area for row in rows if row.what.endswith("elastic")]
    assert areas == sorted(areas)
