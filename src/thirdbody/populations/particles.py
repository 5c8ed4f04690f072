"""Particles: what lies between the surfaces."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

from ..errors import Advice, InvalidValue, Mistake, Note, Problem, tell_of_range
from ..quantities.say import percent
from ..quantities.slips import is_silent
from ..quantities.units import say, to_si
from ..quantities.value import Value, quantity
from .distributions import Distribution
from .materials import Material
from .measured import cleanliness
from .measured.cleanliness import Level, Limit
from .measured.concentration import Amount
from .shape import SPHERE, Angular, Sphere
from .strength import WeibullStrength

__all__ = ["Particles", "about_gaps", "wider_part"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Particles(Value):
    """A population of particles in the interface.

    Parameters
    ----------
    material : Material
        E_a, ν_a, H_a.
    diameter : Distribution
        Sizes x by number [m].
    areal_density : float
        η_a, particles per nominal area [1/m²].
    name : str, optional
        What results call this population, where several share one interface.
    law : AbstractParticleLaw, optional
        What one of these particles does; without it the particle law of the contact.
    strength : WeibullStrength, optional
        How strong the particles are: they break as the gap closes. Without it they never do.
    shape : Sphere or Angular, optional
        Round, the default, or a rounded tip and faces on each side.
    conducts : bool, optional
        Whether they conduct an electric current; without it their material says so
        (`thirdbody.populations.conduction.conducts`). Grains of metal under a skin of oxide do not.

    Raises
    ------
    InvalidValue
        A number outside its meaning, or so many particles that their projected area
        :math:`\\eta_a\\langle\\pi x^2/4\\rangle` reaches the nominal area (jammed).

    Examples
    --------
    >>> import thirdbody as tb
    >>> dust = tb.Particles(material=tb.materials["SiO2"], areal_density=1e11,
    ...                     diameter=tb.distributions.Monodisperse(mean=3e-7))
    >>> round(dust.coverage, 6)
    0.007069
    """

    material: Material
    diameter: Distribution
    areal_density: float = quantity(
        "η_a", "1/m^2", "particles per nominal area", ge=0, hint="1e11 / m^2 is 1e11"
    )
    name: str = ""
    law: Value | None = None
    strength: WeibullStrength | None = None
    shape: Sphere | Angular = SPHERE
    conducts: bool | None = None

    def _problems(self) -> list[str]:
        out: list[str] = []
        if not isinstance(self.material, Material):
            out.append(
                Problem(
                    "material",
                    "must be a Material, e.g. materials['SiO2']",
                    repr(self.material),
                    code=Mistake.KIND,
                )
            )
        if not isinstance(self.diameter, Distribution):
            out.append(
                Problem(
                    "diameter",
                    "must be a size distribution",
                    repr(self.diameter),
                    hint=_sizes_meant(self.diameter),
                    code=Mistake.KIND,
                )
            )
        if not isinstance(self.strength, WeibullStrength | None):
            out.append(
                Problem(
                    "strength",
                    "must be a WeibullStrength, e.g. WeibullStrength.of(material), or None",
                    repr(self.strength),
                    code=Mistake.KIND,
                )
            )
        if not isinstance(self.shape, Sphere | Angular):
            out.append(
                Problem(
                    "shape",
                    Advice(
                        "must be Sphere() or Angular(roundness=..., angle=...)",
                        'must be "sphere" or "angular", or a table: { name = "angular", '
                        'roundness = 0.1, angle = "60 deg" }',
                    ),
                    repr(self.shape),
                    code=Mistake.KIND,
                )
            )
        if not isinstance(self.conducts, bool | None):
            out.append(
                Problem(
                    "conducts",
                    "must be true, false or left out",
                    repr(self.conducts),
                    code=Mistake.KIND,
                )
            )
        if not out and self.coverage >= 1:
            out.append(
                Problem(
                    "areal_density",
                    f"is jammed: the particles would "
                    f"cover {self.coverage:.3g} of the nominal area and it must stay below 1 "
                    "(check the unit of the diameter, or that the density is per area)",
                    f"{self.areal_density:g}",
                    code=Mistake.FULL,
                )
            )
        return out

    @property
    def coverage(self) -> float:
        """Projected particle area per nominal area η_a⟨πx²/4⟩ [1]."""
        return self.areal_density * math.pi / 4 * self.diameter.moment(2)

    @classmethod
    def from_concentration(
        cls,
        concentration: float | str,
        *,
        gap: float | str,
        diameter: Distribution,
        material: Material,
        by: Amount = "number",
        particle_density: float | str | None = None,
        oil_density: float | str = cleanliness.OIL_DENSITY,
        **others: Any,
    ) -> Self:
        r"""The particles that a fluid brings into a gap that closes.

        .. math:: \eta_a = n\,h_{gap}, \qquad n = \frac{\phi}{\langle\pi x^3/6\rangle}, \qquad
                  \phi = \frac{w/\rho_p}{w/\rho_p + (1-w)/\rho_f}

        All particles of the fluid in the gap stay in it while it closes; see
        `thirdbody.populations.measured.cleanliness`.

        Parameters
        ----------
        concentration : float or str
            "0.1 wt%", "0.02 vol%", "50 ppm" (mg/kg), "10 mg/L", "1e6 / mL"; a plain number is in
            SI.
        gap : float or str
            h_gap, the film thickness or trapping gap [m].
        diameter : Distribution
            Sizes x by number [m]; convert others with `thirdbody.sizes.by_number`.
        material : Material
            Of the particles.
        by : {"number", "mass", "volume", "mass per volume"}, optional
            What a plain number is: n [1/m³], w [1], φ [1] or c [kg/m³].
        particle_density, oil_density : float or str, optional
            ρ_p, by default that of the material, needed for a mass; ρ_f, 870 by default [kg/m³].
        **others
            ``name``, ``law``, ``strength``, ``shape`` and ``conducts``, as in the class.

        Raises
        ------
        InvalidValue
            Numbers outside their meaning, or so many particles that they jam.

        Examples
        --------
        >>> import thirdbody as tb
        >>> dust = tb.Particles.from_concentration(
        ...     "0.1 wt%", gap="1 um", particle_density="2.65 g/cm^3",
        ...     diameter=tb.LogNormal(median=300e-9, gsd=1.5), material=tb.materials["SiO2"])
        >>> f"{dust.areal_density:.4g}"
        '1.109e+10'
        """
        if particle_density is None and isinstance(material, Material):
            particle_density = material.density
        n = cleanliness.particles_in(
            cleanliness.concentration(concentration, by),
            diameter,
            particle_density=_optional("particle_density", particle_density, "kg/m^3"),
            oil_density=_read_value("oil_density", oil_density, "kg/m^3"),
        )
        density = n * _gap(gap)
        particles = cls(material=material, diameter=diameter, areal_density=density, **others)
        _warn_of_gap(particles, gap)
        return particles

    @classmethod
    def from_iso4406(
        cls,
        code: str,
        *,
        gap: float | str,
        material: Material,
        level: Level = "middle",
        smallest: float | str | None = None,
        largest: float | str | None = None,
        **others: Any,
    ) -> Self:
        r"""The particles of a fluid with an ISO 4406 code, in a gap that closes.

        .. math:: \eta_a = h_{gap} N(\ge x_1), \qquad N(>x) \propto x^{-s}\ \text{between the sizes}

        A code is a range: ``level`` takes its low end, its middle or its high end, three
        populations that bound what the code can mean. Power laws between 4, 6 and 14 µm(c), and s
        = 3.34 from 14 µm(c) to ``largest``, are assumptions; below 4 µm(c) nothing was counted
        and nothing is added unless ``smallest`` says so.

        Parameters
        ----------
        code : str
            "18/16/13"; "-/16/13" without the count from 4 µm(c).
        gap : float or str
            h_gap [m].
        material : Material
            Of the particles; the code does not know it.
        level : {"low", "middle", "high"}, optional
            Of the range of each number.
        smallest, largest : float or str, optional
            Ends of the sizes [m]: 4 µm and 70 µm by default.
        **others
            ``name``, ``law``, ``strength``, ``shape`` and ``conducts``, as in the class.

        Raises
        ------
        InvalidValue
            A code that is misspelt or impossible, e.g. with numbers that rise.

        References
        ----------
        ISO 4406:2021; scale numbers from two secondary sources, in ``data/cleanliness.toml``.

        Examples
        --------
        >>> import thirdbody as tb
        >>> oil = tb.Particles.from_iso4406("18/16/13", gap="1 um", material=tb.materials["S45C"])
        >>> round(oil.areal_density), oil.iso4406(gap="1 um")
        (1803, '18/16/13')
        """
        n, diameter = cleanliness.suspension_of_iso4406(
            code,
            level=level,
            smallest=_optional("smallest", smallest, "m"),
            largest=_optional("largest", largest, "m"),
        )
        density = n * _gap(gap)
        particles = cls(material=material, diameter=diameter, areal_density=density, **others)
        _warn_of_gap(particles, gap)
        return particles

    @classmethod
    def from_cleanliness_class(
        cls,
        standard: str,
        grade: str,
        *,
        gap: float | str,
        material: Material,
        smallest: float | str | None = None,
        largest: float | str | None = None,
        **others: Any,
    ) -> Self:
        """The particles of the dirtiest fluid that still has a class, in a gap that closes.

        As `from_iso4406`, with the highest permitted count at every size.

        Parameters
        ----------
        standard : {"as4059", "nas1638"}
            SAE AS4059, or NAS 1638.
        grade : str
            "00", "0", "1" to "12"; "000" in AS4059.
        gap, material, smallest, largest, **others
            As in `from_iso4406`; the largest size is 100 µm by default.

        Raises
        ------
        InvalidValue
            An unknown standard or class.

        Examples
        --------
        >>> import thirdbody as tb
        >>> oil = tb.Particles.from_cleanliness_class("nas1638", "6", gap=1e-6,
        ...                                           material=tb.materials["S45C"])
        >>> round(oil.areal_density), oil.iso4406(gap=1e-6)
        (195, '15/15/12')
        >>> oil.cleanliness_class("nas1638", gap=1e-6)
        '6'
        """
        n, diameter = cleanliness.suspension_of_class(
            standard,
            grade,
            smallest=_optional("smallest", smallest, "m"),
            largest=_optional("largest", largest, "m"),
        )
        density = n * _gap(gap)
        particles = cls(material=material, diameter=diameter, areal_density=density, **others)
        _warn_of_gap(particles, gap)
        return particles

    @classmethod
    def test_dust(
        cls,
        grade: str,
        *,
        material: Material,
        concentration: float | str | None = None,
        gap: float | str | None = None,
        areal_density: float | str | None = None,
        by: Amount = "number",
        limit: Limit = "middle",
        smallest: float | str | None = None,
        oil_density: float | str = cleanliness.OIL_DENSITY,
        **others: Any,
    ) -> Self:
        """An Arizona test dust of ISO 12103-1, A1 ultrafine to A4 coarse.

        Sizes as in `thirdbody.populations.measured.cleanliness.dust_sizes`. How many there are
        follows from
        ``concentration`` and ``gap``, as in `from_concentration` with the density of the dust, or
        is ``areal_density`` itself. **The tables of A2, A3 and A4 are those of the 1997 edition
        and were not compared with a printed copy.**

        Parameters
        ----------
        grade : {"A1", "A2", "A3", "A4", "A3-lot"}
            Ultrafine, fine, medium, coarse; one batch of A3 as measured.
        material : Material
            Of the grains: 69 to 77 % quartz, ``materials["quartz"]``.
        concentration, gap, by, oil_density
            As in `from_concentration`.
        areal_density : float or str, optional
            η_a [1/m²], instead of a concentration.
        limit : {"coarse", "middle", "fine"}, optional
            Between the printed limits.
        smallest : float or str, optional
            Size above which the volume below the first printed size lies [m].
        **others
            As in the class.

        Raises
        ------
        InvalidValue
            An unknown grade; both or neither of concentration and areal density.

        Examples
        --------
        >>> import thirdbody as tb
        >>> dust = tb.Particles.test_dust("A2", concentration="0.1 wt%", gap="1 um",
        ...                               material=tb.materials["SiO2"])
        >>> f"{dust.areal_density:.3g}", f"{dust.diameter.mean_diameter:.3g}"
        ('5.62e+07', '1.28e-06')
        """
        entry = cleanliness.dust_table(grade)
        diameter = cleanliness.dust_sizes(
            grade, limit=limit, smallest=_optional("smallest", smallest, "m")
        )
        if areal_density is not None and concentration is None and gap is None:
            density = _read_value("areal_density", areal_density, "1/m^2")
            return cls(material=material, diameter=diameter, areal_density=density, **others)
        if areal_density is not None or concentration is None or gap is None:
            raise InvalidValue(
                "the amount of dust is given either by concentration and gap or by areal_density; "
                f"found concentration = {concentration!r}, gap = {gap!r}, "
                f"areal_density = {areal_density!r}",
                code=Mistake.CLASH,
            )
        return cls.from_concentration(
            concentration,
            gap=gap,
            diameter=diameter,
            material=material,
            by=by,
            particle_density=entry["density"],
            oil_density=oil_density,
            **others,
        )

    def iso4406(self, *, gap: float | str) -> str:
        """The ISO 4406 code of a fluid that holds these particles in a gap [m].

        Sizes are counted as they are, µm for µm(c). A count above the scale reads ">28".

        Examples
        --------
        >>> import thirdbody as tb
        >>> dust = tb.Particles(material=tb.materials["SiO2"], areal_density=1e3,
        ...                     diameter=tb.distributions.Monodisperse(mean=8e-6))
        >>> dust.iso4406(gap="1 um")
        '17/17/0'
        """
        return cleanliness.iso4406_of(
            density=self.areal_density / _gap(gap), diameter=self.diameter
        )

    def cleanliness_class(self, standard: str, *, gap: float | str) -> str:
        """The class in "as4059" or "nas1638" of a fluid that holds these particles in a gap [m].

        The lowest class that permits the count at every size; ">12" where none does.
        """
        return cleanliness.class_of(
            standard, density=self.areal_density / _gap(gap), diameter=self.diameter
        )


WIDER = 0.01
"""Part of the particles, by number, that may be wider than the gap without a word."""


def wider_part(particles: Particles, gap: float) -> float:
    """Part of the particles, by number, that is wider than a gap [m].

    >>> import thirdbody as tb
    >>> grains = tb.Particles(material=tb.materials["SiO2"], areal_density=1e6,
    ...                       diameter=tb.distributions.Monodisperse(mean=5e-6))
    >>> wider_part(grains, 1e-6), wider_part(grains, 6e-6)
    (1.0, 0.0)
    """
    largest = particles.diameter.support[1]
    if largest <= gap:
        return 0.0
    return float(particles.diameter.partial_moment(0, gap, largest))


def about_gaps(wider: Mapping[str, float]) -> Note | None:
    """Doubt of particles that are wider than the gap which brings them; None where few are.

    >>> about_gaps({"gap": 0.5}).effect, about_gaps({"gap": 0.001})
    (0.5, None)
    """
    most = max(wider.values(), default=0.0)
    if not most > WIDER:
        return None
    where = " and ".join(place for place, share in wider.items() if share > WIDER)
    what = (
        f"{where}: {percent(most)} of the particles are wider than the height of the fluid that "
        "brings them; how many of these enter is not known, and all that particles do is "
        "proportional to it"
    )
    action = "give areal_density, or as gap the height in which they are caught"
    return Note(what, code="gap", effect=most, action=action)


def _warn_of_gap(particles: Particles, gap: float | str) -> None:
    """Warn of particles that are wider than their gap [m], unless the caller says it."""
    if not is_silent() and (note := about_gaps({"gap": wider_part(particles, _gap(gap))})):
        tell_of_range(note)


def _sizes_meant(diameter: object) -> str:
    """What to write for a diameter that is one length, or none."""
    try:
        size = 0.0 if isinstance(diameter, bool) else to_si(diameter, "m")
    except InvalidValue:
        size = 0.0
    one = f"{size:g}" if 0 < size < math.inf else "300e-9"
    return (
        f"write distributions.Monodisperse(mean={one}) [m] for one size, LogNormal(median={one}, "
        "gsd=1.5) for many"
    )


def _read_value(name: str, value: float | str, unit: str) -> float:
    try:
        return to_si(value, unit)
    except InvalidValue as error:
        raise InvalidValue(error.problems[0].put_at(name, say(value))) from None


def _optional(name: str, value: float | str | None, unit: str) -> float | None:
    return None if value is None else _read_value(name, value, unit)


def _gap(value: float | str) -> float:
    gap = _read_value("gap", value, "m")
    if not (math.isfinite(gap) and gap > 0):
        raise InvalidValue(
            Problem(
                "gap", "must be > 0 [m]; um are 1e-6 or '1 um'", repr(value), code=Mistake.RANGE
            )
        )
    return gap
