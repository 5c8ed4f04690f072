"""
Which surface wears
===================

Silica between two steel surfaces, one of them softened. Between equal surfaces the spheres roll,
and wear is what breaks off their tracks. Where one surface is softer they sit in it and groove the
*harder* one: with an eighth of their load at the smallest difference, with nearly all of it at
three times the hardness.
"""

import warnings

import numpy as np
from matplotlib.figure import Figure

import thirdbody as tb

warnings.simplefilter("ignore", tb.errors.RangeWarning)  # some sit deeper than their radius

steel = tb.materials["S45C"]
contact = tb.Contact(
    surfaces=tb.MaterialPair(steel, steel),
    roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),  # m
    particles=tb.Particles(
        material=tb.materials["SiO2"],
        areal_density=1e11,  # 1/m²
        diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9),  # m
    ),
    outputs=(
        tb.outputs.Friction(tau_ss=580e6, tau_sa=200e6),  # Pa
        tb.outputs.Wear(K_ss=0.0, K_sa=0.0, f_ab=0.1, f_roll=0.001, renewal=1e6),
    ),
)
ratios = 1 + np.linspace(0.0, np.sqrt(2.0), 13) ** 2


def worn(ratio):
    soft = steel.replace(H=steel.H / ratio)
    pair = tb.MaterialPair(steel, soft)
    return tb.solve(contact.replace(surfaces=pair), pressure=5e6).outputs


found = [worn(ratio) for ratio in ratios]
hard, soft, rolling = (
    np.array([float(each[name]) for each in found])
    for name in ("wear_1", "wear_2", "rolling_share")
)
figure = Figure(figsize=(5.4, 4.6), layout="constrained")
wear, share = figure.subplots(2, 1, sharex=True, height_ratios=[2, 1])
wear.semilogy(ratios, hard, label="harder surface")
wear.semilogy(ratios, soft, "--", label="softer surface")
wear.set(ylabel="worn volume per area\nand sliding length [1]")
wear.legend(frameon=False)
share.plot(ratios, rolling, color="0.3")
share.set(
    xlabel="hardness of surface 1 over surface 2 [1]",
    ylabel="rolling share\nof the load [1]",
    xlim=(1, 3),
    ylim=(0, 1.05),
)

# %%
# Between equal surfaces both lose the same.
print(
    f"equal surfaces lose {hard[0]:.1e} and {soft[0]:.1e}; of unequal ones the harder loses "
    f"{hard[-1]:.1e}, the softer {soft[-1]:.1e}"
)
assert abs(hard[0] / soft[0] - 1) < 1e-9
