r"""Traction coefficient against creep increment, by strips; its slope; shear (paper, 4.3, Figs 5 to 7).

In units of the contact: y = a sin(theta); creep X = xi/xi_s with xi_s = 2 mu p0/E*, X = d + sigma sin + eta
sin^2; the strip at theta has c = X/(m cos(theta)) and lam = lam0/cos(theta), and carries (3/4) m cos^3(theta)
d(theta) of mu N, mu being the largest friction and m that of the strip over it (paper, 4.3.1 and Eq. 15). A
worn track is made of pieces in which lam0 and m change linearly with y; any other is one piece. Strips are
Gauss points of panels that end where |X| passes 0 and a geometric series of levels, so that they crowd at the
zero-creep lines however strong the spin.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from separatrix.chain.film_compliance import Profile, pieces_across
from separatrix.chain.hertz import ContactEllipse, Creep
from separatrix.chain.strip import MasterTable, film_tables, master_traction, solve_strip
from separatrix.ground.compiled import kernel, part
from separatrix.ground.errors import InputError
from separatrix.ground.units import Array, Metre, Ratio, format_quantity

GAUSS_NODES, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(5)
SECTORS = np.pi * np.array([-0.5, -0.4, -0.25, 0.0, 0.25, 0.4, 0.5])
LEVELS = np.array([0.0, 0.6, 1.5, 4.0, 16.0, 100.0])
Y_LOW, Y_HIGH, LAM_LOW, LAM_HIGH, M_LOW, M_HIGH = range(6)  # columns of a piece: edges y/a, lam0 and m there

NODES = (200, 400, 800)  # elements a strip of the coarser of two solutions; the finer one has twice as many
TOLERANCE = 0.005  # relative error of a slope above which strips are refined
INTERPOLATION = 3e-4  # largest relative error of a slope by the tables (measured in the tests)
RIGID = 1e-9  # saturation creep over the largest creep that stands for the limit of no friction
THIN = 0.03  # film thickness over semi-minor axis up to which the film in series is used without a warning


class Strips(NamedTuple):
    """A contact in its own units: sigma = s a/xi_s, eta = q a^2/xi_s, and pieces of shape (piece, 6)."""

    sigma: float
    eta: float
    pieces: Array


@part
def creep_at(theta: float, d: float, sigma: float, eta: float) -> float:
    """Creep X = d + sigma y + eta y^2 at y = sin(theta) [-]."""
    y = math.sin(theta)
    return d + (sigma + eta * y) * y


@part
def _roots(d: float, sigma: float, eta: float) -> tuple[float, float]:
    """Places y where d + sigma y + eta y^2 = 0; 2 where there is none."""
    if eta == 0.0:
        return (-d / sigma if sigma != 0.0 else 2.0), 2.0
    discriminant = sigma * sigma - 4.0 * eta * d
    if discriminant < 0.0:
        return 2.0, 2.0
    q = -0.5 * (sigma + math.copysign(math.sqrt(discriminant), sigma))
    return q / eta, (d / q if q != 0.0 else 2.0)


@kernel
def panel_edges(d: float, sigma: float, eta: float, levels: Array, splits: int) -> Array:
    """Edges in theta of the panels, each cut into `splits` equal parts, in order, shape (edge,) [rad].

    Between the sectors and levels lie the places where a bare strip starts to slip: |X| = cos(theta).
    """
    edges = np.empty(4 * levels.size + SECTORS.size + 1)
    edges[: SECTORS.size], count = SECTORS, SECTORS.size
    if eta != 0.0 and abs(sigma) < 2.0 * abs(eta):
        edges[count] = math.asin(-0.5 * sigma / eta)
        count += 1
    for level in levels:
        for side in (-1.0, 1.0):
            for y in _roots(d + side * level, sigma, eta):
                if abs(y) < 1.0:
                    edges[count] = math.asin(y)
                    count += 1
    for k in range(SECTORS.size, count):  # put each in its place; the library's sort takes seconds to compile
        while k > 0 and edges[k] < edges[k - 1]:
            edges[k - 1], edges[k] = edges[k], edges[k - 1]
            k -= 1
    fine = np.empty(2 * count * splits)
    fine[0], size = edges[0], 1
    for k in range(count - 1):
        low, high = edges[k], edges[k + 1]
        first, slips = low, abs(creep_at(low, d, sigma, eta)) > math.cos(low)
        if slips != (abs(creep_at(high, d, sigma, eta)) > math.cos(high)):
            for _ in range(45):
                middle = 0.5 * (low + high)
                if slips == (abs(creep_at(middle, d, sigma, eta)) > math.cos(middle)):
                    low = middle
                else:
                    high = middle
            last = 0.5 * (low + high)
            for i in range(splits):
                fine[size] = first + (last - first) * (i + 1) / splits
                size += 1
            first = last
        for i in range(splits):
            fine[size] = first + (edges[k + 1] - first) * (i + 1) / splits
            size += 1
    return fine[:size]


@kernel
def reach(lam: float, table: MasterTable) -> float:
    """Creep over xi_s at which the tangent at the origin would saturate a strip under a film [-]."""
    return 2.0 / master_traction(0.0, lam, table)[1]


@part
def resultant(d: float, strips: Strips, splits: int, table: MasterTable) -> tuple[float, float]:
    """Traction over mu N and its derivative with d, of the ellipse of strips [-]."""
    force, slope = 0.0, 0.0
    for j in range(strips.pieces.shape[0]):
        piece = strips.pieces[j]
        low, width = piece[Y_LOW], piece[Y_HIGH] - piece[Y_LOW]
        first, last = math.asin(low), math.asin(piece[Y_HIGH])
        middle = 0.5 * (piece[M_LOW] + piece[M_HIGH])
        thick = max(piece[LAM_LOW], piece[LAM_HIGH])
        levels = reach(thick, table) * LEVELS if thick > 0.0 else LEVELS[:2].copy()
        edges = panel_edges(d / middle, strips.sigma / middle, strips.eta / middle, levels, splits)
        for k in range(edges.size - 1):
            start = min(max(edges[k], first), last)
            half = 0.5 * (min(max(edges[k + 1], first), last) - start)
            if half <= 0.0:
                continue
            for i in range(GAUSS_NODES.size):
                theta = start + half * (1.0 + GAUSS_NODES[i])
                cosine, along = math.cos(theta), (math.sin(theta) - low) / width
                lam = piece[LAM_LOW] + (piece[LAM_HIGH] - piece[LAM_LOW]) * along
                m = piece[M_LOW] + (piece[M_HIGH] - piece[M_LOW]) * along
                c = creep_at(theta, d, strips.sigma, strips.eta) / (m * cosine)
                F, dF = master_traction(c, lam / cosine, table)
                share = 0.75 * cosine * cosine * half * GAUSS_WEIGHTS[i]
                force += share * cosine * m * F
                slope += share * dF
    return min(max(force, -1.0), 1.0), slope  # the shares of the strips sum to 1 but for 1e-9


@kernel
def resultants(offsets: Array, strips: Strips, splits: int, table: MasterTable) -> Array:
    """Traction over mu N and its derivative with the offset d at every offset, shape (case, 2) [-]."""
    found = np.empty((offsets.size, 2))
    for i in range(offsets.size):
        found[i, 0], found[i, 1] = resultant(offsets[i], strips, splits, table)
    return found


@part
def highest(sigma: float, eta: float) -> float:
    """Largest value of sigma y + eta y^2 on the ellipse, |y| <= 1 [-]."""
    return -0.25 * sigma * sigma / eta if abs(sigma) < -2.0 * eta else abs(sigma) + eta


@kernel
def free_rolling(strips: Strips, table: MasterTable) -> float:
    """Offset d without net traction: Newton's steps inside a shrinking bracket [-]."""
    sigma, eta = strips.sigma, strips.eta
    if eta == 0.0:
        return 0.0  # spin alone is odd in y
    low, high, size = -highest(sigma, eta), highest(sigma, -eta), abs(sigma) + abs(eta)
    d = 0.5 * (low + high)
    for _ in range(80):
        force, slope = resultant(d, strips, 1, table)
        if force > 0.0:
            high = d
        else:
            low = d
        trial = d - (force / slope if slope > 0.0 else math.inf)
        if not low < trial < high:
            trial = 0.5 * (low + high)
        if abs(trial - d) <= 1e-13 * size or high - low <= 1e-14 * size:
            return trial
        d = trial
    return d


@dataclass(frozen=True, slots=True)
class ScaledContact:
    """One contact as `strips`, its largest friction and its saturation creep xi_s.

    Where nothing is transmitted, for want of friction or load, `friction` is 0 and xi_s the limit of that.
    """

    strips: Strips
    friction: Ratio
    saturation: Ratio

    def local(self, y: Array) -> tuple[Array, Array]:
        """Film lam0 and friction over mu at y/a, shape of y each [-]."""
        pieces = self.strips.pieces
        piece = pieces[np.searchsorted(pieces[1:, Y_LOW], y, side="right")]
        along = (y - piece[:, Y_LOW]) / (piece[:, Y_HIGH] - piece[:, Y_LOW])
        lam, m = (piece[:, low] + (piece[:, low + 1] - piece[:, low]) * along for low in (LAM_LOW, M_LOW))
        return lam, m

    def slope(self, offset: Ratio, table: MasterTable, splits: int = 1) -> Ratio:
        """Slope alpha = dC_T/dxi at an offset over xi_s; `splits` cuts every panel into as many [-]."""
        by_offset = resultants(np.array([offset]), self.strips, splits, table)[0, 1]
        return float(self.friction / self.saturation * by_offset)

    def refined_slope(self, tolerance: Ratio) -> tuple[Ratio, Ratio, int]:
        """Slope at the origin, its error and the coarser number of elements; refined down to the tolerance.

        The error adds what the last halving of the elements and of the strips changed, and the
        interpolation's share.
        """
        slope, error, nodes = 0.0, math.inf, 0
        for nodes in NODES:
            best, fine = film_tables(nodes)
            offset = free_rolling(self.strips, best)
            slope = self.slope(offset, best, splits=2)
            error = abs(slope - self.slope(offset, best)) + INTERPOLATION * slope
            error += abs(slope - self.slope(free_rolling(self.strips, fine), fine))
            if error <= tolerance * slope:
                break
        return slope, error, nodes


def scaled_contact(
    ellipse: ContactEllipse, creep: Creep, friction: Ratio | Profile, compliance: float | Profile
) -> ScaledContact:
    """Dimensionless form of one contact."""
    a, b, p0, E = ellipse.semi_major, ellipse.semi_minor, ellipse.max_pressure, ellipse.contact_modulus
    mu = max(friction.values) if isinstance(friction, Profile) else friction
    pieces, saturation = np.array([[-1.0, 1.0, 0.0, 0.0, 1.0, 1.0]]), 2.0 * mu * p0 / E
    if saturation == 0.0:
        mu = 0.0
        saturation = RIGID * max(abs(creep.spin) * a, abs(creep.curvature) * a * a) or RIGID
    else:
        edges, (films, shares) = pieces_across(a, compliance, friction)
        pieces = np.column_stack([edges[:-1] / a, edges[1:] / a, films * E / b, shares / mu])
    strips = Strips(creep.spin * a / saturation, creep.curvature * a * a / saturation, pieces)
    return ScaledContact(strips, mu, saturation)


@dataclass(frozen=True, slots=True, kw_only=True)
class TractionCurve:
    """Traction coefficient of one contact against the creep increment, shape (case,) each [-].

    `slope` is the paper's alpha = dC_T/d(delta xi) at the origin, `slope_error` bounds its numerical error;
    `free_rolling_offset` is the creep on the centre line at which the contact carries no net traction;
    `nodes` counts the elements of the finest strip.
    """

    creep_increment: Annotated[Array, "-", ("increment",)]  # what an impact of the cage adds to the creep
    traction_coefficient: Annotated[Array, "-", ("increment",)]  # T over N, at each increment
    slope: Ratio
    slope_error: Ratio
    free_rolling_offset: Ratio
    spin_roll_ratio: Ratio
    nodes: int  # elements along the finest strip
    notes: tuple[str, ...] = ()  # where the film leaves the range of its model, a sentence each


def traction_curve(
    ellipse: ContactEllipse,
    creep: Creep,
    *,
    race_friction: Ratio | Profile,
    film_compliance: float | Profile,
    creep_increments: ArrayLike | None = None,
    film_thickness: Metre = 0.0,
    tolerance: Ratio = TOLERANCE,
) -> TractionCurve:
    r"""Traction coefficient against the creep increment of one ball/race contact.

    Positive where the ball is faster than the race: C_T is then the force of the ball on the race along
    rolling, over the load. Without friction, or without load, traction and slope are exactly 0.

    Parameters
    ----------
    ellipse, creep
        Hertz contact, its spin and Heathcote creep.
    race_friction : float or Profile
        Friction f_BT of ball on track, >= 0; a profile across the groove of a worn track is > 0 [-].
    film_compliance : float or Profile
        Shear compliance L = h/G of the film in series, >= 0 [m/Pa].
    creep_increments : array or None
        Where to compute, shape (case,) [-]; None takes 41 points that span saturation both ways.
    film_thickness : float
        Total thickness of the film [m]; only to note where the film in series is out of its range.
    tolerance : float
        Relative error of the slope above which strips are refined, from 400 to at most 1600 elements [-].

    Raises
    ------
    InputError
        A negative or non-finite number.

    Notes
    -----
    Paper, Eqs 2, 12-15 and Fig. 7, with the rolling entry condition (docs/theory/traction.md). Odd in the
    increment if the creep is pure spin or none, and the track symmetric; bounded by race_friction.
    """
    _check(race_friction=race_friction, film_compliance=film_compliance, film_thickness=film_thickness)
    case = scaled_contact(ellipse, creep, race_friction, film_compliance)
    slope, error, nodes = case.refined_slope(tolerance)
    table = film_tables(nodes)[0]
    offset = free_rolling(case.strips, table)
    if creep_increments is None:
        _, _, pieces = case.strips
        span = 2.5 * reach(float(pieces[:, [LAM_LOW, LAM_HIGH]].max()), table)
        span += 1.5 * (abs(case.strips.sigma) + abs(case.strips.eta))
        creep_increments = span * case.saturation * np.linspace(-1.0, 1.0, 41)
    increments = np.asarray(creep_increments, dtype=np.float64)
    forces = resultants(offset + increments / case.saturation, case.strips, 1, table)[:, 0]
    return TractionCurve(
        creep_increment=increments,
        traction_coefficient=case.friction * forces + 0.0,  # without friction no -0
        slope=slope,
        slope_error=error,
        free_rolling_offset=offset * case.saturation,
        spin_roll_ratio=creep.spin / ellipse.curvature_rolling,
        nodes=2 * nodes,
        notes=_not_thin(film_thickness, ellipse.semi_minor),
    )


def traction_slope(
    ellipse: ContactEllipse,
    creep: Creep,
    *,
    race_friction: Ratio | Profile,
    film_compliance: float | Profile,
    tolerance: Ratio = TOLERANCE,
) -> tuple[Ratio, Ratio]:
    """Slope alpha of the curve at the origin and a bound of its numerical error [-]; see `traction_curve`."""
    _check(race_friction=race_friction, film_compliance=film_compliance)
    return scaled_contact(ellipse, creep, race_friction, film_compliance).refined_slope(tolerance)[:2]


def _not_thin(thickness: Metre, semi_minor: Metre) -> tuple[str, ...]:
    """A sentence where a film is too thick to be in series."""
    if not thickness > THIN * semi_minor > 0.0:
        return ()
    return (
        f"The film of {format_quantity(thickness, 'm', 3)} is {thickness / semi_minor:.3g} of the semi-minor "
        f"axis. Up to {THIN:g} a film in series is within 1.2 % of a layer; beyond, the slope may "
        'be further off. [traction] model = "exact" computes an even film as a layer.',
    )


def _check(**values: float | Profile) -> None:
    """Refuse a friction [-], compliance [m/Pa] or thickness [m] that is negative or not finite."""
    units = {"race_friction": "-", "film_compliance": "m/Pa", "film_thickness": "m"}
    for name, value in values.items():
        if isinstance(value, Profile):
            if name == "race_friction" and not min(value.values) > 0.0:
                raise InputError(f"traction: {name}", "must be > 0 everywhere [-]", f"{min(value.values):g}")
        elif not 0.0 <= value < math.inf:
            raise InputError(f"traction: {name}", f"must be finite and >= 0 [{units[name]}]", f"{value:g}")


@dataclass(frozen=True, slots=True, kw_only=True)
class ShearField:
    """Traction over the ellipse from direct strips, the solution of each without tables."""

    across: Annotated[Array, "m", ("strip",)]  # place of each strip
    along: Annotated[Array, "m", ("strip", "node")]  # place of each element, leading edge first
    creep_ratio: Annotated[Array, "-", ("strip",)]  # of ball and race, over the rolling speed
    pressure: Annotated[Array, "Pa", ("strip", "node")]  # by Hertz
    bound: Annotated[Array, "Pa", ("strip", "node")]  # friction times pressure
    shear: Annotated[Array, "Pa", ("strip", "node")]  # tangential traction
    shear_without_slip: Annotated[Array, "Pa", ("strip", "node")]  # shear of a contact that sticks throughout
    slip: Annotated[Array, ("strip", "node")]  # 0 in stick, else the sign of the slip
    sweeps: Annotated[Array, ("strip",)]  # solutions until the strip's stick zone settled


def shear_field(
    ellipse: ContactEllipse,
    creep: Creep,
    *,
    race_friction: Ratio | Profile,
    film_compliance: float | Profile,
    creep_increment: Ratio = 0.0,
    strips: int = 41,
    nodes: int = 100,
) -> ShearField:
    """Shear over the ellipse at one creep increment (paper, Figs 5 and 6); ``strips=1`` the middle strip.

    Strips are of equal width across the ellipse, with `nodes` elements along each. The increment counts from
    free rolling and is positive where the ball is faster.
    """
    case = scaled_contact(ellipse, creep, race_friction, film_compliance)
    y = 2.0 * (np.arange(strips) + 0.5) / strips - 1.0
    offset = free_rolling(case.strips, film_tables(NODES[0])[0]) * case.saturation
    xi = creep.ratio(y * ellipse.semi_major, offset + creep_increment)
    half = np.sqrt(1.0 - y * y)  # b(y)/b, and p0(y)/p0
    films, shares = case.local(y)
    solved = [
        solve_strip(c, lam, nodes=nodes)
        for c, lam in zip(xi / (case.saturation * shares * half), films / half, strict=True)
    ]
    pressure = ellipse.max_pressure * half[:, None]
    bound = case.friction * shares[:, None] * pressure
    return ShearField(
        across=y * ellipse.semi_major,
        along=ellipse.semi_minor * half[:, None] * solved[0].along,
        creep_ratio=xi,
        pressure=pressure * solved[0].pressure,
        bound=bound * solved[0].pressure,
        shear=bound * np.array([s.shear for s in solved]),
        shear_without_slip=bound * np.array([s.stuck for s in solved]),
        slip=np.array([s.slip for s in solved]),
        sweeps=np.array([s.sweeps for s in solved]),
    )
