"""
Stribeck curve in clean and dirty oil
=====================================

A film, asperities and particles share the load of a ball. Wear debris as large as the film of a
fast contact keeps on carrying where asperities have long come apart.
"""

import warnings

import numpy as np
from matplotlib.figure import Figure

import thirdbody as tb

warnings.simplefilter("ignore", tb.errors.RangeWarning)  # the slow end is below the roughness

steel = tb.materials["S45C"]
clean = tb.Contact(
    surfaces=tb.MaterialPair(steel, steel),
    roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),  # m
    outputs=tb.outputs.Friction(tau_ss=400e6, tau_sa=400e6),  # Pa
)
debris = tb.Particles(
    material=steel, areal_density=3e10, diameter=tb.TruncatedGaussian(mean=500e-9, std=100e-9)
)
ball = tb.films.Point(R=9.5e-3)  # m
oil = tb.films.Oil(eta=0.02, alpha=2e-8, eyring_stress=5e6)  # Pa s, 1/Pa, Pa
speed = np.geomspace(5e-3, 10, 80)  # m/s
curves = {
    label: tb.films.stribeck(
        contact, conjunction=ball, oil=oil, load=20.0, speed=speed, slide_roll=0.05
    )
    for label, contact in (("clean", clean), ("dirty", clean.replace(particles=debris)))
}
figure = Figure(figsize=(5.4, 4.8), layout="constrained")
traction, share = figure.subplots(2, 1, sharex=True)
for (label, curve), style in zip(curves.items(), ("-", "--"), strict=True):
    traction.semilogx(speed, curve.mu, style, label=label)
    share.semilogx(speed, curve.ss_share + curve.sa_share, style)
traction.set(ylabel=r"traction coefficient $\mu$ [1]", ylim=(0, None))
traction.legend(frameon=False)
share.set(xlabel="entrainment speed [m/s]", ylabel="load on solids [1]", xlim=(5e-3, 10))
share.set(yscale="log", ylim=(1e-4, 1.5))

# %%
# The shares of film, asperities and particles make one, at every speed.
whole = sum(curves["dirty"][name] for name in ("film_share", "ss_share", "sa_share"))
lowest = {label: float(curve.mu.min()) for label, curve in curves.items()}
print(f"least friction {lowest['clean']:.4f} in clean oil, {lowest['dirty']:.4f} in dirty oil")
assert np.allclose(whole, 1, atol=1e-9)
assert abs(lowest["clean"] - 0.0240) < 2e-4
