"""Notes where the motion behind verdicts leaves the range of its model."""

from dataclasses import replace

import pytest

from separatrix.chain import cage_state
from separatrix.ranking.plausible import beyond_motion, transmitted_force
from separatrix.ranking.records import RankedMaterial
from separatrix.study_file import read_study

STUDY = read_study("cryogenic-turbopump")
ROW = RankedMaterial(name="A", reason="", largest_contact_force=50.0, largest_offset=501e-6)


@pytest.fixture(scope="module")
def state():
    """The shipped cage."""
    return cage_state(STUDY, friction=0.1)


def test_races_transmit_friction_times_both_loads(state):
    """The shipped bearing: f_BT (Q_i + Q_o) = 95.7 N, as another program has it."""
    assert transmitted_force(STUDY, state) == pytest.approx(95.7, abs=0.05)  # its last digit


def test_forces_and_offsets_within_their_range_draw_no_note(state):
    """Nor does a row that was not measured."""
    assert list(beyond_motion(STUDY, state, [ROW, RankedMaterial(name="B", reason="not measured")])) == []


def test_a_force_beyond_the_races_is_noted_with_both_numbers(state):
    """The largest of all rows."""
    rows = [ROW, replace(ROW, name="B", largest_contact_force=275.0)]
    (note,) = beyond_motion(STUDY, state, rows)
    assert "275 N" in note
    assert "95.7 N" in note


def test_an_offset_beyond_the_land_is_noted_with_its_materials(state):
    """From 20 % beyond the gap of 0.5 mm."""
    rows = [replace(ROW, largest_offset=599e-6), replace(ROW, name="B", largest_offset=852e-6)]
    (note,) = beyond_motion(STUDY, state, rows)
    assert note.startswith("B: the cage centre reaches 852 um, beyond the land at 500 um")
