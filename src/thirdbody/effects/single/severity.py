r"""Severity of a contact with particles, and where rolling turns into grooving.

The empirical route beside the balance of moments: tests with a ball, a specimen and a slurry of
angular abrasive show grooves where the load per abrasive is high and rolling where it is low.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...quantities.carried import takes_units

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = ["severity", "threshold"]


@takes_units
def severity(load: ArrayLike, *, x: ArrayLike, H_1: ArrayLike, H_2: ArrayLike) -> Array:
    r"""Severity S of one particle between two surfaces.

    .. math:: S = \frac{6 f}{\pi x^2 H'}, \qquad \frac1{H'} = \frac1{H_1}+\frac1{H_2}

    Parameters
    ----------
    load : array_like
        Load of the particle f [N].
    x : array_like
        Its diameter [m].
    H_1, H_2 : array_like
        Hardness of the two contacts [Pa].

    Returns
    -------
    array
        S [1].

    Notes
    -----
    Severity of a whole contact is S = W/(A v H'), with the load W, the area A and the volume
    fraction v of abrasive. A layer of slurry one particle high holds η_a = 6 v/(πx²) of them
    per area, which gives the form above with f = W/(A η_a). Where every particle is as large as
    the gap is high, the two are the same number.

    References
    ----------
    Adachi, Hutchings 2003, Wear 255, 23, doi:10.1016/S0043-1648(03)00073-5 (recalled).

    Examples
    --------
    >>> from thirdbody.effects.single.severity import severity
    >>> f, x, H = 1e-3, 4e-6, 7e9
    >>> round(float(severity(f, x=x, H_1=H, H_2=H)), 6)
    0.034105
    """
    softness = 1 / np.asarray(H_1) + 1 / np.asarray(H_2)
    return 6 * np.asarray(load) * softness / (np.pi * np.asarray(x) ** 2)


@takes_units
def threshold(H_s: ArrayLike, *, H_b: ArrayLike) -> Array:
    r"""Severity S* above which particles groove; below it they roll.

    .. math:: S^* = 0.0076\,(H_s/H_b)^{-0.49}

    Parameters
    ----------
    H_s, H_b : array_like
        Hardness of the specimen and of the ball that presses the particles on it [Pa].

    Returns
    -------
    array
        S* [1].

    Notes
    -----
    Fit to micro-scale abrasion tests with angular abrasive. Constants from memory: not confirmed
    in a source.

    References
    ----------
    Adachi, Hutchings 2003, Wear 255, 23, doi:10.1016/S0043-1648(03)00073-5.

    Examples
    --------
    >>> from thirdbody.effects.single.severity import threshold
    >>> round(float(threshold(2e9, H_b=8e9)), 5)
    0.01499
    """
    return 0.0076 * (np.asarray(H_s) / np.asarray(H_b)) ** -0.49
