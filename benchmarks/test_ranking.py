"""Speed of the stability curve and of the whole ranking on the shipped study."""

import pytest

from separatrix.cage import moving_cage
from separatrix.chain.contacts import bearing_state, race_traction
from separatrix.chain.solution import solve
from separatrix.study.reading import read_study
from separatrix.verdict.long_jobs import Runner
from separatrix.verdict.ranking import rank
from separatrix.verdict.stability_curve import critical_friction


@pytest.fixture(scope="module")
def study():
    """The shipped study, everything compiled."""
    found = read_study("cryogenic-turbopump")
    solve(found)
    return found


def test_chain_up_to_the_cage(benchmark, study):
    """Equilibrium without race control, both traction curves, restitution; nothing remembered."""

    def chain():
        bearing_state.cache_clear()
        race_traction.cache_clear()
        found = solve(study)
        return found.restitution

    benchmark(chain)


def test_one_point_of_the_stability_curve(benchmark, study):
    """Critical friction with its band at a restitution factor of 0.6, on one core."""
    cage, settings = moving_cage(solve(study), 0.1), study.stability

    def point():
        return critical_friction(cage, 0.6, settings)

    benchmark.pedantic(point, rounds=1, warmup_rounds=0)


def test_rank(benchmark, study):
    """The whole ranking of the shipped study, its whole ensemble, on two threads; aim: under 5 s."""
    rank(study, runner=Runner(jobs=2))  # every kernel compiled before
    benchmark.pedantic(lambda: rank(study, runner=Runner(jobs=2)), rounds=3, warmup_rounds=0)
