"""`compare`: what differs between two answers of a verb, and whether by more than counting noise."""

import contextlib
import io
import json
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from commands import document, refused

import separatrix
from separatrix import figures
from separatrix.comparing.results import difference_interval, differing, units
from separatrix.comparing.saved import read_answers
from separatrix.comparing.shown import pictures
from separatrix.front import main
from separatrix.ground.errors import InputError
from separatrix.verdict.judgement import wilson_interval

FEW = """extends = "cryogenic-turbopump"
[stability]
runs = 2
duration = "5 ms"
kicks = ["0.5 m/s"]
restitution_factors = [0.2, 0.4]
[ranking]
materials = ["Armalon", "PEEK WG 101"]
"""
THIN = FEW + "[film]\nthickness = '0.3 um'\n"
VERBS = {
    "check": (),
    "bearing": (),
    "traction": (),
    "restitution": (),
    "mobility": (),
    "simulate": (),
    "stability": (),
    "rank": (),
    "map": ("--points", "2", "--runs", "2"),
    "sensitivity": ("--samples", "64"),
    "sweep": ("--vary", "operation.axial_load=1..2kN:2", "--verdicts"),
}


def _steeper(answer):
    answer["inner"]["slope"] *= 2.0


def _worse(answer):
    row = answer["environments"][0]["materials"][0]
    row |= {
        "verdict": "UNSTABLE",
        "probability_stable": 0.0,
        "probability_low": 0.0,
        "probability_high": 0.06,
    }


DEAR = {"traction": _steeper, "sensitivity": _worse}
"""Verbs that take long: their second answer is the first one changed."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Documents of every verb for two studies."""
    made = tmp_path_factory.mktemp("compare")
    for name, text in (("first", FEW), ("second", THIN)):
        (made / f"{name}.toml").write_text(text)
        (made / name).mkdir()
        for verb, options in VERBS.items():
            if name == "second" and verb in DEAR:
                continue
            out = io.StringIO()
            with contextlib.redirect_stdout(out):
                assert main([verb, str(made / f"{name}.toml"), *options, "--json", "--quiet"]) == 0
            (made / name / f"{verb}.json").write_text(out.getvalue())
    for verb in DEAR:
        answer = json.loads((made / "first" / f"{verb}.json").read_text())
        answer["study"]["film"]["thickness"]["value"] = 3e-7
        DEAR[verb](answer)
        (made / "second" / f"{verb}.json").write_text(json.dumps(answer))
    return made


def pair(folder: Path, verb: str) -> list[str]:
    """Return both documents of a verb."""
    return [str(folder / name / f"{verb}.json") for name in ("first", "second")]


@pytest.mark.parametrize("verb", VERBS)
def test_two_answers_of_any_verb_are_compared(folder, capsys, verb):
    """The input that differs, and results of the right kind; an answer does not differ from itself."""
    found = document(capsys, "compare", *pair(folder, verb))
    assert (found["of"], found["left_out"]) == (verb, 0)
    assert [one["key"] for one in found["differences"]] == ["film.thickness"]
    kinds = {row["noise"] for row in found["rows"]}
    if verb in ("traction", "restitution", "mobility"):
        assert "EXACT" in kinds
        assert kinds <= {"EXACT", "WITHIN", "CHANGED"}
    if verb == "sensitivity":
        assert [row["name"] for row in found["verdicts"]] == ["verdict"]
        assert [(row["name"], row["noise"]) for row in found["rows"]] == [("probability_stable", "BEYOND")]
    same = document(capsys, "compare", *pair(folder, verb)[:1] * 2)
    assert (same["rows"], same["verdicts"], same["differences"]) == ([], [], [])
    assert same["unchanged"] > 10


def test_rankings_without_a_common_candidate_have_no_verdict_in_common(folder, capsys, tmp_path, monkeypatch):
    """None changed, because none can be compared: said instead of "None."."""
    monkeypatch.chdir(tmp_path)
    other = json.loads((folder / "second" / "rank.json").read_text())
    for row in [*other["overall"], *(row for one in other["environments"] for row in one["materials"])]:
        row["name"] = f"another {row['name']}"
    (tmp_path / "rank.json").write_text(json.dumps(other))
    both = [str(folder / "first" / "rank.json"), str(tmp_path / "rank.json")]
    found = document(capsys, "compare", *both)
    assert (found["shared_verdicts"], found["verdicts"]) == (0, [])
    assert main(["compare", *both]) == 0
    assert "The two answers have no verdict in common." in capsys.readouterr().out


def test_a_folder_is_compared_by_its_ranking_and_names_the_rest(folder, capsys, tmp_path, monkeypatch):
    """The text fits a screen, with what changed most first; all rows are in the file."""
    monkeypatch.chdir(tmp_path)
    assert main(["compare", str(folder / "first"), str(folder / "second")]) == 0
    text = capsys.readouterr().out
    assert text.startswith("Two answers of rank\n")
    assert "Both also have answers of sensitivity, stability" in text
    assert text.count("\n") < 60
    assert max(map(len, text.splitlines())) < 112
    pictures = {"comparison.png", "comparison.svg"}
    assert {path.name for path in Path("compare").iterdir()} == {"compare.json", "compare.txt"} | pictures
    assert len(Path("compare/compare.txt").read_text()) > len(text)
    assert main(["compare", str(folder / "first"), str(folder / "second"), "--full", "--json"]) == 0


@pytest.mark.parametrize(
    ("first", "second", "low", "high"),
    [
        ((48, 80), (56, 70), 0.0524, 0.3339),
        ((3, 10), (9, 10), 0.1705, 0.8090),
        ((2, 7), (6, 7), 0.0582, 0.8062),
        ((0, 29), (5, 56), -0.0381, 0.1926),
        ((0, 20), (0, 10), -0.1611, 0.2775),
        ((0, 10), (0, 10), -0.2775, 0.2775),
        ((0, 20), (10, 10), 0.6791, 1.0),
        ((0, 10), (10, 10), 0.6075, 1.0),
    ],
)
def test_the_interval_of_a_difference_of_shares_is_that_of_another_program(first, second, low, high):
    """Newcombe's method 10 as statsmodels 0.15.0 has it (confint_proportions_2indep, newcomb), 4 decimals."""
    shares = [(n / runs, *wilson_interval(n, runs)) for n, runs in (first, second)]
    assert difference_interval(*shares) == pytest.approx((low, high), abs=6e-5)


def test_the_interval_holds_the_true_difference_in_about_95_of_100():
    """Of shares of 64 runs with probabilities from anywhere: on average 93 to 98 %."""
    rng = np.random.default_rng(1)
    inside = 0
    for p, q in rng.random((1500, 2)):
        counts = rng.binomial(64, [p, q])
        shares = [(n / 64, *wilson_interval(int(n), 64)) for n in counts]
        low, high = difference_interval(*shares)
        inside += low <= q - p <= high
    assert 0.93 < inside / 1500 < 0.98


def test_noise_is_judged_by_counts_intervals_and_errors():
    """Beyond where the interval of the change excludes 0; a margin has that of its threshold."""

    def node(p, low, high, eta, threshold, error):
        ends = {"restitution_threshold_low": threshold - 0.1, "restitution_threshold_high": threshold + 0.1}
        shares = {"probability_stable": p, "probability_low": low, "probability_high": high, "runs": 64}
        chain = {"restitution_factor": eta, "restitution_threshold": threshold, **ends}
        own = {
            "margin": threshold - eta,
            "friction": 0.1 + error,
            "friction_error": 0.01,
            "verdict": "STABLE",
        }
        return {("A",): {**shares, **chain, **own}}

    first = node(0.5, *wilson_interval(32, 64), 0.3, 0.5, 0.0)
    second = node(0.75, *wilson_interval(48, 64), 0.4, 0.55, 0.05)
    rows = {row.name: row for row in differing("rank", first, second) if row is not None}
    assert {name: row.noise.name for name, row in rows.items()} == {
        "probability_stable": "BEYOND",
        "restitution_factor": "EXACT",
        "restitution_threshold": "WITHIN",
        "margin": "WITHIN",
        "friction": "EXACT",
    }
    assert rows["probability_stable"].first.runs == 64
    assert (rows["margin"].first.low, rows["margin"].first.high) == pytest.approx((0.1, 0.3))
    assert rows["friction"].change_low == pytest.approx(0.05 - 1.96 * 0.01 * 2**0.5, rel=1e-3)
    assert rows["restitution_factor"].relative == pytest.approx(1.0 / 3.0)


def test_python_compares_answers_and_files(folder):
    """`separatrix.compare` takes either, and its rows have units."""
    first = separatrix.restitution(folder / "first.toml")
    found = separatrix.compare(first, folder / "second" / "restitution.json")
    assert (found.of, [one.key for one in found.differences]) == ("restitution", ["film.thickness"])
    assert separatrix.compare(first, first).rows == ()
    damping = next(row for row in found.rows if row.name == "race_damping")
    assert damping.unit == units()["race_damping"] == "N s/m"


def test_two_curves_are_drawn_together(folder, tmp_path):
    """Of rankings with their margins: a row for each material; without a part of the arrays it is refused."""
    one, other = (read_answers(folder / name)["rank"] for name in ("first", "second"))
    ((name, figure),) = pictures(one, other)
    assert name == "comparison"
    assert [len(axes.lines) > 1 for axes in figure.axes] == [True, True]
    assert len(figure.axes[1].get_yticks()) == len(one.document["overall"])
    figures.save(figure, tmp_path / "two.png")
    curve = [
        {"restitution_factor": row["restitution_factor"]} for row in other.document["stability"]["curve"]
    ]
    spoiled = other.document | {"stability": other.document["stability"] | {"curve": curve}}
    with pytest.raises(InputError, match="lacks critical_friction"):
        list(pictures(one, replace(other, document=spoiled)))


def test_what_cannot_be_compared_is_refused(folder, capsys, tmp_path, monkeypatch):
    """Two verbs, a netCDF file, a study that separatrix did not write."""
    monkeypatch.chdir(tmp_path)
    rank, stability = (str(folder / "first" / f"{verb}.json") for verb in ("rank", "stability"))
    assert "must be an answer of rank" in refused(capsys, "compare", rank, stability)
    for call in (("compare", rank, "rank.nc"), ("report", "rank.nc", rank), ("reproduce", "rank.nc")):
        assert "answers are read from their .json. Name the rank.json" in refused(capsys, *call)
    for change, said in (
        ({"study": {}}, "did not write"),
        ({"seed": None}, "seed"),
        ({"title": " "}, "title"),
    ):
        answer = json.loads(Path(rank).read_text()) | change
        Path("odd.json").write_text(json.dumps(answer))
        assert said in refused(capsys, "compare", "odd.json", rank, "--json")


def test_two_studies_are_computed_and_reported(folder, capsys, tmp_path, monkeypatch):
    """What each lacks goes into its folder; a fault of either comes before all work."""
    monkeypatch.chdir(tmp_path)
    for name, text in (("first", FEW), ("second", THIN)):
        Path(f"{name}.toml").write_text(text)
        shutil.copytree(folder / name, tmp_path / name)
        Path(name, "bearing.json").unlink()
    assert "third.toml does not exist" in refused(capsys, "report", "first.toml", "third.toml")
    assert not Path("first/bearing.json").exists()
    assert main(["report", "first.toml", "second.toml", "--quiet"]) == 0
    assert all(Path(name, "bearing.json").exists() for name in ("first", "second"))
    assert capsys.readouterr().out.startswith("1 input differs.")
