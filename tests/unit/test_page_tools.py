"""Pages of `tribometer` and `compare`, and saved answers that are wrong."""

import json

import pytest
from commands import log
from test_reference_tables import missing

from separatrix.ground.document import Part, part_of
from separatrix.ground.errors import InputError
from separatrix.present.blocks import Level, Picture
from separatrix.present.figure import Across
from separatrix.present.text import text
from separatrix.study.reading import read_study
from separatrix.verbs import bearing, compare, computed, tribometer
from separatrix.verbs.answer_files import document, read_answer, read_answers, read_folder
from separatrix.verbs.compare import compared as compared_answers
from separatrix.verbs.compare import difference_interval, differing, results
from separatrix.verdict.judgement import wilson_interval

STUDY = read_study("cryogenic-turbopump")
ANSWER = json.loads(json.dumps(document(bearing.VERB, computed(bearing.VERB, STUDY))))


def saved(folder, name="bearing", **changes):
    """Write the answer of a bearing, changed, and return its path."""
    path = folder / f"{name}.json"
    path.write_text(json.dumps(ANSWER | changes))
    return path


# --- saved answers ------------------------------------------------------------------------------
@pytest.mark.parametrize(
    ("changes", "rule"),
    [
        ({"study": []}, "is not the document of an answer"),
        ({"verb": "none"}, "must be an answer of rank, sensitivity"),
        ({"units": None}, "is damaged: units"),
        ({"title": " "}, "is damaged: title"),
        ({"seed": "1"}, "is damaged: seed"),
        ({"warnings": [1]}, "is damaged: warnings"),
    ],
    ids=str,
)
def test_an_answer_that_was_changed_is_refused(tmp_path, changes, rule):
    """One line that names the file."""
    path = saved(tmp_path, **changes)
    with pytest.raises(InputError, match=rule) as error:
        read_answer(path)
    assert str(error.value).startswith((str(path), path.name))  # short in the folder of the file


def test_folders_and_reports_have_their_answers_by_verb(tmp_path):
    """An interrupted answer is read as any other; one under another name is refused."""
    saved(tmp_path, complete=False)
    assert read_folder(tmp_path)["bearing"]["complete"] is False
    page = tmp_path / "report.html"
    page.write_text(f'<script id="separatrix-answers">{json.dumps({"bearing": ANSWER})}</script>')
    assert list(read_answers(page)) == ["bearing"]
    saved(tmp_path, "rank")
    with pytest.raises(InputError, match="must be an answer of rank; got bearing"):
        read_folder(tmp_path)


# --- two answers --------------------------------------------------------------------------------
def compared(tmp_path, **changes):
    """Compare the answer of a bearing with itself, changed."""
    (tmp_path / "other").mkdir()
    options = compare.Options(first=saved(tmp_path), second=saved(tmp_path / "other", **changes))
    return json.loads(json.dumps(compare.compute(options), allow_nan=False))


def test_the_interval_of_a_difference_of_shares_is_that_of_another_program():
    """Newcombe's method 10 as statsmodels 0.15.0 has it (confint_proportions_2indep, newcomb), 4 decimals."""
    for first, second, low, high in (
        ((48, 80), (56, 70), 0.0524, 0.3339),
        ((2, 7), (6, 7), 0.0582, 0.8062),
        ((0, 20), (0, 10), -0.1611, 0.2775),
        ((0, 20), (10, 10), 0.6791, 1.0),
    ):
        shares = [(n / runs, *wilson_interval(n, runs)) for n, runs in (first, second)]
        assert difference_interval(*shares) == pytest.approx((low, high), abs=6e-5)


def test_noise_is_judged_by_counts_intervals_and_errors():
    """Beyond where the interval of the change excludes 0; what has no interval is not judged."""

    def node(count, eta, threshold, error):
        low, high = wilson_interval(count, 64)
        ends = {"restitution_threshold_low": threshold - 0.1, "restitution_threshold_high": threshold + 0.1}
        shares = {"probability_stable": count / 64, "probability_low": low, "probability_high": high}
        rest = {"restitution_threshold": threshold, "friction": 0.1 + error, "friction_error": 0.01}
        return results(Part({**ends, **shares, **rest, "restitution_factor": eta, "verdict": "A"}, {}))

    rows = {row.name: row for row in differing(node(32, 0.3, 0.5, 0.0), node(48, 0.4, 0.55, 0.05))}
    assert {name: row.beyond_noise for name, row in rows.items()} == {
        "probability_stable": True,
        "restitution_factor": None,
        "restitution_threshold": False,
        "friction": True,
    }
    low, high = 0.1 - 1.959964 * 0.01, 0.1 + 1.959964 * 0.01
    assert (rows["friction"].first.low, rows["friction"].first.high) == pytest.approx((low, high))


def test_the_most_loaded_ball_is_compared(tmp_path):
    """And an input that differs is told with its unit; two equal answers are told to be equal."""
    study = json.loads(json.dumps(ANSWER["study"]))
    study["film"]["thickness"]["value"] = 3e-7
    balls = [ball | {"load_inner": 2.0 * ball["load_inner"]} for ball in ANSWER["balls"]]
    found = compared(tmp_path, balls=balls, study=study)
    assert missing("compare", found) == set()
    assert [(row["place"], row["name"]) for row in found["rows"]] == [("most loaded ball", "load_inner")]
    assert [(one["key"], one["first"], one["second"]) for one in found["inputs"]] == [
        ("film.thickness", 5e-7, 3e-7)
    ]
    words = text(compare.page(part_of(found)))
    assert "most loaded ball  load at the inner race" in words
    assert "500 nm  300 nm" in words
    again = compared_answers({"bearing": ANSWER}, {"bearing": ANSWER}, names=("a", "b"))
    assert "The two answers are equal in every result." in text(compare.page(part_of(again)))


def test_what_is_decided_by_comes_first():
    """Verdicts, then safety factors of the own environment, which is not named; then those of others."""

    def ranked(verdict, *factors):
        rows = [[{"name": "A", "verdict": verdict, "safety_factor": one}] for one in factors]
        each = [{"name": place, "materials": row} for place, row in zip("EF", rows, strict=True)]
        return {"rank": ANSWER | {"verb": "rank", "environment": "E", "environments": each}}

    found = compared_answers(ranked("STABLE", 2.0, 3.0), ranked("UNSTABLE", 0.5, 0.1), names=("a", "b"))
    assert [(row["place"], row["name"]) for row in found["rows"]] == [
        *(("A", "verdict"), ("F / A", "verdict"), ("A", "safety_factor"), ("F / A", "safety_factor")),
    ]
    assert "counting noise: verdict (2)." in text(compare.page(part_of(json.loads(json.dumps(found)))))


def test_what_cannot_be_compared_is_refused(tmp_path):
    """Two verbs, and an answer whose parts are not those of one: a line with its file."""
    with pytest.raises(InputError, match="b must be an answer of bearing, as a is; got check"):
        compared_answers({"bearing": ANSWER}, {"check": ANSWER}, names=("a", "b"))
    with pytest.raises(InputError, match=r"bearing\.json is damaged|did not write"):
        compared(tmp_path, study={"ranking": {"candidates": [1]}})


# --- logs ---------------------------------------------------------------------------------------
@pytest.fixture(scope="module")
def tests_of_logs(tmp_path_factory):
    """Return the document of two logs: running-in from 0.2, then noise about a friction."""
    folder = tmp_path_factory.mktemp("logs")
    for seed, name in enumerate(("a.csv", "b.csv")):
        log(folder / name, 0.08, seed)
    found = tribometer.compute(tribometer.Options(files=(folder,)))
    return json.loads(json.dumps(found, allow_nan=False))


def test_each_test_is_drawn_with_its_cut_and_its_steady_part(tests_of_logs):
    """The ends of its steady part, and the mean over it."""
    page = tribometer.page(part_of(tests_of_logs))
    pictures = [one for one in page.blocks if isinstance(one, Picture)]
    assert [one.name for one in pictures] == ["a.csv", "b.csv"]
    test = tests_of_logs["tests"][0]
    course, *_ = pictures[0].figure().panels
    assert [one.at for one in course.marks if isinstance(one, Across)] == [
        test["run_in_end"],
        test["steady_end"],
    ]
    (mean,) = [one for one in course.marks if getattr(one, "name", "").startswith("steady mean")]
    assert tuple(mean.x) == (test["run_in_end"], test["steady_end"])
    assert len(test["course"]["along"]) == 600


def test_logs_that_were_read_alike_are_told_once(tests_of_logs):
    """With the columns that were taken, in a page that fits a screen; places along a test in minutes."""
    words = text(tribometer.page(part_of(tests_of_logs)))
    assert words.count('"friction coefficient"') == 1
    assert "a.csv and 1 more: plain text" in words
    assert "12.49" in text(tribometer.page(part_of(tests_of_logs)), Level.FULL)  # the last row, at 749.5 s
    assert words.count("\n") < 45
