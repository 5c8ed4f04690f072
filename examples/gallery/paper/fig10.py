"""
Fig. 10: elastic, elastoplastic, plastic
========================================

The area of Eqs. 11 to 13 by regime, over the total. Without particles at most a fifth of it is
elastic, which the paper says too; that needs R = 11.1 µm.
"""

from thirdbody.papers.horng2022 import PANELS, READINGS, Curves
from thirdbody.papers.horng2022.drawing import draw

curves = Curves(READINGS["published"])
figures = [draw(PANELS[name](curves)) for name in ("10a", "10b", "10c")]

# %%
# The largest elastic share without particles.
elastic = float(curves.two_body(100).share("e").max())
print(f"elastic: at most {elastic:.1%}")
assert abs(elastic - 0.1927) < 1e-3
