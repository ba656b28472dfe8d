"""Bearings by designation, and what the library has of wear and friction: sources, origins, refusals."""

import math
from dataclasses import replace
from pathlib import Path

import pytest
from commands import refusal, written

import separatrix
from separatrix.ground.errors import InputError
from separatrix.study.library import Library
from separatrix.study.reading import read_study, study_again
from separatrix.study.sources import resolved
from separatrix.study.study import WearRates, shipped_studies
from separatrix.study.wear_rates import library_rate
from separatrix.verdict.life_table import wear_rates

LIBRARY = Library()
SIZE_608 = """\
title = "Size 608"
extends = "momentum-wheel"

[bearing]
designation = "608-zz"
inner_conformity = 0.54
outer_conformity = 0.54
radial_clearance = "12 um"
ball_material = "440C"
ring_material = "440C"
"""
MULTIPLIERS = [("6205", 3.5848, 5.4152, 0.39828), ("6203", 3.0530, 4.9469, 0.3817)]


@pytest.mark.parametrize("name", LIBRARY.names("bearing"))
def test_a_bearing_of_the_catalogue_can_be_one(name, tmp_path):
    """Its balls fit; what it lacks are the inputs of a study: here grooves of 0.53 and 20 deg."""
    known = LIBRARY.record("bearing", name).data
    lacks = {"inner_conformity": "0.53", "outer_conformity": "0.53", "contact_angle": '"20 deg"'}
    given = "\n".join(f"{key} = {value}" for key, value in lacks.items() if key not in known)
    text = f'extends = "ball-218"\n[bearing]\ndesignation = "{name}"\n{given}\n'
    bearing = read_study(written(tmp_path, text, "case.toml")).bearing
    for key, (datum, *_) in known.items():
        assert getattr(bearing, key) == datum.value
    assert bearing.ball_gap > 0.0
    assert isinstance(bearing.ball_count, int)


@pytest.mark.parametrize(("name", "outer", "inner", "cage"), MULTIPLIERS)
def test_multipliers_that_the_source_prints_follow_from_the_geometry(name, outer, inner, cage):
    """Case Western Reserve prints sizes and multipliers of fault frequencies: they check count and sizes."""
    found = {key: one[0].value for key, one in LIBRARY.record("bearing", name).data.items()}
    share, balls = found["ball_diameter"] / found["pitch_diameter"], found["ball_count"]
    assert 0.5 * balls * (1.0 - share) == pytest.approx(outer, abs=2e-4)  # 0.2656 in is good to 2e-4
    assert 0.5 * balls * (1.0 + share) == pytest.approx(inner, abs=2e-4)
    assert 0.5 * (1.0 - share) == pytest.approx(cage, abs=2e-4)


@pytest.mark.parametrize(("name", "example"), [("218", "ball-218"), ("LE-7", "le7")])
def test_the_shipped_bearings_are_those_of_the_shipped_studies(name, example):
    """Every number that the record has and the study gives."""
    bearing = read_study(example).bearing
    for key, (datum, *_) in LIBRARY.record("bearing", name).data.items():
        if (value := getattr(bearing, key)) is not None:
            assert datum.value == value, key


def test_a_designation_fills_what_the_study_does_not_give(tmp_path):
    """In any spelling; nothing of the base's geometry is left; each value has its place, sure or a guess."""
    study = read_study(written(tmp_path, SIZE_608, "case.toml"))
    bearing = study.bearing
    assert (bearing.designation, bearing.ball_count, bearing.bore) == ("608", 7, 0.008)
    assert (bearing.ball_diameter, bearing.pitch_diameter) == (0.003969, 0.015)
    assert (bearing.contact_angle, bearing.radial_clearance) == (None, 12e-6)
    found = resolved(study)["bearing"]
    assert "bearings.toml, line" in found["ball_diameter"]["origin"]
    assert "maker: CO-SUN" in found["ball_diameter"]["origin"]
    assert "guess: " in found["pitch_diameter"]["origin"]
    assert found["inner_conformity"]["origin"] == "case.toml, line 6: 0.54"
    assert found["contact_angle"]["origin"].startswith("derived, from radial_clearance")
    assert found["designation"]["record"]["data"]["ball_count"][0]["value"] == 7
    (note,) = (note for note in study.notes if "608" in note)
    assert "pitch_diameter 15 mm of 608 is a guess" in note
    assert study_again(study.content) == study


def test_keys_of_the_study_override_the_catalogue(tmp_path):
    """Also in a variant of the study that has the designation, and with a scatter."""
    written(tmp_path, SIZE_608, "case.toml")
    text = 'extends = "case.toml"\n[bearing]\npitch_diameter = "15.1 mm +- 1 %"\nball_count = 6\n'
    study = read_study(written(tmp_path, text, "six.toml"))
    assert (study.bearing.ball_count, study.bearing.ball_diameter) == (6, 0.003969)
    assert study.bearing.pitch_diameter == pytest.approx(0.0151)
    assert list(study.distributions) == ["bearing.pitch_diameter"]
    assert not any("guess" in note for note in study.notes)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('"608-zz"', '"609"', ("line 5", "is not a bearing of the library", "Did you mean 608?")),
        ('"608-zz"', "608", ("line 5", "[bearing] designation must be text; got 608")),
        ("inner_conformity = 0.54\n", "", ("[bearing] lacks: inner_conformity",)),
        ('"12 um"', '"12 um"\nball_count = 30', ("line 9", "ball_count must be at most 11")),
        ('"12 um"', '"12 um"\nbore = "12 mm"', ("line 9", "bore must be smaller than", "11.03 mm")),
    ],
)
def test_wrong_designations_are_refused_in_one_line(tmp_path, old, new, words):
    """With the place, the rule, and near names; a value of the catalogue is checked as one of the file."""
    found = refusal(written(tmp_path, SIZE_608.replace(old, new), "case.toml"))
    assert "\n" not in found
    assert all(word in found for word in words), found


def test_a_bearing_of_the_user_is_one_of_the_library(tmp_path):
    """Beside the study, with the angle that its maker states."""
    written(
        tmp_path,
        "".join(
            f'[bearing."Ours 12"]\n{key} = {{ value = {value}, source = "sheet", confidence = "maker" }}\n'
            if key == "ball_count"
            else f'{key} = {{ value = {value}, source = "sheet", confidence = "maker" }}\n'
            for key, value in [
                ("ball_count", 12), ("ball_diameter", '"7 mm"'), ("pitch_diameter", '"36 mm"'),
                ("contact_angle", '"15 deg"'),
            ]
        ),
        "materials.toml",
    )  # fmt: skip
    text = SIZE_608.replace("608-zz", "ours 12").replace('radial_clearance = "12 um"\n', "")
    bearing = read_study(written(tmp_path, text, "case.toml")).bearing
    assert (bearing.ball_count, bearing.contact_angle) == (12, pytest.approx(math.radians(15.0), rel=1e-15))
    assert bearing.bore is None
    twice = 'radial_clearance = { value = "9 um", source = "sheet", confidence = "maker" }\n'
    path = tmp_path / "materials.toml"
    path.write_text(path.read_text() + twice)
    assert "radial_clearance" in refusal(tmp_path / "case.toml")


def test_the_film_of_the_library_has_a_wear_coefficient_between_endurance_and_run_in():
    """Run-in of a tribometer (Seynstahl and others) and what outlasts 1.05e8 cycles; the middle serves."""
    rate = library_rate(LIBRARY.material("film", "MoS2 sputtered dense", 293.0))
    assert rate.range == (pytest.approx(5e-18), pytest.approx(4e-15))
    assert rate.value == pytest.approx(math.sqrt(5e-18 * 4e-15), rel=0.02)  # its two digits
    assert "vacuum" in rate.test
    assert library_rate(LIBRARY.material("film", "PTFE transfer film")) is None
    assert library_rate(None) is None


def test_wear_that_neither_study_nor_library_has_is_refused_with_the_test():
    """A line for the film and one for the cage; what the study gives goes before the library."""
    study = separatrix.read_study("momentum-wheel")
    with pytest.raises(InputError, match=r"library has no wear coefficient of Vespel SP-3.*Measure the wear"):
        wear_rates(study, WearRates(bare_friction=0.3), study.ranking.candidates[0])
    rates = wear_rates(study, WearRates(bare_friction=0.3, cage_wear=1e-15), study.ranking.candidates[0])
    assert (rates["wear.cage_wear"].value, rates["wear.cage_wear"].test) == (1e-15, "")
    assert "MoS2 sputtered dense in the library" in rates["wear.film_wear"].test
    bare = replace(study, film=read_study("cryogenic-turbopump").film)
    with pytest.raises(InputError) as error:
        wear_rates(bare, WearRates(bare_friction=0.3), None)
    assert [one.path for one in error.value.problems] == ["[wear] film_wear", "[wear] cage_wear"]
    assert "PTFE transfer film" in str(error.value)


def test_a_cage_of_the_library_brings_its_wear():
    """Unfilled PEEK, by the candidate or by the cage."""
    study = separatrix.read_study("momentum-wheel")
    peek = replace(
        study.ranking.candidates[0], name="PEEK", material=LIBRARY.material("cage material", "PEEK")
    )
    rates = wear_rates(study, WearRates(bare_friction=0.3), peek)
    assert rates["wear.cage_wear"].value == pytest.approx(6.5e-14)
    assert rates["wear.cage_wear"].range is None


def test_friction_of_a_film_in_vacuum_is_a_table_of_its_own():
    """With its source; what is published without a number is absent."""
    table = LIBRARY.record("friction table", "MoS2 in vacuum").content
    assert table.rows["MoS2 sputtered dense"]["vacuum, steel"].mean == 0.06
    assert LIBRARY.names("friction table")[0] == "pin-on-disk-77K"


@pytest.mark.parametrize(
    "kind", ["bearing material", "film", "cage material", "friction table", "bearing", "study"]
)
def test_the_page_on_study_files_lists_every_shipped_name(kind):
    """Of the kinds that it lists name by name."""
    page = (Path(__file__).parents[2] / "docs" / "reference" / "study-file.md").read_text(encoding="utf-8")
    names = shipped_studies() if kind == "study" else LIBRARY.names(kind)
    assert [one for one in names if f"`{one}`" not in page] == []
