"""
Fig. 12: separation under load
==============================

Particles of 500 nm hold the surfaces at about their diameter until asperities take over. Area
against separation (b) shows both curves joining.
"""

from thirdbody.papers.horng2022 import PANELS, READINGS, Curves
from thirdbody.papers.horng2022.drawing import draw

curves = Curves(READINGS["published"])
figures = [draw(PANELS[name](curves)) for name in ("12a", "12b")]

# %%
# d* of 500 nm silica where the paper ends contact by particles alone, F* = 7e-6; it reads 8.52.
curve = curves("SiO2", 100, 500)
separation = curve.value_at(7e-6, curve.d_star)
print(f"d* = {separation:.2f}")
assert abs(separation - 8.728) < 0.01
