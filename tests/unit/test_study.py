"""Records of a study check themselves; files are read key by key: defaults, variants, origins, refusals."""

import json
import math
import pickle
from dataclasses import replace
from pathlib import Path

import pytest
from cages import BEARING
from commands import changed, refusal, rows_of, written

from separatrix import InputError, read_study, resolved, template
from separatrix.ground.toml import parsed
from separatrix.ground.units import UNITS
from separatrix.study.keys import with_values
from separatrix.study.study import ORDER, Film, KinematicModel, Operation, Study, Wear, Worn, shipped_studies
from separatrix.verdict.parameter_axes import value_in, varied

VALID = """\
title = "A valid study"

[bearing]
ball_diameter = "11.1125 mm"
pitch_diameter = "65 mm"
ball_count = 13
contact_angle = "25 deg"
inner_conformity = 0.52
outer_conformity = 0.52
bore = "50 mm"
ball_material = "440C"
ring_material = { elastic_modulus = "205 GPa", poisson_ratio = 0.285, density = "7650 kg/m3" }

[operation]
inner_speed = "15000 rpm"
axial_load = "300 daN"

[kinematics]
model = "free"

[film]
race_friction = 0.1
material = "PTFE transfer film"
thickness = "0.5 um"

[cage]
mass = "25 g"
ball_cage_stiffness = "3e6 N/m"
pocket_clearance = "0.6 mm"
guidance = "outer"
land_clearance = "1 mm"
land_friction = 0.1
land_stiffness = "1e7 N/m"
land_restitution = 0.5

[stability]
kicks = ["0.1 m/s", "0.5 m/s", "2 m/s"]
runs = 64
restitution_factors = [0.05, 0.5, 0.95]

[ranking]
friction = "pin-on-disk-77K"
materials = ["Armalon", "Vespel SP 211"]
"""
BASE = VALID.partition("[stability]")[0].replace('[kinematics]\nmodel = "free"\n\n', "")


@pytest.fixture
def read(tmp_path):
    """Read the text of a study, named case.toml."""
    return lambda text: read_study(written(tmp_path, text, "case.toml"))


def test_balls_fit_up_to_touching():
    """Balls of neighbouring places touch when D = d_m sin(pi/Z)."""
    touching = 0.065 * math.sin(math.pi / 13)
    near = replace(BEARING, ball_diameter=touching * (1 - 1e-9))
    assert near.ball_gap == pytest.approx(touching * 1e-9, rel=1e-6)  # cancellation
    with pytest.raises(InputError, match="at most 12"):
        replace(BEARING, ball_diameter=touching * (1 + 1e-9))


def test_the_paper_like_example_has_the_numbers_of_its_class():
    """DN 0.75 million, 300 daN, 77 K, seven materials in four environments."""
    example = read_study("cryogenic-turbopump")
    speed_rpm = example.operation.inner_speed * 30 / math.pi
    assert example.bearing.bore * 1000 * speed_rpm == pytest.approx(0.75e6, rel=1e-12)  # rounding
    assert (example.operation.axial_load, example.operation.temperature) == (3000.0, 77.0)
    assert (example.bearing.ball_diameter, example.bearing.pitch_diameter) == (0.0111125, 0.065)
    assert example.kinematics.model is KinematicModel.FREE
    assert len(example.ranking.candidates) == 7
    assert example.ranking.environments == (
        "gaseous nitrogen, Chromex 40",
        "gaseous nitrogen, 440C",
        "liquid nitrogen, Chromex 40",
        "liquid nitrogen, 440C",
    )


def test_the_examples_of_the_literature_have_their_printed_numbers():
    """LE-7 and the 218 bearing, under outer race control, without a cage."""
    le7, ball_218 = read_study("le7"), read_study("ball-218")
    ball = le7.bearing
    assert (ball.ball_diameter, ball.ball_count, le7.operation.axial_load) == (0.007938, 10, 2670.0)
    assert (le7.bearing.inner_conformity, le7.bearing.outer_conformity) == (0.56, 0.52)
    assert le7.bearing.ball_material.elastic_modulus == 199.948e9
    assert (ball_218.bearing.ball_diameter, ball_218.bearing.ball_count) == (0.02223, 16)
    assert {le7.kinematics.model, ball_218.kinematics.model} == {KinematicModel.OUTER_RACE_CONTROL}
    assert le7.cage is None
    assert le7.ranking is None


def test_a_file_comes_before_a_shipped_study_of_its_name_and_a_folder_does_not(elsewhere, tmp_path):
    """What lies on the disk is meant, but the default output folder has the name of the study."""
    written(tmp_path, BASE, "ball-218")
    (tmp_path / "le7").mkdir()
    assert (read_study("le7").name, read_study("ball-218").title) == ("le7", "A valid study")
    others = "cryogenic-turbopump dry-reaction-wheel lox-turbopump lox-turbopump-radial momentum-wheel"
    assert set(shipped_studies()) == {"ball-218", "le7", *others.split()}


IN_SPACE = ("transverse_inertia", "land_width", "land_diameter", "dynamic_unbalance", "axial_gravity")


def test_every_line_that_is_off_in_the_template_can_be_switched_on(read):
    """The commented alternatives are right too: each key is taken, alone, in place of what it excludes."""
    excluded = {"radial_clearance": "contact_angle", "tilt": "moment", "elastic_modulus": "material"}
    beside = {
        "elastic_modulus": "poisson_ratio = 0.38",
        "ramp_start": 'ramp_time = "50 ms"',
        "preload": 'arrangement = "single"',
        "arrangement": 'preload = "28 N"',
        "preload_kind": 'preload = "28 N"\narrangement = "face-to-face"',
        "worn_pocket_friction": 'worn_pocket_depth = "10 um"',
        "worn_pocket_depth": "worn_pocket_friction = 0.3",
        "pocket_axial_clearance": 'pocket_shape = "elongated"',
        "pocket_axial_offset": 'pocket_shape = "cylindrical"',
        "land_lobes": 'land_out_of_round = "20 um"',
        "balls_at_walls": 'ball_diameter_scatter = "0.1 um"',
        **dict.fromkeys(("fluid_swirl", "fluid_damping"), 'added_mass = "1 g"'),
        "inner_diameter": 'outer_diameter = "72 mm"\nwidth = "14 mm"',
        "outer_diameter": 'inner_diameter = "58 mm"\nwidth = "14 mm"',
        "width": 'inner_diameter = "58 mm"\nouter_diameter = "72 mm"',
        "land_spacing": 'motion = "space"\nland_count = 2',
        **dict.fromkeys((*IN_SPACE, "added_mass"), 'motion = "space"'),
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


ANGLE, FILM = 'contact_angle = "25 deg"', 'material = "PTFE transfer film"\n'
# cos(angle) = 1 - P_d / (2 (f_i + f_o - 1) D); acos loses some digits near 1
OPENED = pytest.approx(math.acos(1 - 20e-6 / (2 * 0.04 * 0.0111125)), rel=1e-12)
READ = [
    ('title = "A valid study"\n', "", lambda s: s.title == "case"),
    (ANGLE, 'radial_clearance = "0 um"', lambda s: s.bearing.free_angle == 0.0),
    (ANGLE, 'radial_clearance = "20 um"', lambda s: s.bearing.free_angle == OPENED),
    (FILM, 'elastic_modulus = "2 GPa"\npoisson_ratio = 0.4\n', lambda s: s.film.body.poisson_ratio == 0.4),
    (FILM + 'thickness = "0.5 um"\n', "", lambda s: s.film == Film(race_friction=0.1)),
    (
        "[cage]",
        '[ranking]\nfriction = "pin-on-disk-77K"\nmaterials = ["Vespel SP 211", "Armalon"]\n[cage]',
        lambda s: [c.name for c in s.ranking.candidates] == ["Vespel SP 211", "Armalon"],
    ),
    ('"15000 rpm"', '"0 rpm"', lambda s: s.operation.inner_speed == 0.0),
    (
        "[film]\nrace_friction = 0.1",
        '[kinematics]\nmodel = "outer race control"\n[film]\nrace_friction = 0',
        lambda s: s.film.race_friction == 0.0,
    ),
    ("\n", "\r\n", lambda s: s.bearing.ball_count == 13),
    ("title", "\ufefftitle", lambda s: s.title == "A valid study"),
]


@pytest.mark.parametrize(("old", "new", "holds"), READ)
def test_another_form_of_a_study_is_read(old, new, holds, read):
    """No title, a clearance, a film in place or none, some materials, zeros, Windows."""
    assert holds(read(BASE.replace(old, new)))


VARIANTS = [
    ('[operation]\naxial_load = "2 kN"', lambda s: s.operation.axial_load == 2e3 and s.operation.inner_speed),
    ('[bearing]\nradial_clearance = "20 um"', lambda s: s.bearing.free_angle < 0.25),
    ('[operation]\ntilt = "1 mrad"', lambda s: s.operation.tilt == 1e-3),
    (
        '[operation]\npreload = "40 N"\narrangement = "face-to-face"',
        lambda s: s.operation.is_pair and s.operation.axial_load is None,
    ),
    ('[film]\nelastic_modulus = "2 GPa"\npoisson_ratio = 0.4', lambda s: s.film.body.elastic_modulus == 2e9),
    ('[film]\nmaterial = "MoS2 sputtered dense"', lambda s: s.film.body.elastic_modulus == 136e9),
    ('[cage]\nguidance = "ball"', lambda s: s.cage.land_clearance is None and s.cage.mass == 0.025),
    ('[kinematics]\nmodel = "inner race control"', lambda s: s.kinematics.model.value.startswith("inner")),
    ('[ranking]\nfriction = "pin-on-disk-77K"', lambda s: len(s.ranking.candidates) == 7),
    ('title = "Variant"', lambda s: s.title == "Variant"),
]


@pytest.mark.parametrize(("text", "holds"), VARIANTS)
@pytest.mark.parametrize("base", ["base.toml", "sub/middle.toml"])
def test_a_variant_overrides_its_base_key_by_key(base, text, holds, tmp_path, read):
    """What excludes a key of the base replaces it, also through another variant in another folder."""
    (tmp_path / "sub").mkdir()
    written(tmp_path, BASE, "base.toml")
    written(tmp_path, 'extends = "../base.toml"\n[bearing]\nball_count = 11\n', "sub/middle.toml")
    variant = read(f'extends = "{base}"\n{text}\n')
    assert holds(variant)
    assert variant.bearing.ball_count == (11 if base.startswith("sub") else 13)


def test_resolved_inputs_are_plain_and_say_where_each_number_comes_from():
    """JSON without NaN; SI with units; origins, defaults, sources and confidences; the same when pickled."""
    example = read_study("cryogenic-turbopump")
    again = pickle.loads(pickle.dumps(example))  # noqa: S301 - our own bytes
    assert (again, again.origins) == (example, example.origins)
    inputs = resolved(example)
    assert json.loads(json.dumps(inputs, allow_nan=False)) == inputs
    assert inputs["bearing"]["ball_diameter"] == {
        "value": 0.0111125,
        "unit": "m",
        "origin": 'cryogenic-turbopump.toml, line 7: "11.1125 mm"',
    }
    assert inputs["operation"]["outer_speed"] == {"value": 0.0, "unit": "rad/s", "origin": "default"}
    inertia = "default: of the ring's shape, or a thin ring at the pitch diameter"
    assert inputs["cage"]["moment_of_inertia"]["origin"] == inertia
    assert inputs["stability"]["runs"]["origin"] == "default"
    assert inputs["film"]["material"]["confidence"] == "modulus: guess, Poisson's ratio: guess"
    armalon = next(c for c in inputs["ranking"]["candidates"] if c["name"] == "Armalon")
    assert armalon["friction"]["liquid nitrogen, 440C"]["mean"] == 0.08
    assert "table 3" in armalon["friction"]["liquid nitrogen, 440C"]["source"]
    meldin = next(c for c in inputs["ranking"]["candidates"] if c["name"] == "Meldin HTC 100")
    assert meldin["friction"]["gaseous nitrogen, 440C"] is None


def test_a_study_built_in_python_resolves_too():
    """Nothing is known of where its numbers come from, and that is said."""
    operation = Operation(inner_speed=1000.0, axial_load=1000.0)
    bare = Study(name="a", title="A", bearing=BEARING, operation=operation, film=Film(race_friction=0.1))
    inputs = resolved(bare)
    assert inputs["bearing"]["ball_diameter"]["origin"] == "given in Python"
    assert inputs["cage"] is None
    assert inputs["film"]["is_bare"] is True


BAND = '[film.wear]\nwidth = "0.2 mm"\nfriction = 0.3\n'
SHARE = '[film.wear]\nshare = 0.1\nthickness = "50 nm"\nfriction = 0.3\nraces = "Inner race"\n'
PLACES = '[film.wear]\nacross = ["-0.1 mm", "0.1 mm"]\nthicknesses = ["0 um", "0.2 um"]\nfriction = 0.3\n'
WORN = [
    (BAND, Wear(width=2e-4, friction=0.3)),
    (SHARE, Wear(share=0.1, thickness=5e-8, friction=0.3, races=Worn.INNER)),
    (PLACES, Wear(across=(-1e-4, 1e-4), thicknesses=(0.0, 2e-7), friction=0.3)),
]


@pytest.mark.parametrize(("section", "wear"), WORN)
def test_each_form_of_wear_is_read(section, wear, read):
    """In SI, with the origin of each key."""
    study = read(BASE + section)
    assert study.film.wear == wear
    found = resolved(study)["film"]
    assert found["wear.races"]["value"] == wear.races.value
    assert found["wear.friction"]["value"] == 0.3
    assert found["wear.friction"]["origin"].startswith("case.toml, line ")


def test_numbers_of_wear_may_be_uncertain_and_varied(read):
    """By the name film.wear.width."""
    study = read(BASE + BAND.replace('"0.2 mm"', '"0.2 mm +- 10 %"'))
    assert study.distributions["film.wear.width"].mean == pytest.approx(2e-4)
    for change in (with_values, varied):
        assert change(study, {"film.wear.width": 3e-4}).film.wear.width == 3e-4
    assert value_in(study, "film.wear.width") == pytest.approx(2e-4)
    whole = read(BASE)
    assert value_in(whole, "film.wear.width") is None
    with pytest.raises(InputError, match=r"\[film\] has no wear that could vary"):
        varied(whole, {"film.wear.share": 0.1})


def test_the_page_on_study_files_is_complete_and_its_examples_are_right(read):
    """It names every section and every unit; the generated page has the keys."""
    page = (Path(__file__).parents[2] / "docs" / "reference" / "study-file.md").read_text(encoding="utf-8")
    assert [section for section in ORDER if f"## [{section}]" not in page] == []
    table = page.partition("| quantity |")[2].partition("Both micro signs")[0]
    rows = table.replace("|", ","), table.replace("|", ",").replace("(", ",")
    listed = {word.strip() for one in rows for word in one.split(",")}
    assert {unit for known in UNITS.values() for unit in known} <= listed
    blocks = [block.partition("```")[0] for block in page.split("```toml\n")[1:]]
    variant, catalogue, preload, wear, candidate = blocks
    assert read(f'extends = "momentum-wheel"\n{preload}').operation.is_pair
    assert read(BASE + wear).film.wear.width == pytest.approx(2e-4)
    assert read(variant).operation.axial_load == 1500.0
    assert read(f'extends = "ball-218"\n{catalogue}').bearing.ball_diameter == 0.003969
    assert read(BASE + candidate).ranking.candidates[0].name == "My compound"


# Every wrong study file is refused with one line: place, rule, value, cure.

IN_PLACE = """\
[[ranking.candidates]]
name = "Mine"
friction = { "liquid nitrogen, 440C" = 0.11 }
"""
TABLE = 'friction = "pin-on-disk-77K"\nmaterials = ["Armalon", "Vespel SP 211"]\n'

EDITS = r"""
model = "free" => model = "jones" :: "outer race control" ; got "jones"
title = "A valid study" => runs = 3 :: line 1 ; runs ; is not a key of a study. It belongs in [stability]
[operation] => [[operation]] :: line 14: [[operation]] ; one section, headed [operation]
inner_conformity = 0.52 => inner_conformity = 0,52 :: line 8 ; not valid TOML ; Write a decimal point: 0.52.
pitch_diameter = "65 mm" => pitch_diameter = 65 mm :: line 5 ; Put quantities in quotes: "65 mm".
model = "free" => model = free :: line 19 ; Put text in quotes.
ball_count = 13 => ball_count = 19 :: line 6 ; [bearing] ball_count must be at most 18 ; got 19
"300 daN" => "300 daN"\ntemperature = "-300 degC"
    :: [operation] temperature must be > 0 K ; got "-300 degC"
"65 mm" => "10 mm" :: ball_count ; too large for the pitch circle
race_friction = 0.1 => race_friction = 3e-5 :: [film] race_friction must be >= 0.0001 ; race control
"50 mm" => "60 mm" :: [bearing] bore must be smaller ; 53.89 mm
ball_material = "440C" => ball_material = "404C"
    :: line 11 ; [bearing] ball_material ; Did you mean 440C? ; 52100
"300 daN" => "0 N" :: [operation] axial_load ; nothing presses the balls
axial_load = "300 daN" => axial_load = "300 daN"\nmoment = "1 N m"\ntilt = "1 mrad"
    :: [operation] tilt and moment exclude each other
axial_load = "300 daN"\n =>  :: [operation] axial_load is missing ; or preload and arrangement.
axial_load = "300 daN" => preload = "300 daN" :: [operation] arrangement is missing ; preload, arrangement
axial_load = "300 daN" => axial_load = "300 daN"\npreload_kind = "spring"
    :: [operation] preload_kind has a meaning only for a pair
"300 daN" => "300 daN"\npreload = "9 N"\narrangement = "single"\npreload_kind = "rigid"
    :: [operation] preload_kind has a meaning only for a pair ; back-to-back
"300 daN" => "300 daN"\npreload = "9 N"\narrangement = "face-to-face"\nradial_load = "1 N"
    :: [operation] radial_load must be 0 for a pair ; got "1 N" ; loads of one of the two
"300 daN" => "300 daN"\npreload = "9 N"\narrangement = "tandem" :: [operation] arrangement ; "back-to-back"
material = "PTFE transfer film"\n =>  :: [film] material is missing
"0.6 mm" => "5 mm"
    :: [cage] pocket_clearance must be smaller than the gap between balls, 4.443 mm ; got "5 mm"
guidance = "outer"\n =>  :: [cage] land_clearance needs guidance ; guidance =
"Vespel SP 211" => "Armalon" :: [ranking] candidates ; "Armalon" twice
TABLE =>  :: [ranking] lacks: friction (or candidates)
bore = => "" = 1\nbore = :: [bearing] "" is not a valid key
"A valid study" => "A\u001b[31m study" :: line 1: title ; printable
title = "A valid study" => extends = "study.toml" :: line 1: extends ; leads back
title = "A valid study" => extends = "le77" :: line 1: extends ; Did you mean le7?
title = "A valid study" => extends = 7 :: line 1: extends ; path
bore = => x = LINES\nbore = :: line 26 ; nests brackets
bore = => x = INLINE\nbore = :: line 10 ; nests brackets
bore = => DOTTED = 1\nbore = :: line 10 ; [bearing] a
ball_count = 13 => ball_count = NINES :: study.toml
race_friction = 0.1 => race_friction = 0xNINES :: 60 digits
ball_count = 13 => ball_count = 0xNINES :: 60 digits
[cage] => [film.wear]\nshare = 2\nfriction = 0.3\n[cage] :: [film] wear.share must lie between 0 and 1; got 2
[cage] => BAND\nshare = 0.1\n[cage] :: [film] wear.share and width exclude each other
[cage] => BAND\n[traction]\npressure = "coated"\n[cage]
    :: [traction] pressure must be "hertz" where the film is
"""
"""An edit of VALID, and the words that its refusal must have."""
LONG = {
    "BAND": '[film.wear]\nwidth = "0.2 mm"\nfriction = 0.3',
    "IN_PLACE": IN_PLACE,
    "TABLE": TABLE,
    "LINES": "[\n" * 9000 + "]" * 3000,
    "INLINE": "{a=" * 900 + "1" + "}" * 900,
    "DOTTED": ".".join("a" * 1500),
    "NINES": "9" * 3900,
}


@pytest.mark.parametrize(("edit", "words"), rows_of(EDITS))
def test_a_wrong_file_is_refused_with_place_rule_and_cure(edit, words, tmp_path):
    """One change to a valid study; the one line names the file, the place, and what to do."""
    for name, text in LONG.items():
        edit = edit.replace(name, text)
    message = refusal(written(tmp_path, changed(VALID, edit)))
    assert [word for word in ["study.toml", *words[0].split(" ; ")] if word not in message] == [], message


def test_a_folder_a_device_and_a_missing_file_are_refused_at_once(tmp_path):
    """Nothing but a regular file is opened, whatever its path: empty, with a NUL, too long."""
    assert "is a folder" in refusal(tmp_path)
    assert refusal("/dev/null").startswith("/dev/null is not a regular file. Save its output")
    assert "does not exist. Shipped examples: ball-218" in refusal(tmp_path / "none.toml")
    assert "Did you mean cryogenic-turbopump?" in refusal("cryogenic_turbopump")
    for path in ("", "a\0b", "x" * 5000, "no/such/folder/x.toml", "two\nlines.toml", "\x1b[31m.toml"):
        refusal(path)


def test_a_stiffness_needs_a_value_or_a_modulus(tmp_path):
    """Of the cage, or of every candidate."""
    text = VALID.replace("[ranking]\n" + TABLE, IN_PLACE).replace('ball_cage_stiffness = "3e6 N/m"\n', "")
    path = written(tmp_path, text)
    rule = r'study\.toml, line 26: \[cage\] ball_cage_stiffness is missing, and the candidate "Mine" has no'
    with pytest.raises(InputError, match=rf"^{rule}.* Give the stiffness or the material\.$"):
        read_study(path)
    path.write_text(text.replace("[cage]", '[cage]\nmaterial = "Armalon"'))
    assert read_study(path).cage.ball_cage_stiffness is None


def test_a_refused_candidate_leaves_the_mass_of_its_cage_open(tmp_path):
    """The density of the cage was "not known" beside the mistake in the candidate that has it."""
    ring = 'material = "Mine"\ninner_diameter = "58 mm"\nouter_diameter = "72 mm"\nwidth = "14 mm"'
    text = VALID.replace("[ranking]\n" + TABLE, IN_PLACE).replace('mass = "25 g"', ring)
    refused = refusal(written(tmp_path, text.replace("= 0.11 }", "= -0.1 }")))
    assert "must lie between 0 and 2" in refused
    assert "density" not in refused


CHAIN = {f"{i}.toml": f'extends = "{i + 1}.toml"\n' for i in range(40)} | {"40.toml": VALID}
EXTENDING = {
    "a circle": ({"b.toml": 'extends = "0.toml"\n'}, "b.toml", "0.toml, line 1: extends leads back"),
    "a long chain": (CHAIN, "0.toml", "chain of more than"),
    "a mistake in the base": (
        {"0.toml": VALID.replace('"300 daN"', "3000")}, "0.toml", "0.toml, line 16: [operation] axial_load",
    ),
}  # fmt: skip


@pytest.mark.parametrize(("files", "base", "words"), EXTENDING.values(), ids=EXTENDING)
def test_a_mistake_across_files_is_refused_where_it_stands(files, base, words, tmp_path):
    """Files that extend each other, more of them than anyone can follow, a wrong base of a right variant."""
    for name, text in ({"0.toml": 'extends = "b.toml"\n'} | files).items():
        written(tmp_path, text, name)
    assert words in refusal(written(tmp_path, f'extends = "{base}"\n'))


SCANNED = '''title = """
[cage]
mass = 1
"""
samples = [
  ["a"],
  [ "b" ], # ]
]
after = 1 # [operation] \u2028
[film]  # "a comment
thickness = { a = 1 }
note = \'\'\'
race_friction = 2
\'\'\'
[[ranking.candidates]]
name = "x"
[[ranking.candidates]]
material.density = 4
'''


def test_the_line_of_a_key_is_not_looked_for_in_texts_and_lists():
    """What looks like a header or a key inside a text, a list or a comment is none; U+2028 ends no line."""
    _, lines = parsed(SCANNED, "study.toml")
    assert ", ".join(f"{'.'.join(map(str, path))} {line}" for path, line in lines.items()) == (
        "title 1, samples 5, after 9, film 10, film.thickness 11, film.note 12, ranking 15, "
        "ranking.candidates 15, ranking.candidates.0 15, ranking.candidates.0.name 16, "
        "ranking.candidates.1 17, ranking.candidates.1.material 18, ranking.candidates.1.material.density 18"
    )
