"""How strong particles are: Weibull survival with an effect of size, and sizes too small to break.

.. math:: P_s = \\exp[-(\\sigma_t/\\sigma_x)^m], \\qquad \\sigma_x = \\sigma_0 (x/x_0)^{-b}
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, Self

from ..errors import Advice, InvalidValue, Mistake, Problem
from ..quantities.value import Value, choice, quantity
from .materials import Material

__all__ = ["WeibullStrength"]

OTHER_STRENGTH = Advice(
    "give WeibullStrength(sigma_0=..., x_0=..., m=...), or material.replace(K_c=...)",
    'give a table, strength = { sigma_0 = "60 MPa", x_0 = "10 mm", m = 3 }, with numbers of your '
    "own, or K_c with the numbers of the material",
)
"""What to do where a material has no strength."""

TOUGHNESS, TOUGHNESS_SIZE, TOUGHNESS_MODULUS = 1.8, 1e-3, 3.0
"""σ_x √x/K_c and Weibull modulus of an estimate from toughness, and the size it is told at [m]."""
KEPT = {"gone": 0.0, "footprint": None, "all": 1.0}
"""Part χ of the volume of a broken particle that stays in the gap; None stands for the ratio κ."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WeibullStrength(Value):
    r"""The strength of particles, as of crushing tests between hard platens, and of their pieces.

    .. math:: P_s = \exp[-(\sigma_t/\sigma_x)^m], \qquad \sigma_x = \sigma_0 (x/x_0)^{-b}

    A broken particle becomes pieces of κ times its size in the same gap, and these may break again.

    Parameters
    ----------
    sigma_0 : float
        Characteristic strength σ_0 = F/x² at the size x_0, of which 37 % survive [Pa].
    x_0 : float
        The size at which it was measured [m].
    m : float
        Weibull modulus [1].
    size_exponent : float, optional
        b [1]; 3/m, the weakest link by volume, where it is not given. The largest uncertainty: vary
        it.
    x_c : float, optional
        Size from which down nothing breaks [m]; where it is not given B (K_c/H_a)² with the
        toughness of the material, or 0 without one.
    B : float, optional
        Of that size [1]; published values reach from 30 to 110.
    fragments : {"footprint", "gone", "all"}, optional
        What pieces bear. ``footprint``: as many as cover the area of their parent, the rest lies on
        top or leaves; ``gone``: none, a lower bound; ``all``: all of them in one layer, an upper
        bound. Nobody has measured it.
    ratio : float, optional
        κ, size of the pieces over that of their parent [1]; a half makes eight of one.
    confinement : {"sphere", "none"}, optional
        Tension inside an elastic sphere pressed over two caps, which ends as the caps grow, or
        F/x² whatever the caps.
    x_from, x_to : float, optional
        Sizes between which strength was measured [m]; x_0 where they are not given.

    Notes
    -----
    Left out: ring cracks at the edge of small contacts, tension near a contact, time, and the
    stress that corners raise (a σ_0 of natural sand has it in it).

    References
    ----------
    McDowell and Bolton 1998, Géotechnique 48, 667 (Weibull statistics of grains). Kendall 1978,
    Nature 272, 710 (smallest size that breaks; from memory). The tension inside is derived.

    Examples
    --------
    >>> import thirdbody as tb
    >>> quartz = tb.grains.WeibullStrength(sigma_0=67e6, x_0=1e-3, m=3.0, size_exponent=0.55)
    >>> f"{quartz.of_size(1e-5) / 1e6:.0f} MPa at 10 µm"
    '843 MPa at 10 µm'
    """

    sigma_0: float = quantity(
        "σ_0", "Pa", "strength F/x² of particles of size x_0", gt=0, hint="MPa are 67e6 or '67 MPa'"
    )
    x_0: float = quantity("x_0", "m", "size at which the strength was measured", gt=0, usual=1.0)
    m: float = quantity("m", "1", "Weibull modulus of the strength", ge=0.1, le=200)
    size_exponent: float | None = quantity(
        "b", "1", "exponent of the size effect", default=None, ge=0, le=30
    )
    x_c: float | None = quantity("x_c", "m", "size below which nothing breaks", default=None, ge=0)
    B: float = quantity("B", "1", "x_c over (K_c/H_a)²", default=96.0, gt=0)
    fragments: Literal["footprint", "gone", "all"] = choice("what pieces bear", default="footprint")
    ratio: float = quantity("κ", "1", "size of pieces over parent", default=0.5, gt=0, lt=1)
    confinement: Literal["sphere", "none"] = choice("tension inside", default="sphere")
    x_from: float | None = quantity("x_from", "m", "smallest size of the data", default=None,
                                    gt=0, usual=1.0)  # fmt: skip
    x_to: float | None = quantity("x_to", "m", "largest size of the data", default=None,
                                  gt=0, usual=1.0)  # fmt: skip

    def _problems(self) -> list[str]:
        low, high = self.tested_sizes
        if low <= high:
            return []
        return [
            Problem(
                "x_from",
                f"must not exceed x_to = {high:g} (where one is not given, it is x_0)",
                f"{low:g}",
                code=Mistake.ORDER,
            )
        ]

    @classmethod
    def of(cls, material: Material, **options: Any) -> Self:
        """The strength that a material of the library has, or an estimate from its toughness.

        Parameters
        ----------
        material : Material
        **options
            Other arguments of the class, e.g. ``fragments``; they replace what the material says.

        Raises
        ------
        InvalidValue
            The material has neither a strength nor a toughness.

        Examples
        --------
        >>> import thirdbody as tb
        >>> tb.grains.WeibullStrength.of(tb.materials["quartz"]).sigma_0
        67000000.0
        """
        if not isinstance(material, Material):
            raise InvalidValue(f"material = {material!r} must be a Material", code=Mistake.KIND)
        numbers = {name: getattr(material, name) for name in ("sigma_0", "x_0", "m")}
        if None not in numbers.values():
            return cls(**numbers | {"size_exponent": material.size_exponent} | options)
        if material.K_c is not None:
            return cls.from_toughness(material.K_c, **options)
        missing = ", ".join(name for name, value in numbers.items() if value is None)
        raise InvalidValue(
            f"the material {material.name or 'of these particles'} has no strength: it lacks "
            f"{missing}, and K_c for an estimate; " + OTHER_STRENGTH,
            code=Mistake.BEYOND,
        )

    @classmethod
    def from_toughness(cls, K_c: float, **options: object) -> Self:
        r"""An estimate, :math:`\sigma_x = 1.8\,K_c/\sqrt x` and m = 3: one constant, from quartz.

        Parameters
        ----------
        K_c : float
            Fracture toughness [Pa m^0.5].
        **options
            Other arguments of the class.

        Examples
        --------
        >>> import thirdbody as tb
        >>> alumina = tb.grains.WeibullStrength.from_toughness(4.1e6)
        >>> f"{alumina.of_size(20e-6) / 1e9:.2f} GPa at 20 µm"
        '1.65 GPa at 20 µm'
        """
        if isinstance(K_c, (bool, str)) or not hasattr(K_c, "__float__") or not K_c > 0:
            raise InvalidValue(
                Problem(
                    "K_c",
                    "must be > 0 [Pa m^0.5]",
                    repr(K_c),
                    hint="1.2 MPa m^0.5 is 1.2e6",
                    code=Mistake.RANGE,
                )
            )
        estimate = {
            "sigma_0": TOUGHNESS * K_c / TOUGHNESS_SIZE**0.5,
            "x_0": TOUGHNESS_SIZE,
            "m": TOUGHNESS_MODULUS,
            "size_exponent": 0.5,
        }
        return cls(**estimate | options)

    @property
    def b(self) -> float:
        """Exponent of the size effect [1]."""
        return 3 / self.m if self.size_exponent is None else self.size_exponent

    @property
    def bearing_share(self) -> float:
        """χ, part of the volume of a broken particle whose pieces bear [1]."""
        kept = KEPT[self.fragments]
        return self.ratio if kept is None else kept

    @property
    def tested_sizes(self) -> tuple[float, float]:
        """Sizes between which strength was measured [m]."""
        return (
            self.x_0 if self.x_from is None else self.x_from,
            self.x_0 if self.x_to is None else self.x_to,
        )

    def of_size(self, x: Any) -> Any:
        """σ_x [Pa] of particles of size x [m]."""
        return self.sigma_0 * (x / self.x_0) ** -self.b

    def least(self, material: Material) -> float:
        """x_c [m]: from this size down particles of the material do not break."""
        if self.x_c is not None:
            return self.x_c
        return 0.0 if material.K_c is None else self.B * (material.K_c / material.H) ** 2
