r"""What sliding of ball on race does to the film in a pass: pressure times the way that surfaces slide.

A place at y across the groove is passed over by every ball. In full sliding the film there loses

.. math:: \Delta h(y) = K \int p\,\frac{|v|}{V}\,dx

by Archard's law with the wear coefficient K: p Hertz's pressure, v the slip of rigid bodies, V the rolling
speed. docs/theory/life.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from separatrix.chain.contacts import BearingState
from separatrix.chain.creep import deformed_radius, track_area
from separatrix.chain.slip_friction import chebyshev_nodes
from separatrix.ground.units import Array, PerSecond, SquareMetre
from separatrix.study.study import BallBearing, Operation, Race

STRIPS = 16
"""Strips across the contact: the largest work of one is 2 % less than with 512 (shipped bearing)."""

ALONG = 32
"""Places along rolling."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TrackWork:
    """What the passes of the most loaded ball do to the track of one race, by strips across it."""

    across: Annotated[Array, "-", ("strip",)]  # middle of the strip over the semi-axis of the contact
    share: Annotated[Array, "-", ("strip",)]  # of the load that the strip carries
    work: Annotated[Array, "N/m", ("strip",)]  # of a pass on an area, over friction: pressure times slid way
    passes: PerSecond  # balls that pass a place of the ring
    area: SquareMetre  # of the track


def track_work(bearing: BallBearing, operation: Operation, state: BearingState, race: Race) -> TrackWork:
    """Work of the most loaded ball on the track of a race; 0 of a ring that the balls do not pass."""
    inner, found = race is Race.INNER, state.equilibrium
    at = state.inner if inner else state.outer
    D, d_m, a, b = bearing.ball_diameter, bearing.pitch_diameter, at.ellipse.semi_major, at.ellipse.semi_minor
    ring = operation.inner_speed if inner else operation.outer_speed
    orbit, (axial, outward, along) = found.orbital_speed[at.ball], found.ball_spin[at.ball]
    side = -1.0 if inner else 1.0
    n_x, n_r = side * math.sin(at.contact_angle), side * math.cos(at.contact_angle)
    spin = axial - (ring - orbit), outward
    pivoting, rolling = spin[0] * n_x + spin[1] * n_r, spin[0] * n_r - spin[1] * n_x
    edges = np.linspace(-1.0, 1.0, STRIPS + 1)
    middle = 0.5 * (edges[1:] + edges[:-1])
    y, chord = a * middle, b * np.sqrt(1.0 - middle**2)
    conformity = bearing.inner_conformity if inner else bearing.outer_conformity
    radius = deformed_radius(D, conformity)
    height = 0.5 * D - radius + np.sqrt(radius**2 - y**2)
    nodes, weights = chebyshev_nodes(ALONG)  # of a semi-ellipse whose mean is 1
    x = chord[:, None] * nodes
    forward = pivoting * y + rolling * height - 0.5 * (ring - orbit) * d_m
    sideways = along * height[:, None] - pivoting * x
    slip = np.hypot(forward[:, None], sideways) @ weights
    # Hertz's pressure on a line along rolling has the integral p_0 b (1 - y^2/a^2) pi/2
    line = 0.5 * math.pi * at.ellipse.max_pressure * b * (1.0 - middle**2)
    shares = np.diff(0.75 * (edges - edges**3 / 3.0))
    speed = at.rolling_speed
    return TrackWork(
        across=middle,
        share=shares,
        work=line * slip / speed if speed > 0.0 else 0.0 * line,
        passes=bearing.ball_count * abs(ring - orbit) / (2.0 * math.pi),
        area=track_area(bearing, at.ellipse, at.contact_angle, side),
    )
