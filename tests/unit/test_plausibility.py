"""Numbers beyond real bearings draw a note each, with number and limit; the answers stand."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest

from separatrix import KinematicModel, Kinematics, Operation, PocketShape, Study, read_study, solve
from separatrix.study.reading import beyond_bearings
from separatrix.verbs import restitution
from separatrix.verbs.verb import NoOptions
from separatrix.verdict.beyond_models import Moved, bending_frequency, beyond_motion, pocket_pressure

SHIPPED = read_study("cryogenic-turbopump", "paper")
CAGE = SHIPPED.cage
assert CAGE is not None


def operated(**changes: float) -> Study:
    """The shipped study under another operation."""
    return replace(SHIPPED, operation=replace(SHIPPED.operation, **changes))


def notes(study: Study) -> list[str]:
    """What its equilibrium notes."""
    return list(solve(study).bearing.notes)


BORELESS = replace(SHIPPED.bearing, bore=None)
STATIC = {
    "DN": (operated(inner_speed=41_888.0), "DN 20 million (bore in mm times speed in rpm) exceeds 3 million"),
    "DN without a bore": (replace(operated(inner_speed=8000.0), bearing=BORELESS), "DN 4.97 million (pitch"),
    "friction": (replace(SHIPPED, film=replace(SHIPPED.film, race_friction=1.9)), "friction 1.9 exceeds 1"),
    "heavy cage": (
        replace(SHIPPED, cage=replace(CAGE, mass=5.0)),
        "mass 5 kg does not fit the bearing: a polymer ring around these balls, 0.2 to 0.7 ball diameters "
        "high and 1.1 to 2.2 wide, has 2.5 g to 64 g.",
    ),
    "light cage": (replace(SHIPPED, cage=replace(CAGE, mass=1e-6)), "mass 1 mg does not fit the bearing"),
}


@pytest.mark.parametrize("case", STATIC)
def test_a_number_beyond_real_bearings_draws_one_note(case: str):
    """With the number and its limit; the shipped bearing draws none."""
    study, words = STATIC[case]
    (note,) = beyond_bearings(study)
    assert words in note
    assert list(beyond_bearings(SHIPPED)) == notes(SHIPPED) == []


def test_a_pressure_beyond_the_static_limit_and_a_contact_over_the_shoulder():
    """100 kN on the shipped bearing; 13.2 kN are just beyond it, were "52 deg, beyond 52 deg"."""
    assert "race ends 52.1 deg from" in notes(operated(axial_load=13.2e3))[-1]
    pressure, shoulder = notes(operated(axial_load=1e5))
    assert "GPa at the inner race exceeds 4.2 GPa, the static limit of ISO 76" in pressure
    assert "beyond a shoulder at 52 deg (assumed height: 0.2 of the ball diameter)" in shoulder


def test_balls_that_the_inner_race_hardly_touches_skid():
    """0.1 N at 15 000 rpm; at standstill nothing skids."""
    (note,) = notes(operated(axial_load=0.1))
    assert note.startswith("13 of 13 balls are almost unloaded: the inner race carries as little as 0.01")
    assert "below the limit of 1 %" in note
    still = Operation(inner_speed=0.0, axial_load=0.1, radial_load=1.0)
    assert notes(replace(SHIPPED, operation=still)) == []


def test_inner_race_control_fades_below_the_centrifugal_force():
    """39 N of each ball on the inner race beside 92 N under 300 N; 444 N beside 80 N under the own load."""
    inner = replace(SHIPPED, kinematics=Kinematics(model=KinematicModel.INNER_RACE_CONTROL))
    (note,) = notes(replace(inner, operation=replace(inner.operation, axial_load=300.0)))
    assert note.startswith("13 of 13 balls press the inner race with less than their centrifugal force")
    assert notes(inner) == notes(operated(axial_load=300.0)) == []


def test_an_overdamped_impact_is_called_so():
    """MoS2 on the shipped races: eta is 0, and the answer says what follows from it."""
    slippery = replace(SHIPPED, film=replace(SHIPPED.film, race_friction=0.02))
    answer = restitution.compute(slippery, NoOptions())
    (note,) = answer.notes
    assert re.match(r"eta = 0: .* C_mu = 87 N s/m is below .* = 137 N s/m; every", note)
    found = answer.solution.restitution
    assert found.race_damping < found.least_damping
    assert restitution.compute(SHIPPED, NoOptions()).solution.restitution.restitution_factor > 0.0
    assert restitution.compute(SHIPPED, NoOptions()).notes == ()


SOFT = replace(SHIPPED.ranking.candidates[0].material, compressive_strength=100e6)
FIRM = replace(SOFT, compressive_strength=None)
SIZE = {"outer_diameter": 0.070, "inner_diameter": 0.062, "width": 0.014}
ROW = Moved("A", largest_contact_force=50.0, largest_offset=501e-6)

STATE = solve(SHIPPED)


def test_round_pockets_kicked_faster_than_the_pocket_speed_are_noted():
    """At 669 rad/s and half of 0.6 mm the pocket speed is 0.201 m/s."""

    def notes(shape, *kicks):
        cage = replace(SHIPPED.cage, pocket_shape=shape)
        study = replace(SHIPPED, cage=cage, stability=replace(SHIPPED.stability, kicks=kicks))
        return [*beyond_motion(replace(STATE, study=study), [ROW])]

    assert notes(PocketShape.CYLINDRICAL, 0.2) == notes(PocketShape.SQUARE, 0.21) == []
    (note,) = notes(PocketShape.CYLINDRICAL, 0.05, 0.21)
    assert "the strongest disturbance, 0.21 m/s, exceeds 0.201 m/s" in note


def test_a_force_beyond_the_races_or_an_offset_beyond_the_land_is_noted():
    """The largest force of all rows; materials from 20 % beyond the gap of 0.5 mm. Nothing within."""
    assert list(beyond_motion(STATE, [ROW])) == list(beyond_motion(STATE, [])) == []
    (note,) = beyond_motion(STATE, [ROW, ROW._replace(name="B", largest_contact_force=275.0)])
    assert "275 N" in note
    assert "95.7 N" in note
    rows = [ROW._replace(largest_offset=599e-6), ROW._replace(name="B", largest_offset=852e-6)]
    (note,) = beyond_motion(STATE, rows)
    assert note.startswith("B: the cage centre reaches 852 um, beyond the land at 500 um")


def made_of(**walls):
    """The shipped study with candidates of these names and materials."""
    one = SHIPPED.ranking.candidates[0]
    candidates = tuple(replace(one, name=name, material=wall) for name, wall in walls.items())
    return replace(SHIPPED, ranking=replace(SHIPPED.ranking, candidates=candidates))


def test_pressure_in_a_pocket_is_hertz_of_a_ball_on_a_flat():
    r"""By the other form of the law, :math:`p_0^3 = 6 F E^{*2} / (\pi^3 R^2)`."""
    bearing, force = SHIPPED.bearing, 60.0
    ball = bearing.ball_material
    each = [(1 - one.poisson_ratio**2) / one.elastic_modulus for one in (ball, SOFT)]
    cubed = 6 * force / sum(each) ** 2 / (math.pi**3 * (bearing.ball_diameter / 2) ** 2)
    # the same law in another form: rounding of two roots
    assert pocket_pressure(bearing, SOFT, force) == pytest.approx(cubed ** (1 / 3), rel=1e-12)


def test_the_first_bending_of_a_ring_is_that_of_rayleigh():
    """By his quotient of two waves round: what a ring of E, I and rho A has."""
    wall = replace(SOFT, elastic_modulus=5e9, density=1500.0)
    shaped = replace(SHIPPED.cage, **SIZE, material=wall)
    radius, thickness = 0.033, 0.004
    angle = np.linspace(0.0, 2.0 * math.pi, 400, endpoint=False)
    w, v = np.cos(2 * angle), -0.5 * np.sin(2 * angle)  # outward; along, without stretching
    curved = (w - 4.0 * w) / radius**2  # w + w''
    stiff = 5e9 * thickness**3 / 12.0 * np.mean(curved**2)
    squared = stiff / (1500.0 * thickness * np.mean(w**2 + v**2))
    found = bending_frequency(shaped, None)
    assert found == pytest.approx(math.sqrt(squared) / (2.0 * math.pi), rel=1e-12)  # the same by other means
    assert bending_frequency(SHIPPED.cage, None) is None


@pytest.mark.parametrize(
    ("modulus", "words"),
    [
        (5e9, "bends at 830 Hz (solid, without its pockets), 0.19 times the 4.4 kHz at which it would"),
        (5e9, "a safety factor from 0.85 to 1.14 does not decide"),
        (1e8, "bends at 120 Hz (solid, without its pockets), 0.026 times the 4.4 kHz at which it would"),
        (1e8, "a softer ring was not computed"),
        (2e12, ""),
    ],
)
def test_a_ring_that_bends_as_fast_as_it_whirls_is_noted(modulus, words):
    """With both frequencies, their ratio and what the verdict is then worth; at 3.7 times it is rigid."""
    wall = replace(SOFT, elastic_modulus=modulus, density=1500.0)
    shaped = replace(SHIPPED.cage, **SIZE, material=wall)
    notes = beyond_motion(replace(STATE, study=replace(SHIPPED, cage=shaped), candidate=None), [ROW])
    (note,) = [one for one in notes if "ring of the cage" in one] or [""]
    assert words in note
    assert bool(words) == bool(note)


def test_fluid_in_the_gap_of_a_land_is_noted_unless_it_is_counted():
    """A land of 14 mm: 37 g beside a cage of 25 g, which by the closed law is sqrt(62/25) = 1.57 times."""

    def notes(**keys):
        study = replace(SHIPPED, cage=replace(SHIPPED.cage, **keys))
        return list(beyond_motion(solve(study), [ROW]))

    (note,) = notes(land_width=0.014)
    assert "37 g beside its 25 g" in note
    assert "by some 57 %" in note
    assert 'added_mass = "37 g", fluid_damping = "4.1 N s/m"' in note
    assert notes(land_width=0.014, added_mass=0.037) == notes(land_width=0.004) == []


def test_a_pocket_that_yields_is_noted_if_its_strength_is_known():
    """From 1.6 times the strength on; the other candidate states none."""
    study, rows = made_of(soft=SOFT, firm=FIRM), [ROW._replace(name="soft"), ROW._replace(name="firm")]
    pressure = pocket_pressure(study.bearing, SOFT, 50.0)
    for share, notes in ((1.59, 0), (1.61, 1)):
        wall = replace(SOFT, compressive_strength=pressure / share)
        assert len(list(beyond_motion(replace(STATE, study=made_of(soft=wall, firm=FIRM)), rows))) == notes
    (note,) = beyond_motion(replace(STATE, study=study), rows)
    assert f"soft {float(f'{pressure:.2g}') / 1e6:.0f} MPa against 160 MPa" in note
    assert "firm" not in note
