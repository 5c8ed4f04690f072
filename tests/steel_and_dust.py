"""The interface that most tests ask: rough steel on steel, bare, or with quartz dust between."""

import thirdbody as tb

STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]
TWO_BODY = tb.Contact(
    surfaces=tb.MaterialPair(STEEL, STEEL), roughness=tb.Roughness(sigma=100e-9, R=2.8e-6)
)
DUSTY = TWO_BODY.replace(
    particles=tb.Particles(
        material=SILICA,
        areal_density=1e11,
        diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9),
    ),
    # the law whose numbers tests hold; that of the table has tests of its own
    particle_law=tb.particle.Series(deep="off"),
)
