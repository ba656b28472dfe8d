"""Speed of a sweep: the chain of a thousand cases of the shipped study on two threads."""

from __future__ import annotations

import numpy as np
from pytest_benchmark.fixture import BenchmarkFixture

from separatrix.chain.contacts import bearing_state, race_traction
from separatrix.study.reading import read_study
from separatrix.verdict.long_jobs import Runner
from separatrix.verdict.swept_cases import Sweep, sweep


def test_sweep_of_the_chain(benchmark: BenchmarkFixture) -> None:
    """Film thickness against contact angle, nothing remembered; aim: 10 000 cases in under 60 s."""
    study = read_study("cryogenic-turbopump")
    thicknesses, angles = np.geomspace(2e-7, 2e-6, 20), np.linspace(0.25, 0.45, 50)
    cases = [{"film.thickness": t, "bearing.contact_angle": a} for t in thicknesses for a in angles]
    sweep(study, cases[:2])  # every kernel compiled before

    def whole() -> Sweep:
        bearing_state.cache_clear()
        race_traction.cache_clear()
        return sweep(study, cases, runner=Runner(jobs=2))

    found = benchmark.pedantic(whole, rounds=3)
    assert found.complete
    assert not any(case.reason for case in found.cases)
