"""Answers of `rank` to random sane studies: none contradicts itself."""

import json

import pytest
from rank_answers import contradictions
from sane_studies import sane_text

from separatrix.front import main


@pytest.mark.parametrize("seed", [1, 14, 26])
def test_no_verdict_is_contradicted_by_its_evidence(seed, tmp_path, capsys):
    """With 8 runs of 50 ms; a hundred studies with default settings: benchmarks/rank_sane_studies.py."""
    study = tmp_path / "sane.toml"
    study.write_text(sane_text(seed, duration="50 ms", runs=8), encoding="utf-8")
    assert main(["rank", str(study), "--json"]) == 0
    assert list(contradictions(json.loads(capsys.readouterr().out))) == []


def test_a_contradiction_is_found():
    """A whirl called stable, a probability outside its interval, a cage outside its room: each is told."""
    ends = ("whirls", "drifts", "unresolved", "kept_by_land")
    count = {"kick": 0.5, "settles": 5, "rolls": 3, **dict.fromkeys(ends, 0)}
    row = {
        "name": "x",
        "verdict": "STABLE",
        "cage_motion": "ON THE LAND",
        "by_kick": [count],
        "runs": 8,
        "probability_stable": 1.0,
        "probability_low": 0.7,
        "probability_high": 1.0,
        "margin": 0.5,
        "restitution_threshold": 0.7,
        "restitution_threshold_low": 0.6,
        "restitution_threshold_high": 0.8,
        "restitution_factor": 0.2,
        "energy_imbalance": 0.0,
        "worst_kick": 0.5,
        "largest_offset": 1e-4,
        "mean_offset": 1e-4,
        "rubbing_force": 1.0,
    }
    cage = {"pocket_clearance": 2e-4, "land_clearance": 2e-4}

    def told(**change):
        rows = [{"name": "air", "materials": [row | change]}]
        return list(contradictions({"environments": rows, "cage": cage}))

    assert told() == []
    assert len(told(cage_motion="WHIRLING")) == 2
    assert len(told(probability_high=0.9)) == 1
    assert len(told(largest_offset=4e-4)) == 1
    assert len(told(mean_offset=2e-4)) == 1
    assert len(told(by_kick=[count | {"settles": 4, "rolls": 0, "whirls": 4}])) == 1
    assert len(told(by_kick=[count | {"kept_by_land": 5}])) == 1
    assert len(told(margin=0.6)) == 1
