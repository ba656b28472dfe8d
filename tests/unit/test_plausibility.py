"""Numbers beyond real bearings draw a note each, with number and limit; the answers stand."""

import math
import warnings
from dataclasses import replace

import pytest

from separatrix import verbs
from separatrix.chain.solution import solve
from separatrix.errors import ValidityWarning
from separatrix.study import BallBearing, Operation, Study
from separatrix.study_file import read_study
from separatrix.study_file.cautions import beyond_bearings, plausible_cage_masses

SHIPPED = read_study("cryogenic-turbopump")
CAGE = SHIPPED.cage
assert CAGE is not None


def operated(**changes: float) -> Study:
    """The shipped study under another operation."""
    return replace(SHIPPED, operation=replace(SHIPPED.operation, **changes))


def notes(study: Study) -> list[str]:
    """What its equilibrium warns of."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", ValidityWarning)
        _ = solve(study).bearing
    return [str(one.message) for one in caught]


def test_a_plausible_study_draws_no_note() -> None:
    """The shipped bearing is one."""
    assert list(beyond_bearings(SHIPPED)) == []
    assert notes(SHIPPED) == []


STATIC = {
    "DN": (
        operated(inner_speed=400_000 * math.pi / 30.0),
        "DN 20 million (bore in mm times speed in rpm) exceeds 3 million",
    ),
    "race friction": (
        replace(SHIPPED, film=replace(SHIPPED.film, race_friction=1.9)),
        "race_friction 1.9 exceeds 1",
    ),
    "heavy cage": (
        replace(SHIPPED, cage=replace(CAGE, mass=5.0)),
        "mass 5 kg does not fit the bearing: a polymer ring around these balls, 0.2 to 0.7 ball diameters "
        "high and 1.1 to 2.2 wide, has 2.5 g to 64 g.",
    ),
    "light cage": (replace(SHIPPED, cage=replace(CAGE, mass=1e-6)), "mass 1 mg does not fit the bearing"),
}


@pytest.mark.parametrize("case", STATIC)
def test_a_number_beyond_real_bearings_draws_one_note(case: str) -> None:
    """With the number and its limit."""
    study, words = STATIC[case]
    (note,) = beyond_bearings(study)
    assert words in note


def test_without_a_bore_the_pitch_diameter_stands_for_it() -> None:
    """A study need not give its bore."""
    bare = replace(operated(inner_speed=8000.0), bearing=replace(SHIPPED.bearing, bore=None))
    (note,) = beyond_bearings(bare)
    assert "DN 4.97 million (pitch diameter in mm times speed in rpm)" in note


def test_the_range_of_cage_masses_holds_real_ones() -> None:
    """A ring of half a ball's height and 1.7 balls' width of a polymer lies inside it."""
    low, high = plausible_cage_masses(SHIPPED)
    bearing: BallBearing = SHIPPED.bearing
    D = bearing.ball_diameter
    volume = (math.pi * bearing.pitch_diameter * 1.7 * D - 13 * math.pi / 4 * D**2) * 0.45 * D
    assert 2.0 * low < 1400.0 * volume < 0.7 * high


def test_a_pressure_beyond_the_static_limit_and_a_contact_over_the_shoulder() -> None:
    """100 kN on the shipped bearing."""
    pressure, shoulder = notes(operated(axial_load=1e5))
    assert "GPa at the inner race exceeds 4.2 GPa, the static limit of ISO 76" in pressure
    assert "beyond a shoulder at 52 deg (assumed height: 0.2 of the ball diameter)" in shoulder


def test_balls_that_the_inner_race_hardly_touches_skid() -> None:
    """0.1 N at 15 000 rpm; at standstill nothing skids."""
    (note,) = notes(operated(axial_load=0.1))
    assert note.startswith("13 of 13 balls are almost unloaded: the inner race carries as little as 0.01")
    assert "below the limit of 1 %" in note
    still = Operation(inner_speed=0.0, axial_load=0.1, radial_load=1.0)
    assert notes(replace(SHIPPED, operation=still)) == []


def test_an_overdamped_impact_is_called_so() -> None:
    """MoS2 on the shipped races: eta is 0, and the answer says what follows from it."""
    slippery = replace(SHIPPED, film=replace(SHIPPED.film, race_friction=0.02))
    with pytest.warns(ValidityWarning, match=r"eta = 0: .* C_mu = 87 N s/m is below .* = 137 N s/m; every"):
        found = verbs.restitution(slippery).solution.restitution
    assert found.race_damping < found.least_damping
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert verbs.restitution(SHIPPED).solution.restitution.restitution_factor > 0.0
