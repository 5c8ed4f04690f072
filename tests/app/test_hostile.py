"""Links made to do harm: texts that are script, and studies that are too large."""

import ast
import copy
import json
from pathlib import Path

import pytest

pytest.importorskip("nicegui", reason="the page needs the extra thirdbody[app]")

from nicegui import Client
from nicegui.page import page as place

import thirdbody.app
from thirdbody.app.examples import example
from thirdbody.app.figures import plain
from thirdbody.app.inputs import Inputs
from thirdbody.app.state import State
from thirdbody.app.widgets import facts

PAYLOADS = [
    'A" innerHTML="<img src=x onerror=window.__hit=1>',
    "A' :innerHTML='window.__hit=1",
    "<img src=x onerror=window.__hit=1>",
    "</script><script>window.__hit=1</script>",
    '<a href="javascript:window.__hit=1">here</a>',
    "{{ constructor.constructor('window.__hit=1')() }}",
    "`${window.__hit=1}`\\",
    "```\n<svg onload=window.__hit=1>\n%{meta}",
]


def test_no_attribute_is_put_together_as_text():
    """A value inside the string that `props` parses could end there and begin another."""
    found = []
    for file in sorted(Path(thirdbody.app.__file__).parent.rglob("*.py")):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            named = isinstance(node, ast.Call) and getattr(node.func, "attr", "") in (
                "props", "style", "classes", "add_head_html", "add_body_html", "run_javascript",
            )  # fmt: skip
            if named and any(isinstance(part, ast.JoinedStr) for part in node.args):
                values = [v for part in node.args for v in ast.walk(part)
                          if isinstance(v, ast.Name)]  # fmt: skip
                found.append((file.name, node.lineno, node.func.attr, [v.id for v in values]))
    # the swatches of the legend, by their colours
    assert [each for each in found if each[0::2] != ("interface.py", "style")] == []


@pytest.mark.parametrize("payload", PAYLOADS)
def test_a_text_stays_one_attribute(payload):
    with Client(place("/test"), request=None) as client:
        facts([(payload, payload)], "film: ")
        (made,) = [e for e in client.elements.values() if "data-fact" in e.props]
    assert made.props["data-fact"] == f"film: {payload}"
    assert not {"innerHTML", ":innerHTML"} & set(made.props)


def hostile(payload):
    """A study with this text wherever a study can hold one."""
    study = copy.deepcopy(example())
    dust = study["particles"]
    own = {"name": payload, "E": "200 GPa", "nu": 0.3, "H": "5 GPa"}
    study["title"] = payload
    study["surfaces"]["second"] = own
    study["particles"] = [
        dust | {"name": payload, "material": own},
        dust | {"name": f"{payload} 2", "areal_density": "2e10 / m^2"},
    ]
    study["outputs"] = {"counts": {}, "friction": {"m_ss": 0.2, "m_sa": 0.3}}
    study["uncertainty"] = {"inputs": {"roughness.sigma": {"low": "95 nm", "high": "105 nm"}}}
    return study


def wrong(payload):
    """Studies that are refused, with this text where a word, a name or a key is expected."""
    base = hostile(payload)
    for *where, last in (
        ("surfaces", "first"), ("asperity_law", "name"), ("particle_law", "name"),
        ("particles", 0, "distribution"), ("particles", 0, "iso4406"), ("particles", 0, "sizes"),
        ("particles", 0, "mean"), ("particles", 0, payload), ("materials",), (payload,),
        ("roughness", "topography"), ("roughness", "heights"), ("roughness", "sigma"),
        ("load", "F_star"), ("outputs", payload), ("uncertainty", "inputs", payload),
        ("sweep",), ("design",), ("film",), ("film", "load"),
    ):  # fmt: skip
        study = copy.deepcopy(base)
        table = study
        for step in where:
            table = table[step] if isinstance(table, list) else table.setdefault(step, {})
        table[last] = payload
        yield ".".join(map(str, (*where, last))), study


@pytest.mark.parametrize("payload", PAYLOADS[:2])
def test_fields_take_any_text_as_text(payload, tmp_path):
    allowed = {"hint", "aria-label", "data-path", "label", "value", "model-value", "options",
               "error-message", "placeholder", "modelValue"}  # fmt: skip
    for name, study in [("all", hostile(payload)), *wrong(payload)]:
        with Client(place("/test"), request=None) as client:
            inputs = Inputs(State(study, tmp_path), lambda: None)
            for part in ("surfaces", "roughness", "asperity_law", "particles", "load"):
                getattr(inputs, part)()
            inputs.uncertain()
            inputs.tell()
            for element in client.elements.values():
                holds = {k for k, v in element.props.items() if "__hit" in json.dumps(v)}
                assert holds <= allowed, (name, holds)
                assert not any(key.startswith(":") for key in holds)
                assert "innerHTML" not in element.props


def test_names_in_figures_are_no_markup():
    assert plain("<a href='x'>y</a> %{meta}") == "&lt;a href='x'&gt;y&lt;/a&gt; %&#123;meta}"
