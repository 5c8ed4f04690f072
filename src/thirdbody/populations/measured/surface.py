r"""Measured surfaces: spectral moments, asperities and what they owe to the cut-off.

.. math:: m_0 = \langle h^2\rangle, \qquad m_2 = \tfrac12\langle|\nabla h|^2\rangle, \qquad
          m_4 = \tfrac38\langle(\nabla^2 h)^2\rangle

m2 and m4 belong to a surface *and* to the shortest wave it is allowed to have: every answer here
names its cut-off, and tells how far it moves when the cut-off doubles.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np

from ...errors import InvalidValue, Mistake, Note, Problem
from ...quantities.arguments import NamesArguments, need_one
from ...quantities.carried import takes_units
from ...quantities.record import Entry, Record
from ...quantities.say import percent, signed_number, value_of
from ..ellipticity import Ellipticity
from ..heights import Heights
from ..roughness import Roughness
from .cutoff_curve import COLUMNS, Curve
from .spectra import (
    FEW_SUMMITS,
    Differences,
    SpectralMoments,
    Spectrum,
    Summits,
    count_summits,
    differences,
    gaussian_filtered,
    skewness_and_kurtosis,
    spectrum,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["Topography"]

Method = Literal["differences", "spectrum"]
METHODS = get_args(Method)

LEAST_CUTOFF = 4
"""Points per cut-off below which a Gaussian filter has no meaning on the grid."""
RESOLVED = 8
"""Points per wave from which m4 by second differences is right within 10 %: sinc⁴(1/8) = 0.90."""
LONGEST = 5
"""The longest cut-off of a curve is the shorter side divided by this."""
MOST_MISSING = 0.01
"""Part of the points without a datum from which on there is a warning."""
PER_OCTAVE = 0.1
"""Relative change of an answer, when the cut-off doubles, above which there is a warning."""


ASPERITIES: tuple[Entry, ...] = (
    *((name, f"moments.{name}") for name in ("sigma", "R", "eta", "alpha", "sigma_s", "y_s")),
    ("eta_R_sigma", lambda face: face.moments.eta * face.moments.R * face.moments.sigma),
)
SUMMITS = tuple((name, f"summits.{name}") for name in ("count", "density", "R", "sigma_s", "y_s"))
"""What plain data say of asperities by the moments, and of the summits counted."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Topography(NamesArguments, Record):
    """Heights on a regular grid, form removed, as `from_topography` reads them.

    Cut-offs are those of a Gaussian filter that passes one half of a wave of that length
    (ISO 16610-61); 0 stands for the heights as sampled.

    Parameters
    ----------
    heights : array (Nx, Ny) or (N,)
        Heights above their mean plane [m], NaN where there is no datum.
    spacing : tuple of float
        Distance of neighbouring points [m], one number per axis.
    source : str
        Where it is from, for messages.
    periodic : bool
        The heights repeat themselves beyond their edges.
    given_cutoff : float, optional
        The cut-off asked for; the recommended one when None.
    limit : float, optional
        Shortest wave that the instrument tells apart [m], where it is known.
    limit_reason : str
        Where `limit` is from, or that it is not known.
    notes : tuple of str
        What happened while reading.

    References
    ----------
    Nayak 1971, doi:10.1115/1.3451608, and McCool 1986, doi:10.1016/0043-1648(86)90045-1: asperities
    from moments.

    Examples
    --------
    >>> import thirdbody as tb
    >>> surface = tb.surfaces.from_topography("example", cutoff=1e-6)
    >>> f"{surface.roughness().sigma * 1e9:.1f} nm, R {surface.roughness().R * 1e6:.2f} µm"
    '59.5 nm, R 3.27 µm'
    """

    in_dict = (
        *("source", ("points", "heights.shape"), "spacing", "size", "periodic", "missing"),
        ("as_sampled", ("rms_height", "rms_slope", "rms_curvature")),
        (
            "cutoff",
            (
                ("used", "cutoff"),
                ("recommended", lambda face: face.recommended[0]),
                ("reason", lambda face: face.recommended[1]),
                ("instrument_limit", "limit"),
                ("instrument_limit_reason", "limit_reason"),
            ),
        ),
        "moments",
        ("moments_spectrum", lambda face: face.moments_at(method="spectrum")),
        ("asperities", ASPERITIES),
        ("summits", SUMMITS),
        *("anisotropy", "skewness", "kurtosis", "curve"),
        ("units", lambda face: {name: column.unit for name, column in COLUMNS.items()}),
        "warnings",
    )
    heights: Array = field(repr=False)
    spacing: tuple[float, ...]
    source: str
    periodic: bool = False
    given_cutoff: float | None = None
    limit: float | None = None
    limit_reason: str = "not known: the file does not state it"
    notes: tuple[str, ...] = ()

    # ---------------------------------------------------------------- as sampled
    @property
    def dim(self) -> int:
        """2 for a map, 1 for a profile."""
        return self.heights.ndim

    @property
    def size(self) -> tuple[float, ...]:
        """Length of each side [m]."""
        return tuple(n * d for n, d in zip(self.heights.shape, self.spacing, strict=True))

    @property
    def missing(self) -> float:
        """Share of points without a datum."""
        return float(np.isnan(self.heights).mean())

    @cached_property
    def _differences(self) -> Differences:
        return differences(self.heights, self.spacing, self.periodic)

    @property
    def rms_height(self) -> float:
        """RMS of the heights as sampled [m] (Sq, or Rq of a profile)."""
        return float(np.nanstd(self.heights))

    @property
    def rms_slope(self) -> float:
        """RMS gradient of a map as sampled, or RMS slope of a profile [1]."""
        return math.sqrt(self._differences.slopes.trace())

    @property
    def rms_curvature(self) -> float:
        """RMS mean curvature of a map as sampled, or RMS second derivative of a profile [1/m]."""
        return math.sqrt(self._differences.second) * (0.5 if self.dim == 2 else 1.0)

    # ---------------------------------------------------------------- at a cut-off
    @property
    def cutoff(self) -> float:
        """The cut-off used unless another is asked for [m]."""
        return self.recommended[0] if self.given_cutoff is None else self.given_cutoff

    @takes_units
    def filtered(self, cutoff: float | None = None) -> Array:
        """Heights without the waves below a cut-off.

        Parameters
        ----------
        cutoff : float, optional
            Cut-off wavelength [m]; `cutoff` of the surface by default, 0 for none.

        Returns
        -------
        array
            Heights [m]. Within half a cut-off of an edge, or of missing data, the filter lacks
            part of its weight; slopes, curvatures and summits are not taken there.

        Raises
        ------
        InvalidValue
            A cut-off that the grid cannot resolve, or longer than the surface.
        """
        cutoff = self._cutoff(cutoff)
        if cutoff == 0:
            return self.heights
        return gaussian_filtered(self.heights, self.spacing, cutoff, self.periodic)

    @takes_units
    def moments_at(
        self, cutoff: float | None = None, *, method: Method = "differences"
    ) -> SpectralMoments:
        r"""Spectral moments at a cut-off.

        .. math:: m_2 = \tfrac12\sum_q q^2P(q)\,2^{-2(\lambda_cq/2\pi)^2}, \qquad
                  m_4 = \tfrac38\sum_q q^4P(q)\,2^{-2(\lambda_cq/2\pi)^2}

        for maps; both factors are 1 for profiles. Differences act on the filtered heights.

        Parameters
        ----------
        cutoff : float, optional
            Cut-off wavelength λ_c [m]; `cutoff` of the surface by default, 0 as sampled.
        method : {"differences", "spectrum"}
            First and second differences of neighbouring points, which are exact about the points
            and see waves shorter than eight points too weakly (m4 by a factor sinc⁴(Δ/λ)); or
            the power spectrum, exact for periodic heights, under a Hann window for others.

        Returns
        -------
        SpectralMoments

        Raises
        ------
        InvalidValue
            A cut-off out of range, or a surface without roughness.

        Examples
        --------
        >>> from thirdbody.populations.measured.topography import from_topography
        >>> surface = from_topography("example")
        >>> surface.moments_at(2e-6).R > surface.moments_at(1e-6).R
        True
        """
        need_one("method", method, *METHODS)
        cutoff = self._cutoff(cutoff)
        if method == "spectrum":
            m0, m2, m4 = self._spectrum.moments(cutoff)
        else:
            m0, m2, m4 = self._state(cutoff)[:3]
        if not (m2 > 0 and m4 > 0 and m0 > 0):
            raise InvalidValue(
                f"{self.source} is smooth at a cut-off of {value_of(cutoff, 'm')}",
                code=Mistake.BEYOND,
            )
        return SpectralMoments(m0=m0, m2=m2, m4=m4)

    def _state(self, cutoff: float) -> tuple[float, float, float, Summits, Array]:
        """m0, m2, m4, the summits, and the heights at a cut-off."""
        states = self.__dict__.setdefault("_states", {})
        if cutoff not in states:
            h = self.filtered(cutoff)
            inner = self._inner(h, cutoff)
            derivatives = differences(inner, self.spacing, self.periodic)
            share = (0.5, 0.375) if self.dim == 2 else (1.0, 1.0)
            m2, m4 = share[0] * float(derivatives.slopes.trace()), share[1] * derivatives.second
            summits = count_summits(inner, self.spacing, self.periodic, cutoff)
            states[cutoff] = (float(np.nanvar(h)), m2, m4, summits, skewness_and_kurtosis(h))
        return states[cutoff]

    def _inner(self, h: Array, cutoff: float) -> Array:
        """The part of a filtered surface that is half a cut-off away from its edges."""
        if self.periodic or cutoff == 0:
            return h
        margins = (math.ceil(cutoff / 2 / d) for d in self.spacing)
        return h[tuple(slice(m, n - m) for m, n in zip(margins, h.shape, strict=True))]

    def _cutoff(self, cutoff: float | None) -> float:
        if cutoff is None:
            return self.cutoff
        least, most = LEAST_CUTOFF * max(self.spacing), min(self.size) / 2
        if cutoff == 0 or least * (1 - 1e-9) <= cutoff <= most:
            return float(cutoff)
        raise InvalidValue(
            Problem(
                "cutoff",
                f"must be between {value_of(least, 'm')} "
                f"({LEAST_CUTOFF} points) and {value_of(most, 'm')} (half of the shorter side) of "
                f"{self.source}, or 0 for the heights as sampled",
                value_of(cutoff, "m"),
                code=Mistake.RANGE,
            )
        )

    @property
    def moments(self) -> SpectralMoments:
        """Spectral moments at `cutoff`, by differences."""
        return self.moments_at()

    @property
    def summits(self) -> Summits:
        """Summits counted at `cutoff`."""
        return self.summits_at()

    @takes_units
    def summits_at(self, cutoff: float | None = None) -> Summits:
        """Summits counted at a cut-off.

        Parameters
        ----------
        cutoff : float, optional
            Cut-off wavelength [m]; `cutoff` of the surface by default, 0 as sampled.

        Returns
        -------
        Summits

        Examples
        --------
        >>> from thirdbody.populations.measured.topography import from_topography
        >>> surface = from_topography("example")
        >>> surface.summits_at(1e-6).count > surface.summits_at(2e-6).count
        True
        """
        return self._state(self._cutoff(cutoff))[3]

    @property
    def skewness(self) -> float:
        """Skewness of the heights at `cutoff`."""
        return float(self._state(self.cutoff)[4][0])

    @property
    def kurtosis(self) -> float:
        """Kurtosis of the heights at `cutoff`, 3 for a Gaussian."""
        return float(self._state(self.cutoff)[4][1])

    @takes_units
    def roughness(
        self,
        *,
        cutoff: float | None = None,
        heights: Heights | str | None = None,
        ellipticity: Ellipticity | str | None = None,
    ) -> Roughness:
        """The rough surface of a contact, against a smooth one.

        Parameters
        ----------
        cutoff : float, optional
            Cut-off wavelength [m]; `cutoff` of the surface by default, 0 as sampled.
        heights : Heights or "measured", optional
            Distribution of asperity heights, Gaussian by default, with σ, R, η and α by moments.
            With "measured", heights, density, mean curvature and σ_s are those of the summits
            counted; α is then the one that gives their σ_s.
        ellipticity : Ellipticity or "measured", optional
            Shapes of the tips, for laws of elliptic tips; round by default. With "measured",
            those of the summits counted, by `Ellipticity.from_curvatures`.

        Returns
        -------
        Roughness

        Raises
        ------
        InvalidValue
            As `moments_at`; a bandwidth at or below 1.5; too few summits, or summits whose
            spread no bandwidth gives.

        Examples
        --------
        >>> from thirdbody.populations.measured.topography import from_topography
        >>> rough = from_topography("example").roughness(cutoff=1e-6)
        >>> 0.03 < rough.eta * rough.R * rough.sigma < 0.07
        True
        """
        moments = self.moments_at(cutoff)
        if isinstance(ellipticity, str):
            if ellipticity != "measured":
                raise InvalidValue(
                    Problem(
                        "ellipticity",
                        'must be "measured" or an Ellipticity',
                        repr(ellipticity),
                        code=Mistake.OPTION,
                    )
                )
            rough = self.roughness(cutoff=cutoff, heights=heights)
            tips = Ellipticity.from_curvatures(self.summits_at(cutoff).principal, R=rough.R)
            return rough.replace(ellipticity=tips)
        if ellipticity is not None:
            rough = self.roughness(cutoff=cutoff, heights=heights)
            return rough.replace(ellipticity=ellipticity)
        if heights != "measured":
            if isinstance(heights, str):
                raise InvalidValue(
                    Problem(
                        "heights",
                        'must be "measured" or a distribution',
                        repr(heights),
                        code=Mistake.OPTION,
                    )
                )
            return moments.roughness(heights=heights)
        summits = self.summits_at(cutoff)
        law = summits.distribution()
        ratio = summits.sigma_s / moments.sigma
        if not (1 - 0.8968 / 1.5) ** 0.5 < ratio < 1:
            raise InvalidValue(
                f"the summits of {self.source} at a cut-off of {value_of(summits.cutoff, 'm')} "
                f"have σ_s = {ratio:.3g} σ, and a Roughness has from 0.634 to 1; "
                "use Gaussian heights or another cut-off",
                code=Mistake.BEYOND,
            )
        return Roughness(
            sigma=moments.sigma,
            R=summits.R,
            alpha=0.8968 / (1 - ratio**2),
            eta=summits.density,
            heights=law,
        )

    # ---------------------------------------------------------------- the cut-off itself
    @takes_units
    def curve(self, points_per_octave: int = 2) -> Curve:
        """Moments, asperities and summits against the cut-off.

        Parameters
        ----------
        points_per_octave : int
            Cut-offs in each octave, from four points to a fifth of the shorter side.

        Returns
        -------
        Curve

        Examples
        --------
        >>> from thirdbody.populations.measured.topography import from_topography
        >>> len(from_topography("example").curve()["cutoff"])
        6
        """
        curves: dict[int, Curve] = self.__dict__.setdefault("_curves", {})
        if points_per_octave in curves:
            return curves[points_per_octave]
        if not (isinstance(points_per_octave, int) and 1 <= points_per_octave <= 100):
            raise InvalidValue(
                Problem(
                    "points_per_octave",
                    "must be a whole number from 1 to 100",
                    repr(points_per_octave),
                    code=Mistake.KIND,
                )
            )
        low, high = LEAST_CUTOFF * max(self.spacing), min(self.size) / LONGEST
        steps = max(int(points_per_octave * math.log2(high / low) + 1e-9), 1)
        cutoffs = low * 2.0 ** (np.arange(steps + 1) / points_per_octave)
        rows = [self.row(float(cutoff)) for cutoff in cutoffs]
        columns = {name: np.array([row[name] for row in rows]) for name in COLUMNS}
        return curves.setdefault(points_per_octave, Curve(columns=columns))

    @takes_units
    def row(self, cutoff: float) -> dict[str, float]:
        """Every column of `COLUMNS` at one cut-off, 0 for the heights as sampled."""
        moments, summits = self.moments_at(cutoff), self.summits_at(cutoff)
        spectrum = self.moments_at(cutoff, method="spectrum")
        names = ("m0", "m2", "m4", "sigma", "rms_gradient", "alpha", "R", "eta", "sigma_s", "y_s")
        counted = {"R": summits.R, "sigma_s": summits.sigma_s, "y_s": summits.y_s}
        counted["eta"] = summits.density
        if self.dim == 1:
            counted = dict.fromkeys(counted, math.nan)
        skewness, kurtosis = self._state(cutoff)[4]
        return (
            {"cutoff": cutoff, "summits": summits.count}
            | {name: getattr(moments, name) for name in names}
            | {f"{name}_spectrum": getattr(spectrum, name) for name in ("m0", "m2", "m4")}
            | {f"{name}_counted": value for name, value in counted.items()}
            | {"skewness": float(skewness), "kurtosis": float(kurtosis)}
        )

    @cached_property
    def recommended(self) -> tuple[float, str]:
        """The shortest cut-off at which the data stand for the surface [m], and why."""
        step, longest = max(self.spacing), min(self.size) / LONGEST
        reasons = {
            f"{RESOLVED} points ({value_of(step, 'm')} apart) carry the shortest wave, so that m4 "
            "by differences is right within 10 %": RESOLVED * step
        }
        if self.limit is not None:
            reasons[f"the instrument's limit, {self.limit_reason}"] = self.limit
        if self._noise is not None:
            reasons[
                "shorter waves look like noise: their spectrum falls more slowly than that of any "
                "self-affine surface (Hurst exponent 0)"
            ] = self._noise
        reason = max(reasons, key=lambda text: reasons[text])
        if reasons[reason] <= longest:
            return reasons[reason], reason
        limited = f"a {LONGEST}th of the shorter side, although {value_of(reasons[reason], 'm')} "
        return max(longest, LEAST_CUTOFF * step), limited + f"would be asked for: {reason}"

    @cached_property
    def _spectrum(self) -> Spectrum:
        return spectrum(self.heights, self.spacing, self.periodic)

    @cached_property
    def _noise(self) -> float | None:
        return self._spectrum.noise_below()

    def psd(self) -> tuple[Array, Array]:
        """Wavelengths [m] and radially averaged power spectral density.

        Returns
        -------
        wavelength, density : arrays (N,)
            Density [m⁴] of maps, with m0 = ∫∫C d²q/(2π)²; [m³] of profiles, m0 = ∫C dq/2π
            over both signs of q.

        Examples
        --------
        >>> from thirdbody.populations.measured.topography import from_topography
        >>> wavelength, density = from_topography("example").psd()
        >>> bool(density[0] < density[-1])
        True
        """
        return self._spectrum.radial()

    @cached_property
    def anisotropy(self) -> float:
        """Mean square slope along the steepest direction over that across it, 1 for profiles."""
        if self.dim == 1:
            return 1.0
        h = self._inner(self.filtered(), self.cutoff)
        low, high = np.linalg.eigvalsh(differences(h, self.spacing, self.periodic).slopes)
        return float(high / low) if low > 0 else math.inf

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """Notes for the user of these numbers, one sentence each."""
        out = list(self.notes)
        moving, few = self._bandwidth(), self._few()
        if moving or few:
            code = "cutoff" if moving else "few"
            out.append(self._note("; ".join((*moving, *few)), code))
        least = self.recommended[0]
        if self.cutoff < least * (1 - 1e-9):
            at = (
                "the heights as sampled" if self.cutoff == 0 else f"a cut-off {self._cutoff_said()}"
            )
            what = (
                f"{at} is below the recommended cut-off of {value_of(least, 'm')}: "
                f"{self.recommended[1]}"
            )
            out.append(self._note(what, "recommended"))
        if self.missing > MOST_MISSING:
            what = (
                f"{percent(self.missing, digits=2)} of the points have no datum; the filter and "
                "the differences pass over them, the spectrum has them filled harmonically"
            )
            out.append(self._note(what, "missing"))
        if self.dim == 1:
            what = (
                "one profile stands for the surface: it is taken as isotropic, and peaks of a "
                "profile are no summits"
            )
            out.append(self._note(what, "profile"))
        elif self.anisotropy > 2:
            what = (
                f"the surface is not isotropic: the mean square slope is {self.anisotropy:.3g} "
                "times as large along as across; moments are means over all directions, and "
                "Nayak's relations are off (compare the summits counted)"
            )
            out.append(self._note(what, "isotropy"))
        if abs(self.skewness) > 0.5 or abs(self.kurtosis - 3) > 1:
            what = (
                f"the heights are not Gaussian (skewness {self.skewness:.2f}, kurtosis "
                f"{self.kurtosis:.2f}); Nayak's relations assume that they are"
            )
            out.append(self._note(what, "gaussian"))
        return tuple(out)

    def _note(self, what: str, code: str) -> Note:
        """A note on this surface, apart from the same of another one."""
        return Note(what, code=f"topography.{code}.{self.source}")

    def _cutoff_said(self) -> str:
        return f"of {value_of(self.cutoff, 'm')}"

    def _bandwidth(self) -> list[str]:
        """Which answers move with the cut-off, and how far."""
        least = LEAST_CUTOFF * max(self.spacing)
        middle = min(max(self.cutoff, least * 2**0.5), min(self.size) / 2 / 2**0.5)
        below, above = (self.moments_at(middle * 2**half) for half in (-0.5, 0.5))
        names = {"sigma": "σ", "rms_gradient": "RMS gradient", "R": "R", "eta": "η"}
        changes = {
            symbol: getattr(above, name) / getattr(below, name) - 1
            for name, symbol in names.items()
        }
        moving = [
            f"{symbol} by {signed_number(100 * change, 0, '%')}"
            for symbol, change in changes.items()
            if abs(change) > PER_OCTAVE
        ]
        if not moving:
            return []
        return [
            f"the answer depends on the cut-off: from {value_of(middle / 2**0.5, 'm')} to "
            f"{value_of(middle * 2**0.5, 'm')}, one octave about the one used, {', '.join(moving)}"
            "; quote them with their cut-off"
        ]

    def _few(self) -> list[str]:
        """How far a map of few summits leaves their numbers open."""
        count = self.summits.count
        if self.dim != 2 or count >= 10 * FEW_SUMMITS:
            return []
        error = percent(1 / math.sqrt(max(count, 1)), digits=2)
        return [
            f"{count} summits on the map at a cut-off {self._cutoff_said()}: their mean numbers "
            f"are uncertain by some {error}; a larger map, or several, make them surer"
        ]
