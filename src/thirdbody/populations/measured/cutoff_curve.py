"""Moments and asperities of a surface against the cut-off."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...quantities.arguments import names_arguments
from ...quantities.record import Column, TableRecord, Variable

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["COLUMNS", "Curve"]

COLUMNS: dict[str, Column] = {
    name: Column(symbol, unit, meaning)
    for name, symbol, unit, meaning in (
        ("cutoff", "λ_c", "m", "cut-off wavelength, of which the Gaussian filter passes one half"),
        ("m0", "m_0", "m^2", "mean square height"),
        ("m2", "m_2", "1", "mean square slope of profiles, by differences"),
        ("m4", "m_4", "1/m^2", "mean square second derivative of profiles, by differences"),
        ("sigma", "σ", "m", "RMS height"),
        ("rms_gradient", "g", "1", "RMS of the gradient"),
        ("alpha", "α", "1", "Nayak's bandwidth"),
        ("R", "R", "m", "mean asperity radius (Nayak, McCool)"),
        ("eta", "η", "1/m^2", "asperity density (Nayak, McCool)"),
        ("sigma_s", "σ_s", "m", "standard deviation of asperity heights (Nayak, McCool)"),
        ("y_s", "y_s", "m", "mean asperity height above the mean plane (Nayak, McCool)"),
        ("m0_spectrum", "m_0", "m^2", "mean square height, by the power spectrum"),
        ("m2_spectrum", "m_2", "1", "mean square slope of profiles, by the power spectrum"),
        ("m4_spectrum", "m_4", "1/m^2", "mean square second derivative, by the power spectrum"),
        ("summits", "N", "", "summits counted"),
        ("eta_counted", "η", "1/m^2", "density of summits counted"),
        ("R_counted", "R", "m", "one over the mean curvature of summits counted"),
        ("sigma_s_counted", "σ_s", "m", "standard deviation of heights of summits counted"),
        ("y_s_counted", "y_s", "m", "mean height of summits counted above the mean plane"),
        ("skewness", "", "1", "skewness of the surface heights"),
        ("kurtosis", "", "1", "kurtosis of the surface heights, 3 for a Gaussian"),
    )
}
"""Columns of a `Curve`: symbol, unit and meaning."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Curve(TableRecord):
    """Moments and asperities of one surface against the cut-off.

    As labelled data and as a table they lie along ``cutoff``.

    Parameters
    ----------
    columns : dict of array (N,)
        One array for every name in `COLUMNS`, in SI; NaN where there is none.

    Examples
    --------
    >>> import numpy as np
    >>> from thirdbody.populations.measured.topography import from_topography
    >>> curve = from_topography("example").curve()
    >>> bool(np.all(np.diff(curve["R"]) > 0))
    True
    """

    in_dict = (("", "columns"),)
    along = "cutoff"
    columns: dict[str, Array]

    def variables(self) -> dict[str, Variable]:
        """Every column but the cut-off."""
        return {
            name: Variable((self.along,), values, COLUMNS[name].labels)
            for name, values in self.columns.items()
            if name != self.along
        }

    def coordinates(self) -> dict[str, Variable]:
        """The cut-offs."""
        return {self.along: Variable((self.along,), self[self.along], COLUMNS[self.along].labels)}

    def __getitem__(self, name: str) -> Array:
        return self.columns[name]

    @names_arguments
    def per_octave(self, name: str) -> Array:
        """Relative change of a column when the cut-off doubles, at each cut-off.

        Examples
        --------
        >>> import numpy as np
        >>> from thirdbody.populations.measured.topography import from_topography
        >>> curve = from_topography("example").curve()
        >>> bool(np.all(curve.per_octave("R") > 0.1))
        True
        """
        octaves = np.log2(self["cutoff"])
        return np.exp(np.gradient(np.log(self[name]), octaves)) - 1
