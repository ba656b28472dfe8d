"""The generated reference: each key of a study, and each name in a real document of every verb."""

import re
from dataclasses import replace

import numpy as np
import pytest
from commands import document
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
from separatrix.study.template import sections, study_keys
from separatrix.verbs.parts.quantity_text import QUANTITIES
from separatrix.verdict.ranking_records import Ranked

BY_NAME = {"study", "provenance", "units", "metadata", "slopes", "tested"}
"""Parts of a document that are not records: their keys are those of a study, of a log, or conditions."""

FULL = separatrix.read_study("cryogenic-turbopump")
SMALL = replace(
    FULL,
    stability=replace(FULL.stability, runs=1, duration=0.01, kicks=(0.5,), restitution_factors=(0.3, 0.6)),
    ranking=replace(FULL.ranking, candidates=FULL.ranking.candidates[1:3]),
)
IN_SPACE = replace(SMALL, cage=replace(SMALL.cage, motion=separatrix.study.study.MotionModel.SPACE))
WEARS = replace(
    SMALL, wear=separatrix.study.study.WearRates(film_wear=5e-18, cage_wear=1e-15, bare_friction=0.35)
)
WORN = replace(SMALL, film=replace(SMALL.film, wear=separatrix.study.study.Wear(friction=0.3, share=0.2)))

ASKED = {
    "check": lambda: separatrix.check(SMALL),
    "bearing": lambda: separatrix.bearing(SMALL),
    "traction": lambda: separatrix.traction(SMALL),
    "restitution": lambda: separatrix.restitution(WORN),
    "mobility": lambda: separatrix.mobility(SMALL),
    "stability": lambda: separatrix.stability(SMALL, jobs=1),
    "map": lambda: separatrix.map(SMALL, points=2, runs=1, jobs=1),
    "simulate": lambda: separatrix.simulate(SMALL),
    "rank": lambda: separatrix.rank(SMALL, jobs=1),
    "sensitivity": lambda: separatrix.sensitivity(SMALL, samples=64, jobs=1),
    "sweep": lambda: separatrix.sweep(SMALL, "film.thickness=0.2..1um:2", jobs=1),
    "life": lambda: separatrix.life(WEARS, samples=64, revolutions=1e5, jobs=1),
    "simulate, in space": lambda: separatrix.simulate(IN_SPACE),
    "compare": lambda: separatrix.compare(*(separatrix.simulate(SMALL, run=run) for run in (0, 1))),
}


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


@pytest.mark.parametrize("what", ASKED)
def test_every_name_of_a_document_has_a_line(what):
    """A document of each verb that takes a study, small but complete; two runs that differ in inputs, too."""
    found, verb = ASKED[what]().document(), what.partition(",")[0]
    assert found["verb"] == verb
    assert verb != "compare" or (found["rows"] and found["inputs"])
    assert missing(verb, found) == set()


def test_every_name_of_the_verbs_without_a_study_has_a_line(tmp_path, monkeypatch, capsys):
    """Logs of a tribometer with what slid on what."""
    monkeypatch.chdir(tmp_path)
    rows = (f"{t},{0.1 + 0.003 * np.sin(t):.4f}" for t in range(600))
    (tmp_path / "a.csv").write_text("time (s),friction coefficient\n" + "\n".join(rows) + "\n")
    what = 'material = "PEEK"\ncounterface = "440C"\nmedium = "air"\nslip_speed = "1 m/s"\n'
    (tmp_path / "map.toml").write_text("[test]\n" + what)
    found = document(capsys, "tribometer", "a.csv", "--map", "map.toml")
    assert found["fits"]
    assert missing("tribometer", found) == set()


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
