"""The script a user would write without this library: scipy quad for the integrals, brentq for d.

ZMC asperities, symmetric series law with the smooth pressure, truncated Gaussian sizes, seat
`plane`. Integration limits are finite and split, with no absolute tolerance: the plainest call,
`quad(f, d, inf)` in metres, silently returns zero.
"""

import math

from scipy.integrate import quad
from scipy.optimize import brentq

E, NU, H = 205e9, 0.29, 5e9
E_A, NU_A = 68e9, 0.19
SIGMA, R, ETA_A = 100e-9, 2.8e-6, 1e11
X_A, S_A, CUT = 300e-9, 24e-9, 3.0
K, RHO = 0.4, 54.0

E_SS = E / (2 * (1 - NU**2))
E_SA = 1 / ((1 - NU**2) / E + (1 - NU_A**2) / E_A)
SIGMA_S = SIGMA * math.sqrt(1 - 0.8968 / 5)
ETA = 0.0455 / (R * SIGMA)
MASS = math.erf(CUT / math.sqrt(2))


def sphere(omega, radius, modulus, smooth):
    """Load and area of one contact."""
    w1 = (3 * math.pi * K * H / (4 * modulus)) ** 2 * radius
    if omega <= 0:
        return 0.0, 0.0
    if omega < w1:
        return 4 / 3 * modulus * math.sqrt(radius) * omega**1.5, math.pi * radius * omega
    if omega >= RHO * w1:
        area, p = 2 * math.pi * radius * omega, H
    else:
        s = (omega / w1 - 1) / (RHO - 1)
        u = math.log(omega / w1) / math.log(RHO)
        area = math.pi * radius * omega * (1 + 3 * s**2 - 2 * s**3)
        if smooth:
            m0 = 0.5 * K * math.log(RHO)
            p = K * (2 * u**3 - 3 * u**2 + 1) + m0 * (u**3 - 2 * u**2 + u) + 3 * u**2 - 2 * u**3
            p *= H
        else:
            p = H * (K + (1 - K) * u)
    return p * area, area


def particle(x, d):
    """Load and area of one particle between equal surfaces."""
    radius = x / 2
    load, area = sphere((x - d) / 2, radius, E_SA, smooth=True)
    if area > math.pi * radius**2:
        load, area = load / area * math.pi * radius**2, math.pi * radius**2
    return load, area


def integral(f, points):
    total = 0.0
    for a, b in zip(points[:-1], points[1:], strict=True):
        if b > a:
            total += quad(f, a, b, epsabs=0, epsrel=1e-10, limit=200)[0]
    return total


def total_load(d):
    w1 = (3 * math.pi * K * H / (4 * E_SS)) ** 2 * R
    h = d / SIGMA_S
    end = SIGMA_S * (math.sqrt(h * h + 76) - h)

    def asperity(omega):
        phi = math.exp(-0.5 * ((d + omega) / SIGMA_S) ** 2) / (math.sqrt(2 * math.pi) * SIGMA_S)
        return sphere(omega, R, E_SS, smooth=False)[0] * phi

    two_body = ETA * integral(asperity, [0, min(w1, end), min(RHO * w1, end), end])
    low, high = X_A - CUT * S_A, X_A + CUT * S_A
    if d >= high:
        return two_body
    c = 0.5 * (3 * math.pi * K * H / (4 * E_SA)) ** 2
    kinks = [d / (1 - 2 * c), d / (1 - 2 * RHO * c) if 2 * RHO * c < 1 else high, 2 * d]
    points = sorted(min(max(p, low, d), high) for p in [low, d, high, *kinks])

    def size(x):
        phi = math.exp(-0.5 * ((x - X_A) / S_A) ** 2) / (math.sqrt(2 * math.pi) * S_A * MASS)
        return phi

    load = ETA_A * integral(lambda x: particle(x, d)[0] * size(x), points)
    shadow = ETA_A * integral(lambda x: particle(x, d)[1] * size(x), points)
    return (1 - shadow) * two_body + load


def separation(F_star):
    """d that carries the load F_star."""
    target = math.log(F_star * E_SS)
    return brentq(lambda d: math.log(total_load(d)) - target, -2e-7, 8e-7, xtol=1e-18)
