"""A preloaded pair: limits of its gap, both bearings at once, and what speed, a spring and a gap change."""

import math
from dataclasses import replace

import pytest
from cages import BEARING, BEARING_218
from hypothesis import given, settings
from hypothesis import strategies as st

import separatrix
from separatrix import Arrangement, BallBearing, InputError, KinematicModel, Operation, PreloadKind
from separatrix.chain.contacts import FAINT, GAPPED, PairLoads, pair_loads, with_axial_load
from separatrix.chain.equilibrium import equilibrium

FREE, FRICTION = KinematicModel.FREE, 0.1
PRELOAD = 200.0


def pair(inner_speed: float = 0.0, **values) -> Operation:
    """A pair under 200 N, at rest unless a speed is given."""
    values = {"preload": PRELOAD, "arrangement": Arrangement.BACK_TO_BACK} | values
    return Operation(inner_speed=inner_speed, **values)


def solved(at: Operation, bearing: BallBearing = BEARING) -> PairLoads:
    """Loads of a pair whose balls turn by friction alone."""
    return pair_loads(bearing, at, FREE, FRICTION)


def displacement(at: Operation, load: float, bearing: BallBearing = BEARING) -> float:
    """Axial displacement of one bearing under this load."""
    return equilibrium(bearing, with_axial_load(at, load), FREE, FRICTION).axial_displacement


@pytest.mark.parametrize("angle", [15.0, 40.0])
@pytest.mark.parametrize("preload", [20.0, 160.0])
def test_a_pair_gaps_at_2_sqrt_2_of_its_preload_and_later_as_the_angle_grows(angle, preload):
    """Load ~ displacement^1.5 at a constant angle; the first order of its growth: 1 + 7 c^2/(4 s) x."""
    bearing = replace(BEARING_218, contact_angle=math.radians(angle))
    found = solved(pair(preload=preload), bearing)
    span = (bearing.inner_conformity + bearing.outer_conformity - 1.0) * bearing.ball_diameter
    x, s, c = found.ring_offset / span, math.sin(bearing.free_angle), math.cos(bearing.free_angle)
    expected = 2.0 * math.sqrt(2.0) * (1.0 + 1.75 * c**2 / s * x)
    second_order = 3.0 * (c * x / s) ** 2  # derived above
    # x is the displacement over the distance of the groove centres A, s and c are of the free angle. With n =
    # s x + c^2 x^2/2 the approach over A, the load goes as n^1.5 (s + x)/(1 + n). Second order: below 3 x^2
    # c^2/s^2 here.
    assert found.gap_load / preload == pytest.approx(expected, rel=second_order)
    assert found.gap_load / preload > 2.0 * math.sqrt(2.0)


@settings(max_examples=15)
@given(
    angle=st.floats(10.0, 40.0),
    speed=st.sampled_from([0.0, 300.0, 1500.0]),
    preload=st.floats(20.0, 500.0),
    external=st.floats(0.0, 3.0),
)
def test_both_bearings_balance_the_external_load_between_rings_that_keep_their_distance(
    angle, speed, preload, external
):
    """Their loads differ by the external one; their displacements have the sum of the preload at rest."""
    bearing = replace(BEARING, contact_angle=math.radians(angle))
    at = pair(speed, preload=preload, axial_load=external * preload)
    found = solved(at, bearing)
    own, other = found.own_axial_load, found.other_axial_load
    assert own - other == pytest.approx(at.axial_load, rel=1e-12, abs=1e-12 * preload)  # rounding
    rest = displacement(replace(at, inner_speed=0.0), preload, bearing)
    assert found.ring_offset == pytest.approx(rest, rel=1e-12)
    together = displacement(at, own, bearing) + displacement(at, max(other, FAINT * preload), bearing)
    if other > 0.0:
        assert together == pytest.approx(2.0 * rest, rel=1e-6, abs=1e-6 * rest)  # root found to 1e-9 N
    else:
        assert together >= 2.0 * rest
        assert found.notes == (GAPPED,)


def test_a_rigid_pair_loads_itself_at_speed_and_a_spring_does_not():
    """The centrifugal force of the balls presses rings apart that cannot give way."""
    still, fast = solved(pair()), solved(pair(1500.0))
    assert still.own_axial_load == pytest.approx(PRELOAD, rel=1e-9)  # of the search
    assert fast.own_axial_load > 1.5 * PRELOAD
    assert fast.gap_load == still.gap_load  # stated at rest
    spring = solved(pair(1500.0, axial_load=50.0, preload_kind=PreloadKind.SPRING))
    assert (spring.own_axial_load, spring.other_axial_load, spring.gap_load) == (250.0, 200.0, None)


def test_beyond_the_gap_one_bearing_carries_all():
    """A thousandth below the gap the other one still carries something."""
    gap = solved(pair()).gap_load
    beyond, below = solved(pair(axial_load=1.001 * gap)), solved(pair(axial_load=0.999 * gap))
    assert (beyond.own_axial_load, beyond.other_axial_load) == (1.001 * gap, 0.0)
    assert beyond.notes == (GAPPED,)
    assert 0.0 < below.other_axial_load < 0.01 * PRELOAD
    assert below.notes == ()


def test_a_preload_that_the_balls_lose_at_speed_is_refused():
    """Without a contact angle they come to rest in the outer race, and the inner one is loose."""
    flat = replace(BEARING, contact_angle=0.0)
    with pytest.raises(InputError, match="preload is lost at this speed"):
        solved(pair(3000.0, preload=1.0), flat)


def test_every_verb_has_the_bearing_that_the_external_load_presses():
    """The chain of a pair is that of one bearing under its own load; a single preload is an axial load."""
    study = separatrix.read_study("momentum-wheel")
    speed = study.operation.inner_speed
    paired = separatrix.solve(replace(study, operation=pair(speed, axial_load=20.0)))
    own = paired.pair.own_axial_load
    alone = separatrix.solve(replace(study, operation=Operation(inner_speed=speed, axial_load=own)))
    assert paired.restitution == alone.restitution
    assert paired.orbit_by_diameter == alone.orbit_by_diameter
    assert paired.mobility.linear == alone.mobility.linear
    single = pair(speed, axial_load=20.0, arrangement=Arrangement.SINGLE)
    found = separatrix.solve(replace(study, operation=single))
    assert (found.pair, found.operation.axial_load) == (None, 220.0)


def test_the_answer_has_both_bearings_and_notes_on_the_lighter_one():
    """Far above the gap at rest the centrifugal force alone presses its balls, on the outer race."""
    study = separatrix.read_study("momentum-wheel")
    at = replace(study.operation, axial_load=2800.0, preload=10.0, arrangement=Arrangement.FACE_TO_FACE)
    answer = separatrix.bearing(replace(study, operation=at))
    found = answer.document()["pair"]
    gaps, skids = answer.document()["warnings"][:2]
    assert found["own_axial_load"] - found["other_axial_load"] == pytest.approx(2800.0, rel=1e-12)
    assert found["preload_kind"] == "rigid"
    assert gaps.startswith("At rest this axial_load gaps the preloaded pair: the limit is 28.7 N.")
    assert skids.startswith("The other bearing of the pair: 12 of 12 balls are almost unloaded")
    assert "an external axial load of 28.7 N at rest" in answer.summary()
