"""Advice in the words of study files, where the library gives it in those of Python."""

from __future__ import annotations

import re

__all__ = ["in_study_words"]

BODIES = {
    "surface 1": "surfaces.first",
    "surface 2": "surfaces.second",
    "the particles": "particles.material",
}
_MATERIAL = re.compile(
    r"needs (?P<key>\w+) of (?P<body>surface 1|surface 2|the particles.*?)(?P<named> \(.*?\))?; "
    r"give it with the material, e\.g\. material\.replace\((?P=key)=\.\.\.\)"
)
SERIES, FLAKES = 'particle_law.name = "series"', 'particle_law.name = "flakes"'
ADVICE = {
    "Particles(..., strength=WeibullStrength.of(material))": 'particles.strength = "material"',
    "give WeibullStrength(sigma_0=..., x_0=..., m=...), or material.replace(K_c=...)": (
        'give particles.strength = { sigma_0 = "60 MPa", x_0 = "10 mm", m = 3 } with numbers of '
        "your own, or K_c with the numbers of the material"
    ),
    "give each its own, material.replace(density=...)": "give each its own, key density",
    'Series(seat="rough") in the place of': f'{SERIES}, seat = "rough", in the place of',
    "particle.Series(seat='plane')": '{ name = "series", seat = "plane" }',
    "use law='full stick'": 'use law = "full stick"',
    "must be Sphere() or Angular(roundness=..., angle=...)": (
        'must be "sphere" or "angular", or a table: { name = "angular", roundness = 0.1, '
        'angle = "60 deg" }'
    ),
    "particle.Series or particle.Flakes": f"{SERIES} or {FLAKES}",
    "particle.Series": SERIES,
    "e.g. Hermite()": 'e.g. "hermite"',
    "give outputs, e.g. outputs.Counts()": "give tables, e.g. [outputs.counts]",
    "; progress=True shows how far they are": "",
    "(--force, in Python force=True)": "(--force)",
    "cutoff=0 presses": "roughness.cutoff = 0 presses",
    "give columns=... when the table is made": "this command makes tables without shares",
}
"""Words of a sentence of the library, and what stands for them in a study file."""


def in_study_words(sentence: str) -> str:
    """A sentence of the library as a reader of a study file or of the command line acts on it.

    Parameters
    ----------
    sentence : str

    Returns
    -------
    str
        The same where it names no call of Python.

    Examples
    --------
    >>> in_study_words("Particles.shape: use particle.Series, or remove shape")
    'Particles.shape: use particle_law.name = "series", or remove shape'
    >>> in_study_words("outputs.wear needs density of surface 2; give it with the material, "
    ...                "e.g. material.replace(density=...)").partition(": ")[2]
    'surfaces.second = { E = ..., nu = ..., H = ..., density = ... }'
    """
    sentence = _MATERIAL.sub(_key_of_material, sentence)
    for python, study in ADVICE.items():
        sentence = sentence.replace(python, study)
    return sentence


def _key_of_material(found: re.Match[str]) -> str:
    """Which key of the study holds the property of the material."""
    place = BODIES.get(found["body"], "material")
    which = f"{found['body']}{found['named'] or ''}"
    return (
        f"needs {found['key']} of {which}: {place} = "
        f"{{ E = ..., nu = ..., H = ..., {found['key']} = ... }}"
    )
