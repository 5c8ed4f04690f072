"""Studies that the page opens with."""

from __future__ import annotations

import tomllib

__all__ = ["EXAMPLES", "example"]

_STEEL = """
[surfaces]
first  = "S45C"
second = "S45C"

[roughness]
sigma = "{sigma}"
R     = "{R}"
"""

EXAMPLES = {
    "Dust in a ball-screw nut": """
title = "Dust in a ball-screw nut"

[surfaces]
first  = "S45C"
second = { E = "205 GPa", nu = 0.29, H = "5 GPa" }

[roughness]
sigma = "100 nm"
R     = "2.8 um"
alpha = 5.0
eta_R_sigma = 0.0455

[asperity_law]
name = "zmc"
k = 0.4

[particles]
material = "SiO2"
distribution = "truncated-gaussian"
mean = "300 nm"
std  = "24 nm"
n    = 3
areal_density = "1e11 / m^2"

[particle_law]
name = "series"
seat = "rough"

[load]
F_star = { from = 5e-7, to = 2.4e-4, points = 200, spacing = "log" }
""",
    "Nanoparticles as an oil additive": 'title = "50 nm silica nanoparticles in oil"\n'
    + _STEEL.format(sigma="100 nm", R="2.8 um")
    + """
[particles]
material = "SiO2"
distribution = "log-normal"
median = "50 nm"
gsd    = 1.3
areal_density = "2e12 / m^2"

[load]
pressure = { from = "0.05 MPa", to = "50 MPa", points = 200 }
""",
    "Oil of code 18/16/13": 'title = "Oil of code 18/16/13 between ground steel"\n'
    + _STEEL.format(sigma="400 nm", R="25 um")
    + """
[particles]
material = "S45C"
iso4406 = "18/16/13"
gap = "1 um"
level = "middle"

[load]
pressure = { from = "10 kPa", to = "100 MPa", points = 200 }
""",
    "Two surfaces without particles": 'title = "Two rough steel surfaces"\n'
    + _STEEL.format(sigma="100 nm", R="2.8 um")
    + """
[load]
pressure = { from = "0.1 MPa", to = "30 MPa", points = 200 }
""",
}
"""Study files by their title on the page; the first is the one it opens with."""


def example(name: str | None = None) -> dict[str, object]:
    """One of the studies, parsed."""
    return tomllib.loads(EXAMPLES[name or next(iter(EXAMPLES))])
