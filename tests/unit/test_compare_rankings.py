"""Two saved rankings side by side."""

import json

import pytest
from commands import document, refused

from separatrix.front import main

STUDY = {
    "cage": {"mass": {"value": 0.025, "unit": "kg", "origin": "default"}},
    "bearing": {"ball_material": {"name": "440C", "elastic_modulus": {"value": 2e11, "unit": "Pa"}}},
    "film": {"is_bare": True},
    "ranking": {
        "candidates": [{"name": "A", "friction": {"gas": {"mean": 0.1}, "liquid": None}, "material": None}],
        "table": {"conditions": {"normal_force": {"value": [10.0, 140.0], "unit": "N"}}},
    },
}


def saved(path, study, materials, verb="rank", **numbers):
    """Write a ranking in one environment; all numbers that are not given are null."""
    names = ("margin", "probability_stable", "friction", "restitution_threshold", "verdict")
    values = {name: numbers.get(name, [None] * len(materials)) for name in names}
    rows = [
        {"name": material} | {name: values[name][i] for name in names} for i, material in enumerate(materials)
    ]
    answer = {"verb": verb, "title": path.stem, "seed": 1, "study": study, "overall": rows}
    path.write_text(json.dumps(answer | {"environments": [{"name": "gas", "materials": rows}]}))
    return str(path)


@pytest.fixture
def pair(tmp_path, monkeypatch):
    """Two rankings: another mass, ball material and friction, a material more, another verdict."""
    monkeypatch.chdir(tmp_path)
    other = json.loads(json.dumps(STUDY))
    other["cage"]["mass"]["value"] = 0.03
    other["bearing"]["ball_material"]["name"] = "Si3N4"
    other["ranking"]["candidates"][0]["friction"]["gas"]["mean"] = 0.2
    other["ranking"]["table"]["conditions"]["normal_force"]["value"] = [1.0, 2.0]
    first = {"margin": [0.5], "probability_stable": [0.0], "friction": [0.1], "verdict": ["UNSTABLE"]}
    second = {
        "margin": [-0.25, 0.1],
        "friction": [0.2, 0.3],
        "verdict": ["UNDECIDED", "STABLE"],
    }
    return (
        saved(tmp_path / "first.json", STUDY, ["A"], **first),
        saved(tmp_path / "second.json", other, ["A", "B"], **second),
    )


def test_verdict_margin_and_probability_of_each_material(pair, capsys):
    """A material that only one of them has is there too; 0 is a number, null is none."""
    found = document(capsys, "compare", *pair)
    rows = {(row["place"], row["name"]): row for row in [*found["verdicts"], *found["rows"]]}
    verdict, margin = rows["gas / A", "verdict"], rows["gas / A", "margin"]
    assert (verdict["first"]["value"], verdict["second"]["value"]) == ("UNSTABLE", "UNDECIDED")
    assert (margin["first"]["value"], margin["second"]["value"]) == (0.5, -0.25)
    assert (margin["change"], margin["noise"]) == (-0.75, "UNJUDGED")
    probability = rows["gas / A", "probability_stable"]
    assert (probability["first"]["value"], probability["second"]["value"]) == (0.0, None)
    only = rows["gas / B", ""]
    assert (only["first"]["value"], only["second"]["value"]) == (None, "there")
    assert found["verdicts"][0]["name"] == "verdict"


def test_inputs_that_differ_are_those_of_a_study_file(pair, capsys):
    """Values, names of materials and frictions; not what the library says of the tests."""
    found = document(capsys, "compare", *pair)["differences"]
    assert {one["key"]: (one["first"], one["second"]) for one in found} == {
        "cage.mass": (0.025, 0.03),
        "bearing.ball_material": ("440C", "Si3N4"),
        "friction of A in gas": (0.1, 0.2),
    }


def test_the_tables_are_printed_and_written(pair, tmp_path, capsys):
    """Text and document; no figure."""
    assert main(["compare", *pair, "--out", "both"]) == 0
    text = capsys.readouterr().out
    assert "UNSTABLE  UNDECIDED" in text
    assert "-0.75" in text
    assert {path.name for path in (tmp_path / "both").iterdir()} == {"compare.json", "compare.txt"}


def test_a_ranking_is_not_compared_with_a_simulation(pair, tmp_path, capsys):
    """One line says which is which."""
    run = saved(tmp_path / "run.json", STUDY, ["A"], verb="simulate")
    assert "rank" in refused(capsys, "compare", pair[0], run)
