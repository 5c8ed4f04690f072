"""Studies with script in their texts."""

import copy

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
        ("particles", 0, "as4059"), ("particles", 0, "nas1638"), ("particles", 0, "test_dust"),
        ("particles", 0, "level"), ("particles", 0, "strength"), ("body",), ("body", payload),
        ("explicit",), ("explicit", payload), ("roughness", "Ra"), ("roughness", "process"),
        ("roughness", payload),
    ):  # fmt: skip
        study = copy.deepcopy(base)
        table = study
        for step in where:
            table = table[step] if isinstance(table, list) else table.setdefault(step, {})
        table[last] = payload
        yield ".".join(map(str, (*where, last))), study


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
    return study
