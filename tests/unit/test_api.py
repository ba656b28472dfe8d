"""The verbs as Python functions: text, tables, arrays and figure, equal to the command line's."""

import copy
import html
from dataclasses import replace

import pytest
from commands import SMALL, written

import separatrix
from separatrix.front import api
from separatrix.ground.errors import InputError
from separatrix.verdict.long_jobs import Interrupted


@pytest.fixture
def small(tmp_path):
    """A study with an ensemble of no weight."""
    return written(tmp_path, SMALL)


def test_an_answer_has_the_names_of_its_record(small):
    """So `answer.ranking` is `answer.record.ranking`; an unknown one is an AttributeError; copies work."""
    answer = api.restitution(small)
    assert answer.solution is answer.record.solution
    with pytest.raises(AttributeError):
        _ = answer.no_such_name
    assert copy.deepcopy(answer).document() == answer.document()


def test_a_figure_by_its_name(small):
    """The first one, or the one asked for; another name is refused."""
    answer = api.mobility(small)
    assert answer.plot().axes
    assert answer.plot("mobility").axes
    with pytest.raises(InputError, match="no picture nothing"):
        answer.plot("nothing")


def test_notes_are_in_the_answer_and_its_document(tmp_path):
    """MoS2 on the races: eta is 0; and what the reading of the study notes, if it was read before, too."""
    slippery = '[film]\nrace_friction = 0.02\n[operation]\ntemperature = "120 K"\n'
    answer = api.restitution(separatrix.read_study(written(tmp_path, SMALL + slippery)))
    read, eta = answer.notes
    assert "not stated at 120 K" in read
    assert eta.startswith("eta = 0")
    assert answer.document()["warnings"] == [read, eta]
    assert eta[:70] in " ".join(answer.summary().split())


def test_an_interrupt_carries_the_answer_of_what_was_finished(small, tmp_path):
    """And the folder keeps the runs for the next call."""

    def stop(done, total):
        if done > 0.6 * total:
            raise KeyboardInterrupt

    with pytest.raises(Interrupted) as caught:
        api.stability(small, jobs=1, folder=tmp_path / "kept", progress=stop)
    part = caught.value.finished
    assert part.verb == "stability"
    assert part.document()["complete"] is False
    whole = api.stability(small, folder=tmp_path / "kept")
    assert whole.document()["complete"] is True
    assert whole.document() == api.stability(small).document()


def test_a_report_of_a_study_is_a_document(small):
    """What the verbs answer, in one page; a progress that is asked for is told."""
    told = []
    bare = separatrix.read_study(small)
    bare = replace(bare, ranking=None)
    found = separatrix.report(bare, jobs=1, progress=lambda done, total: told.append((done, total)))
    assert [*found.documents] == ["stability", "bearing", "traction", "restitution"]
    assert told
    assert found.documents["bearing"]["balls"] == separatrix.bearing(bare).document()["balls"]
    assert found.summary().splitlines() == list(found.page.lead)
    assert found.page.lead[0] in html.unescape(found.html())
    assert found.pdf().startswith(b"%PDF-")
