"""Balls at an edge of which two points are nearly as near: the nearest by search, and the ledger.

The draws were found among 25 000 (`benchmarks/edge_ledger.py`): with one point at an edge their energy
jumped by 1e-8 to 1e-3 of the work done, or they stalled.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from space_cages import course
from test_cage_space_balance import drawn
from test_cage_space_rims import R, edged

from separatrix.cage.space.edge_points import nearest, squared_at
from separatrix.errors import InputError


def drawn_on_edges(rng):
    """Draw a cage whose walls end near its balls, and a start."""
    while True:
        cage, start = drawn(rng)
        beyond = rng.uniform(-6e-4, 1.2e-3)
        is_outer, is_thin, is_dry = rng.integers(0, [2, 4, 4])
        radii = {"outer_radius": R - beyond} if is_outer else {"inner_radius": R + beyond}
        if is_thin == 0:
            radii = {"inner_radius": R - 2e-4 + beyond / 3.0, "outer_radius": R + 6e-4 + beyond / 3.0}
        friction = 0.0 if is_dry == 0 else cage.ball_cage_friction
        try:
            return edged(replace(cage, ball_cage_friction=friction), **radii), start
        except InputError:  # a pocket too tight for its edge
            continue


@pytest.mark.parametrize(
    ("seed", "draw"),
    [
        (5015, 7),
        (5017, 12),
        (5025, 11),
        (5085, 49),
        (5106, 58),
        (5111, 38),
        (5119, 40),
        (5187, 75),
        (5241, 36),
    ],
)
def test_a_ball_between_two_points_of_an_edge_keeps_the_ledger_closed(seed, draw):
    """1e-9 of the work done, as of all cages; (5085, 49) did not come to its end."""
    rng = np.random.default_rng(seed)
    for _ in range(draw):
        drawn_on_edges(rng)
    cage, start = drawn_on_edges(rng)
    there = course(cage, 2e-3, samples=3, **start)
    assert there.filled == 3
    assert there.imbalance < 1e-9


def test_the_nearest_point_of_a_round_edge_is_the_nearest_of_all():
    """By search over 40 001 points of bores and round ends, 400 places, near the evolute too.

    Tolerance: points 1.6e-4 rad apart miss the minimum of the distance by less than 1e-10 m; a search in
    cells of 4 degrees takes two minima in one cell for one, which are less than that apart in distance.
    """
    rng, single = np.random.default_rng(8), 0
    for _ in range(400):
        radius, edge = 5.55625e-3 + rng.uniform(3e-5, 3e-4), R + rng.uniform(-5e-4, 5e-4)
        side = float(rng.integers(-1, 2))
        middle = side * rng.uniform(0.0, 1e-4)
        height = edge + rng.uniform(-6e-4, 6e-4)
        t, z = rng.uniform(-1.5e-4, 1.5e-4, 2)
        first, last = (-math.pi, math.pi) if side == 0.0 else (-0.5 * math.pi, 0.5 * math.pi)
        angles = np.linspace(first, last, 40001) + (math.pi if side < 0.0 else 0.0)
        along, axial = radius * np.cos(angles), radius * np.sin(angles)
        up = np.sqrt(edge**2 - (middle + along) ** 2) - height
        found = np.sqrt((along - t) ** 2 + (axial - z) ** 2 + up**2)
        at = int(found.argmin())
        if side != 0.0 and at in (0, angles.size - 1):  # of a slot's flat, or of its other end
            continue
        angle = nearest(t, z, height, radius, middle, edge, side)
        here = math.sqrt(squared_at(t, z, height, radius, middle, edge, angle))
        # Twice what the search's grid of 1.6e-4 rad can miss, 1e-10 m
        assert here == pytest.approx(found[at], abs=2e-10)
        single += 1
    assert single > 200
