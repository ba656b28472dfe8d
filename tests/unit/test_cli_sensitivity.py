"""The verb `sensitivity`: keys, text, files, threads, interrupts."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.text import Text

from separatrix import results
from separatrix.cli import main, sensitivity
from separatrix.cli.sensitivity import STAGES, stages
from separatrix.figures import figures
from separatrix.figures.sensitivity import environments
from separatrix.report.sensitivity import MARK
from separatrix.study_file import read_study
from separatrix.uncertainty import training

SMALL = """
extends = "cryogenic-turbopump"
title = "A small uncertain ranking"

[film]
thickness = { between = ["0.4 um", "0.6 um"] }

[stability]
kicks = ["0.5 m/s"]
runs = 8
duration = "10 ms"
restitution_factors = [0.2, 0.5, 0.8]

[[ranking.candidates]]
name = "A"
friction = { air = { mean = 0.1, standard_deviation = 0.02, count = 4 }, vacuum = 0.15 }

[[ranking.candidates]]
name = "B"
friction = { air = "0.3 +- 10 %" }
"""
KEYS = (
    "samples failed notes default_scatter inputs environments overall sizes convergence clouds boundaries "
    "boundary_draws kicks runs sobol next_test allowed_friction films films_reason doubt_reason chain cage "
    "complete seed study"
)
OF_A_ROW = (
    "name friction friction_deviation friction_scatter_assumed extrapolation restitution_factor reason "
    "restitution_threshold restitution_threshold_low restitution_threshold_high margin margin_low "
    "margin_high verdict nominal_threshold nominal_margin probability_stable probability_stable_low "
    "probability_stable_high probability_undecided probability_unstable probability_lowest_friction "
    "probability_best probability_best_low probability_best_high tie_group"
)
PARTS = ("stable", "undecided", "unstable")


@pytest.fixture(autouse=True)
def _small(tmp_path, monkeypatch):
    """Run in a folder with nothing but the small study, with few runs and samples."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(training, "RUNS", 200)
    monkeypatch.setattr(sensitivity, "DESIGN", 128)
    monkeypatch.setattr(sensitivity, "INVERSE", 128)
    Path("small.toml").write_text(SMALL)


def asked(capsys, *options: str) -> dict:
    """Return the document of the small study."""
    assert main(["sensitivity", "small.toml", "--json", "--samples", "64", *options]) == 0
    return json.loads(capsys.readouterr().out, parse_constant=pytest.fail)


def row(document, environment, name):
    """Return the row of a candidate."""
    one = next(one for one in document["environments"] if one["name"] == environment)
    return next(row for row in one["materials"] if row["name"] == name)


def test_the_document_has_the_keys_that_scripts_rely_on(capsys):
    """Every candidate in every environment, with probabilities that add up and lie in their intervals."""
    found = asked(capsys)
    assert set(KEYS.split()) <= set(found)
    assert set(OF_A_ROW.split()) <= set(found["overall"][0])
    rows = [r for one in found["environments"] for r in one["materials"] if r["friction"]] + found["overall"]
    assert len(rows) == 5
    for one in rows:
        assert sum(one[f"probability_{part}"] for part in PARTS) == pytest.approx(1.0, abs=1e-12)
        alone = one is row(found, "vacuum", "A")
        assert (one["probability_best"] is None) == alone
        for part in PARTS if alone else (*PARTS, "best"):
            low, value, high = (one[f"probability_{part}{end}"] for end in ("_low", "", "_high"))
            assert 0.0 <= low <= value <= high <= 1.0
        assert one["restitution_threshold_low"] <= one["restitution_threshold"]


def test_a_verdict_stands_with_its_evidence(capsys):
    """Largest offset, drift, forces, number and length of runs, as `rank` has them of the same cage."""
    found = asked(capsys)
    Path("small.toml").write_text(SMALL.replace("[[ranking", '[ranking]\nenvironment = "air"\n[[ranking', 1))
    assert main(["rank", "small.toml", "--json"]) == 0
    ranked = json.loads(capsys.readouterr().out)
    for name in "AB":
        known, same = row(found, "air", name), row(ranked, "air", name)
        for key in ("verdict", "largest_offset", "drift_rate", "largest_contact_force", "largest_land_force"):
            assert known[key] == same[key]
        assert (known["runs"], known["duration"]) == (8, 0.01)
    assert row(found, "vacuum", "B")["verdict"] is None
    for one in (found, ranked):
        assert row(one, "vacuum", "A")["probability_lowest_friction"] is None
        assert row(one, "air", "A")["probability_lowest_friction"] > 0.99


def test_the_runs_are_one_of_the_drivers(capsys):
    """What their finite number leaves open has indices as every input has; it is not a test to make."""
    found = asked(capsys)
    for case in found["sobol"]["cases"]:
        assert "boundary" in {one["factor"] for one in case["margin"]}
    assert "boundary" not in {one["name"] for one in found["next_test"]["tests"]}


def test_fewer_samples_than_a_fit_needs_are_answered(capsys, monkeypatch):
    """Here 80 for a line in one input, as 64 are too few for 16: more are drawn, after all the work."""
    for module in ("uncertainty.polynomial", "sensitivity.of_model"):
        monkeypatch.setattr(f"separatrix.{module}.LEAST_FOR_A_TERM", 40)
    assert asked(capsys)["sobol"]["fit_error"] < 1e-3  # a line in the thickness between 0.4 and 0.6 um


def test_what_was_not_measured_is_missing(capsys):
    """Everything is null but name and reason; it has no part in being best."""
    found = asked(capsys)
    missing = row(found, "vacuum", "B")
    assert missing["reason"] == "not measured in vacuum"
    assert missing["friction"] is missing["probability_stable"] is missing["tie_group"] is None


def test_one_that_is_measured_alone_is_best_among_none(capsys):
    """Null in row and convergence, missing in the dataset, said in text and picture."""
    assert main(["sensitivity", "small.toml", "--samples", "64", "--out", "here", "--quiet"]) == 0
    text = capsys.readouterr().out
    (line,) = [line for line in text.split("Over all")[0].splitlines() if "0.150 (" in line]
    assert line.split()[-1] == "none"
    found = json.loads((Path("here") / "sensitivity.json").read_text())
    for end in ("", "_low", "_high"):
        assert row(found, "vacuum", "A")[f"probability_best{end}"] is None
        assert row(found, "air", "A")[f"probability_best{end}"] > 0.9
    alone = {one["environment"] for one in found["convergence"] if one["probability_best"] is None}
    assert alone == {"vacuum"}
    data = results.load(Path("here") / "sensitivity.nc")
    assert np.isnan(data["convergence_probability_best"].sel(place="vacuum").values.astype(float)).all()
    drawn = dict(figures("sensitivity", data))
    words = {one.get_text() for one in drawn["sensitivity-probabilities"].findobj(Text)}
    assert "none: no other measured" in words
    labels = {one.get_text() for one in drawn["sensitivity-convergence"].findobj(Text)}
    assert "stable: A, vacuum" in labels
    assert not any(label.startswith("best") and label.endswith("vacuum") for label in labels)


def test_a_study_with_one_candidate_has_nobody_to_be_best_among(capsys):
    """The last sentence says that it is the only one; every picture is drawn."""
    Path("small.toml").write_text(SMALL[: SMALL.rindex("[[ranking")])
    assert main(["sensitivity", "small.toml", "--samples", "64", "--out", "here", "--quiet"]) == 0
    text = " ".join(capsys.readouterr().out.split())
    assert "In short: A is the only one measured over all environments; it is stable with" in text
    assert len(list(Path("here").glob("*.png"))) >= 5


def test_each_friction_has_the_scatter_that_is_known_of_it(capsys):
    """A measured one that of the next cage, an unrepeated one the default, a written one its own."""
    found = asked(capsys)
    expected = {("air", "A"): 0.02 * (1 + 1 / 4) ** 0.5, ("vacuum", "A"): 0.09 * 0.15, ("air", "B"): 0.015}
    for place, deviation in expected.items():
        known = row(found, *place)
        assert known["friction_deviation"] == pytest.approx(deviation, rel=1e-4)  # tails are cut at 5 of them
        assert known["friction_scatter_assumed"] is (place == ("vacuum", "A"))


def test_inputs_say_where_they_come_from(capsys):
    """Name, distribution as it was written, and its source."""
    inputs = {one["name"]: one for one in asked(capsys)["inputs"]}
    assert inputs["film.thickness"]["source"] == "study"
    assert inputs["ranking.A.air"]["source"] == "measured"
    assert inputs["ranking.A.vacuum"]["source"] == "assumed"
    assert not any(one["moves_boundary"] or one["moves_friction"] for one in inputs.values())


def test_any_number_of_threads_gives_the_same_answer(capsys):
    """To the last bit."""
    assert asked(capsys, "--jobs", "1") == asked(capsys, "--jobs", "2")


def test_another_seed_gives_another_answer_of_the_same_kind(capsys):
    """Another draw of samples and runs: the medians differ by less than nine in ten samples do."""
    first = asked(capsys)
    Path("small.toml").write_text(SMALL.replace("runs = 8", "runs = 8\nseed = 9"))
    one, other = (row(found, "air", "A") for found in (first, asked(capsys)))
    threshold = "restitution_threshold"
    assert one[threshold] != other[threshold]
    assert one[f"{threshold}_low"] < other[threshold] < one[f"{threshold}_high"]


def test_the_first_samples_are_those_of_a_smaller_question(capsys):
    """The last point of the convergence is the answer; earlier ones are wider."""
    found = asked(capsys, "--samples", "128")
    assert found["sizes"] == [64, 128]
    for one in found["convergence"]:
        place = one["environment"]
        rows = found["overall"] if place == "" else next(
            e["materials"] for e in found["environments"] if e["name"] == place)  # fmt: skip
        known = next(r for r in rows if r["name"] == one["name"])
        assert one["probability_stable"][-1] == known["probability_stable"]


def test_text_and_files(capsys):
    """Sections in their order; document, dataset and pictures in the folder, and each drawn again from it."""
    assert main(["sensitivity", "small.toml", "--samples", "64", "--out", "here", "--quiet"]) == 0
    text = capsys.readouterr().out
    heads = ("Air", "Vacuum", "Over all environments", "Uncertain inputs", "Boundary", "Convergence",
             "What drives", "Which test", "Which friction", "Which film", "In short")  # fmt: skip
    places = [text.index(head) for head in heads]
    assert places == sorted(places)
    assert "0.150 (" in text
    assert " own friction " in text
    assert MARK not in text.split("Uncertain inputs")[0]
    assert max(len(line) for line in text.splitlines()) <= 100
    pictures = {"sensitivity-probabilities", "sensitivity-convergence", "sensitivity-drivers",
                "sensitivity-1-air", "sensitivity-2-vacuum", "sensitivity-film"}  # fmt: skip
    assert {path.stem for path in Path("here").glob("*.png")} == pictures
    data = results.load(Path("here") / "sensitivity.nc")
    assert {name for name, _ in figures("sensitivity", data)} == pictures
    assert data["material_probability_stable"].attrs["units"] == "-"
    assert data["cloud_friction"].dims == ("environment", "material", "sample")
    assert data["film_probability_stable"].dims == (
        "environment",
        "material",
        "race_friction",
        "film_thickness",
    )
    assert data["film_thickness"].attrs["units"] == "m"
    data["material_extrapolation"] = data["material_extrapolation"].astype(object)
    data["material_extrapolation"][0, 0] = "too fast"
    drawn = dict(environments(data))
    beside = [{text.get_text() for text in one.findobj(Text)} for one in drawn.values()]
    assert ["friction outside the tests" in texts for texts in beside] == [True, False]
    assert [any(f"{MARK}  P(stable)" in text for text in texts) for texts in beside] == [True, False]


def test_an_interrupt_of_the_last_stage_keeps_the_probabilities(capsys, monkeypatch):
    """One line on standard error, status 130, complete: false; what was left out is null."""

    def interrupt(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(sensitivity, "doubt_of", interrupt)
    assert main(["sensitivity", "small.toml", "--json", "--samples", "64"]) == 130
    out, err = capsys.readouterr()
    found = json.loads(out)
    assert (found["complete"], found["sobol"], err.count("\n")) == (False, None, 1)
    assert found["overall"][0]["probability_stable"] is not None
    assert "interrupted" in found["doubt_reason"]


def test_an_earlier_interrupt_writes_nothing(capsys, monkeypatch):
    """One line, status 130, no file."""

    def interrupt(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("separatrix.uncertainty.model.trained", interrupt)
    assert main(["sensitivity", "small.toml", "--samples", "64"]) == 130
    out, err = capsys.readouterr()
    assert (out, err) == ("", "separatrix: interrupted; no file was written.\n")
    assert [path.name for path in Path().iterdir()] == ["small.toml"]


def test_films_are_asked_of_a_cage_that_only_its_candidates_make(monkeypatch):
    """A cage without stiffness and material of its own has the pocket of the first candidate."""
    study = read_study("cryogenic-turbopump")
    first = study.ranking.candidates[0]
    wall = replace(first, material=replace(study.bearing.ball_material, elastic_modulus=5e9))
    changed = replace(
        study,
        cage=replace(study.cage, ball_cage_stiffness=None, material=None),
        ranking=replace(study.ranking, candidates=(wall, *study.ranking.candidates[1:])),
    )
    monkeypatch.setattr("separatrix.sensitivity.stable_regions", lambda *asked: asked[2:])
    (grid,), _ = sensitivity._films(SimpleNamespace(study=changed), None, None)
    assert grid.x.own == study.film.thickness
    assert grid.restitution_factor.max() > 0.0


def test_stages_fill_one_progress():
    """From 0 to the end, never back."""
    told = []
    stage = stages(lambda done, total: told.append(done / total))
    for name in STAGES:
        part = stage(name)
        part(1, 2)
        part(2, 2)
    assert told == sorted(told)
    assert told[-1] == pytest.approx(1.0)
    assert stages(None)("chain") is None


def test_the_paper_table_with_the_default_scatter(capsys):
    """Armalon's friction is the lowest with 0.67 on Chromex 40 in gas, tied with three; else over 0.99."""
    Path("paper.toml").write_text(
        'extends = "cryogenic-turbopump"\n[stability]\nkicks = ["0.5 m/s"]\nruns = 8\nduration = "10 ms"\n'
        "restitution_factors = [0.2, 0.5, 0.8]\n"
    )
    assert main(["sensitivity", "paper.toml", "--json", "--samples", "1024", "--quiet"]) == 0
    found = json.loads(capsys.readouterr().out)
    rows = [row(found, one["name"], "Armalon") for one in found["environments"]]
    lowest = [one["probability_lowest_friction"] for one in rows]
    assert lowest[0] == pytest.approx(0.667, abs=0.001)  # the quadrature's, three digits
    assert min(lowest[1:]) > 0.99
    first = found["environments"][0]["materials"]
    tied = {one["name"] for one in first if one["tie_group"] == 1}
    assert tied == {"Armalon", "Meldin 7211", "PEEK WG 101", "PEEK 450 CA 30"}
    # the order of thresholds is that of frictions: the same within the scatter of 1024 samples
    assert [one["probability_best"] for one in rows] == pytest.approx(lowest, abs=0.04)
    assert found["default_scatter"] == 0.09
    assert np.mean([one["friction_scatter_assumed"] for one in rows]) == 1.0
