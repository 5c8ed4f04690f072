"""
One interface under every law
=============================

What the choice of the asperity law is worth for clean rough steel: mean real pressure, area,
separation, and what each law believes of the regimes.
"""

import warnings

import numpy as np

import thirdbody as tb
from thirdbody.views.comparison import figure as draw

warnings.simplefilter("ignore", tb.errors.RangeWarning)  # gw says that it is out of its range
steel = tb.materials["S45C"]
contact = tb.Contact(
    surfaces=tb.MaterialPair(steel, steel), roughness=tb.Roughness(sigma=100e-9, R=2.8e-6)
)
table = tb.compare(contact, F_star=np.geomspace(1e-6, 1e-3, 25), laws=["gw", "ceb", "ke", "jg"])
figure = draw(table)

# %%
# The elastic law against the contact's own, ZMC, at F* = 1e-5.
area = {
    name: float(
        tb.solve(contact.replace(asperity_law=tb.asperity.REGISTRY[name]()), F_star=1e-5).A_t
    )
    for name in ("gw", "zmc")
}
difference = area["gw"] / area["zmc"] - 1
print(f"gw: {difference:+.0%} of area; it knows no yield and is out here")
assert abs(difference + 0.4045) < 1e-3
