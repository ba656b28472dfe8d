"""Levels of credibility: what is claimed, and what the report counts of a study."""

import re
from pathlib import Path

import pytest
from commands import extended

import separatrix
from separatrix.present.blocks import Facts, Table
from separatrix.study.sources import resolved
from separatrix.verbs.parts.credibility_blocks import FACTORS, claims, credibility

ROOT = Path(separatrix.__file__).parents[2]
STUDY = resolved(separatrix.read_study("cryogenic-turbopump"))
ROWS = [{"extrapolation": ["slip speed"]}, {"extrapolation": []}, {"reason": "not measured"}]
RANKED = {
    "study": STUDY,
    "warnings": ["one", "two"],
    "environment": "air",
    "environments": [{"name": "air", "materials": ROWS}, {"name": "vacuum", "materials": ROWS[:1]}],
}


@pytest.mark.parametrize("part", claims(), ids=lambda part: part["name"])
def test_a_claim_has_a_worded_level_its_evidence_and_what_is_missing(part):
    """A level without a wording in the documentation is not claimed; each test that is named exists."""
    page = (ROOT / "docs" / "credibility.md").read_text(encoding="utf-8")
    for key, words in FACTORS.items():
        cells = re.search(rf"^\| {words} \|(.*)\|$", page, re.MULTILINE)[1].split("|")
        worded = [0, *(level for level, cell in enumerate(cells, 1) if cell.strip() != "not found")]
        claim = part[key]
        assert claim["level"] in worded, key
        assert claim["missing"], key
        named = re.findall(r"`([a-z]+/test_\w+\.py)`", claim["evidence"])
        assert all((ROOT / "tests" / one).exists() for one in named), key
        assert named or claim["level"] < 2, key


def _shown(documents):
    """Rows of the table, and what is counted, by label."""
    _, table, counted = credibility(documents)
    assert isinstance(table, Table)
    assert isinstance(counted, Facts)
    rows = [[column.cell(row).text for column in table.columns] for row in table.rows]
    return rows, {label: cell.text for label, cell in counted.pairs}


def test_the_report_has_the_claimed_levels_and_counts_the_study():
    """Rows without a friction do not count, nor do other environments."""
    rows, counted = _shown({"rank": RANKED})
    assert rows == [[part["name"], *(str(part[key]["level"]) for key in FACTORS)] for part in claims()]
    assert counted["Use assessment"] == (
        "2 notes on what is outside its range; the friction of 1 of 2 candidates is extrapolated"
    )
    assert counted["Uncertain inputs"].startswith("none is stated")
    assert counted["Results robustness"] == "no input was varied"
    known = [
        one["confidence"] for row in STUDY["ranking"]["candidates"] for one in row["friction"].values() if one
    ]
    assert f"{len(known)} measured" in counted["Input pedigree"]
    assert " guess" in counted["Input pedigree"]


def test_uncertain_and_varied_inputs_are_named(tmp_path):
    """Of a study with a distribution, and with a sensitivity among its answers."""
    thin = extended(tmp_path, 'film.thickness = "0.5 um +- 20 %"\n')
    bearing = {"study": resolved(thin), "warnings": []}
    _, counted = _shown({"bearing": bearing, "sensitivity": bearing})
    assert counted["Uncertain inputs"] == "film.thickness"
    assert counted["Results robustness"] == "varied by `sensitivity`"
    assert counted["Use assessment"] == "no notes on what is outside its range"
