"""The generated reference: each key of a study, and each name of a document (as test_pages asks)."""

import re
from pathlib import Path

import pytest
from commands import extended
from reference_meanings import lines_of
from reference_tables import (
    PAPER,
    VERBS,
    json_page,
    lines_by_name,
    names_of,
    quantities_page,
    records_of,
    study_page,
    units_of_name,
)

import separatrix
from separatrix.present.blocks import Facts, Table
from separatrix.present.quantity_text import QUANTITIES
from separatrix.study.sources import resolved
from separatrix.study.template import sections, study_keys
from separatrix.verbs.report import FACTORS, claims, credibility
from separatrix.verdict.ranking_records import Ranked

BY_NAME = {"study", "provenance", "units", "metadata", "slopes", "tested"}
"""Parts of a document that are not records: their keys are those of a study, of a log, or conditions."""


def names_in(value):
    """Yield each key of a document, those of parts with names of their own left out."""
    if isinstance(value, dict):
        for key, inside in value.items():
            yield key
            if key not in BY_NAME:
                yield from names_in(inside)
    elif isinstance(value, list):
        for inside in value:
            yield from names_in(inside)


COMMON = {"separatrix_version", "verb", "name", "title", "study", "seed", "warnings", "provenance", "units"}


def missing(verb, found):
    """Names of a document without a line; the key of a study that a sweep varies is not one."""
    return {name for name in names_in(found) if "." not in name} - names_of(verb) - COMMON


@pytest.mark.parametrize("verb", VERBS)
def test_every_name_has_a_meaning(verb):
    """Of its own lines and of its records: words that are not the name again."""
    lines = [line for record in records_of(*VERBS[verb].records) for line in lines_of(record)]
    empty = [one for one in [*lines, *VERBS[verb].own] if not one.meaning.strip()]
    again = [one for one in lines if one.meaning.strip(". ").casefold() == one.name.replace("_", " ")]
    assert empty + again == []


def test_every_key_of_a_study_has_a_line():
    """With its unit, its bounds and its meaning; candidates have a section of their own."""
    page = study_page()
    for section in sections():
        assert f"\n## {f'[{section}]' if section else 'Above the first section'}\n" in page
        assert all(f"\n| `{one.name}` |" in page for one in study_keys(section))
    assert "| `mass` | kg | > 0 | May be left out" in page
    assert "| `ball_count` |  | whole number, 3 to 200 | Required. |" in page
    assert "| `contact_angle` | rad | 0 deg to below 90 deg | Without load" in page


def test_a_line_states_unit_dimensions_and_meaning():
    """From the type of a field, the text below it or in the docstring, or the comment beside it."""
    margin = next(one for one in lines_of(Ranked) if one.name == "margin")
    assert (margin.unit, margin.meaning) == ("-", "threshold less the restitution factor")
    page = json_page()
    assert all(f"\n## {verb}\n" in page for verb in VERBS)
    assert page.count("(verdict-judgement-judgement)=") == 1
    anchors = re.findall(r"^\((.*)\)=$", page, flags=re.MULTILINE)
    assert len(set(anchors)) == len(anchors)


def test_every_quantity_is_a_name_of_a_document_and_has_a_unit():
    """What stands in the table of quantities is in a record or document; so is each name with a symbol."""
    known = lines_by_name()
    told = [*QUANTITIES, *PAPER]
    assert [name for name in told if name not in known] == []
    assert [name for name in told if not units_of_name(name, known)] == []
    page = quantities_page()
    assert "| eta | `restitution_factor` | - | restitution factor |" in page
    assert "| N_I or Q_i | `load_inner` | N |" in page


# Levels of credibility: what is claimed, and what the report counts of a study.

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
