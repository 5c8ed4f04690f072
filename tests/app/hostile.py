"""Studies with script in their texts."""

import copy
import itertools

from thirdbody.app.examples import example

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


def places(payload):
    """Where a word, a name or a key is expected, in parts that leave each other's mistakes be."""
    return [
        [
            ("surfaces", "first"), ("asperity_law", "name"), ("particle_law", "name"),
            ("particles", 0, "distribution"), ("particles", 0, "mean"), (payload,),
            ("roughness", "heights"), ("roughness", "sigma"), ("load", "F_star"),
            ("outputs", payload), ("sweep",), ("design",), ("film",), ("particles", 0, "strength"),
            ("body",), ("explicit",), ("roughness", payload),
        ],
        [
            ("particles", 0, "iso4406"), ("particles", 0, payload), ("film", "load"),
            ("uncertainty", "inputs", payload), ("particles", 0, "level"), ("explicit", payload),
            ("roughness", "Ra"),
        ],
        [("particles", 0, "sizes"), ("materials",), ("roughness", "topography")],
        [("particles", 0, "as4059"), ("body", payload), ("roughness", "process")],
        [("particles", 0, "nas1638")],
        [("particles", 0, "test_dust")],
    ]  # fmt: skip


def wrong_at(payload, *there):
    """A study with this text at each of these places."""
    study = hostile(payload)
    for *where, last in there:
        table = study
        for step in where:
            table = table[step] if isinstance(table, list) else table.setdefault(step, {})
        table[last] = payload
    return study


def wrong(payload):
    """Studies that are refused, each with one text of the wrong kind, and its place."""
    for place in itertools.chain(*places(payload)):
        yield ".".join(map(str, place)), wrong_at(payload, place)


def several():
    """A study with a population for every payload."""
    study = hostile(PAYLOADS[0])
    dust = study["particles"][0]
    study["particles"] = [
        dust
        | {"name": f"{n} {text}", "areal_density": "1e10 / m^2"}
        | {"material": dust["material"] | {"name": text}}
        for n, text in enumerate(PAYLOADS)
    ]
    study["title"] = " ".join(PAYLOADS)
    study["load"] = {"F_star": study["load"]["F_star"] | {"points": 12}}
    return study
