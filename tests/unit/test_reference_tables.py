"""The generated reference: each key of a study, and each name of a document (as test_pages asks)."""

import re

import pytest
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

from separatrix.present.quantity_text import QUANTITIES
from separatrix.study.template import sections, study_keys
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
