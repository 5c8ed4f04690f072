"""
Film thickness against load
===========================

Central film of a steel ball on a steel flat. Stiff, piezoviscous contacts hardly feel the load; at
small loads the bodies no longer flatten, and only the formula for every regime knows that.
"""

import numpy as np
from matplotlib.figure import Figure

import thirdbody as tb

films = {
    "every regime, exponent by EI/RI": tb.films.NijenbanningVennerMoes(),
    "every regime, exponent by EI/EP": tb.films.NijenbanningVennerMoes(blend="EI/EP"),
    "Hamrock and Dowson": tb.films.HamrockDowson(),
}
load = np.geomspace(0.1, 1e3, 200)  # N
ball = {"eta": 0.04, "alpha": 2e-8, "R": 0.0127, "E": 226.37e9}  # Pa s, 1/Pa, m, Pa


def central(film, load):
    return film.central(load=load, speed=1.0, **ball)


figure = Figure(figsize=(5.4, 3.6), layout="constrained")
ax = figure.add_subplot()
for (label, film), style in zip(films.items(), ("-", "--", ":"), strict=True):
    ax.loglog(load, central(film, load) * 1e9, style, label=label)
ax.set(
    xlabel="load [N]",
    ylabel="central film thickness [nm]",
    xlim=(load[0], load[-1]),
    ylim=(200, 1000),
)
ax.set_yticks([200, 300, 500, 1000], ["200", "300", "500", "1000"])
ax.minorticks_off()
ax.legend(frameon=False)

# %%
# At 50 N the formulas lie within the range that their authors leave open.
found = [float(central(film, 50.0)) * 1e9 for film in films.values()]
print(*(f"{h:.0f} nm" for h in found), "at 50 N and 1 m/s")
assert abs(found[0] - 307.0) < 0.1
