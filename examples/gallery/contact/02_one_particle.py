"""
One particle between two surfaces
=================================

A sphere is squeezed between two flats. Small squeezes are elastic, large ones plastic. A silica
sphere 1.5 times as hard as the steel is squashed at large ones, to a cake that carries more and
more; the same sphere, were it rigid, would be embedded and carry no more than the hardness of the
steel on its great circle.
"""

from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure

import thirdbody as tb

steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
x = 300e-9  # m
contact = tb.Contact(
    surfaces=tb.MaterialPair(steel, steel),
    roughness=tb.Roughness(sigma=1e-9, R=2.8e-6),  # nearly smooth: the gap is d
    particles=tb.Particles(
        material=silica, diameter=tb.distributions.Monodisperse(mean=x), areal_density=1e11
    ),
    particle_law=tb.particle.Series(seat="plane"),
)
squeeze = np.geomspace(1e-4, 0.9, 200) * x


def load_of_one(law):
    state = tb.solve(replace(contact, particle_law=law), d=x - squeeze)
    return np.asarray(state.F_sa_star) * contact.E_ss / 1e11  # N


force = load_of_one(contact.particle_law)
rigid = load_of_one(tb.particle.Series(seat="plane", deep="off"))

E_sa = tb.MaterialPair(steel, silica).E_star
elastic = 4 / 3 * E_sa * np.sqrt(x / 2) * (squeeze / 2) ** 1.5
plastic = np.pi / 2 * steel.H * x * squeeze
embedded = np.pi / 4 * steel.H * x**2

figure = Figure(figsize=(5.2, 3.6), layout="constrained")
ax = figure.add_subplot()
ax.loglog(squeeze / x, force * 1e6, linewidth=2.5, label="silica")
ax.loglog(squeeze / x, rigid * 1e6, "-.", linewidth=1, label='kept round, deep = "off"')
ax.loglog(squeeze / x, elastic * 1e6, "--", label="elastic limit")
ax.loglog(squeeze / x, plastic * 1e6, ":", label="fully plastic limit")
ax.axhline(embedded * 1e6, color="0.5", linewidth=1, label="embedded")
ax.set(xlabel="squeeze δ over diameter [1]", ylabel="load of one particle [µN]")
ax.set_ylim(1e-4, 2e3)
ax.legend(frameon=False)

# %%
# At the smallest squeeze the particle is elastic; at nine tenths of its diameter a round one is
# embedded, and silica carries twice as much.
print(f"{force[0] / elastic[0]:.6f} of the elastic, {force[-1] / embedded:.3f} of the embedded")
assert abs(force[0] / elastic[0] - 1) < 1e-6
assert abs(rigid[-1] / embedded - 1) < 1e-6
assert abs(force[-1] / embedded - 2.106) < 2e-3
