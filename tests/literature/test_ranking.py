"""The paper's own ranking of its seven cage materials.

Source: the paper, section 5 and Figs 9-12, quoted in sources/cage_material_ranking.txt; friction from
its table 3. Frame: its thresholds are read from the stability curve of a bearing it does not give (DN
0.75e6, axial load 300 daN); ours is one of that class, with a land, and the ball set turns. So the order
is compared, and the statement about 0.6; not the thresholds themselves. The ensemble is small (24 runs of
0.1 s, 5 restitution factors): its thresholds scatter by some 0.05, far less than what separates the groups
compared.
"""

from dataclasses import replace

import pytest

from separatrix import Runner, StabilitySettings, read_study
from separatrix.chain.impact_restitution import SOLID_LUBRICATION_LIMIT
from separatrix.verdict.ranking import rank
from separatrix.verdict.ranking_records import NotMeasured, Ranked

SETTINGS = StabilitySettings(
    kicks=(0.5,), runs=24, duration=0.1, restitution_factors=(0.1, 0.3, 0.5, 0.7, 0.9), seed=1
)
INAPT = {"PEEK 450 GL 30", "Meldin HTC 100"}


@pytest.fixture(scope="module")
def ranking():
    """The shipped study, ranked with a small ensemble."""
    return rank(replace(read_study("cryogenic-turbopump"), stability=SETTINGS), runner=Runner(jobs=2))


def test_armalon_is_first_in_each_environment_and_the_two_inapt_materials_last(ranking):
    """The most appropriate material seems to be Armalon, according to these four graphs."""
    for environment in ranking.environments:
        best = environment.materials[0]
        assert (best.name, best.rank) == ("Armalon", 1)
    assert ranking.overall[0].name == "Armalon"
    # PEEK 450 GL 30 and Meldin HTC 100 come last over all environments, and need less than 0.6
    assert {row.name for row in ranking.overall[-2:]} == INAPT
    assert all(row.restitution_threshold < SOLID_LUBRICATION_LIMIT for row in ranking.overall[-2:])


def rows(ranking):
    """Every ranked row of every environment."""
    return [row for place in ranking.environments for row in place.materials if isinstance(row, Ranked)]


def test_armalon_alone_needs_no_less_than_the_paper_grants_solid_lubrication(ranking):
    """A threshold of 0.6 or more: the paper's section 5."""
    assert any(0.5 < row.restitution_threshold < 0.6 for row in rows(ranking))
    # Armalon alone: about 0.9 in the paper; ours, with the ball set turning, is lower but above 0.6 overall
    assert ranking.overall[0].restitution_threshold > SOLID_LUBRICATION_LIMIT


def test_what_the_paper_did_not_measure_is_not_ranked(ranking):
    """Meldin HTC 100 has a cross in both columns of gaseous nitrogen."""
    for environment in ranking.environments[:2]:
        row = next(row for row in environment.materials if row.name == "Meldin HTC 100")
        assert isinstance(row, NotMeasured)
        assert row.reason.startswith("not measured in gaseous nitrogen")
