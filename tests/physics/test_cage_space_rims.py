"""The edges of pockets in space: nearest points by search, hand geometry, small steps, and the ledger.

Tolerances: rounding, 1e-9 of the work done, or the order by which differences from exact rotations fall.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from space_cages import ROUND, course
from space_program import edge_contact
from test_cage_space_balance import drawn
from test_cage_space_limits import differences

from separatrix.cage.closed_forms import time_unit
from separatrix.cage.records import Pace
from separatrix.cage.space.history import SOURCES, simulate_in_space
from separatrix.cage.space.inputs import numbers, parts_of
from separatrix.cage.space.records import (
    AXIAL,
    DEPTH,
    FT,
    FZ,
    GX,
    INNER_RIM,
    LEAD,
    OUTER_RIM,
    RUB_R,
    SLIDE,
    TO_R,
    TO_T,
    TO_Z,
)
from separatrix.cage.space.rim import expand_rim
from separatrix.cage.space.rim_events import place_ball
from separatrix.cage.space_body import wall_margin
from separatrix.errors import InputError
from separatrix.pocket_shape import PocketShape

R, H = ROUND.pitch_radius, ROUND.space.ball_diameter / 2.0
BORE = H + ROUND.half_play
DRY = replace(ROUND, ball_cage_friction=0.0)


def edged(cage=ROUND, **radii):
    """Return the cage with walls between these radii."""
    return replace(cage, space=replace(cage.space, **radii))


def touched(cage, *, axial=0.0, along=0.0, outward=0.0, kind=OUTER_RIM, region=0, contact=0):
    """Contact 0 or 1 of the pocket at azimuth 0, with its ball there against the pocket, and its edge."""
    p, parts = numbers(cage, 0.5), parts_of(cage)
    parts.cage[0, GX], parts.ball[0, 0, [AXIAL, LEAD]] = -outward, (axial, along)
    parts.kind[contact], parts.region[0] = kind, region
    place_ball(parts, 0)
    expand_rim(p, parts, contact, Pace(1.0, 0.0), 0)
    return parts.contact[contact, 0], parts.rim[contact, 0], moving(cage)


def moving(cage):
    """Newtons of a force of one by the engine."""
    return cage.mass / time_unit(cage) ** 2


SQUARE = replace(DRY, pocket_shape=PocketShape.SQUARE, space=replace(DRY.space, axial_play=2e-4))


@pytest.mark.parametrize("cage", [DRY, SQUARE], ids=["bore", "square"])
def test_a_ball_pressed_along_the_orbit_on_an_outer_edge(cage):
    """By hand: the edge is s = R - (r^2 - b^2)^(1/2) below the ball and b - 0.4 mm beside it."""
    c, _, newton = touched(edged(cage, outer_radius=32.2e-3), along=4e-4)
    s, beside = R - math.sqrt(32.2e-3**2 - BORE**2), BORE - 4e-4
    assert s == pytest.approx(0.837e-3, abs=1e-6)
    force = cage.ball_cage_stiffness * (H - math.hypot(s, beside))
    assert force > 30.0
    assert math.hypot(c[FT], c[RUB_R]) * newton == pytest.approx(force, rel=1e-10)
    tilt = math.asin(s / math.hypot(s, beside))
    assert math.atan2(c[RUB_R], c[FT]) == pytest.approx(-tilt, rel=1e-12)
    assert abs(c[FZ]) * newton < 1e-12 * force


@pytest.mark.parametrize(("cage", "contact"), [(DRY, 0), (SQUARE, 1)], ids=["bore", "square"])
def test_a_ball_pressed_along_the_axis_on_an_inner_edge(cage, contact):
    """By hand: the edge is 0.4 mm above the ball, the wall at its own clearance."""
    wall = (BORE if contact == 0 else H + 2e-4) - 3.5e-4
    c, _, newton = touched(edged(cage, inner_radius=R + 4e-4), axial=3.5e-4, kind=INNER_RIM, contact=contact)
    force = cage.ball_cage_stiffness * (H - math.hypot(4e-4, wall))
    assert force > 30.0
    assert math.hypot(c[FZ], c[RUB_R]) * newton == pytest.approx(force, rel=1e-10)
    assert math.atan2(c[RUB_R], c[FZ]) == pytest.approx(math.asin(4e-4 / math.hypot(4e-4, wall)), rel=1e-12)


def test_the_edge_of_a_bore_touches_at_its_nearest_point():
    """By search over the edge, at 200 places; and the friction is across the force. Rounding."""
    rng = np.random.default_rng(5)
    for _ in range(200):
        angle, far, outward = rng.uniform([-math.pi, 3.5e-4, -2e-4], [math.pi, 6e-4, 3e-4])
        kind, surface = [(OUTER_RIM, 32.3e-3), (INNER_RIM, 32.9e-3)][rng.integers(2)]
        name = "outer_radius" if kind == OUTER_RIM else "inner_radius"
        place = {"axial": far * math.sin(angle), "along": far * math.cos(angle), "outward": outward}
        c, e, _ = touched(edged(**{name: surface}), kind=kind, **place)
        ball = np.array([R + outward, place["along"], place["axial"]])
        distance, direction = edge_contact(ball, BORE, surface)
        assert H - c[DEPTH] == pytest.approx(distance, rel=1e-13)
        assert e[[TO_R, TO_T, TO_Z]] == pytest.approx(direction, abs=1e-9)
        push = c[DEPTH] * numbers(edged(), 0.5)["stiffness"]
        force = np.array([c[RUB_R], c[FT], c[FZ]])
        assert force @ e[[TO_R, TO_T, TO_Z]] == pytest.approx(push, rel=1e-9)
        rubbed = np.linalg.norm(force - push * e[[TO_R, TO_T, TO_Z]])
        assert rubbed == pytest.approx(ROUND.ball_cage_friction * abs(push), rel=1e-6)
        assert c[SLIDE] > 0.0


def test_the_edge_of_a_slot_touches_at_its_nearest_point():
    """By search over the stadium's edge, from flats and round ends, 200 places: rounding of the distance."""
    rng, c_a = np.random.default_rng(6), 0.6 * ROUND.pocket_clearance
    slot = replace(DRY, pocket_shape=PocketShape.ELONGATED, pocket_axial_clearance=c_a)
    round_, apart, surface = H + c_a / 2.0, (ROUND.pocket_clearance - c_a) / 2.0, 32.5e-3
    beta = np.linspace(-0.5 * math.pi, 0.5 * math.pi, 20001)
    ends = [(side * (apart + round_ * np.cos(beta)), round_ * np.sin(beta)) for side in (1.0, -1.0)]
    line = np.linspace(-apart, apart, 20001)
    flats = [(line, np.full(line.size, side * round_)) for side in (1.0, -1.0)]
    along, axial = (np.concatenate([part[k] for part in (*ends, *flats)]) for k in (0, 1))
    height = np.sqrt(surface**2 - along**2)
    for _ in range(200):
        t, z, out = rng.uniform([-4e-4, 2e-4, -1e-4], [4e-4, 4e-4, 3e-4]) * [1, rng.choice([-1, 1]), 1]
        distance = np.sqrt((along - t) ** 2 + (axial - z) ** 2 + (height - R - out) ** 2).min()
        found = []
        for region, contact in ((0, 1), (1, 0), (-1, 0)):
            at = {"along": t, "axial": z, "outward": out, "region": region, "contact": contact}
            c, e, _ = touched(edged(slot, outer_radius=surface), **at)
            touches = t + e[TO_T] * (H - c[DEPTH])
            on_it = abs(touches) <= apart if contact else -region * touches >= apart
            found += [H - c[DEPTH]] if on_it else []
        assert min(found) == pytest.approx(distance, rel=1e-8)  # the search's grid


@pytest.mark.parametrize("kind", [OUTER_RIM, INNER_RIM])
def test_wall_and_edge_join_smoothly(kind):
    """Where the wall ends the edge is as deep; 2 um beyond, by no more than the square of that over h."""
    rng = np.random.default_rng(7)
    name, sense = ("outer_radius", 1.0) if kind == OUTER_RIM else ("inner_radius", -1.0)
    for _ in range(100):
        angle, far = rng.uniform(-math.pi, math.pi), rng.uniform(3e-4, 6e-4)
        surface = math.hypot(R + 1e-4, BORE * math.cos(angle))
        place = {"axial": far * math.sin(angle), "along": far * math.cos(angle), "kind": kind}
        cage = edged(**{name: surface})
        at, after = (touched(cage, outward=1e-4 + s, **place)[0][DEPTH] for s in (0.0, sense * 2e-6))
        wall = far - ROUND.half_play
        assert at == pytest.approx(wall, abs=1e-17)
        assert 0.0 <= wall - after < 2e-6**2 / H


def at_a_scale(scale, side):
    """Return `ROUND` with walls that end 0.8 or 0.4 mm of a scale beside the ball's equator at a pole."""
    bore = H + scale * ROUND.half_play
    name, end = ("outer_radius", R - 8e-4 * scale) if side == "outer" else ("inner_radius", R + 4e-4 * scale)
    return edged(**{name: math.hypot(end, bore)})


@pytest.mark.parametrize("side", ["outer", "inner"])
def test_it_moves_on_edges_as_small_steps_with_exact_rotations(side):
    """As on walls: differences fall by 4 for half the motion and half the way to the edge, to a quarter."""
    full, half = (differences(at_a_scale(scale, side), scale) for scale in (1.0, 0.5))
    assert full < 2e-6
    assert full / half == pytest.approx(4.0, rel=0.25)


def test_edges_out_of_reach_change_no_bit():
    """The same bytes with and without the shape of a ring whose walls reach far."""
    lead = 1e-4 * np.sin(np.arange(13.0))
    there = [course(cage, 5e-3, lead=lead) for cage in (ROUND, edged(inner_radius=29e-3, outer_radius=36e-3))]
    for name in ("motion", "rates", "work", "lead", "axial"):
        assert getattr(there[0], name).tobytes() == getattr(there[1], name).tobytes()
    assert there[0].steps == there[1].steps


def test_the_ledger_of_cages_on_their_edges_closes():
    """80 random cages, walls ending 1.2 mm short of the ball's centre to 0.6 mm beyond it: no stall either.

    Without friction an edge does no work: its force is the slope of its energy.
    """
    rng, ran, pressed, dry = np.random.default_rng(60607), 0, 0, 0
    while ran < 80:
        cage, start = drawn(rng)
        beyond, is_outer, is_thin, is_dry = rng.uniform(-6e-4, 1.2e-3), *rng.integers(0, [2, 4, 4])
        radii = {"outer_radius": R - beyond} if is_outer else {"inner_radius": R + beyond}
        if is_thin == 0:
            radii = {"inner_radius": R - 2e-4 + beyond / 3.0, "outer_radius": R + 6e-4 + beyond / 3.0}
        friction = 0.0 if is_dry == 0 else cage.ball_cage_friction
        try:
            cage = edged(replace(cage, ball_cage_friction=friction), **radii)
        except InputError:  # a pocket too tight for its edge
            continue
        ran += 1
        there = course(cage, 2e-3, samples=3, **start)
        assert there.filled == 3, cage
        assert np.isfinite(there.motion).all(), cage
        assert there.imbalance < 1e-9, (there.imbalance, cage)
        pressed += int((there.parts.kind >= OUTER_RIM).sum())
        if friction == 0.0:
            dry += 1
            rubbed = there.work[-1][SOURCES.index("pocket_friction")]
            assert abs(rubbed) < 1e-9 * (there.gross + there.kinetic[0]), cage
    assert pressed > 40
    assert dry > 10


def test_samples_have_the_force_of_an_edge():
    """Of all forces the springs' energy follows, and with that of the grooves what is stored: rounding."""
    cage = edged(outer_radius=32.2e-3)
    assert wall_margin(cage, cage.space) < 0.0
    there = simulate_in_space(cage, kick=0.5, samples=200, until=5e-3)
    springs = (there.contact_force**2).sum(1) / (2.0 * cage.ball_cage_stiffness)
    grooves = 0.5 * cage.space.groove_stiffness * (there.ball_axial**2).sum(1)
    assert springs.max() > 1e-4
    assert there.stored_energy == pytest.approx(springs + grooves, rel=1e-9, abs=1e-9 * springs.max())
    touching = there.contact_force > 0.0
    assert there.contact_tilt[touching].max() < 0.0  # the edge is inside the ball's equator
    assert np.abs(there.contact_tilt[~touching]).max() == 0.0
