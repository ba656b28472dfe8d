"""Cages, bearings and ensembles from which the tests of several files start; short ways to run a cage."""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from separatrix import BallTraction, Cause, Ensemble, History, MovingCage, RunOutcome
from separatrix.cage.closed_forms import felt_mass, whirl_rate
from separatrix.cage.course import follow_start
from separatrix.cage.disturbance import Starts
from separatrix.study.keys import settled_in, with_values
from separatrix.study.study import BallBearing, Guidance, Material, MotionModel, PocketShape, Study
from separatrix.study.uncertain import Distribution

AT_REST = MovingCage(
    mass=0.05, moment_of_inertia=0.05 * 0.0325**2, ball_count=11, pitch_radius=0.0325, cage_speed=0.0,
    inner_speed=1500.0, outer_speed=0.0, pocket_clearance=6e-4, ball_cage_stiffness=3e6, race_damping=2000.0,
    ball_cage_friction=0.1,
)  # fmt: skip
"""A thin ring in a ball set at rest, without a land."""

SMALL = replace(AT_REST, moment_of_inertia=0.05 * 0.03**2, pitch_radius=0.03, inner_speed=1000.0)
"""The same in a smaller bearing."""

TURNING = MovingCage(
    mass=0.025, moment_of_inertia=0.025 * 0.0325**2, ball_count=13, pitch_radius=0.0325, cage_speed=670.0,
    inner_speed=1570.0, outer_speed=0.0, pocket_clearance=6e-4, ball_cage_stiffness=3e6, race_damping=800.0,
    ball_cage_friction=0.12,
)  # fmt: skip
"""A thin ring of 25 g in a turbopump's ball set, without a land."""

ON_A_LAND = replace(TURNING, guidance=Guidance.OUTER, land_clearance=1e-3)

UNEVEN = tuple(2 * math.pi * (j + 0.15 * math.sin(5 * j)) / 13 for j in range(13))
WAVES = {"orbital_cosines": (0.3, 0.1), "orbital_sines": (-0.1, 0.2)}
RAMP = {"ramp_time": 5e-4, "ramp_start": 0.2}
EVERYTHING = replace(
    ON_A_LAND, cage_speed=669.0, inner_speed=1570.8, land_clearance=4e-4, land_restitution=0.5,
    land_out_of_round=2e-5, land_lobes=3, land_count=2, unbalance=1e-6, gravity=9.81, hertz_coefficient=3e8,
    pocket_shape=PocketShape.CYLINDRICAL, pocket_axial_offset=1e-4, pocket_angles=UNEVEN, **WAVES, **RAMP,
)  # fmt: skip
"""Every input of a cage in the plane at once."""

STEEL = Material(name="440C", elastic_modulus=205e9, poisson_ratio=0.285, density=7650.0)
BEARING = BallBearing(
    ball_diameter=11.1125e-3, pitch_diameter=65e-3, ball_count=13, contact_angle=math.radians(25.0),
    inner_conformity=0.52, outer_conformity=0.53, ball_material=STEEL, ring_material=STEEL,
)  # fmt: skip
"""A turbopump's bearing."""

STEEL_218 = Material(name="steel", elastic_modulus=206.84e9, poisson_ratio=0.3, density=7800.0)
BEARING_218 = BallBearing(
    ball_diameter=22.23e-3, pitch_diameter=125.26e-3, ball_count=16, contact_angle=math.radians(40.0),
    inner_conformity=0.523167, outer_conformity=0.523167, ball_material=STEEL_218, ring_material=STEEL_218,
)  # fmt: skip
"""The bearing of the rolling-bearing books."""


def with_distributions(study: Study, given: Mapping[str, Distribution]) -> Study:
    """Study with these numbers uncertain; its values are their means."""
    central = with_values(study, {key: one.mean for key, one in given.items()})
    settled = {key: settled_in(central, key, one) for key, one in given.items()}
    return replace(central, distributions={**central.distributions, **settled})


def damping_of(eta: float) -> float:
    """C_mu at which `AT_REST` has this nominal restitution factor (physics of Eq. 17 as modelled)."""
    zeta = -math.log(eta) / math.hypot(math.pi, math.log(eta))
    return math.sqrt(AT_REST.ball_cage_stiffness * AT_REST.mass) / (2 * zeta)


def gripped(damping: float, friction: float = 0.0, **change: object) -> MovingCage:
    """`AT_REST` with pockets that have no clearance."""
    grip = {"pocket_clearance": 0.0, "race_damping": damping, "ball_cage_friction": friction}
    return replace(AT_REST, **(grip | change))


def linear_roots(cage: MovingCage) -> np.ndarray:
    """Exact rates of small motions without clearance, fastest growing first, shape (3,) or (4,) [rad/s].

    (lambda + i Omega)^2 (lambda D + k) + (1 - i sigma f) omega_0^2 lambda D = 0, D = m_e lambda + C; in
    spheres 2 lambda D + (1 + i sigma f) k in place of the last lambda D.
    """
    law, w0 = cage.traction, whirl_rate(cage)
    mass, slope = (0.0, cage.race_damping) if law is None else (law.mass, law.slope)
    yields = np.array([mass * w0 * w0, slope * w0, 0.0])
    turned = np.poly([-1j * cage.cage_speed / w0] * 2)
    driving, pressed = 1j * cage.friction_sense * cage.ball_cage_friction, np.zeros(3, dtype=complex)
    pressed[2] = cage.is_wrapped * (1.0 + driving) * cage.ball_cage_stiffness
    driven = (1.0 - driving) * ((1.0 + cage.is_wrapped) * yields + pressed)
    held = np.polymul(turned, yields + np.array([0.0, 0.0, cage.ball_cage_stiffness]))
    roots = np.roots(np.polyadd(held, driven)) * w0
    return roots[np.argsort(-roots.real)]


def followed(
    cage: MovingCage, duration: float, *, direction: float = math.pi / 2.0, lead=None, **how: object
) -> History:
    """Follow a run to its whole duration: from 0.5 m/s straight onto ball 0 and without leads by default."""
    lead = np.zeros(cage.ball_count) if lead is None else lead
    whole = {"kick": 0.5, "duration": duration, "until": duration, "samples": 400}
    return follow(cage, direction=direction, ball_lead=lead, **whole | how)


NOTHING = (
    *("largest_offset", "mean_offset", "offset_spread", "orbit_speed", "drift_rate", "end_energy"),
    *("whirl_frequency", "largest_land_force", "energy_imbalance", "pocket_power", "land_power"),
    *("rubbing_force", "rubbing_speed", "strike_rate", "left_time", "pocket_sliding"),
)
KICKS = np.array([0.1, 0.5, 2.0, 4.0, 8.0])


def ensemble(rows: object, balls: int = AT_REST.ball_count, **evidence: object) -> Ensemble:
    """Ensemble made of these outcomes, a row for each kick; evidence is spread over all runs."""
    outcome = np.array(rows, dtype=np.int64)
    floats = dict.fromkeys(NOTHING, 0.0) | {
        "growth_rate": np.where(outcome == RunOutcome.WHIRLS, 9.0, -25.0),
        "largest_contact_force": 1.0,
        "followed": 0.3,
        "judged_from": 0.24,
    }
    cause = np.where(
        outcome == RunOutcome.UNRESOLVED, int(evidence.pop("cause", Cause.FALLING)), int(Cause.NONE)
    )
    whole = {"whirl_direction": 0, "land_impacts": 0, "left_ball": 0, "cause": cause}
    changed = {name: evidence.pop(name) for name in list(evidence) if name in floats | whole}
    spread = {
        name: np.broadcast_to(np.asarray(value, dtype=float if name in floats else int), outcome.shape).copy()
        for name, value in (floats | whole | changed).items()
    }
    by_ball = {"pocket_impacts": np.zeros((*outcome.shape, balls), dtype=np.int64)}
    by_ball["pocket_rubbing"] = np.zeros((*outcome.shape, balls))
    given = by_ball | {"kicks": KICKS[: len(outcome)], "duration": 0.3}
    return Ensemble(outcome=outcome, **{**spread, **given, **evidence})


def follow(
    cage, *, kick, direction, ball_lead, duration, samples=4000, until=None, real=np.float64, refine=1
) -> History:
    """Follow the run that starts in this direction [rad] and with these leads, shape (ball,) [m]."""
    leads, none = np.array([ball_lead]), np.zeros((1, cage.ball_count))
    angle = np.array([cage.ball_angles])
    starts = Starts(np.array([direction]), np.zeros(1), np.ones(1), leads, none, angle)
    return follow_start(cage, kick, starts, duration, samples, until, real=real, refine=refine)


def impact_restitution(cage, *, may_turn=True):
    r"""Restitution of an impact of the series spring and damper on the mass that it feels [-].

    :math:`\eta = \exp(-\pi\zeta/\sqrt{1-\zeta^2})` with :math:`\zeta = \sqrt{km}/2C_\mu`, 0 from :math:`\zeta
    = 1`. The nominal eta has m = M; a thin ring that may turn returns more: 0.928 for 0.90, 0.698 for 0.60.
    """
    m = felt_mass(cage, may_turn=may_turn)
    zeta = math.sqrt(cage.ball_cage_stiffness * m) / (2.0 * cage.slow_damping)
    return math.exp(-math.pi * zeta / math.sqrt((1.0 - zeta) * (1.0 + zeta))) if zeta < 1.0 else 0.0


def random_cage(rng: np.random.Generator, space: bool) -> MovingCage:
    """A cage with every input of the motion drawn; ranges of real bearings."""
    draw = rng.uniform
    mass, radius, balls = 10.0 ** draw(-3.0, -0.8), draw(0.01, 0.06), int(rng.integers(7, 16))
    shape = PocketShape(rng.choice(["square", "cylindrical", "elongated", "spherical"]))
    clearance, speed = draw(1e-4, 6e-4), draw(20.0, 900.0)
    return MovingCage(
        mass=mass, moment_of_inertia=mass * radius**2, ball_count=balls, pitch_radius=radius,
        cage_speed=speed, inner_speed=2.3 * speed, outer_speed=0.0,
        ball_spin=(-6.0 * speed, 2.0 * speed, draw(-1.0, 1.0)),
        ball_diameter=0.3 * radius, pocket_clearance=clearance, pocket_shape=shape,
        pocket_axial_clearance=0.6 * clearance if shape is PocketShape.ELONGATED else None,
        ball_cage_stiffness=10.0 ** draw(5.5, 6.8), race_damping=10.0 ** draw(1.7, 3.2),
        traction=BallTraction(mass=6.5e-3, slope=207.0, speed=0.435) if draw() < 0.5 else None,
        ball_cage_friction=draw(0.02, 0.4),
        guidance=Guidance(rng.choice(["outer", "inner"])), land_clearance=draw(1e-4, 1e-3),
        land_out_of_round=draw(0.0, 5e-6), land_count=2, land_spacing=0.2 * radius, land_width=0.05 * radius,
        unbalance=1e-5 * mass, dynamic_unbalance=1e-4, gravity=draw(0.0, 10.0), axial_gravity=draw(0.0, 10.0),
        added_mass=0.1 * mass, pivot_speed=0.05, groove_damping=700.0, groove_stiffness=4e6,
        orbital_cosines=(draw(-0.02, 0.02),), orbital_sines=(draw(-0.02, 0.02),),
        capacity_waves=(0.7, draw(-0.3, 0.3), draw(-0.3, 0.3)),
        slope_waves=(0.6, draw(-0.3, 0.3), 0.0, 0.05, 0.1),
        ramp_time=2e-3, ramp_start=0.3, pocket_spacing_scatter=0.05, ball_diameter_scatter=1e-6,
        pocket_position_scatter=1e-6, axial_kick=0.1, tilt_kick=0.1,
        motion=MotionModel.SPACE if space else MotionModel.PLANE,
    )  # fmt: skip
