"""Which number of a state stands where: columns that NumPy fills and the kernel reads."""

from __future__ import annotations

GW, ZMC, HERMITE, CEB, KE, JG, DMT, JKR, COATED = range(9)
"""Laws of one contact; the last three of asperities alone."""
FIELD = 100
"""In the place of a law: the surface is one field of heights."""
SPHERE, SQUASHED, DEEP, FACED = range(4)
"""What a side of a particle is."""
ONE_SIZE, GAUSSIAN, LOGNORMAL, UNIFORM, POWER = range(5)
"""Kinds of sizes."""
GAUSSIAN_HEIGHTS, EXPONENTIAL, WEIBULL = range(3)
"""Kinds of heights of asperities."""
PLANE, ROUGH, PRINTED = range(3)
"""Where particles rest, or that their sum over sizes is one of closed formulas."""
FOOTPRINT, PROJECTED, COVERED, NOTHING = range(4)
"""What the shadow is."""

# ------------------------------------------------------------------ given, of a law
CODE, LAW_1, LAW_2, LAW_3, LAW_4 = range(5)

# ------------------------------------------------------------------ given, of the asperities
W, FORCE, AREA, SIGMA_S, SIGMA = range(5, 10)
"""ω_1/σ_s, the units of load [Pa] and area, σ_s and σ [m]."""
HEIGHTS, SHAPE, MIDDLE, SPREAD, LOWEST_HEIGHT, LAID_FROM, STEP, LAST = range(10, 18)
"""Kind of heights, shape, and mean and standard deviation of the plain variable; lower end; the
separation below which it shows in the nodes; width of a panel over t = ω/σ_s, and where t ends."""
START, FINEST = 18, 19
"""Reduced interference at which contact begins, and the width of the first panel from there, at
most."""
OF_ASPERITIES = 20
BENDS, STEPS, TOP, THIN, REST = range(5)
"""Of a coating's table: β of ln(1 + β√y), pieces per unit of it, the last √y, its limit, and four
numbers of what follows; the pieces are the next rows, powers of load and area side by side."""
COATING_TERMS = 8

# ------------------------------------------------------------------ given, of one field of heights
CHI, ABOVE_FIELD, WIDER, IS_SOFT, OF_TABLE = range(OF_ASPERITIES, OF_ASPERITIES + 5)
"""In more columns: H/(E*g), the remainder ε of high separations, what it adds to the pressure, and
whether the table goes down to low separations."""
HEIGHTS_OF_TABLE, COLUMNS_OF_TABLE = 30, 3
"""At separations of the table: ln Φ over that of the plastic surface, s_0 − h, and the part of the
area that is pressed with H."""
OF_FIELD = OF_TABLE + HEIGHTS_OF_TABLE * COLUMNS_OF_TABLE

# ------------------------------------------------------------------ given, of a side
FORM, DELTA_1, UNIT, FULL, TIP, HILL, HARDER, TAKEN = range(5, 13)
"""Kind, first yield over x, unit of load [Pa], reduced area of the great circle or of the disc,
tip radius over x, friction hill, hardness of the surface over H, and the part of a deep squeeze
that the particle takes."""
TABLE_TERMS = 20
TABLE_LOAD = 13
TABLE_AREA = TABLE_LOAD + TABLE_TERMS
"""Series of ln of load and of area of a side by the table of deep squeezes."""
OF_SIDE = TABLE_AREA + TABLE_TERMS
FACE_AREA, FACE_TAN, JOINT, FACE_PRESSURE, FACE_START, FACE_RATE = range(TABLE_LOAD, TABLE_LOAD + 6)
"""Of an angular side instead: reduced area where its faces begin and tan β; once a state the
reduced indentation there, their pressure over H, and the root of their reduced area and its slope.
"""
# found once a state
CAP, WIDE, END, PLATEAU, LIMIT, COUNT, KINKS = range(OF_SIDE, OF_SIDE + 7)
"""Reduced indentation at the cap; where it is as wide as the sphere; where it sinks in; whether
it goes on; the most load; how many kinks, and where they begin [x]."""
MOST_KINKS = 40
MOST_JUMPS = 4
JUMPS = KINKS + MOST_KINKS
"""How many jumps its load has, and of each where [x] and the loads before and behind it."""
LOADS = JUMPS + 1 + 3 * MOST_JUMPS
"""Load at each kink, between two different sides."""
SIDE = LOADS + MOST_KINKS

# ------------------------------------------------------------------ given, of particles
SEAT, SHADOW, EQUAL, KIND, SIZE_1, SIZE_2, NORM, LOW, HIGH = range(9)
"""Where they rest, what their shadow is, whether both sides are alike, kind of sizes, their two
numbers (centre and width; of one size the size), factor of the density, ends of the support [m]."""
DENSITY, OFFSET, WIDTH, BREADTH, COVERAGE = range(9, 14)
"""Number per area, gap − d [m], width of the seat [m], projected area over πx²/4 and the nominal
area."""
STIFFEST, SOFTEST = 14, 15
"""Least E* and least H of both sides [Pa]."""
BEYOND, TAKES, BEARS, WINDOW, FIXED, ABOVE, SHADES, DARK, SPLIT = range(16, 25)
"""Of printed sums: h_e [m], area over Σ, pressure [Pa], C, x_a [m] where it stands for x, weight
of the second integral, shadow over it and where that begins, and whether areas are split."""
NEVER, AS_FIRST, BY_APPROACH = range(3)
"""What the second integral weighs: nothing, what the first does, x(x − d)."""
BREAKS, LN_STRENGTH, MODULUS, EXPONENT, UNBROKEN, KEPT, RATIO, LEAST = range(25, 33)
"""Of particles that break, if they do: ln of the strength of a size of 1 m, Weibull modulus and
exponent of the size, size from which down nothing breaks [m], part of the volume that stays, size
of pieces over that of their parent; once a state the smallest size [m]."""
OF_PARTICLES = 33

# ------------------------------------------------------------------ found, of a state
COLUMNS = ("F", "A_e", "A_ep", "A_p", "F_sa", "A_sa_e", "A_sa_ep", "A_sa_p", "A_sa2", "shadow")
"""Of the asperities alone; of the particles."""
F_SS, A_E, F_SA, A_SA, A_SA2, SHADE = 0, 1, 4, 5, 8, 9

# ------------------------------------------------------------------ what became of a state
OK, TOO_MUCH, TOO_LITTLE, UNSOLVED = range(4)
TOO_DEEP = 5
NOT_MONOTONE, NOT_RESOLVED, TOO_LONG, SQUEEZED, NO_TABLE = range(10, 15)
"""For another engine: the load may rise, the error is not small enough, too many nodes, particles
that are squeezed by more than their size, bandwidths that no table holds."""
FAR = 0.1
"""Errors of a separation are over σ, or over so much of itself where that is more."""

# ------------------------------------------------------------------ the rules of a level
NODES, SPAN, SIZE_NODES, SIZE_SPAN, SEAT_NODES, SEAT_SPAN = range(6)
PANEL_NODES, PANEL_SPAN, PLANE_SPAN, NARROW_NODES, HALF_NODES, ALL_KINKS = range(6, 12)
RULE, SIZE_RULE, NARROW_RULE, PANEL_RULE, HALF_RULE, POLYNOMIAL = 1, 3, 5, 7, 9, 11
"""Rows of Gauss nodes, each before one of weights, and of Chebyshev nodes before their series."""
ASKED, ENOUGH = range(2)
"""In the first row of the last of the rules: error of loads, areas and the separation that is asked
for, and with which a state is solved where the finest nodes do not reach that, or there is no room
for finer ones."""
