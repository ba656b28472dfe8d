"""Traction of a ball on one race, by strips or by the exact contact, and where the strips leave their range.

The film is a layer on the race, as thick as the study's film in all; a worn one, whose thickness varies, is
in series. Of it the cage takes, for a pushed ball of one state, a mass and a law of traction; for a free one
two slip fields.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from separatrix.chain.exact.influence import Body, Layer, solid
from separatrix.chain.exact.pressure import pressed_contact
from separatrix.chain.exact.rolling import ContactProblem, rigid_slip, rolling_contact, solve_each
from separatrix.chain.exact.slip import FrictionLaw
from separatrix.chain.exact.slope import COLUMNS, ROWS, RaceSlope, traction_slope
from separatrix.chain.film_compliance import track_of
from separatrix.chain.hertz import ContactEllipse, Creep
from separatrix.chain.traction_curve import ShearField, TractionCurve, shear_field, traction_curve
from separatrix.ground.errors import ConvergenceError, InputError
from separatrix.ground.schema import Fault, Faults, check, key, positive, record
from separatrix.ground.units import (
    Array,
    Kilogram,
    KilogramMetre2,
    Metre,
    MetrePerSecond,
    Newton,
    NewtonSecondPerMetre,
    Pascal,
    PerSecond,
    Ratio,
)
from separatrix.study.study import (
    ContactPressure,
    Film,
    Material,
    PressureSlip,
    Race,
    TractionModel,
    TractionSettings,
)

REMEMBERED = 512
"""Exact contacts that are kept, by the records they are made of."""

SLOPE_ALONE = np.empty(0)
"""Increments of a curve of which only the slope is asked."""

STRIPS = TractionSettings()

STRAINED: Ratio = 0.1
"""Film strain p0/M_c from which a film is no longer linearly elastic."""

SQUEEZED: Ratio = 0.01
"""Film strain times thickness over the approach from which a film may change the pressure."""

NOTICED: Ratio = 0.2
"""Slip by the pressure over the saturation creep that is named: it moves free rolling by that."""

CLOSE: Ratio = 0.03
"""Difference of slopes that is named: a bearing's contacts without a soft film are closer."""

LATERAL: Ratio = 0.05
"""Lateral force over mu N from which it is named: strips have none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RaceTrack:
    """What rolls on what: contact of a ball with a race, their creep, materials and film."""

    ellipse: ContactEllipse
    creep: Creep
    race: Race
    ball: Material
    ring: Material
    film: Film

    @property
    def is_idle(self) -> bool:
        """Whether nothing is transmitted: no friction or no load."""
        return self.film.race_friction == 0.0 or self.ellipse.load == 0.0


def contact_traction(
    track: RaceTrack, settings: TractionSettings, increments: Array | None = None
) -> TractionCurve:
    """Traction curve of a contact and its slope, by the model of the settings.

    Without creep increments it takes those of `traction_curve`, and with `SLOPE_ALONE` none: each costs the
    exact contact a solution.

    Raises
    ------
    InputError
        A film that the exact contact does not take: too thick, nearly incompressible, or compressed to
        nothing.
    ConvergenceError
        Free rolling or a point of the exact curve did not settle.
    """
    film, ellipse, by_strips = track.film, track.ellipse, settings.model is TractionModel.STRIPS
    is_coated = settings.pressure is ContactPressure.COATED and film.body is not None and not track.is_idle
    if by_strips and is_coated:
        ellipse = coated_ellipse(track)
    friction, compliance = track_of(film, track.race, ellipse.semi_major)
    plain = traction_curve(
        ellipse,
        track.creep,
        race_friction=friction,
        film_compliance=compliance,
        film_thickness=film.thickness or 0.0,
        creep_increments=increments,
    )
    if by_strips or track.is_idle:
        return plain
    found = exact_slope(track, settings)
    return replace(
        plain,
        traction_coefficient=_exact_coefficients(track, settings, plain.creep_increment),
        slope=found.slope,
        slope_error=found.slope_error,
        free_rolling_offset=found.free_rolling_offset,
        nodes=COLUMNS[1],
        notes=found.solution.notes,
    )


@lru_cache(maxsize=REMEMBERED)
def exact_slope(track: RaceTrack, settings: TractionSettings) -> RaceSlope:
    """The exact contact in free rolling and the slope there; remembered by the value of the records."""
    return traction_slope(contact_problem(track, settings), track.creep)


def _exact_coefficients(track: RaceTrack, settings: TractionSettings, increments: Array) -> Array:
    """Traction coefficients at increments from free rolling, on the finer of the grids of its slope."""
    if increments.size == 0:
        return increments
    found, problem, creep = exact_slope(track, settings), contact_problem(track, settings), track.creep
    rows = ROWS if problem.own_pressure else found.solution.across.size
    made = rolling_contact(problem, columns=COLUMNS[1], rows=rows)
    slips = (
        rigid_slip(
            made.grid,
            longitudinal=found.free_rolling_offset + float(increment),
            spin=creep.spin,
            curvature=creep.curvature,
        )
        for increment in increments
    )
    coefficients = []
    for solution in solve_each(made, slips):
        if isinstance(solution, ConvergenceError):
            raise solution
        coefficients.append(solution.traction_coefficient)
    return np.array(coefficients)


def contact_problem(track: RaceTrack, settings: TractionSettings) -> ContactProblem:
    """The exact contact of a race."""
    film = track.film
    ball, ring = (solid(m.elastic_modulus, m.poisson_ratio) for m in (track.ball, track.ring))
    layers: tuple[Layer, ...] = ()
    is_worn = film.wear is not None and film.wear.touches(track.race)
    if film.body is not None and film.thickness is not None and not is_worn:
        coat = solid(film.body.elastic_modulus, film.body.poisson_ratio)
        layers = (Layer(thickness=film.thickness, solid=coat),)
    friction, compliance = track_of(film, track.race, track.ellipse.semi_major)
    return ContactProblem(
        ellipse=track.ellipse,
        bodies=(Body(base=ball), Body(base=ring, layers=layers)),
        friction=FrictionLaw(coefficient=friction),
        film_compliance=compliance if is_worn else 0.0,
        own_pressure=settings.pressure is ContactPressure.COATED and bool(layers),
        coupled=settings.pressure_slip is PressureSlip.INCLUDED,
    )


@lru_cache(maxsize=REMEMBERED)
def coated_ellipse(track: RaceTrack) -> ContactEllipse:
    """Ellipse with the area and the length along rolling of the contact of the coated bodies.

    Its pressure is Hertz's form with the largest value that the load gives it.
    """
    whole = replace(track.film, wear=None)
    bodies = contact_problem(replace(track, film=whole), STRIPS).bodies
    grid, _, _ = pressed_contact(track.ellipse, bodies, columns=COLUMNS[1], rows=ROWS)
    area = float(grid.fraction.sum()) * grid.cell_area
    b = 0.5 * float(grid.fraction.sum(axis=1).max()) * grid.dx
    p0 = 1.5 * track.ellipse.load / area
    return replace(track.ellipse, semi_minor=b, semi_major=area / (math.pi * b), max_pressure=p0)


def beyond_strips(tracks: tuple[RaceTrack, RaceTrack], asked: TractionSettings) -> Iterator[str]:
    """Where the strips leave their range: a sentence each, from the exact contact in free rolling."""
    by_hertz = asked.by(TractionModel.EXACT, ContactPressure.HERTZ)
    try:
        found = [exact_slope(track, asked.by(TractionModel.EXACT)).solution for track in tracks]
    except (InputError, ConvergenceError) as error:
        yield f"The exact contact has no answer to compare the strips with: {error}"
        return
    off = _apart(tracks, STRIPS, by_hertz)
    if off > CLOSE:
        yield f"The slopes by strips are up to {100.0 * off:.0f} % off those of the exact contact."
    is_soft = all(track.film.wear is None for track in tracks) and any(
        film_strain(track, track.ellipse.max_pressure) * (track.film.thickness or 0.0)
        > SQUEEZED * track.ellipse.approach
        for track in tracks
    )
    is_pressed = is_soft or asked.pressure is ContactPressure.COATED
    by_coated = asked.by(TractionModel.EXACT, ContactPressure.COATED)
    pressed = _apart(tracks, by_coated, by_hertz) if is_pressed else 0.0
    if pressed > CLOSE:
        yield (
            f"The film changes the pressure, and with it the slopes by up to {100.0 * pressed:.0f} %: "
            'consider [traction] pressure = "coated".'
        )
    strain = max(film_strain(track, one.max_pressure) for track, one in zip(tracks, found, strict=True))
    if strain > STRAINED:
        yield (
            f"The pressure compresses the film by {100.0 * strain:.0f} % of its thickness: above "
            f"{100.0 * STRAINED:.0f} % it is not linearly elastic, as every model here takes it to be."
        )
    try:
        slip = max(map(pressure_slip, tracks))
    except InputError as error:  # own pressure is bearable, Hertz's, by which strips are compared, is not
        yield f"Under Hertz's pressure the exact contact has no answer to compare the strips with: {error}"
        slip = 0.0
    if slip > NOTICED and asked.pressure_slip is PressureSlip.NEGLECTED:
        yield (
            f"The pressure alone makes the surfaces slip by up to {slip:.2g} times the saturation creep: "
            'consider [traction] model = "exact" with pressure_slip = "included".'
        )
    lateral = max(
        abs(one.lateral_force / (track.film.race_friction * track.ellipse.load))
        for track, one in zip(tracks, found, strict=True)
    )
    if lateral > LATERAL:
        yield (
            f"Spin pushes the ball across the groove with up to {100.0 * lateral:.0f} % of friction times "
            "load; strips have no such force."
        )


def _apart(tracks: tuple[RaceTrack, RaceTrack], *models: TractionSettings) -> Ratio:
    """Largest relative difference of the slopes by two models; 0 where one of them has no answer."""
    try:
        pairs = [[contact_traction(track, model, SLOPE_ALONE).slope for model in models] for track in tracks]
    except (InputError, ConvergenceError):
        return 0.0
    return max(abs(x / y - 1.0) for x, y in pairs)


def film_strain(track: RaceTrack, pressure: Pascal) -> Ratio:
    """Compression of the film by a pressure over its thickness; 0 without a film."""
    material = track.film.body
    if material is None:
        return 0.0
    return pressure / solid(material.elastic_modulus, material.poisson_ratio).compression_modulus


def pressure_slip(track: RaceTrack) -> Ratio:
    """Largest slip by the pressure, between unlike or coated bodies, over the saturation creep 2 mu p0/E*."""
    settings = TractionSettings(model=TractionModel.EXACT, pressure_slip=PressureSlip.INCLUDED)
    contact = rolling_contact(contact_problem(track, settings), columns=COLUMNS[0], rows=ROWS // 2)
    saturation = 2.0 * track.film.race_friction * track.ellipse.max_pressure / track.ellipse.contact_modulus
    return float(np.abs(contact.coupling).max()) / saturation


SPIN_ROLL_RATIOS = (0.0, 0.1, 0.2, 0.4, 0.8)
"""Pivoting-to-rolling ratios at which the traction curves are drawn, as in the paper's Fig. 7."""

SATURATED = 0.995
"""Share of the whole friction from which a traction curve counts as flat in a figure."""


def shown_curve(track: RaceTrack, settings: TractionSettings) -> TractionCurve:
    """Curve of one contact at 101 increments, up to a quarter beyond those at which it is saturated."""
    widest = float(contact_traction(track, STRIPS).creep_increment[-1])
    finer = contact_traction(track, STRIPS, widest * np.sinh(np.linspace(-6.0, 6.0, 201)) / math.sinh(6.0))
    coefficient = np.abs(finer.traction_coefficient)
    rising = coefficient < SATURATED * coefficient.max()
    farthest = float(np.abs(finer.creep_increment[rising]).max(initial=0.0))
    return contact_traction(
        track, settings, np.linspace(-1.0, 1.0, 101) * min(1.25 * farthest or widest, widest)
    )


def curves_by_ratio(track: RaceTrack, curve: TractionCurve) -> tuple[TractionCurve, ...]:
    """Traction curves by strips at `SPIN_ROLL_RATIOS`, with the sign and at the increments of a curve."""
    own = track.creep.spin
    spins = (math.copysign(ratio, own) * track.ellipse.curvature_rolling for ratio in SPIN_ROLL_RATIOS)
    tracks = (replace(track, creep=replace(track.creep, spin=spin)) for spin in spins)
    return tuple(contact_traction(one, STRIPS, curve.creep_increment) for one in tracks)


def shear(track: RaceTrack) -> ShearField:
    """Shear in five strips of a contact in free rolling (the paper's Fig. 6)."""
    friction, compliance = track_of(track.film, track.race, track.ellipse.semi_major)
    return shear_field(
        track.ellipse, track.creep, race_friction=friction, film_compliance=compliance, strips=5
    )


@record
class BallTraction:
    r"""A ball of one state: :math:`m_e \dot u = N - F(u)`, :math:`F(u) = C u / (1 + (u/v)^4)^{1/4}`.

    u is the speed beyond its free orbit. The slip fields of bearings have the knee of this power within 1 to
    2 % of the capacity (docs/theory/mobility.md).
    """

    mass: Kilogram = key(positive(1e-12, 1e3))  # m_e, of the ball with the spin that follows it at once
    slope: NewtonSecondPerMetre = key(positive(1e-12, 1e12))  # C
    speed: MetrePerSecond  # v, above which the races slide; infinite for a damper

    @property
    def capacity(self) -> Newton:
        """Largest force of the law, at infinite speed; infinite with a damper."""
        return self.slope * self.speed

    def stiffened(self, ratio: float) -> BallTraction:
        """Return the law with a slope this many times as large, of the same capacity and mass."""
        return replace(self, slope=self.slope * ratio, speed=self.speed / ratio)

    def force(self, speed: Array) -> Array:
        """F(u) at speeds beyond the free orbit, same shape [N]."""
        u = np.asarray(speed, dtype=np.float64)
        return np.asarray(self.slope * u / (1.0 + (u / self.speed) ** 4) ** 0.25)


@check(BallTraction)
def _knee_above_rest(speed: MetrePerSecond) -> Faults:
    """The knee is at a speed above zero; it may be infinite."""
    if not speed > 0.0:
        yield Fault("speed", "must be > 0 [m/s]")


@dataclass(frozen=True, slots=True, kw_only=True)
class SlipField:
    """One race at a free ball in steady rolling, seen from the ball."""

    normal_axial: Ratio  # direction from the ball's centre to the contact, along the axis
    normal_radial: Ratio  # and outward
    limit: Newton  # friction times load
    semi_major: Metre  # half the ellipse across the groove
    axis_ratio: Ratio  # its other half over it
    slip: MetrePerSecond  # of the middle along the orbit
    pivoting: MetrePerSecond  # half the ellipse times the pivoting speed
    heathcote: MetrePerSecond  # slip of the ellipse's ends against its middle, as the pressed surface curves
    elastic_slip: MetrePerSecond  # slip that elastic creep makes of full friction

    def stiffened(self, ratio: float) -> SlipField:
        """Return the race that has the same tractions at slips this many times smaller."""
        slips = ("slip", "pivoting", "heathcote", "elastic_slip")
        return replace(self, **{name: getattr(self, name) / ratio for name in slips})


@dataclass(frozen=True, slots=True, kw_only=True)
class FreeBall:
    """A ball with its mass, both races' slip fields, and the fastest rate of its small motions."""

    mass: Kilogram  # of the ball
    inertia: KilogramMetre2  # moment of inertia of the ball
    inner: SlipField  # slip field of the inner race
    outer: SlipField  # slip field of the outer race
    fastest_rate: PerSecond  # of the ball's small motions

    @property
    def capacity(self) -> Newton:
        """Largest force that both races hold, f_BT (Q_i + Q_o) [N]."""
        return self.inner.limit + self.outer.limit

    def stiffened(self, ratio: float) -> FreeBall:
        """Return the ball between races that have the same tractions at slips this many times smaller."""
        races = {name: getattr(self, name).stiffened(ratio) for name in ("inner", "outer")}
        return replace(self, **races, fastest_rate=self.fastest_rate * ratio)

    def __post_init__(self) -> None:
        if not all(
            math.isfinite(x) and x > 0.0 for x in (self.mass, self.inertia, self.capacity, self.fastest_rate)
        ):
            raise InputError("FreeBall", "must have a mass, an inertia, loads and rates above zero")
