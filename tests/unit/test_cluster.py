"""Runs on a Dask cluster: the same numbers as here; and what is refused."""

import os
import sys
from dataclasses import replace

import distributed
import pytest

from separatrix.cage import moving_cage
from separatrix.chain.solution import solve
from separatrix.ground.errors import InputError
from separatrix.study.reading import read_study
from separatrix.verdict import cluster as clusters
from separatrix.verdict.cluster import cluster
from separatrix.verdict.long_jobs import Runner
from separatrix.verdict.stability_curve import stability_curve

STUDY = read_study("momentum-wheel")
CAGE = moving_cage(solve(STUDY), 0.0)
SETTINGS = replace(STUDY.stability, runs=4, duration=0.005, restitution_factors=(0.2, 0.8))


@pytest.fixture(scope="module")
def two():
    """Two worker processes."""
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, silence_logs=50
    ) as found:
        yield found


def test_a_cluster_gives_the_same_curve(two):
    """To the last bit."""
    with cluster(two.scheduler_address) as (executor, threads):
        assert threads == 4  # two for each worker
        runner = Runner(jobs=threads, executor=executor)
        far = stability_curve(CAGE, SETTINGS, runner=runner)
    assert far == stability_curve(CAGE, SETTINGS)


def refused(address):
    """Return the line with which an address is refused: with the option, and the address."""
    with pytest.raises(InputError) as refusal, cluster(address):
        pass
    text = str(refusal.value)
    assert text.startswith("--cluster ")
    assert "\n" not in text
    return text


def test_workers_of_another_version_are_refused(two, monkeypatch):
    """Their runs would be another engine's; the worker is named."""
    monkeypatch.setattr(clusters, "program", lambda: str(os.getpid()).encode())
    text = refused(two.scheduler_address)
    assert "has workers with another version" in text
    assert "tcp://" in text


WRONG = {
    "local:0": "must be local:N with N from 1 to 1024",
    "local:many": "must be local:N",
    "local:2000": "must be local:N",
    "nowhere": "is not the address of a running Dask scheduler",
    "tcp://127.0.0.1:1": "is not the address of a running Dask scheduler",
}


@pytest.mark.parametrize(("address", "words"), WRONG.items(), ids=WRONG.keys())
def test_a_wrong_address_is_refused_in_one_line(address, words, monkeypatch):
    """With the option, the rule and what was given."""
    monkeypatch.setattr(clusters, "PATIENCE", 0.5)
    text = refused(address)
    assert words in text
    assert f'"{address}"' in text


def test_without_the_extra_the_refusal_names_it(monkeypatch):
    """dask[distributed] is not among the requirements."""
    monkeypatch.setitem(sys.modules, "distributed", None)
    text = refused("local:1")
    assert "needs the extra cluster" in text
    assert "separatrix[cluster]" in text
