"""Answers of `rank` to random sane studies: none contradicts itself."""

import json

import pytest
from rank_answers import contradictions
from sane_studies import sane_text

from separatrix.front import main


@pytest.mark.parametrize("seed", [14, 26])
def test_no_verdict_is_contradicted_by_its_evidence(seed, tmp_path, capsys):
    """With 8 runs of 50 ms; a hundred studies with default settings: benchmarks/rank_sane_studies.py."""
    study = tmp_path / "sane.toml"
    quick = sane_text(seed, duration="50 ms", runs=8) + "restitution_factors = [0.2, 0.5, 0.8]\n"
    study.write_text(quick, encoding="utf-8")
    assert main(["rank", str(study), "--json"]) == 0
    assert list(contradictions(json.loads(capsys.readouterr().out))) == []
