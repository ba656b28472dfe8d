"""The ball that is held, and the slip speeds of its contacts, from the chain before."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache

import numpy as np

from separatrix.chain.ball_traction import FreeBall, SlipField
from separatrix.chain.contacts import BearingState, bearing_state, of_both_races, race_tracks
from separatrix.chain.creep import Creep
from separatrix.chain.equilibrium.groove import chebyshev_nodes
from separatrix.chain.equilibrium.problem import problem
from separatrix.chain.mobility.field import HeldBall, settle
from separatrix.chain.mobility.record import SlipLaw
from separatrix.chain.race_curve import race_slope
from separatrix.ground.errors import InputError
from separatrix.ground.units import MetrePerSecond, PerSecond, RadianPerSecond
from separatrix.study.study import BallBearing, Film, KinematicModel, Operation, TractionSettings

REMEMBERED = 256
"""Balls that are kept, by the records they are made of."""

RIGID = 1e-4
"""Slip speed of rigid contacts over the speed difference of the rings times d_m/4."""

CELLS = {SlipLaw.ELASTIC: 48, SlipLaw.RIGID: 96}
"""Strips across an ellipse; half as many places along rolling. Those of 4 times as many are within 1e-3."""


@lru_cache(maxsize=REMEMBERED)
def held_ball(
    bearing: BallBearing,
    operation: Operation,
    kinematics: KinematicModel,
    film: Film,
    settings: TractionSettings,
    slip_law: SlipLaw,
) -> HeldBall:
    """Most loaded ball at rest in its two slip fields, remembered by the value of these records.

    It orbits in the positive sense: a bearing that turns the other way is mirrored.

    Raises
    ------
    InputError
        The ball does not touch both races.
    ConvergenceError
        The friction of both races does not balance.
    """
    state = bearing_state(bearing, operation, kinematics, film.race_friction)
    ball = state.inner.ball
    if state.equilibrium.orbital_speed[ball] < 0.0:
        turned = replace(operation, inner_speed=-operation.inner_speed, outer_speed=-operation.outer_speed)
        return held_ball(bearing, turned, kinematics, film, settings, slip_law)
    if not (state.inner.load > 0.0 and state.outer.load > 0.0):
        cure = "Raise the axial load or lower the speed."
        raise InputError("[operation] loads and speed", "must press a ball on both races", "", cure)
    p = problem(bearing, operation, 0.0, film.race_friction)
    place = {
        race: (0.5 * p.ball_diameter * (2.0 * f - 1.0) + at.ellipse.approach, at.contact_angle)
        for race, f, at in (
            ("inner", p.inner_conformity, state.inner),
            ("outer", p.outer_conformity, state.outer),
        )
    }
    inner, outer = (length * np.array((math.sin(a), math.cos(a))) for length, a in place.values())
    orbit = (state.equilibrium.orbital_speed[ball] - p.outer_speed) / p.speed
    slips = (RIGID * 0.25 * p.pitch_diameter,) * 2
    if slip_law is SlipLaw.ELASTIC:
        inner_slip, outer_slip = elastic_slip_speeds(bearing, film, settings, state)
        slips = inner_slip / abs(p.speed), outer_slip / abs(p.speed)
    cells = CELLS[slip_law]
    return settle(
        HeldBall(
            problem=p,
            rings=outer + inner,
            state=np.array((*outer, orbit, *(state.equilibrium.ball_spin[ball] / p.speed))),
            slips=slips,
            cells=cells,
            nodes=chebyshev_nodes(cells // 2),
            capacity=film.race_friction * (state.inner.load + state.outer.load),
        )
    )


def elastic_slip_speeds(
    bearing: BallBearing, film: Film, settings: TractionSettings, state: BearingState
) -> tuple[MetrePerSecond, MetrePerSecond]:
    r"""Slip at which the elastic creep of the inner and of the outer race would transmit all friction [m/s].

    :math:`v_e = f_{BT} V/\alpha_0` with the slope :math:`\alpha_0` of contact and film without spin and
    Heathcote's slip, by the traction model of the settings.
    """
    tracks = [replace(one, creep=Creep(spin=0.0, curvature=0.0)) for one in race_tracks(bearing, film, state)]
    found = of_both_races(lambda track: race_slope(track, settings), (tracks[0], tracks[1]))
    speeds = state.inner.rolling_speed, state.outer.rolling_speed
    inner, outer = (film.race_friction * abs(v) / one.slope for v, one in zip(speeds, found, strict=True))
    return inner, outer


def free_ball(
    bearing: BallBearing,
    operation: Operation,
    kinematics: KinematicModel,
    film: Film,
    settings: TractionSettings,
    fastest_rate: PerSecond,
) -> tuple[FreeBall, tuple[RadianPerSecond, RadianPerSecond, RadianPerSecond]]:
    """The most loaded ball with its slip fields at free rolling, and its spin; it orbits positively."""
    held = held_ball(bearing, operation, kinematics, film, settings, SlipLaw.ELASTIC)
    state, p = bearing_state(bearing, operation, kinematics, film.race_friction), held.problem
    spin, outer_speed = held.state[3:] * p.speed, p.outer_speed
    orbit = held.state[2] * p.speed + outer_speed
    fields = []
    for side, race, contact, f, ring, slip in (
        (
            -1.0,
            held.rings - held.state[:2],
            state.inner,
            p.inner_conformity,
            p.speed + outer_speed,
            held.slips[0],
        ),
        (1.0, held.state[:2], state.outer, p.outer_conformity, outer_speed, held.slips[1]),
    ):
        normal, a = side * race / np.hypot(*race), contact.ellipse.semi_major
        pivoting = (spin[0] - ring + orbit) * normal[0] + spin[1] * normal[1]
        rolling = (spin[0] - ring + orbit) * normal[1] - spin[1] * normal[0]
        fields.append(
            SlipField(
                normal_axial=float(normal[0]),
                normal_radial=float(normal[1]),
                limit=film.race_friction * contact.load,
                semi_major=a,
                axis_ratio=contact.ellipse.semi_minor / a,
                slip=float(0.5 * rolling * p.ball_diameter - (ring - orbit) * held.orbit_radius),
                pivoting=float(a * pivoting),
                heathcote=float(rolling * a * a * (2.0 * f + 1.0) / (4.0 * f * p.ball_diameter)),
                elastic_slip=float(slip * abs(p.speed)),
            )
        )
    ball = FreeBall(
        mass=p.ball_mass, inertia=p.ball_inertia, inner=fields[0], outer=fields[1], fastest_rate=fastest_rate
    )
    return ball, (float(spin[0]), float(spin[1]), float(spin[2]))
