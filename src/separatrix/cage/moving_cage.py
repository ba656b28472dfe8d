"""The moving cage: one frozen record of the numbers of its equations."""

from __future__ import annotations

import math
from dataclasses import fields, replace
from itertools import chain
from typing import TYPE_CHECKING, Annotated, ClassVar

import numpy as np

from separatrix.chain.impact_restitution import hertz_coefficient_for
from separatrix.chain.race_traction import BallTraction, FreeBall
from separatrix.ground.errors import InputError
from separatrix.ground.schema import (
    Fault,
    Faults,
    between,
    check,
    key,
    not_negative,
    one_of,
    positive,
    record,
)
from separatrix.ground.units import (
    Array,
    Kilogram,
    KilogramMetre,
    KilogramMetre2,
    Metre,
    MetrePerSecond,
    MetrePerSecond2,
    NewtonPerMetre,
    NewtonPerMetre1_5,
    NewtonSecondPerMetre,
    PerSecond,
    Radian,
    RadianPerSecond,
    Ratio,
    Second,
    format_quantity,
)
from separatrix.study import cage_design
from separatrix.study.cage_design import CageDesign
from separatrix.study.study import BallModel, Guidance, MotionModel, PocketContact, PocketShape

if TYPE_CHECKING:
    from separatrix.chain.solution import Solution

FAST: MetrePerSecond = 1e6
"""Surface speed of a ball whose spin is not given: its direction alone decides where friction acts."""

LEVER: Metre = 1e-9
"""Distance of the friction from the centre of a ball whose diameter is not given: as good as none."""


_SAME = cage_design.POCKET_AND_LAND
_SIZE, _AMOUNT, _RADIUS = positive(1e-30, 1e12), between(0.0, 1e12), positive(1e-9, 1e3)
_TURNS, _SPEEDS, _AMOUNTS = between(-1e7, 1e7), between(-1e12, 1e12), between(-1e3, 1e3)


@record
class MovingCage:
    """A cage among balls that the races guide, moving in the bearing plane or in space.

    The plane is space with tilt and axial motion held. Axes: x and y in the bearing plane, z along the
    bearing axis; the frame turns with the ball set. Tilts are small. Scatters are drawn run by run.

    Raises
    ------
    InputError
        A size is not finite or has the wrong sign, or sizes contradict each other.
    """

    RULES: ClassVar = (one_of("pocket_angles", "pocket_spacing_scatter"),)

    mass: Kilogram = key(_SIZE)  # M
    moment_of_inertia: KilogramMetre2 = key(_SIZE)  # J about the axis; a thin ring has M R^2
    transverse_inertia: KilogramMetre2 | None = key(_SIZE, default=None)  # about a diameter; None: J/2
    ball_count: int = key(between(1, 1000))  # number of balls
    pitch_radius: Metre = key(_SIZE)  # R, where balls and pockets meet
    cage_speed: RadianPerSecond = key(_TURNS)  # Omega of the ball set
    inner_speed: RadianPerSecond = key(_TURNS)  # of the inner ring
    outer_speed: RadianPerSecond = key(_TURNS)  # of the outer ring
    motion: MotionModel = key(default=MotionModel.PLANE)  # in the plane or in space
    pocket_clearance: Metre = key(not_negative(10.0))  # along the orbit, stop to stop, 2 c_p; 0: gripped
    ball_cage_stiffness: NewtonPerMetre = key(_SIZE)  # k_BC, in series with race_damping
    race_damping: NewtonSecondPerMetre  # C_mu; infinite: a ball gripped by its races
    ball_cage_friction: Ratio = key(_AMOUNT)  # f_BC
    ball_spin: Annotated[tuple[RadianPerSecond, ...], ("axis",)] | None = key(
        _SPEEDS, default=None, length=(3, 3)
    )
    """Spin of a ball relative to its orbit: along the axis, outward, and along the orbit. None: about the
    axis, so fast that it alone decides where friction acts."""
    ball_diameter: Metre = key(_AMOUNT, default=0.0)  # friction acts at half of it; 0: at the centre
    traction: BallTraction | None = None  # of a ball of one state; None: the paper's damper
    free_ball: FreeBall | None = None  # of a ball whose three spins are states too
    guidance: Guidance = key(default=Guidance.BALL)  # by the outer land, the inner land, or the balls
    land_clearance: Metre | None = key(positive(1e-9, 10.0), default=None)  # diametral
    land_friction: Ratio = key(_AMOUNT, default=0.1)  # of the cage on its land
    land_stiffness: NewtonPerMetre = key(_SIZE, default=1e7)  # of each land
    land_restitution: Ratio = _SAME["land_restitution"]()  # of an impact on the land
    land_count: int = _SAME["land_count"]()  # 2 for a land on each side of the balls
    land_spacing: Metre | None = None  # between the middles of two lands
    land_width: Metre = key(_AMOUNT, default=0.0)  # of each land
    land_radius: Metre | None = key(_RADIUS, default=None)  # of friction; None: the pitch radius
    land_out_of_round: Metre = _SAME["land_out_of_round"]()  # amplitude of its lobes
    land_lobes: int = _SAME["land_lobes"]()  # lobes of the cage's land
    unbalance: KilogramMetre = key(_AMOUNT, default=0.0)  # mass times eccentricity
    dynamic_unbalance: Radian = key(between(0.0, 0.1), default=0.0)  # to its principal axis
    gravity: MetrePerSecond2 = key(_AMOUNT, default=0.0)  # across the axis, along azimuth 0
    axial_gravity: MetrePerSecond2 = key(between(-1e6, 1e6), default=0.0)  # gravity along the axis
    added_mass: Kilogram = key(_AMOUNT, default=0.0)  # of fluid that moves along, across the axis
    fluid_speed: RadianPerSecond = key(_TURNS, default=0.0)  # W, mean speed of that fluid round the axis
    fluid_damping: NewtonSecondPerMetre = key(_AMOUNT, default=0.0)  # its drag across the axis
    orbit_by_diameter: PerSecond = key(_TURNS, default=0.0)  # orbital speed over the diameter of a ball
    balls_at_walls: bool = False  # runs start with each ball at the wall to which its diameter makes it run
    pocket_shape: PocketShape = key(default=PocketShape.SQUARE)  # wall of a pocket, seen along the radius
    pocket_axial_clearance: Metre | None = _SAME["pocket_axial_clearance"]()  # stop to stop
    pocket_axial_offset: Metre = _SAME["pocket_axial_offset"]()  # in space at the start
    pocket_radial_offset: Metre = key(between(-10.0, 10.0), default=0.0)  # of spherical ones, outward
    hertz_coefficient: NewtonPerMetre1_5 | None = key(positive(1e-3, 1e18), default=None)  # K of N = K d^1.5
    pocket_angles: Annotated[tuple[Radian, ...], ("pocket",)] = key(default=())  # empty: even
    pocket_spacing_scatter: Ratio = _SAME["pocket_spacing_scatter"]()  # of the pitch, uniform
    ball_diameter_scatter: Metre = _SAME["ball_diameter_scatter"]()  # normal, cut at 3
    pocket_position_scatter: Metre = _SAME["pocket_position_scatter"]()  # the same, along the orbit
    groove_damping: NewtonSecondPerMetre = math.inf  # of a ball pushed along its grooves; infinite: held
    groove_stiffness: NewtonPerMetre = key(_AMOUNT, default=0.0)
    pivot_speed: MetrePerSecond = key(_AMOUNT, default=0.0)  # below it pivoting lowers friction
    inner_radius: Metre | None = key(_RADIUS, default=None)  # of the walls; None: no edge
    outer_radius: Metre | None = key(_RADIUS, default=None)  # of the cage, where the walls of pockets end
    orbital_cosines: Annotated[tuple[MetrePerSecond, ...], ("harmonic",)] = key(_SPEEDS, default=())
    """A_h: a free ball at azimuth p, fixed in space and 0 along the radial load, is faster than the ball set
    by the sum of A_h cos h p + B_h sin h p over h = 1, 2, ..."""
    orbital_sines: Annotated[tuple[MetrePerSecond, ...], ("harmonic",)] = key(_SPEEDS, default=())  # B_h
    capacity_waves: Annotated[tuple[Ratio, ...], ("capacity_wave",)] = key(_AMOUNTS, default=())
    """Most that the races hold of a ball at azimuth p, over that of `traction` or `free_ball`: its mean, then
    pairs of A_h, B_h. Empty: all balls alike."""
    slope_waves: Annotated[tuple[Ratio, ...], ("slope_wave",)] = key(_AMOUNTS, default=())
    """The same of the slope of `traction`."""
    ramp_time: Second = key(not_negative(1e4), default=0.0)  # in which all speeds rise; 0: none
    ramp_start: Ratio = key(between(0.0, 1.0, open_low=True), default=0.1)  # of the speeds, at its start
    axial_kick: Ratio = key(_AMOUNT, default=0.0)  # of a disturbance, along the axis
    tilt_kick: Ratio = key(_AMOUNT, default=0.0)  # at the rim by tilting
    is_tilt_held: bool = False  # the cage may not tilt
    is_axially_held: bool = False  # it may not move along the axis

    @property
    def is_in_space(self) -> bool:
        """Whether the cage tilts and moves along the axis."""
        return self.motion is MotionModel.SPACE

    @property
    def is_wrapped(self) -> bool:
        """Whether the pockets wrap round their balls."""
        return self.pocket_shape is PocketShape.SPHERICAL

    @property
    def is_guided(self) -> bool:
        """Whether a land or the pockets hold the centre of the cage."""
        return self.is_wrapped or math.isfinite(self.land_gap)

    @property
    def half_play(self) -> Metre:
        """c_p, half the clearance of a ball along the circumference, after shape and offsets [m]."""
        play, out = cage_design.half_play(self), self.pocket_radial_offset
        return math.sqrt((play - out) * (play + out)) if out else play

    @property
    def slow_damping(self) -> NewtonSecondPerMetre:
        """Damping of a ball that is pushed slowly: C_mu, or the mean slope of the law of traction [N s/m]."""
        if self.traction is None:
            return self.race_damping
        return self.traction.slope * (self.slope_waves[0] if self.slope_waves else 1.0)

    @property
    def transverse(self) -> KilogramMetre2:
        """Moment of inertia about a diameter: as given, or of a thin ring [kg m2]."""
        return 0.5 * self.moment_of_inertia if self.transverse_inertia is None else self.transverse_inertia

    @property
    def spin(self) -> tuple[RadianPerSecond, RadianPerSecond, RadianPerSecond]:
        """Spin of a ball: as given, or about the axis and as good as infinite [rad/s]."""
        if self.ball_spin is None:
            return (-FAST / self.lever * self.friction_sense, 0.0, 0.0)
        axial, outward, along = self.ball_spin
        return (axial, outward, along)

    @property
    def lever(self) -> Metre:
        """Distance of the pocket's friction from the ball's centre [m]; next to none without a diameter."""
        return self.ball_diameter / 2.0 or LEVER

    @property
    def ball_angles(self) -> tuple[Radian, ...]:
        """Angle of each ball with its pocket, before any scatter [rad]."""
        even = (2.0 * math.pi * j / self.ball_count for j in range(self.ball_count))
        return self.pocket_angles or tuple(even)

    @property
    def lead_amplitude(self) -> Metre:
        """Largest lead or lag of a free ball, from its uneven orbital speed [m]."""
        return float(np.abs(self.free_leads(np.linspace(0.0, 2.0 * math.pi, 361))).max())

    @property
    def notes(self) -> tuple[str, ...]:
        """A sentence where free balls would lead and lag by more than their clearance."""
        if not self.lead_amplitude > self.half_play:
            return ()
        lead, clearance = (format_quantity(x, "m", 3) for x in (self.lead_amplitude, self.half_play))
        return (
            f"Unconstrained, the balls would lead and lag by up to {lead} under this load, more than half "
            f"their clearance in a pocket, {clearance}: the cage has to drive them, which adds load and "
            "wear.",
        )

    @property
    def land_gap(self) -> Metre:
        """Offset of the cage centre at which it touches its land [m]; infinite without a land."""
        if self.guidance is Guidance.BALL or self.land_clearance is None:
            return math.inf
        return self.land_clearance / 2

    @property
    def wall_margins(self) -> tuple[Metre, Metre]:
        """Way of the cage outward, and inward, at a ball until the wall of its pocket ends beside it [m].

        A wall touches a ball at its equator, at the height of the ball's centre, up to half the pocket's
        length along the orbit; infinite where no diameter of the cage is given, or the wall is a sphere.
        """
        if self.is_wrapped:
            return math.inf, math.inf
        half = (self.ball_diameter + self.pocket_clearance) / 2.0 + 1.5 * self.ball_diameter_scatter
        outer = math.inf if self.outer_radius is None else self.outer_radius
        inward = math.inf if math.isinf(outer) else cage_design.edge_level(outer, half) - self.pitch_radius
        return (math.inf if self.inner_radius is None else self.pitch_radius - self.inner_radius), inward

    @property
    def friction_sense(self) -> int:
        """Sigma of the friction: 1 for inner-race rotation, -1 for outer, 0 if the balls do not spin."""
        return _sign(self.inner_speed - self.outer_speed)

    @property
    def rotation_sense(self) -> int:
        """Sense in which the ball set turns; at rest, of the rings' mean, or of the inner ring."""
        return (
            _sign(self.cage_speed) or _sign(self.inner_speed + self.outer_speed) or self.friction_sense or 1
        )

    @property
    def guiding_ring_speed(self) -> RadianPerSecond:
        """Speed of the ring that carries the land [rad/s]; the cage's own without a land."""
        speeds = {Guidance.INNER: self.inner_speed, Guidance.OUTER: self.outer_speed}
        return speeds.get(self.guidance, self.cage_speed)

    def free_leads(self, angles: Array) -> Array:
        """Lead of each ball at these angles in its free orbit, which a radial load makes uneven [m]."""
        lead = np.zeros(angles.size)
        for h, (a, b) in enumerate(zip(self.orbital_cosines, self.orbital_sines, strict=True), start=1):
            lead += (a * np.sin(h * angles) - b * np.cos(h * angles)) / (h * self.cage_speed)
        return lead


def turned_forward(cage: MovingCage) -> MovingCage:
    """Return the cage, or its mirror image where its ball set turns backward.

    Motion is chaotic: only runs of the same cage from the same starts agree to the last bit, so a bearing
    that turns the other way is run as its mirror image: azimuth 0 stays where it is, ball j becomes ball -j
    (counted around), and what runs faster at an azimuth runs slower, backward, at the opposite one.
    """
    if cage.rotation_sense > 0:
        return cage
    spin, angles = cage.ball_spin, cage.pocket_angles
    return replace(
        cage,
        cage_speed=0.0 - cage.cage_speed,
        inner_speed=0.0 - cage.inner_speed,
        fluid_speed=0.0 - cage.fluid_speed,
        orbit_by_diameter=0.0 - cage.orbit_by_diameter,
        outer_speed=0.0 - cage.outer_speed,
        pocket_angles=tuple(0.0 - a for a in angles[:1]) + tuple(2.0 * math.pi - a for a in angles[:0:-1]),
        orbital_cosines=tuple(0.0 - value for value in cage.orbital_cosines),
        capacity_waves=_reflected(cage.capacity_waves),
        slope_waves=_reflected(cage.slope_waves),
        ball_spin=None if spin is None else (0.0 - spin[0], 0.0 - spin[1], spin[2]),
    )


def _reflected(waves: tuple[float, ...]) -> tuple[float, ...]:
    """Waves of a quantity around with the azimuth counted the other way: the sines change their sign."""
    return tuple(0.0 - value if i and i % 2 == 0 else value for i, value in enumerate(waves))


cage_design.share_rules(MovingCage)


@check(MovingCage)
def _pockets_reach_their_balls(pocket_radial_offset: Metre, cage: MovingCage) -> Faults:
    """Only a sphere notices the offset, which is less than it allows."""
    if pocket_radial_offset and not cage.is_wrapped:
        yield Fault("pocket_radial_offset", "has a meaning only for a spherical pocket")
    elif pocket_radial_offset and abs(pocket_radial_offset) >= (play := cage_design.half_play(cage)):
        rule = f"must be smaller than half the clearance, {format_quantity(play, 'm')}"
        yield Fault("pocket_radial_offset", rule, "Farther out the pockets would grip their balls.")


@check(MovingCage)
def _dampings_are_above_zero(
    race_damping: NewtonSecondPerMetre, groove_damping: NewtonSecondPerMetre
) -> Faults:
    """C_mu must be above zero; it may be infinite, where the races grip the balls (eta = 1)."""
    if race_damping != math.inf and (rule := positive(1e-12, 1e12).rule(race_damping, "N s/m")):
        yield Fault("race_damping", rule)
    if not groove_damping > 0.0:
        yield Fault("groove_damping", "must be > 0")


@check(MovingCage)
def _land_has_a_clearance(guidance: Guidance, land_clearance: Metre | None) -> Faults:
    if guidance is not Guidance.BALL and land_clearance is None:
        cure = 'Give the diametral clearance, or guidance = "ball" for a cage without a land.'
        yield Fault("land_clearance", "is missing", cure)


@check(MovingCage)
def _harmonics_come_in_pairs(
    orbital_cosines: tuple[float, ...], orbital_sines: tuple[float, ...], cage_speed: RadianPerSecond
) -> Faults:
    """Only a ball set that turns brings its balls back to where they were."""
    count = len(orbital_cosines)
    if count != len(orbital_sines):
        got = str(len(orbital_sines))
        yield Fault("orbital_sines", f"must be as many as orbital_cosines, {count}", got=got)
    elif orbital_cosines and cage_speed == 0.0:
        rule = "must be empty for a ball set at rest: its balls would run apart"
        yield Fault("orbital_cosines", rule, "Give the cage's speed.", str(count))


@check(MovingCage)
def _waves_have_a_mean_and_pairs(
    capacity_waves: tuple[float, ...], slope_waves: tuple[float, ...], cage_speed: RadianPerSecond
) -> Faults:
    for name, waves in (("capacity_waves", capacity_waves), ("slope_waves", slope_waves)):
        if waves and (len(waves) % 2 == 0 or cage_speed == 0.0):
            yield Fault(name, "must be a mean and pairs of cosine and sine, of a ball set that turns")


@check(MovingCage)
def _one_angle_a_ball(pocket_angles: tuple[float, ...], ball_count: int) -> Faults:
    if pocket_angles and len(pocket_angles) != ball_count:
        rule = f"must hold one angle for each of the {ball_count} balls"
        cure = "Leave it out for evenly spaced pockets."
        yield Fault("pocket_angles", rule, cure, str(len(pocket_angles)))


@check(MovingCage)
def _hertz_needs_a_clearance(hertz_coefficient: float, pocket_clearance: Metre) -> Faults:
    if hertz_coefficient and pocket_clearance == 0.0:
        rule = "must be > 0 with Hertz contact, whose stiffness begins at zero at the first touch"
        yield Fault("pocket_clearance", rule, "Give the clearance, or linear contact.")


@check(MovingCage)
def _body_that_can_be(moment_of_inertia: KilogramMetre2, transverse_inertia: KilogramMetre2) -> Faults:
    if moment_of_inertia > 2.0 * transverse_inertia * (1.0 + 1e-9):
        rule = f"must be at least half that about the axis, {moment_of_inertia / 2.0:.4g} [kg m2]"
        yield Fault(
            "transverse_inertia", rule, "A flat ring has half of it, a long one more; no body has less."
        )


@check(MovingCage)
def _walls_reach_the_balls(
    inner_radius: Metre | None, outer_radius: Metre | None, cage: MovingCage
) -> Faults:
    if (inner_radius or 0.0) >= (outer_radius or math.inf):
        yield Fault("outer_radius", "must be larger than inner_radius")
    outward, inward = cage.wall_margins
    lost = "The walls of its pockets do not reach the balls."
    if outward <= 0.0:
        yield Fault("inner_radius", f"must be < {cage.pitch_radius:.4g} [m]", lost)
    if inward <= 0.0:
        least = math.hypot(cage.pitch_radius, (cage.ball_diameter + cage.pocket_clearance) / 2.0)
        yield Fault("outer_radius", f"must be > {least:.4g} [m]", lost)


def _sign(value: float) -> int:
    return (value > 0) - (value < 0)


def moving_cage(solution: Solution, friction: Ratio, ball: BallModel | None = None) -> MovingCage:
    """The cage of a solved study, with any friction, among balls of the study's level.

    The ball set turns at the balls' mean orbital speed; under a radial load or a moment each ball runs
    faster and slower around as the equilibrium says. In the plane among dampers, as in the paper, the balls
    spin about the axis of the bearing; else about their own.

    `friction` is that of ball on cage [-]; `ball` is used instead of the study's, AUTO is one state.

    Raises
    ------
    InputError
        The study has no cage, or its running clearances cannot be.
    """
    study, design, body = solution.study, solution.design, solution.inertia
    level, waves = ball or design.ball_model, solution.orbital_waves
    held: tuple[tuple[float, ...], ...] = ((), ())
    if waves.cosines and level is not BallModel.DAMPER:
        held = tuple(
            (one.mean, *chain.from_iterable(zip(one.cosines, one.sines, strict=True)))
            for one in solution.held_waves
        )
    hertz = design.pocket_contact is not PocketContact.LINEAR
    stiffness = solution.restitution.ball_cage_stiffness
    spin = tuple(float(x) for x in solution.bearing.equilibrium.ball_spin.mean(axis=0))
    if design.motion_model is MotionModel.PLANE and level is BallModel.DAMPER:
        spin = (math.copysign(math.hypot(*spin), spin[0]), 0.0, 0.0)
    free = solution.free_ball if level is BallModel.FREE else None
    if free is not None:  # that of the most loaded ball, in the sense of this bearing
        sense = math.copysign(1.0, solution.bearing.cage_speed)
        spin = (sense * free[1][0], sense * free[1][1], free[1][2])
    linear = solution.mobility.linear if design.motion_model is MotionModel.SPACE else None
    outer = design.outer_diameter if design.guidance is Guidance.OUTER else design.inner_diameter
    land = design.land_diameter or outer
    depth = solution.impact_speed * math.sqrt(body.mass / 2.0 / stiffness)
    radius = math.sqrt(study.bearing.ball_diameter / 2.0 * depth)
    try:
        cage = MovingCage(
            mass=body.mass,
            moment_of_inertia=body.moment_of_inertia,
            transverse_inertia=body.transverse_inertia,
            ball_count=study.bearing.ball_count,
            pitch_radius=study.bearing.pitch_diameter / 2.0,
            cage_speed=solution.bearing.cage_speed,
            inner_speed=study.operation.inner_speed,
            outer_speed=study.operation.outer_speed,
            ball_cage_stiffness=stiffness,
            race_damping=solution.restitution.race_damping,
            ball_cage_friction=friction,
            ball_spin=spin,
            ball_diameter=study.bearing.ball_diameter,
            traction=None if level is BallModel.DAMPER else solution.mobility.traction,
            free_ball=free[0] if free else None,
            # equal energy and depth in an impact at the impact speed
            hertz_coefficient=hertz_coefficient_for(stiffness, body.mass, solution.impact_speed)
            if hertz
            else None,
            # sliding at which a contact as wide as in an impact at the impact speed pivots (Contensou)
            pocket_radial_offset=solution.clearances.pocket_radial_offset if solution.clearances else 0.0,
            pivot_speed=8.0 / (3.0 * math.pi) * radius * math.hypot(*spin),
            groove_damping=linear.groove_damping if linear else math.inf,
            groove_stiffness=linear.groove_stiffness if linear else 0.0,
            land_radius=land / 2.0 if land is not None else None,
            inner_radius=design.inner_diameter / 2.0 if design.inner_diameter else None,
            outer_radius=design.outer_diameter / 2.0 if design.outer_diameter else None,
            orbital_cosines=waves.cosines,
            orbital_sines=waves.sines,
            capacity_waves=held[0],
            slope_waves=held[1],
            ramp_time=study.operation.ramp_time,
            ramp_start=study.operation.ramp_start,
            fluid_speed=_fluid_speed(design, solution),
            orbit_by_diameter=solution.orbit_by_diameter if design.ball_diameter_scatter else 0.0,
            axial_kick=study.stability.axial_kick,
            tilt_kick=study.stability.tilt_kick,
            motion=design.motion_model,
            **{name: getattr(design, name) for name in _AS_DESIGNED},
        )
    except InputError as error:
        key = error.path.removeprefix("MovingCage.")
        if key not in ("pocket_clearance", "pocket_axial_clearance"):
            raise
        raise error.at(f"[cage] {key}", cure=f"It is that of the running cage. {error.cure}") from None
    return cage


def _fluid_speed(design: CageDesign, solution: Solution) -> RadianPerSecond:
    """Mean speed of the fluid round the cage: as stated, or halfway from the cage to the ring beside it."""
    speed, operation = solution.bearing.cage_speed, solution.study.operation
    if design.fluid_swirl is not None:
        return design.fluid_swirl * speed
    ring = operation.inner_speed if design.guidance is Guidance.INNER else operation.outer_speed
    return 0.5 * (speed + ring) if design.added_mass else 0.0


_OF_THE_CHAIN = {
    "mass", "moment_of_inertia", "transverse_inertia", "ball_cage_stiffness", "ball_cage_friction", "motion",
}  # fmt: skip
_OWN = {one.name for one in fields(MovingCage)} - _OF_THE_CHAIN
_AS_DESIGNED = _OWN & {one.name for one in fields(CageDesign)}
"""Fields that the moving cage has as its design states them."""
