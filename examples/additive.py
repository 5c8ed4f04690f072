"""
Silica as an oil additive: which size, and how much
===================================================

**In short**: one size and one amount lower friction most. There is no margin above that amount.

Ground steel slides on ground steel at 1 to 10 MPa. A silica powder goes into the oil, at most 0.7 %
by weight. Rolling particles lower friction, and the more of them roll the more area is plastic.
What is ordered from the supplier?
"""

import sys
import warnings
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import thirdbody as tb
from thirdbody.study import load_study
from thirdbody.study.analyses import arguments, design_study

warnings.simplefilter("ignore", tb.errors.RangeWarning)  # the clean surfaces at small loads

study = load_study(
    Path(__file__).with_suffix(".toml") if "__file__" in globals() else "additive.toml"
)
best = design_study(study)
size, weight = best.values.values()
(friction,) = best.objectives.values()

# %%
# The map behind the answer: friction, and where too much of the real area is plastic.
asked = arguments(study)
pressure, fluid = asked["pressure"], asked["suspension"]
sizes, weights = np.geomspace(50e-9, 1e-6, 20), np.geomspace(5e-4, 12e-3, 18)


def states(diameter, concentration):
    """Mean friction and largest plastic share over the loads, for sizes and amounts."""
    dust = study.contact.particles.replace(areal_density=1.0)
    every_size = (dust.diameter.replace(mean=x, std=0.1 * x) for x in diameter)
    density = [
        fluid.areal_density(dust.replace(diameter=size), concentration=c)
        for size, c in zip(every_size, concentration, strict=True)
    ]
    vary = {
        "particles.diameter.mean": diameter,
        "particles.diameter.std": 0.1 * diameter,
        "particles.areal_density": np.array(density),
    }
    every = [tb.equilibria.solve_states(study.contact, pressure=p, vary=vary) for p in pressure]
    plastic = [state["A_p"] / state["A_t"] for state in every]
    return np.mean([state["mu"] for state in every], axis=0), np.max(plastic, axis=0)


x, c = np.meshgrid(sizes, weights)
mu, plastic = (values.reshape(x.shape) for values in states(x.ravel(), c.ravel()))
clean = tb.solve(study.contact.replace(particles=None), pressure=pressure).outputs["mu"].mean()

# %%
figure = Figure(figsize=(5.6, 3.8), layout="constrained")
ax = figure.add_subplot()
drawn = ax.contourf(x * 1e9, c * 100, mu, levels=15, cmap="viridis")
figure.colorbar(drawn, label="mean coefficient of friction")
ax.contour(x * 1e9, c * 100, mu, levels=[clean], colors="w", linestyles="--")
limit = study.design["limits"][0].most
ax.contourf(x * 1e9, c * 100, plastic, levels=[limit, 1], colors="none", hatches=["///"])
ax.axhline(0.7, color="r", lw=1)
ax.annotate(
    "at most 0.7 %", (53, 0.7), xytext=(0, 3), textcoords="offset points", color="r",
    bbox={"fc": "w", "ec": "none", "pad": 1},
)  # fmt: skip
ax.plot(size * 1e9, weight * 100, "r*", ms=13)
ax.set(
    xscale="log",
    yscale="log",
    xticks=[50, 100, 200, 500, 1000],
    yticks=[0.05, 0.1, 0.2, 0.5, 1],
    xlabel="particle diameter [nm]",
    ylabel="silica in the oil [wt %]",
    title=f"dashed: as without powder; hatched: plastic share above {limit:g}",
)
ax.title.set_size("small")
for axis in (ax.xaxis, ax.yaxis):
    axis.set_major_formatter("{x:g}")
    axis.set_minor_formatter("")
if __name__ == "__main__":
    figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "additive.png", dpi=150)

# %%
# How much of that is luck? A third of the powder, and a little more of it.
(low, high), _ = best.tolerance.values()
(thin, _), (_, too_plastic) = states(np.array([size, size]), np.array([weight / 3, 1.05 * weight]))
assert abs(friction - 0.1099) < 1e-4
assert "plastic_share" in best.active[0]
assert limit < too_plastic
assert friction < thin < clean
print(
    f"Order silica of {low * 1e9:.0f} to {high * 1e9:.0f} nm and put in {weight:.2%} by weight: "
    f"friction falls from {clean:.3f} to {friction:.3f}. There is no margin: with 5 % more powder "
    f"{too_plastic:.2f} of the area is plastic at 1 MPa ({limit:g} allowed), with a third of it "
    f"friction is {thin:.3f}; and surfaces that rub below {friction:.2f} anyway gain nothing."
)
