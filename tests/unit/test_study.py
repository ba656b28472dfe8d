"""Records of a study check themselves; files are read key by key, with defaults, variants and origins."""

import json
import math
import pickle
from dataclasses import replace
from operator import attrgetter

import pytest
from commands import refusal, table

from separatrix.ground.errors import ValidityWarning
from separatrix.ground.units import UNITS
from separatrix.study.reading import read_study
from separatrix.study.sources import resolved
from separatrix.study.study import (
    ORDER,
    BallBearing,
    CageDesign,
    Candidate,
    Film,
    Friction,
    KinematicModel,
    Kinematics,
    Material,
    Operation,
    RankingQuestion,
    StabilitySettings,
    Study,
    evenly_spaced,
    shipped_studies,
)
from separatrix.study.template import template

STEEL = Material(name="steel", elastic_modulus=2e11, poisson_ratio=0.3, density=7800.0)

BASE = """\
title = "Base"
[bearing]
ball_diameter = "10 mm"
pitch_diameter = "60 mm"
ball_count = 12
contact_angle = "20 deg"
inner_conformity = 0.52
outer_conformity = 0.53
ball_material = "Si3N4"
ring_material = "440C"
[operation]
inner_speed = "10000 rpm"
axial_load = "1 kN"
[film]
race_friction = 0.1
material = "PTFE"
thickness = "1 um"
[cage]
mass = "20 g"
pocket_clearance = "0.5 mm"
material = "Armalon"
guidance = "inner"
land_clearance = "0.8 mm"
land_friction = 0.1
land_stiffness = "1e7 N/m"
land_restitution = 0.5
"""


def bearing(**changes):
    """A valid bearing with some fields changed."""
    fields = {"ball_diameter": 0.01, "pitch_diameter": 0.06, "ball_count": 12, "contact_angle": 0.4}
    fields |= {"inner_conformity": 0.52, "outer_conformity": 0.53}
    fields |= {"ball_material": STEEL, "ring_material": STEEL}
    return BallBearing(**fields | changes)


def study(**changes):
    """A valid study with some parts changed."""
    turning = Operation(inner_speed=1000.0, axial_load=1000.0)
    parts = {"bearing": bearing(), "operation": turning, "film": Film(race_friction=0.1)}
    return Study(**{"name": "test", "title": "Test"} | parts | changes)


@pytest.fixture
def read(tmp_path):
    """Read the text of a study, named case.toml."""

    def read_text(text, name="case.toml"):
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return read_study(path)

    return read_text


GOOD = {
    Operation: {"inner_speed": 1.0, "axial_load": 1.0},
    Film: {"race_friction": 0.1},
    CageDesign: {"mass": 0.02, "pocket_clearance": 1e-3},
    Friction: {"mean": 0.1},
    Candidate: {"name": "A", "friction": {"air": Friction(mean=0.1)}},
    RankingQuestion: {"environments": ("air",), "candidates": ()},
    Material: {"name": "steel", "elastic_modulus": 2e11, "poisson_ratio": 0.3},
}
OILY = Candidate(name="A", friction={"oil": Friction(mean=0.1)})
WIDE = {"cage": CageDesign(mass=0.02, pocket_clearance=0.006, ball_cage_stiffness=1e6)}
WRONG_RECORDS = [
    (
        bearing,
        {"ball_diameter": "1"},
        'BallBearing.ball_diameter needs a unit of length; got "1". Write "1 mm".',
    ),
    (bearing, {"ball_diameter": -1.0}, "BallBearing.ball_diameter must be > 0; got -1 m"),
    (bearing, {"ball_diameter": None}, "BallBearing.ball_diameter is missing"),
    (bearing, {"ball_diameter": True}, "BallBearing.ball_diameter must be a finite number > 0; got true"),
    (bearing, {"contact_angle": 15}, "contact_angle must be >= 0 and < 90 deg; got 859.43669 deg (15 rad)"),
    (bearing, {"contact_angle": math.pi / 2}, "BallBearing.contact_angle must be >= 0 and < 90 deg; got 90"),
    (bearing, {"ball_count": 12.0}, "ball_count must be a whole number from 3 to 200; got 12.0"),
    (bearing, {"ball_count": 19}, "BallBearing.ball_count must be at most 18"),
    (bearing, {"bore": 0.05}, "BallBearing.bore must be smaller than"),
    (Material, {"elastic_modulus": math.inf}, "Material.elastic_modulus must be a finite number > 0"),
    (Material, {"name": "a\nb"}, "Material.name must be one line of 1 to 200 printable"),
    (Operation, {"axial_load": 0.0}, "nothing presses the balls"),
    (Operation, {"axial_load": 0.0, "tilt": 1e-3}, "there is no radial load or moment"),
    (Operation, {"moment": 1.0, "tilt": 0.0}, "tilt and moment exclude each other"),
    (Operation, {"temperature": 0.0}, "Operation.temperature must be > 0"),
    (Film, {"thickness": 1e-6}, "Film.material is missing"),
    (CageDesign, {"land_clearance": 1e-3}, "CageDesign.land_clearance needs guidance: without it"),
    (StabilitySettings, {"kicks": ("1 m/s", "2 m")}, "StabilitySettings.kicks needs a unit of speed"),
    (StabilitySettings, {"kicks": (0.5, 0.1)}, "must be strictly increasing; got 0.1 m/s after 0.5 m/s"),
    (StabilitySettings, {"kicks": (math.nan,)}, "StabilitySettings.kicks[1] must be a finite number"),
    (Candidate, {"friction": {"air": None}}, 'Candidate.friction of "A" has no measured value'),
    (RankingQuestion, {"candidates": (OILY,)}, "RankingQuestion.candidates"),
    (RankingQuestion, {"environments": ()}, "must not be empty"),
    (study, {"film": Film(race_friction=0.0)}, 'must be > 0 for the "free" kinematics'),
    (study, {"bearing": bearing(ball_material=replace(STEEL, density=None))}, "needs a density"),
    (study, WIDE, "must be smaller than the gap between balls, 5.529 mm; got 6 mm"),
]


@pytest.mark.parametrize(("record", "changes", "words"), WRONG_RECORDS)
def test_a_wrong_record_is_refused_when_it_is_built(record, changes, words):
    """The field, the rule, the value in readable units."""
    refusal([words], record, lines=0, **GOOD.get(record, {}) | changes)


def test_a_record_reports_everything_wrong_at_once():
    """Two fields, one error that holds both."""
    refusal(["ball_diameter", "inner_conformity"], bearing, ball_diameter=-1, inner_conformity=5.88, lines=2)


def test_a_number_may_be_text_with_its_unit():
    """Every record takes text where a field has a unit; what it holds is in SI."""
    cage = CageDesign(mass="25 g", pocket_clearance="0.6 mm", pocket_angles=("0 deg", "180 deg"))
    assert (cage.mass, cage.pocket_clearance) == (0.025, 0.0006)
    assert cage.pocket_angles == (0.0, math.pi)
    assert replace(cage, pocket_clearance="0.2 mm").pocket_clearance == 2e-4
    assert Operation(inner_speed="30000 rpm", axial_load="3 daN").axial_load == 30.0
    assert StabilitySettings(kicks=("10 cm/s", 0.5)).kicks == (0.1, 0.5)
    assert replace(STEEL, elastic_modulus="200 GPa").elastic_modulus == 2e11


def test_balls_fit_up_to_touching():
    """Balls of neighbouring places touch when D = d_m sin(pi/Z)."""
    touching = 0.06 * math.sin(math.pi / 12)
    assert bearing(ball_diameter=touching * (1 - 1e-9)).ball_gap == pytest.approx(
        touching * 1e-9, rel=1e-6
    )  # cancellation
    refusal(["at most 11"], bearing, ball_diameter=touching * (1 + 1e-9))


def test_no_speed_and_no_friction_are_allowed_where_they_mean_something():
    """A static bearing; rings held at an angle; a frictionless one under race control."""
    assert Operation(inner_speed=0.0, axial_load=1.0, tilt=1e-3).tilt == 1e-3
    assert study(operation=Operation(inner_speed=0.0, axial_load=1.0)).operation.inner_speed == 0.0
    controlled = study(
        film=Film(race_friction=0.0), kinematics=Kinematics(model=KinematicModel.OUTER_RACE_CONTROL)
    )
    assert controlled.film.race_friction == 0.0


def test_evenly_spaced_numbers_are_round():
    """0.15 is 0.15, not 0.15000000000000002; exact."""
    assert evenly_spaced(0.05, 0.95, 19)[2] == 0.15
    assert evenly_spaced(0.05, 0.95, 19) == tuple(round(0.05 * i, 2) for i in range(1, 20))


def test_the_paper_like_example_has_the_numbers_of_its_class():
    """DN 0.75 million, 300 daN, 77 K, seven materials in four environments."""
    example = read_study("cryogenic-turbopump")
    speed_rpm = example.operation.inner_speed * 30 / math.pi
    assert example.bearing.bore * 1000 * speed_rpm == pytest.approx(0.75e6, rel=1e-12)  # rounding
    assert (example.operation.axial_load, example.operation.temperature) == (3000.0, 77.0)
    assert (example.bearing.ball_diameter, example.bearing.pitch_diameter) == (0.0111125, 0.065)
    assert example.kinematics.model is KinematicModel.FREE
    assert len(example.ranking.candidates) == 7
    fluids, rings = ("gaseous nitrogen", "liquid nitrogen"), ("Chromex 40", "440C")
    assert example.ranking.environments == tuple(f"{a}, {b}" for a in fluids for b in rings)


def test_the_examples_of_the_literature_have_their_printed_numbers():
    """LE-7 and the 218 bearing, under outer race control, without a cage."""
    le7, ball_218 = read_study("le7"), read_study("ball-218")
    assert (le7.bearing.ball_diameter, le7.bearing.ball_count) == (0.007938, 10)
    assert le7.operation.axial_load == 2670.0
    assert (le7.bearing.inner_conformity, le7.bearing.outer_conformity) == (0.56, 0.52)
    assert le7.bearing.ball_material.elastic_modulus == 199.948e9
    assert (ball_218.bearing.ball_diameter, ball_218.bearing.ball_count) == (0.02223, 16)
    assert {le7.kinematics.model, ball_218.kinematics.model} == {KinematicModel.OUTER_RACE_CONTROL}
    assert le7.cage is None
    assert le7.ranking is None


def test_shipped_studies_are_found_by_name_even_beside_a_folder_of_that_name(tmp_path, monkeypatch):
    """The default output folder has the name of the study; the next run must not stumble over it."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "le7").mkdir()
    assert read_study("le7").name == "le7"
    assert set(shipped_studies()) == {
        *("ball-218", "cryogenic-turbopump", "le7"),
        *("lox-turbopump", "lox-turbopump-radial", "momentum-wheel"),
    }


def test_a_file_of_that_very_name_comes_before_a_shipped_study(tmp_path, monkeypatch):
    """What lies on the disk is what was meant."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "le7").write_text(BASE)
    assert read_study("le7").title == "Base"


def test_the_template_is_a_valid_study(read):
    """What `separatrix new` writes can be ranked as it stands."""
    filled = read(template())
    assert filled.cage is not None
    assert len(filled.ranking.candidates) == 7


IN_SPACE = (
    *("transverse_inertia", "land_width", "land_diameter", "dynamic_unbalance", "axial_gravity"),
    "added_mass",
)


def test_every_line_that_is_off_in_the_template_can_be_switched_on(read):
    """The commented alternatives are right too: each key is taken, alone, in place of what it excludes."""
    excluded = {
        "radial_clearance": "contact_angle",
        "tilt": "moment",
        "elastic_modulus": "material",
    }
    beside = {
        "elastic_modulus": "poisson_ratio = 0.38",
        "ramp_start": 'ramp_time = "50 ms"',
        "pocket_axial_clearance": 'pocket_shape = "elongated"',
        "pocket_axial_offset": 'pocket_shape = "cylindrical"',
        "land_lobes": 'land_out_of_round = "20 um"',
        "inner_diameter": 'outer_diameter = "72 mm"\nwidth = "14 mm"',
        "outer_diameter": 'inner_diameter = "58 mm"\nwidth = "14 mm"',
        "width": 'inner_diameter = "58 mm"\nouter_diameter = "72 mm"',
        "land_spacing": 'motion = "space"\nland_count = 2',
        **dict.fromkeys(IN_SPACE, 'motion = "space"'),
    }
    text, _, candidates = template().partition("# [[")
    lines = text.splitlines()
    for line in lines:
        key = line.removeprefix("# ").partition(" = ")[0]
        if not line.startswith("# ") or not key.isidentifier():
            continue
        if key in ("poisson_ratio", "extends", "library"):  # with its modulus; files that are not there
            continue
        text = [other for other in lines if not (excluded.get(key) and other.startswith(excluded[key] + " "))]
        text[text.index(line)] = "\n".join([line.removeprefix("# "), *filter(None, [beside.get(key)])])
        assert read("\n".join(text)).title == "My bearing", line
    text = [line for line in lines if not line.startswith("friction =")]
    with_own = read("\n".join([*text, f"[[{candidates}".replace("# name", "name").replace("\n# ", "\n")]))
    assert [one.name for one in with_own.ranking.candidates] == ["My compound"]


def test_absent_keys_have_the_documented_defaults(read):
    """The defaults of the study file."""
    given = read(BASE)
    assert given.kinematics.model is KinematicModel.FREE
    operation, cage = given.operation, given.cage
    assert (operation.outer_speed, operation.radial_load, operation.moment) == (0.0, 0.0, None)
    assert operation.is_tilt_held
    assert (cage.land_friction, cage.land_stiffness, cage.land_restitution) == (0.1, 1e7, 0.5)
    assert (given.cage.unbalance, given.cage.gravity, given.cage.moment_of_inertia) == (0.0, 0.0, None)
    assert given.stability == StabilitySettings()
    assert given.stability.restitution_factors == ()
    assert given.ranking is None


def test_the_free_angle_follows_from_the_clearance(read):
    """cos(angle) = 1 - P_d / (2 (f_i + f_o - 1) D)."""
    given = read(BASE.replace('contact_angle = "20 deg"', 'radial_clearance = "20 um"'))
    expected = math.acos(1 - 20e-6 / (2 * 0.05 * 0.01))
    assert given.bearing.free_angle == pytest.approx(expected, rel=1e-12)  # acos loses some digits near 1
    assert "radial_clearance" in resolved(given)["bearing"]["contact_angle"]["origin"]


def test_a_film_may_be_given_in_place_or_left_out(read):
    """Modulus and Poisson's ratio in the section itself; nothing is bare."""
    in_place = read(BASE.replace('material = "PTFE"', 'elastic_modulus = "2 GPa"\npoisson_ratio = 0.4'))
    assert (in_place.film.body.elastic_modulus, in_place.film.body.poisson_ratio) == (2e9, 0.4)
    bare = read(BASE.replace('material = "PTFE"\nthickness = "1 um"\n', ""))
    assert bare.film == Film(race_friction=0.1)
    assert resolved(bare)["film"]["is_bare"] is True


def test_candidates_in_place_keep_their_gaps_and_their_scatter(read):
    """An environment where one was not measured is None, never 0."""
    given = read(
        BASE
        + """
[[ranking.candidates]]
name = "Mine"
friction = { "air" = 0.11, "liquid nitrogen, 440C" = { mean = 0.12, standard_deviation = 0.02, count = 8 } }
material = { elastic_modulus = "5 GPa", poisson_ratio = 0.4 }
[[ranking.candidates]]
name = "Armalon"
friction = { "air" = 0.07 }
material = "Armalon"
"""
    )
    mine, armalon = given.ranking.candidates
    assert given.ranking.environments == ("air", "liquid nitrogen, 440C")
    assert mine.friction["liquid nitrogen, 440C"] == Friction(mean=0.12, standard_deviation=0.02, count=8)
    assert mine.material.elastic_modulus == 5e9
    assert armalon.friction == {"air": Friction(mean=0.07), "liquid nitrogen, 440C": None}
    assert armalon.material.source.startswith("Composition")


VARIANTS = r"""
[operation]\naxial_load = "2 kN" :: operation.axial_load ; 2000.0
[operation]\naxial_load = "2 kN" :: operation.inner_speed ; 1047.1975511965977
[bearing]\nradial_clearance = "20 um" :: bearing.free_clearance ; 2e-05
[bearing]\nradial_clearance = "0 um" :: bearing.free_angle ; 0.0
[operation]\ntilt = "1 mrad" :: operation.tilt ; 0.001
[film]\nelastic_modulus = "2 GPa"\npoisson_ratio = 0.4 :: film.body.elastic_modulus ; 2000000000.0
[film]\nmaterial = "MoS2 sputtered dense" :: film.body.elastic_modulus ; 136000000000.0
[cage]\nguidance = "ball" :: cage.land_clearance ; None
[cage]\nguidance = "ball" :: cage.mass ; 0.02
[kinematics]\nmodel = "inner race control" :: kinematics.model ; KinematicModel.INNER_RACE_CONTROL
[stability]\nkicks = ["2 m/s", "100 mm/s", "0.5 m/s"] :: stability.kicks ; (0.1, 0.5, 2.0)
[ranking]\nfriction = "pin-on-disk-77K"\nmaterials = ["Vespel SP 211", "Armalon"]
    :: ranking.names ; ['Vespel SP 211', 'Armalon']
title = "Variant" :: title ; Variant
"""


@pytest.mark.parametrize(("text", "found"), table(VARIANTS))
def test_a_variant_overrides_its_base_key_by_key(text, found, tmp_path, read):
    """What excludes a key of the base replaces it; kicks come in order, materials in that of the study."""
    (tmp_path / "base.toml").write_text(BASE)
    variant = read(f'extends = "base.toml"\n{text}\n')
    if found[0] == "ranking.names":
        assert str([one.name for one in variant.ranking.candidates]) == found[1]
    else:
        assert str(attrgetter(found[0])(variant)) == found[1]
    assert variant.bearing.ball_count == 12
    assert read(BASE.replace('title = "Base"\n', "")).title == "case"


def test_a_variant_of_a_shipped_study_needs_no_path(read):
    """The candidates in place replace the table of the base, and the origins name both files."""
    text = (
        'extends = "cryogenic-turbopump"\n[[ranking.candidates]]\nname = "Mine"\nfriction = { "air" = 0.1 }\n'
    )
    variant = read(text)
    assert [c.name for c in variant.ranking.candidates] == ["Mine"]
    assert variant.origins["bearing.bore"] == 'cryogenic-turbopump.toml, line 13: "50 mm"'
    assert variant.origins["ranking.candidates"] == "case.toml, line 2"
    assert variant.title == "Cryogenic turbopump bearing in liquid nitrogen, seven cage materials"


def test_a_variant_of_a_variant_reads_through(tmp_path, read):
    """Two steps, in another folder."""
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "base.toml").write_text(BASE)
    (tmp_path / "sub" / "middle.toml").write_text('extends = "base.toml"\n[cage]\nmass = "30 g"\n')
    variant = read('extends = "sub/middle.toml"\n[operation]\naxial_load = "2 kN"\n')
    assert (variant.cage.mass, variant.operation.axial_load) == (0.03, 2000.0)


def test_resolved_inputs_are_plain_and_say_where_each_number_comes_from():
    """JSON without NaN; SI with units; origins, defaults, sources and confidences."""
    inputs = resolved(read_study("cryogenic-turbopump"))
    assert json.loads(json.dumps(inputs, allow_nan=False)) == inputs
    assert inputs["bearing"]["ball_diameter"] == {
        "value": 0.0111125,
        "unit": "m",
        "origin": 'cryogenic-turbopump.toml, line 7: "11.1125 mm"',
    }
    assert inputs["operation"]["outer_speed"] == {"value": 0.0, "unit": "rad/s", "origin": "default"}
    assert (
        inputs["cage"]["moment_of_inertia"]["origin"]
        == "default: of the ring's shape, or a thin ring at the pitch diameter"
    )
    assert inputs["stability"]["runs"]["origin"] == "default"
    assert inputs["film"]["material"]["confidence"] == "modulus: guess, Poisson's ratio: guess"
    armalon = next(c for c in inputs["ranking"]["candidates"] if c["name"] == "Armalon")
    assert armalon["friction"]["liquid nitrogen, 440C"]["mean"] == 0.08
    assert "table 3" in armalon["friction"]["liquid nitrogen, 440C"]["source"]
    meldin = next(c for c in inputs["ranking"]["candidates"] if c["name"] == "Meldin HTC 100")
    assert meldin["friction"]["gaseous nitrogen, 440C"] is None


def test_a_study_built_in_python_resolves_too():
    """Nothing is known of where its numbers come from, and that is said."""
    inputs = resolved(study())
    assert inputs["bearing"]["ball_diameter"]["origin"] == "given in Python"
    assert inputs["cage"] is None


def test_every_unit_of_a_record_can_be_read_from_text():
    """The reader takes the unit of a key from the type of its field; each has its table."""
    from separatrix.ground.units import unit_of

    for record in (BallBearing, Operation, Film, CageDesign, StabilitySettings, Material):
        for name in record.__dataclass_fields__:
            assert unit_of(record, name) in {"", "-", *UNITS}


def test_a_windows_file_is_read(tmp_path):
    """A byte order mark and CRLF line ends."""
    path = tmp_path / "case.toml"
    path.write_bytes(b"\xef\xbb\xbf" + BASE.replace("\n", "\r\n").encode())
    assert read_study(path).bearing.ball_count == 12


def test_a_study_crosses_a_process_border():
    """Studies are pickled to workers."""
    example = read_study("cryogenic-turbopump")
    again = pickle.loads(pickle.dumps(example))  # noqa: S301 - our own bytes
    assert again == example
    assert again.origins == example.origins


def test_the_page_on_study_files_names_every_section_and_every_unit():
    """The documentation of the contract is complete; the generated page has the keys."""
    from pathlib import Path

    page = (Path(__file__).parents[2] / "docs" / "reference" / "study-file.md").read_text(encoding="utf-8")
    for section in ORDER:
        assert f"## [{section}]" in page
    table = (
        page.partition("| quantity |")[2].partition("Both micro signs")[0].replace("|", ",").replace("(", ",")
    )
    listed = {word.strip() for word in table.split(",")}
    for unit in {unit for known in UNITS.values() for unit in known}:
        assert unit in listed, unit


def test_the_toml_on_the_page_is_right(read):
    """All examples can be read."""
    from pathlib import Path

    page = (Path(__file__).parents[2] / "docs" / "reference" / "study-file.md").read_text(encoding="utf-8")
    variant, wear, candidate = (block.partition("```")[0] for block in page.split("```toml\n")[1:])
    assert read(BASE + wear).film.wear.width == pytest.approx(2e-4)
    assert read(variant).operation.axial_load == 1500.0
    assert read(BASE + candidate).ranking.candidates[0].name == "My compound"


def test_a_land_left_beside_ball_guidance_is_said_to_be_unused(tmp_path):
    """Switching guidance to "ball" in a file answers without the land, and says which keys it leaves out."""
    path = tmp_path / "landless.toml"
    path.write_text(template().replace('guidance = "outer"', 'guidance = "ball"'))
    with pytest.warns(ValidityWarning, match=r"\[cage\] land_clearance, .*not used") as said:
        study = read_study(path)
    assert study.cage.land_clearance is None
    assert len({str(one.message) for one in said}) == 1
