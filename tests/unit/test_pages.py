"""The contract of every verb: Python = JSON = command line, and a page whose numbers are the document's."""

from __future__ import annotations

import contextlib
import json
import re
from dataclasses import replace

import pytest

import separatrix
from separatrix.front import api, main
from separatrix.ground.document import part_of
from separatrix.ground.errors import InputError
from separatrix.ground.quantity import Estimate
from separatrix.present import html
from separatrix.present.blocks import Facts, Heading, Level, Note, Picture, Table, View
from separatrix.present.draw import save
from separatrix.present.hover import plotly
from separatrix.present.pdf import pdf
from separatrix.present.spreadsheet import spreadsheet
from separatrix.present.text import text
from separatrix.study.reading import read_study
from separatrix.verbs import VERBS, verb_named
from separatrix.verbs.answer_files import page_of_document
from separatrix.verbs.parts import quantity_text
from separatrix.verbs.saved_answers import refusing_damage
from separatrix.verdict.long_jobs import Interrupted

SMALL = """
extends = "momentum-wheel"
[stability]
kicks = ["0.4 m/s"]
runs = 4
duration = "2 ms"
restitution_factors = [0.4, 0.6]
[cage]
model = "full"
[bearing]
contact_angle = "20 deg +- 1 deg"
"""
CALLS = {
    "simulate": {"kick": "0.4 m/s"},
    "map": {"x": "restitution_factor=0.2..0.8:2", "y": "ball_cage_friction=0..0.4:3", "runs": 2},
    "sensitivity": {"samples": 64},
    "sweep": {"vary": ("cage.mass=3..4g:2",), "verdicts": True},
}
LEVELS = (Level.BRIEF, Level.FULL, Level.REPORT, Level.SHEET)


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    """The shipped wheel, full model, with an ensemble of no weight and an uncertain input."""
    path = tmp_path_factory.mktemp("small") / "small.toml"
    path.write_text(SMALL, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def answers(small):
    """The answer of every verb to it, computed once."""
    found = {}

    def answer(verb):
        if verb not in found:
            found[verb] = getattr(api, verb)(small, **CALLS.get(verb, {}))
        return found[verb]

    return answer


def options(verb):
    """Return the options of a call as those of the command."""
    words = []
    for name, value in CALLS.get(verb, {}).items():
        for one in value if isinstance(value, tuple) else (value,):
            words += [f"--{name}"] if one is True else [f"--{name}", str(one)]
    return words


@pytest.mark.parametrize("verb", VERBS)
def test_python_and_command_line_answer_alike(verb, small, answers, capsys, tmp_path, monkeypatch):
    """The same document to the last digit, nothing else anywhere; the page of a saved answer is the same."""
    monkeypatch.chdir(tmp_path)
    answer = answers(verb)
    assert main([verb, str(small), *options(verb), "--json", "--quiet"]) == 0
    out, err = capsys.readouterr()
    assert (err, list(tmp_path.iterdir())) == ("", [])
    printed = json.loads(out, parse_constant=pytest.fail)
    assert json.loads(json.dumps(answer.document())) == printed
    known = verb_named(verb)
    assert answer.summary() == text(page_of_document(known, printed))
    assert answer.summary().startswith(printed["title"])


def numbers(value):
    """Yield every number of a document."""
    if isinstance(value, dict):
        for one in value.values():
            yield from numbers(one)
    elif isinstance(value, list):
        for one in value:
            yield from numbers(one)
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield float(value)


@pytest.mark.parametrize("verb", VERBS)
def test_every_number_of_a_page_is_the_documents(verb, answers, monkeypatch):
    """Those of tables and facts, and those told in sentences, too."""
    document = json.loads(json.dumps(answers(verb).document()))
    known, told = set(numbers(document)), []
    alone = quantity_text.alone

    def noted(value, *rest):
        told.append(value)
        return alone(value, *rest)

    monkeypatch.setattr(quantity_text, "alone", noted)
    page = verb_named(verb).page(part_of(document))
    for block in page.blocks:
        if isinstance(block, Table):
            told += [cell.value for one in block.shown for cell in one.cells if cell.is_number]
        elif isinstance(block, Facts):
            told += [cell.value for _, cell in block.pairs if cell.is_number]
    found = {one for value in told for one in (value if isinstance(value, Estimate) else (value,))}
    assert len(found) >= 5
    assert {one for one in found if one is not None} <= known


@pytest.mark.parametrize("verb", VERBS)
def test_every_medium_shows_every_page(verb, answers):
    """Text, HTML, PDF, workbook; each picture on paper and to hover over; no block is empty."""
    page = answers(verb).page()
    names = [one.name for one in page.blocks if isinstance(one, Picture | View)]
    assert len(names) == len(set(names))
    for level in LEVELS:
        shown = text(page, level)
        assert shown.isascii() or verb == "check"
        assert not re.search(r"\bnan\b|\binf\b|None|\$", shown), shown
    assert len(text(page).splitlines()) < 75
    drawn = html.html(page, {verb: answers(verb).document()})
    assert all('aria-label="' in drawn for _ in [0])
    assert pdf(page).startswith(b"%PDF")
    assert spreadsheet(page).startswith(b"PK")
    for one in page.blocks:
        if isinstance(one, Picture):
            spec = one.figure()
            assert save(spec).svg.startswith("<svg")
            json.dumps(plotly(spec), allow_nan=False)
            assert spec.alt
            assert all(
                "[" in axis.label or axis.names or not axis.has_ticks
                for panel in spec.panels
                for axis in (panel.x, panel.y)
            )


@pytest.mark.parametrize("verb", [verb for verb in VERBS if verb_named(verb).keeps_runs])
def test_an_interrupted_answer_has_a_page(verb, small):
    """Interrupted at any of its first steps: marked as incomplete, with a page in every medium."""
    for after in (1, 2):
        calls = iter(range(after))

        def stop(done, total, calls=calls):
            if next(calls, None) is None:
                raise KeyboardInterrupt

        with pytest.raises(Interrupted) as caught:
            getattr(api, verb)(small, **CALLS.get(verb, {}), progress=stop, jobs=1)
        answer = caught.value.finished
        if answer is None or answer.document()["complete"]:  # nothing or all was finished
            continue
        assert answer.document()["complete"] is False
        page = answer.page()
        assert "Interrupted" in text(page)
        html.html(page, level=Level.REPORT | Level.FULL)
        spreadsheet(page)


@pytest.mark.parametrize("verb", VERBS)
def test_a_damaged_answer_is_refused_in_a_line(verb, answers):
    """Each key taken away or made a text: the page is whole, or the answer is refused; no other error."""
    document = answers(verb).document()
    own = [key for key in document if key not in ("separatrix_version", "verb", "name", "title", "seed")]
    for key in own:
        for broken in ({k: v for k, v in document.items() if k != key}, {**document, key: "?"}):
            with contextlib.suppress(InputError), refusing_damage("old.json"):
                text(page_of_document(verb_named(verb), broken, "old.json"), Level.FULL)


def test_blocks_are_where_their_level_says(answers):
    """The screen has no picture, the report no hint on options; a heading has something below it."""
    page = answers("rank").page()
    brief = page.at(Level.BRIEF).blocks
    assert not any(isinstance(one, Picture) for one in brief)
    assert sum(isinstance(one, Note) and one.kind == "lead" for one in brief) == 1
    for level in LEVELS:
        blocks = page.at(level).blocks
        pairs = zip(blocks, [*blocks[1:], Heading("end")], strict=True)
        heads = [(a.depth, b.depth) for a, b in pairs if isinstance(a, Heading) and isinstance(b, Heading)]
        assert all(inner > outer for outer, inner in heads)
    assert "--full" not in text(page, Level.REPORT)


def test_a_notebook_shows_the_page(answers):
    """An answer is its page in a notebook."""
    assert "<h1>" in answers("bearing")._repr_html_()


def test_uncertain_inputs_are_said_to_be_at_their_means(answers):
    """By verbs that do not draw them."""
    assert "at their means: bearing.contact_angle" in answers("bearing").summary()
    assert "at their means" not in answers("sensitivity").summary()


def test_an_old_document_names_what_it_lacks():
    """What an answer of an earlier version lacks is said with its place."""
    study = replace(read_study("momentum-wheel"), cage=None, ranking=None)
    document = separatrix.bearing(study).document()
    del document["contacts"]["outer"]["approach"]
    with pytest.raises(InputError, match=r"old\.json: contacts: outer lacks approach"):
        text(page_of_document(verb_named("bearing"), document, "old.json"))
