"""Notes where the motion behind verdicts leaves the range of its model."""

import math
from dataclasses import replace

import pytest

from separatrix.chain.solution import solve
from separatrix.ranking.plausible import Moved, beyond_motion, pocket_pressure, transmitted_force
from separatrix.study_file import read_study

STUDY = read_study("cryogenic-turbopump")
SOFT = replace(STUDY.ranking.candidates[0].material, compressive_strength=100e6)
FIRM = replace(SOFT, compressive_strength=None)
ROW = Moved("A", largest_contact_force=50.0, largest_offset=501e-6)


@pytest.fixture(scope="module")
def state():
    """The shipped cage."""
    return solve(STUDY)


def test_races_transmit_friction_times_both_loads(state):
    """The shipped bearing: f_BT (Q_i + Q_o) = 95.7 N, as another program has it."""
    assert transmitted_force(state) == pytest.approx(95.7, abs=0.05)  # its last digit


def test_forces_and_offsets_within_their_range_draw_no_note(state):
    """Nor do no rows at all."""
    assert list(beyond_motion(state, [ROW])) == list(beyond_motion(state, [])) == []


def test_a_force_beyond_the_races_is_noted_with_both_numbers(state):
    """The largest of all rows."""
    rows = [ROW, ROW._replace(name="B", largest_contact_force=275.0)]
    (note,) = beyond_motion(state, rows)
    assert "275 N" in note
    assert "95.7 N" in note


def test_an_offset_beyond_the_land_is_noted_with_its_materials(state):
    """From 20 % beyond the gap of 0.5 mm."""
    rows = [ROW._replace(largest_offset=599e-6), ROW._replace(name="B", largest_offset=852e-6)]
    (note,) = beyond_motion(state, rows)
    assert note.startswith("B: the cage centre reaches 852 um, beyond the land at 500 um")


def made_of(**walls):
    """The shipped study with candidates of these names and materials."""
    one = STUDY.ranking.candidates[0]
    candidates = tuple(replace(one, name=name, material=wall) for name, wall in walls.items())
    return replace(STUDY, ranking=replace(STUDY.ranking, candidates=candidates))


def test_pressure_in_a_pocket_is_hertz_of_a_ball_on_a_flat(state):
    r"""By the other form of the law, :math:`p_0^3 = 6 F E^{*2} / (\pi^3 R^2)`."""
    bearing, force = STUDY.bearing, 60.0
    ball = bearing.ball_material
    each = [(1 - one.poisson_ratio**2) / one.elastic_modulus for one in (ball, SOFT)]
    cubed = 6 * force / sum(each) ** 2 / (math.pi**3 * (bearing.ball_diameter / 2) ** 2)
    # the same law in another form: rounding of two roots
    assert pocket_pressure(bearing, SOFT, force) == pytest.approx(cubed ** (1 / 3), rel=1e-12)


def test_a_pocket_that_yields_is_noted_if_its_strength_is_known(state):
    """From 1.6 times the strength on; the other candidate states none."""
    study, rows = made_of(soft=SOFT, firm=FIRM), [ROW._replace(name="soft"), ROW._replace(name="firm")]
    pressure = pocket_pressure(study.bearing, SOFT, 50.0)
    for share, notes in ((1.59, 0), (1.61, 1)):
        wall = replace(SOFT, compressive_strength=pressure / share)
        assert len(list(beyond_motion(replace(state, study=made_of(soft=wall, firm=FIRM)), rows))) == notes
    (note,) = beyond_motion(replace(state, study=study), rows)
    assert f"soft {float(f'{pressure:.2g}') / 1e6:.0f} MPa against 160 MPa" in note
    assert "firm" not in note
