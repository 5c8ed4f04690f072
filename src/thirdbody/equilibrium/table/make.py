r"""A contact's answer as a C¹ table: pressure and real area against separation, for other solvers.

Between knots :math:`x_i` pressure and area are the exponential of a cubic,

.. math:: p(x) = p_i\, e^{c_{i1}s + c_{i2}s^2 + c_{i3}s^3}, \qquad
          s = \frac{x - x_i}{x_{i+1} - x_i},

the Hermite interpolant of :math:`\ln p` with the true slopes, so that the relative error is the
same from full contact to the last asperity. Panels are halved until it is met.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ...contact.contact import Contact
from ...contact.interface import Interface, interface
from ...errors import InvalidValue, Mistake, Problem, RangeWarning, tell_of_range
from ...quantities.carried import takes_units
from ..load_scan import LoadScan, load_scan
from ..solve import pull_off, solve
from .cubic import _LogCubic
from .writers import _PLACES, ContactTable, TableError, _is_number

__all__ = ["SHARES", "table"]

Array = NDArray[np.float64]


SHARES = ("particle_area_share", "particle_load_share")
"""Columns that can be had beside pressure and area; A_sa is the area share times A_t."""
COORDINATES = {"h": "mean surface plane", "d": "datum of d"}

LEAST_LOAD = 1e-9
"""F* at the upper end of a table unless another is given: nothing that a solver could feel."""
MOST_AREA = 0.2
"""A_t at its lower end: beyond it neighbouring contacts interact, which the model neglects."""
ACCURACY = 1e-10
"""Relative accuracy of the loads and areas that the table is compared with."""
SAFETY = 1.5
"""Stated error over the largest one met at SAMPLES places of a panel."""
LEAST_PRESSURE = 1e-250
MOST_PANELS = 20_000


# -------------------------------------------------------------------------- making a table
@takes_units
def table(
    contact: Contact,
    *,
    low: float | None = None,
    high: float | None = None,
    tolerance: float = 1e-6,
    coordinate: Literal["h", "d"] = "h",
    columns: Sequence[str] = (),
) -> ContactTable:
    r"""Pressure, real area and stiffness against separation as a C¹ table for other solvers.

    .. math:: p(h), \quad A_t(h), \quad dp/dh, \qquad
              |\hat p - p| \le \epsilon\,p

    Parameters
    ----------
    contact : Contact
    low, high : float, optional
        Range of separations [m] in the chosen coordinate. Without them the table runs from
        A_t = 0.2 (at most down to −3 σ_s, or to where the pressure stops to rise on
        approach) up to the largest separation that carries F* = 1e-9.
    tolerance : float, optional
        Largest relative error ε of p and A_t, from 1e-9 to 0.1 [1]; for shares absolute.
    coordinate : {"h", "d"}, optional
        Count separations from the mean surface plane, or as `solve` counts d.
    columns : sequence of str, optional
        Shares to keep as well: "particle_area_share", "particle_load_share".

    Returns
    -------
    ContactTable
        Functions, knots, stated errors, and exports to CSV, Abaqus, COMSOL, AVL EXCITE,
        Python and C.

    Raises
    ------
    InvalidValue
        A range without contact, with attraction, or in which the pressure rises with the
        separation; a load that jumps; a tolerance that cannot be met.

    Warns
    -----
    RangeWarning
        The range leaves the model's validity; kept in ``warnings``.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> made = tb.table(contact, tolerance=1e-4)
    >>> made.p(250e-9) > made.p(300e-9) > 0 > made.dp_dh(300e-9)
    True
    """
    problems = _mistakes(low, high, tolerance, coordinate, columns)
    if problems:
        raise InvalidValue(*problems)
    contact_interface = interface(contact)
    shift = contact_interface.mean_plane if coordinate == "h" else 0.0
    scan = LoadScan(contact_interface)
    d_high = _upper_end(contact_interface, scan) if high is None else float(high) - shift
    d_low = _bottom(contact_interface) if low is None else float(low) - shift
    _check_range(contact_interface, d_low, d_high, shift, coordinate)
    if low is None:
        d_low = _lower_end(contact_interface, d_high)
    panels = _Panels(contact_interface, shift, columns, coordinate)
    x_low = d_low + shift if low is None else float(low)
    x_high = d_high + shift if high is None else float(high)
    x, parts, error = panels.refine_panels(x_low, x_high, tolerance)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        said = solve(contact, d=np.array([d_low, d_high])).warnings
    for sentence in said:
        tell_of_range(sentence)
    p, A, *shares = parts
    return ContactTable(
        contact=contact,
        coordinate=coordinate,
        h=x,
        tolerance=float(tolerance),
        warnings=said,
        error=TableError(**error, above=_above(contact_interface, scan, d_high, p.last)),
        _p=p,
        _A=A,
        _shares=dict(zip(columns, shares, strict=True)),
    )


def _mistakes(
    low: Any, high: Any, tolerance: Any, coordinate: Any, columns: Sequence[str]
) -> list[str]:
    out: list[str] = []
    for name, value in (("low", low), ("high", high)):
        if value is not None and not (_is_number(value) and np.isfinite(value)):
            rule = "must be a separation [m], or None"
            out.append(Problem(name, rule, repr(value), code=Mistake.KIND))
    if not out and low is not None and high is not None and not low < high:
        rule = f"must be below high = {high:g} [m]"
        out.append(Problem("low", rule, f"{low:g}", code=Mistake.ORDER))
    if not (_is_number(tolerance) and 1e-9 <= tolerance <= 0.1):
        rule, hint = "must be from 1e-9 to 0.1 [1]", "it is a relative error"
        out.append(Problem("tolerance", rule, repr(tolerance), hint=hint, code=Mistake.RANGE))
    if coordinate not in COORDINATES:
        rule = "must be 'h' or 'd'"
        out.append(Problem("coordinate", rule, repr(coordinate), code=Mistake.OPTION))
    if isinstance(columns, str) or len(set(columns)) != len(columns):
        rule = "must be a list of different names"
        out.append(Problem("columns", rule, repr(columns), code=Mistake.KIND))
    else:
        options = ", ".join(SHARES)
        out += [
            Problem("columns", f": {c!r} must be one of {options}", code=Mistake.OPTION)
            for c in columns
            if c not in SHARES
        ]
    return out


def _upper_end(contact_interface: Interface, scan: LoadScan) -> float:
    """The largest d that carries `LEAST_LOAD`, or more where the load jumps over it."""
    d, _, status = scan.solve_across_jumps(
        np.array([LEAST_LOAD * contact_interface.contact.E_ss]), "loading"
    )
    if np.isnan(d[0]):
        raise InvalidValue(f"no table: {status.words[0]}; give high [m]", code=Mistake.MISSING)
    return float(d[0])


def _bottom(contact_interface: Interface) -> float:
    return contact_interface.lowest


def _lower_end(contact_interface: Interface, d_high: float) -> float:
    """The separation of A_t = MOST_AREA, of −3 σ_s, or where the load stops to rise on approach."""
    bottom = _bottom(contact_interface)
    d = np.linspace(d_high, bottom, _panel_count(contact_interface, bottom, d_high) * 8)
    F, F1, _ = contact_interface.load(d).T
    good = (F > 0) & (F1 < 0) & (contact_interface.fields(d)["A_t"] <= MOST_AREA)
    stop = int(np.argmin(good)) if not good.all() else len(d)
    if stop == 0 and F1[0] < 0 < F[0]:
        raise InvalidValue(
            f"A_t is above {MOST_AREA:g} at the upper end already, so the range has no natural "
            "lower end; give low [m]",
            code=Mistake.BEYOND,
        )
    if stop == len(d):
        return bottom
    if stop == 0 or F1[stop] >= 0:
        return float(d[max(stop - 1, 0)])
    inside, outside = d[stop - 1], d[stop]
    for _ in range(60):
        middle = 0.5 * (inside + outside)
        if contact_interface.fields(np.array([middle]))["A_t"][0] <= MOST_AREA:
            inside = middle
        else:
            outside = middle
    return float(inside)


def _panel_count(contact_interface: Interface, low: float, high: float) -> int:
    """Panels of the first grid: none wider than half a σ_s, nor too wide to see a narrow size."""
    width = 0.5 * contact_interface.asperities.sigma_s
    if not load_scan(contact_interface).monotone and contact_interface.particles is not None:
        width = min(width, 20 * contact_interface.particles.resolution)
    count = int(np.ceil((high - low) / width))
    if count > MOST_PANELS:
        raise InvalidValue(
            f"the range of {high - low:.4g} m needs {count} panels to see particles "
            f"{width:.3g} m wide; give low and high closer together",
            code=Mistake.BEYOND,
        )
    return max(count, 4)


def _check_range(
    contact_interface: Interface, low: float, high: float, shift: float, name: str
) -> None:
    """The range must be one in which ln p exists."""
    bottom = _bottom(contact_interface)
    if low < bottom - 1e-12 * contact_interface.asperities.sigma_s:
        raise InvalidValue(
            Problem(
                "low",
                f": {name} = {low + shift:.6g} m must be >= {bottom + shift:.6g} m, "
                f"{contact_interface.why_lowest} and the model ends",
                code=Mistake.RANGE,
            )
        )
    if not low < high:
        raise InvalidValue(
            f"the range of {name} from {low + shift:.6g} to {high + shift:.6g} m is empty; give "
            "low and high [m]",
            code=Mistake.ORDER,
        )
    d = np.linspace(low, high, 8 * _panel_count(contact_interface, low, high))
    F = contact_interface.load(d)[:, 0]
    bad = np.flatnonzero(~(F > LEAST_PRESSURE))
    if len(bad):
        at = d[bad[0]]
        what = (
            "the surfaces attract each other and ln p does not exist"
            if F[bad[0]] < 0
            else "nothing touches any more"
        )
        raise InvalidValue(
            Problem(
                "high",
                f": {name} = {high + shift:.6g} m is too far: from {at + shift:.6g} m on {what}",
                hint="leave high out, or give a smaller one",
                code=Mistake.BEYOND,
            )
        )


def _above(contact_interface: Interface, scan: LoadScan, d_high: float, p_last: float) -> float:
    """Largest difference from the exponential tail beyond the range [Pa].

    Both lie between zero and the last pressure, unless the surfaces attract each other or the
    load rises again.
    """
    asperities = contact_interface.asperities
    d = asperities.centre + asperities.sigma_s * np.linspace(asperities.searched, 10, 400)
    pull = 0.0
    if np.any(contact_interface.load(d)[:, 0] < 0):
        pull = pull_off(contact_interface.contact)[0] * (1 + 1e-6)
    most = p_last
    if not load_scan(contact_interface).monotone:
        beyond = scan.log_F[scan.d > d_high]
        most = max([most, *np.exp(beyond) * 1.1])
    return most + pull


class _Panels:
    """Panels of a growing table: the truth at their samples is computed once."""

    def __init__(
        self, contact_interface: Interface, shift: float, columns: Sequence[str], name: str
    ):
        self.interface, self.shift, self.name = contact_interface, shift, name
        self.columns = tuple(columns)

    # ------------------------------------------------------------------ the contact itself
    def truth(self, x: Array) -> Array:
        """p, dp/dx, A_t and the shares: (N, 3 + shares)."""
        d = x - self.shift
        F, F1, _ = self.interface.load(d).T
        fields = self.interface.fields(d)
        shares = {
            "particle_area_share": lambda: fields["A_sa"] / fields["A_t"],
            "particle_load_share": lambda: fields["F_sa"] / (fields["F_ss"] + fields["F_sa"]),
        }
        return np.column_stack([F, F1, fields["A_t"], *(shares[c]() for c in self.columns)])

    def log_slopes(self, x: Array) -> Array:
        """d ln A_t/dx and slopes of the shares at knots, by differences of fourth order."""
        step = np.diff(x)
        step = np.minimum(np.append(step, step[-1]), np.append(step[0], step))
        step = np.minimum(0.25 * step, 1e-3 * self.interface.asperities.sigma_s)
        # steps that the separations can tell
        step = (x + step) - x
        # five places about each knot, at the ends all of them inside the range
        offsets = np.tile(np.arange(-2.0, 3.0)[:, None], len(x))
        offsets[:, 0], offsets[:, -1] = np.arange(5), np.arange(-4, 1)
        weights = np.tile(np.array([1, -8, 0, 8, -1])[:, None] / 12, len(x))
        weights[:, 0] = np.array([-25, 48, -36, 16, -3]) / 12
        weights[:, -1] = -weights[::-1, 0]
        f = self.truth((x + offsets * step).ravel())[:, 2:].reshape(5, len(x), -1)
        f[..., 0] = np.log(f[..., 0])
        slope = np.einsum("kn,knj->nj", weights, f) / step[:, None]
        # a tail that does not grow
        slope[-1, 0] = min(slope[-1, 0], 0.0)
        return slope

    # ------------------------------------------------------------------ refinement
    def refine_panels(
        self, low: float, high: float, tolerance: float
    ) -> tuple[Array, list[Any], dict[str, float]]:
        """Knots, interpolants of p, A_t and the shares, and their errors."""
        x = np.linspace(low, high, _panel_count(self.interface, low, high) + 1)
        reach = [a.reach for a in (self.interface.particles,) if a is not None]
        x = np.unique([*x, *(r + self.shift for r in reach if low < r + self.shift < high)])
        at_knots = self.truth(x)
        inside = self._samples(x[:-1], x[1:])
        while True:
            cubics = self._cubics(x, at_knots)
            errors, falls = self._errors(x, cubics, inside, at_knots)
            stated = SAFETY * errors + ACCURACY
            relevant = np.delete(stated, 1, axis=1)
            bad = np.flatnonzero(~((relevant <= tolerance).all(axis=1) & falls))
            if not len(bad):
                break
            self._give_up(x, bad, at_knots, relevant, tolerance)
            middle = 0.5 * (x[bad] + x[bad + 1])
            new = self.truth(middle)
            left, right = self._samples(x[bad], middle), self._samples(middle, x[bad + 1])
            x, at_knots = np.insert(x, bad + 1, middle), np.insert(at_knots, bad + 1, new, axis=0)
            inside = np.insert(inside, bad + 1, right, axis=0)
            inside[bad + np.arange(len(bad))] = left
        worst = stated.max(axis=0)
        names = ("p", "dp_dh", "A")
        error = {key: float(value) for key, value in zip(names, worst, strict=False)}
        error["shares"] = float(worst[3:].max()) if len(worst) > 3 else 0.0
        return x, cubics, error

    def _samples(self, a: Array, b: Array) -> Array:
        x = a[:, None] + (b - a)[:, None] * _PLACES
        return self.truth(x.ravel()).reshape(*x.shape, -1)

    def _cubics(self, x: Array, at_knots: Array) -> list[Any]:
        slopes = self.log_slopes(x)
        width = np.diff(x)
        p, dp, A = at_knots[:, :3].T
        out: list[Any] = []
        for value, slope in ((p, dp / p), (A, slopes[:, 0])):
            rise = np.log(value[1:] / value[:-1])
            c = _hermite(rise, slope[:-1] * width, slope[1:] * width)
            out.append(
                _LogCubic(x, value[:-1], c, float(value[-1]), float(slope[0]), float(slope[-1]))
            )
        for j in range(len(self.columns)):
            value, slope = at_knots[:, 3 + j], slopes[:, 1 + j]
            c = _hermite(np.diff(value), slope[:-1] * width, slope[1:] * width)
            out.append(np.column_stack([value[:-1], c]))
        return out

    def _errors(
        self, x: Array, cubics: list[Any], inside: Array, at_knots: Array
    ) -> tuple[Array, NDArray[np.bool_]]:
        """Largest error of p, dp/dx, A_t and the shares, panel by panel; whether p falls."""
        s, width = _PLACES, np.diff(x)[:, None]
        p, A, *shares = cubics

        def cubic(c: Array) -> Array:
            return s * (c[:, :1] + s * (c[:, 1:2] + s * c[:, 2:]))

        c = p.c
        # a panel that is still too wide may overflow
        with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
            value = p.left[:, None] * np.exp(cubic(c))
            slope = value * (c[:, :1] + s * (2 * c[:, 1:2] + s * 3 * c[:, 2:])) / width
            columns = [
                value / inside[..., 0] - 1,
                slope / inside[..., 1] - 1,
                A.left[:, None] * np.exp(cubic(A.c)) / inside[..., 2] - 1,
            ]
        for j, share in enumerate(shares):
            columns.append(share[:, :1] + cubic(share[:, 1:]) - inside[..., 3 + j])
        errors = np.stack([np.abs(column).max(axis=1) for column in columns], axis=1)
        self._must_fall(x, inside, at_knots)
        # the derivative of a cubic is largest at an end or at its vertex
        with np.errstate(divide="ignore", invalid="ignore"):
            vertex = np.clip(np.nan_to_num(-c[:, 1] / (3 * c[:, 2])), 0.0, 1.0)
        at = np.stack([np.zeros_like(vertex), vertex, np.ones_like(vertex)])
        steepest = (c[:, 0] + at * (2 * c[:, 1] + at * 3 * c[:, 2])).max(axis=0)
        return np.where(np.isnan(errors), np.inf, errors), steepest < 0

    def _must_fall(self, x: Array, inside: Array, at_knots: Array) -> None:
        """A pressure that rises with the separation has no single gap: refused."""
        rising = np.flatnonzero((inside[..., 1] >= 0).any(axis=1) | (at_knots[:-1, 1] >= 0))
        if len(rising):
            a, b = x[rising[0]], x[rising[-1] + 1]
            raise InvalidValue(
                f"the pressure rises with the separation between {self.name} = {a:.6g} and "
                f"{b:.6g} m, so one pressure would have several gaps; give low >= {b:.6g} m, the "
                f"branch met on approach, or high <= {a:.6g} m",
                code=Mistake.BEYOND,
            )

    def _give_up(
        self, x: Array, bad: NDArray[np.intp], at_knots: Array, stated: Array, tolerance: float
    ) -> None:
        narrow = 1e-13 * np.maximum(np.abs(x[bad]), self.interface.contact.roughness.sigma)
        stuck = bad[np.diff(x)[bad] < narrow]
        if len(stuck):
            i = int(stuck[0])
            near = at_knots[np.abs(x - x[i]) <= 1e-9 * self.interface.asperities.sigma_s]
            spread = near.max(axis=0) - near.min(axis=0)
            jumps = {"p": spread[0] / near[0, 0], "A_t": spread[2] / near[0, 2]}
            jumps |= dict(zip(self.columns, spread[3:], strict=True))
            which = max(jumps, key=lambda key: jumps[key])
            place = f"at {self.name} = {x[i]:.9g} m"
            if jumps[which] > tolerance:
                raise InvalidValue(
                    f"{which} jumps by {jumps[which]:.3g} {place}, so no continuous table is "
                    f"within {tolerance:g}; take a law without jumps, or particles of more than "
                    "one size, or give a range without that place",
                    code=Mistake.BEYOND,
                )
            raise InvalidValue(
                f"the tolerance {tolerance:g} cannot be met {place}: the load is not known that "
                "well there; give a larger tolerance or another range",
                code=Mistake.BEYOND,
            )
        if len(x) > MOST_PANELS:
            raise InvalidValue(
                f"the tolerance {tolerance:g} needs more than {MOST_PANELS} panels; give a larger "
                f"one (met so far: {stated.max():.3g})",
                code=Mistake.TOO_LARGE,
            )


def _hermite(rise: Array, m0: Array, m1: Array) -> Array:
    """c_1, c_2, c_3 of the cubic in s with rise and end slopes, zero at s = 0: (N, 3)."""
    return np.column_stack([m0, 3 * rise - 2 * m0 - m1, m0 + m1 - 2 * rise])
