"""Samples whose cage meets its land first, where the cage as given meets its balls."""

import numpy as np
import pytest

from separatrix.study_file import read_study
from separatrix.uncertainty.regime import other_regime
from separatrix.uncertainty.sampling import sample

BASE = 'extends = "cryogenic-turbopump"\n[cage]\n'


def drawn(tmp_path, text):
    """Draws of the shipped study (land 1 mm, pockets 0.6 mm) with other lines in [cage]."""
    path = tmp_path / "case.toml"
    path.write_text(BASE + text, encoding="utf-8")
    return sample(read_study(path), 256)


@pytest.mark.parametrize(
    "text",
    [
        'mass = "25 g +- 10 %"',
        'land_clearance = { between = ["0.7 mm", "1.2 mm"] }',
        'guidance = "ball"\npocket_clearance = { between = ["0.4 mm", "2 mm"] }',
    ],
)
def test_nothing_is_said_where_all_samples_are_of_one_kind(tmp_path, text):
    """Clearances that are certain, or never cross; no land."""
    assert other_regime(drawn(tmp_path, text)) == ()


def test_samples_that_meet_their_land_first_are_counted(tmp_path):
    """A quarter of the pocket clearances drawn evenly from 0.7 to 1.1 mm pass the land of 1 mm."""
    draws = drawn(tmp_path, 'pocket_clearance = { between = ["0.7 mm", "1.1 mm"] }')
    (sentence,) = other_regime(draws)
    count = np.count_nonzero(draws.column("cage.pocket_clearance") > 1e-3)
    assert abs(count - 64) <= 1  # a quarter of 256 points that fill their range evenly
    assert sentence.startswith(f"In {count} of 256 samples the cage meets its land before its pockets")
