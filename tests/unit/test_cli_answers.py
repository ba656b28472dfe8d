"""Each verb on a small study: keys that scripts rely on, and files."""

from __future__ import annotations

import json
from importlib import resources
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from commands import SMALL
from matplotlib import image

import separatrix
from separatrix.front import main
from separatrix.verbs import VERBS as NAMES
from separatrix.verbs import verb_named
from separatrix.verdict.ledger import NAME

ENVIRONMENTS = [
    "gaseous nitrogen, Chromex 40",
    "gaseous nitrogen, 440C",
    "liquid nitrogen, Chromex 40",
    "liquid nitrogen, 440C",
]
ELLIPSE = "semi_major semi_minor max_pressure approach rolling_speed"
CURVE = "slope slope_error creep_increment traction_coefficient"
DAMPING = "race_damping damping_ratio restitution_factor"
CRITICAL = "restitution_factor critical_friction critical_friction_low critical_friction_high"
MATERIAL = "name friction restitution_threshold margin probability_stable verdict rank reason"
KEYS = {
    ("bearing", "balls"): "contact_angle_inner contact_angle_outer load_inner load_outer orbital_speed "
    "pitch_angle spin_roll_ratio_inner spin_roll_ratio_outer",
    ("bearing", ""): "axial_displacement radial_displacement",
    **{("bearing", f"contacts.{race}"): ELLIPSE for race in ("inner", "outer")},
    **{("traction", race): CURVE for race in ("inner", "outer")},
    ("restitution", ""): " ".join(f"{name} {name}_free_spin" for name in DAMPING.split()),
    ("mobility", ""): "rates damping damping_relaxed effective_mass capacity speed force_forward force_law",
    ("simulate", ""): "outcome largest_offset whirl_frequency whirl_speed pocket_power",
    ("stability", "curve"): CRITICAL,
    ("stability", "linear_limit"): "restitution_factor critical_friction",
    ("rank", ""): "restitution_factor",
    ("rank", "overall"): MATERIAL,
    ("rank", "environments.materials"): MATERIAL,
}
"""Verb and place in its document -> the keys that scripts rely on."""

EXTRA = {
    "map": ("--points", "3", "--runs", "2"),
    "sensitivity": ("--samples", "64"),
    "sweep": ("--vary", "film.thickness=0.2..1um:3"),
}
"""Options without which a verb would take long."""

VERBS = [verb_named(name) for name in NAMES]
KEPT = {verb.name: {NAME} for verb in VERBS if verb.keeps_runs}
KEPT["simulate"] = {"moving-cage.html"}
KEPT["sweep"] = set()  # of the chain alone: no runs are kept
"""Files beside the answer."""

pytestmark = pytest.mark.usefixtures("elsewhere")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with the small study, and the answers of every verb in it."""
    place = tmp_path_factory.mktemp("answers")
    (place / "small.toml").write_text(SMALL)
    for verb in VERBS:
        options = ["--out", str(place / verb.name), "--quiet", *EXTRA.get(verb.name, ())]
        assert main([verb.name, str(place / "small.toml"), *options]) == 0
    return place


@pytest.fixture
def elsewhere(tmp_path, monkeypatch):
    """Run in an empty folder, to see what is written."""
    monkeypatch.chdir(tmp_path)


def answer(folder: Path, verb: str) -> dict:
    """Return the document of a verb, as it was written beside the figures."""
    return json.loads((folder / verb / f"{verb}.json").read_text(), parse_constant=pytest.fail)


def has(record: dict, names: str) -> bool:
    """Whether all names are keys, each present or null."""
    return set(names.split()) <= set(record)


def records(found, path: str) -> list[dict]:
    """Return the records at a place of a document."""
    places = [found]
    for key in filter(None, path.split(".")):
        inside = [one[key] for one in places]
        places = [one for item in inside for one in (item if isinstance(item, list) else [item])]
    return places


@pytest.mark.parametrize("verb", [verb.name for verb in VERBS])
def test_every_answer_says_where_it_comes_from(verb, folder):
    """Version, resolved study with its sources, seed and warnings are in every document."""
    found = answer(folder, verb)
    assert has(found, "separatrix_version verb name title study seed warnings")
    assert found["verb"] == verb
    assert found["study"]["bearing"]["ball_diameter"]["value"] == 0.0111125
    assert "cryogenic-turbopump.toml" in found["study"]["bearing"]["ball_diameter"]["origin"]


@pytest.mark.parametrize(("verb", "path"), KEYS)
def test_documents_have_the_keys_that_scripts_rely_on(verb, path, folder):
    """Each record at that place."""
    found = records(answer(folder, verb), path)
    assert found
    assert all(has(one, KEYS[verb, path]) for one in found)


def test_documents_have_a_row_for_each(folder):
    """Ball, point of a curve, restitution factor, environment and candidate."""
    assert len(answer(folder, "bearing")["balls"]) == 13
    for race in ("inner", "outer"):
        curve = answer(folder, "traction")[race]
        assert len(curve["creep_increment"]) == len(curve["traction_coefficient"])
    curve, rank = answer(folder, "stability"), answer(folder, "rank")
    assert [row["restitution_factor"] for row in curve["curve"]] == [0.3, 0.6, 0.9]
    assert curve["complete"] is True
    assert [one["name"] for one in rank["environments"]] == ENVIRONMENTS
    for rows in (rank["overall"], *(one["materials"] for one in rank["environments"])):
        assert {row["name"] for row in rows} == {"Armalon", "Meldin HTC 100"}


def test_a_missing_measurement_is_null_with_its_reason(folder):
    """Meldin HTC 100 was not measured in gaseous nitrogen: nulls, and the reason says so."""
    rows = answer(folder, "rank")["environments"][0]["materials"]
    missing = next(row for row in rows if row["name"] == "Meldin HTC 100")
    absent = ("friction", "restitution_threshold", "margin", "probability_stable", "verdict", "rank")
    assert [missing[name] for name in absent] == [None] * 6
    assert missing["reason"].startswith("not measured")


def test_what_is_null_has_a_reason(folder):
    """A stability point without a critical friction or without an end of its band says why."""
    for row in answer(folder, "stability")["curve"]:
        assert row["reason"] or None not in [row[name] for name in CRITICAL.split()]


@pytest.mark.parametrize("verb", [verb.name for verb in VERBS if verb.writes_data])
def test_files_are_whole_and_nothing_else_is_left(verb, folder):
    """Document, text for a terminal, dataset, each figure as PNG and SVG; no temporary file stays."""
    names = {path.name for path in (folder / verb).iterdir()}
    pictures = {name for name in names if name.endswith(".png")}
    assert pictures or verb == "bearing"  # none where all balls run alike
    own = {f"{verb}{suffix}" for suffix in (".json", ".txt", ".nc", ".xlsx", ".html")}
    assert names == pictures | KEPT.get(verb, set()) | {f"{p[:-4]}.svg" for p in pictures} | own
    text = (folder / verb / f"{verb}.txt").read_text(encoding="ascii")
    assert max(len(line) for line in text.splitlines()) <= 100


@pytest.mark.parametrize("verb", [verb.name for verb in VERBS if verb.writes_data])
def test_an_answer_read_back_has_the_arrays_of_the_fresh_one(verb, folder):
    """Values, units and places on the axes of the netCDF file, which was written from the record."""
    with xr.open_dataset(folder / verb / f"{verb}.nc", engine="h5netcdf", decode_times=False) as fresh:
        xr.testing.assert_identical(separatrix.load(folder / verb / f"{verb}.json"), fresh.load())


def test_no_figure_is_clipped(folder):
    """The outermost pixels of every picture are white: no label runs over the edge."""
    for path in folder.rglob("*.png"):
        pixels = image.imread(path)[..., :3]
        edges = [pixels[:2], pixels[-2:], pixels[:, :2], pixels[:, -2:]]
        least = min(edge.min() for edge in edges)
        assert least > 0.98, path.name  # white is 1; a grey hint of antialiasing passes


def test_the_dataset_names_dimensions_and_units(folder):
    """Ball and race, environment and material, are dimensions; quantities carry their unit."""
    bearing = separatrix.load(folder / "bearing" / "bearing.json")
    assert bearing["load_inner"].dims == ("ball",)
    assert bearing["load_inner"].attrs["units"] == "N"
    assert bearing["contact_max_pressure"].sel(race="inner").attrs["units"] == "Pa"
    rank = separatrix.load(folder / "rank" / "rank.json")
    assert rank["material_friction"].dims == ("environment", "material")
    there = {"environment": "liquid nitrogen, 440C", "material": "Armalon"}
    assert float(rank["material_friction"].sel(there)) == 0.08
    assert json.loads(rank.attrs["study"])["bearing"]["ball_count"]["value"] == 13
    # the numbers of the document
    data = separatrix.load(folder / "traction" / "traction.json")
    found = answer(folder, "traction")["outer"]["traction_coefficient"]
    np.testing.assert_array_equal(data["traction_coefficient"].sel(race="outer"), found)


def test_every_dimensional_variable_has_a_unit(folder):
    """Whatever is a plain number without a unit is in this list of counts and names."""
    counts = (
        *("most_loaded", "iterations", "whirling", "ball", "run", "runs", "nodes", "sweeps", "slip", "rank"),
        *("whirl_direction", "friction_scatter_assumed", "settles", "rolls", "whirls"),
        *("drifts", "unresolved", "kept_by_land", "left_pocket", "force_exceeds_races"),
        *("input_mean", "input_standard_deviation"),  # each in the unit beside it, in input_unit
    )
    for verb in (verb.name for verb in VERBS if verb.writes_data):
        data = separatrix.load(folder / verb / f"{verb}.json")
        for name, variable in data.variables.items():
            if variable.dtype.kind == "f":
                known = "units" in variable.attrs or str(name).endswith(counts)
                assert known, f"{verb}: {name}"


def test_the_default_folder_is_named_after_the_study(capsys):
    """Without `--out` the files are in a folder beside, with the study's name."""
    assert main(["bearing", "le7"]) == 0
    assert (Path("le7") / "bearing.html").exists()
    assert "Text, figures and data are in le7/" in capsys.readouterr().out


def test_jobs_do_not_change_the_answer(folder, capsys):
    """The same numbers on one thread and on three."""
    texts = []
    for jobs in ("1", "3"):
        assert main(["stability", str(folder / "small.toml"), "--json", "--jobs", jobs]) == 0
        texts.append(capsys.readouterr().out)
    assert texts[0] == texts[1]


def test_what_new_writes_is_a_study(capsys):
    """`new` writes a study that `check` accepts."""
    assert main(["new", "mine.toml"]) == 0
    assert "separatrix check mine.toml" in capsys.readouterr().out
    assert main(["check", "mine.toml"]) == 0


def test_a_check_fits_a_screen_and_full_shows_the_rest(capsys):
    """Seven materials without a datum at 90 K are one note; what matters and what is assumed comes first."""
    shipped = resources.files("separatrix") / "examples" / "cryogenic-turbopump.toml"
    bare = shipped.read_text(encoding="utf-8")
    lines = [line for line in bare.splitlines() if "ball_cage_stiffness" not in line]
    Path("cold.toml").write_text("\n".join(lines).replace('"77 K"', '"90 K"'))
    assert main(["check", "cold.toml"]) == 0
    said = capsys.readouterr().out
    assert len(said.splitlines()) <= 57
    assert max(map(len, said.splitlines())) <= 96
    assert said.count("not stated at 90 K") <= 3
    assert said.count("Note: ") == 1
    words = ("Speed parameter", "million mm rpm", "Pressure at rest", "maximum", "Assumed, because the study")
    assert all(one in said for one in words)
    assert main(["check", "cold.toml", "--full"]) == 0
    whole = capsys.readouterr().out
    assert "cold.toml, line" in whole
    assert "Materials, at the temperature of the study." in whole


def test_the_speed_parameter_and_the_static_pressure_are_those_of_the_bearing(capsys):
    """DN is bore times speed; the pressure at rest is that of `bearing` at 0 rpm."""
    Path("still.toml").write_text('extends = "cryogenic-turbopump"\n[operation]\ninner_speed = "0 rpm"\n')
    assert main(["check", "cryogenic-turbopump", "--json"]) == 0
    checked = json.loads(capsys.readouterr().out)
    assert main(["bearing", "still.toml", "--json"]) == 0
    still = json.loads(capsys.readouterr().out)["contacts"]
    for race in ("inner", "outer"):
        assert checked["static"][race]["max_pressure"] == still[race]["max_pressure"]
