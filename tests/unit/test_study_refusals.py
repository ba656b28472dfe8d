"""Every wrong study file is refused with one line: place, rule, value, cure."""

import os

import pytest
from commands import refusal, table

from separatrix.ground.errors import InputError, ValidityWarning
from separatrix.ground.toml import parsed
from separatrix.study.reading import read_study, require

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
restitution_factors = { from = 0.05, to = 0.95, count = 19 }

[ranking]
friction = "pin-on-disk-77K"
materials = ["Armalon", "Vespel SP 211"]
"""

IN_PLACE = """\
[[ranking.candidates]]
name = "Mine"
friction = { "liquid nitrogen, 440C" = 0.11 }
"""
TABLE = 'friction = "pin-on-disk-77K"\nmaterials = ["Armalon", "Vespel SP 211"]\n'


EDITS = r"""
bore = "50 mm" => axial_load = "3 N" :: line 10 ; [bearing] axial_load ; belongs in [operation]
title = "A valid study" => runs = 3 :: line 1 ; runs ; is not a key of a study. It belongs in [stability]
[operation] => [[operation]] :: line 14: [[operation]] ; one section, headed [operation]
"50 mm" => "49,5 mm" :: [bearing] bore ; decimal point ; Write "49.5 mm".
inner_conformity = 0.52 => inner_conformity = 0,52 :: line 8 ; not valid TOML ; Write a decimal point: 0.52.
pitch_diameter = "65 mm" => pitch_diameter = 65 mm :: line 5 ; Put quantities in quotes: "65 mm".
model = "free" => model = free :: line 19 ; Put text in quotes.
"11.1125 mm" => "nan mm" :: [bearing] ball_diameter ; finite ; "nan mm"
"300 daN" => "inf daN" :: [operation] axial_load ; finite
"300 daN" => "1e999 N" :: [operation] axial_load ; 1e999 N
ball_count = 13 => ball_count = 19 :: line 6 ; [bearing] ball_count must be at most 18 ; got 19
"65 mm" => "10 mm" :: ball_count ; too large for the pitch circle
race_friction = 0.1 => race_friction = 0 :: [film] race_friction must be > 0 ; race control
"25 deg" => "90 deg" :: [bearing] contact_angle ; < 90 deg ; got "90 deg"
"25 deg" => "-5 deg" :: [bearing] contact_angle ; >= 0
contact_angle = "25 deg" => contact_angle = "25 deg"\nradial_clearance = "10 um"
    :: radial_clearance and contact_angle exclude each other
contact_angle = "25 deg" => radial_clearance = "1 mm" :: [bearing] radial_clearance ; 889 um ; got "1 mm"
contact_angle = "25 deg" => radial_clearance = "-1 um" :: [bearing] radial_clearance
"50 mm" => "60 mm" :: [bearing] bore must be smaller ; 53.89 mm
ball_material = "440C" => ball_material = "404C"
    :: line 11 ; [bearing] ball_material ; Did you mean 440C? ; 52100
"PTFE transfer film" => "Teflon" :: [film] material ; PTFE transfer film ; MoS2
ball_material = "440C" => ball_material = 440
    :: [bearing] ball_material must be the name of a bearing material, or its properties ; 440
"300 daN" => "0 N" :: [operation] axial_load ; nothing presses the balls
axial_load = "300 daN" => axial_load = "300 daN"\nmoment = "1 N m"\ntilt = "1 mrad"
    :: [operation] tilt and moment exclude each other
axial_load = "300 daN" => axial_load = "300 daN"\ntemperature = "-300 degC"
    :: [operation] temperature must be > 0; ; "-300 degC"
model = "free" => model = "jones" :: "outer race control" ; got "jones"
"0.6 mm" => "5 mm"
    :: [cage] pocket_clearance must be smaller than the gap between balls, 4.443 mm ; got "5 mm"
"0.1 m/s" => "0.5 m/s" :: [stability] kicks ; strictly increasing
from = 0.05 => from = 0.99 :: [stability] restitution_factors must be strictly increasing
count = 19 => count = 1 :: restitution_factors ; count from 2 ; got 1
runs = 64 => duration = "-1 s" :: [stability] duration must be > 0
runs = 64 => ball_scatter = 1.5 :: [stability] ball_scatter must lie between 0 and 1
runs = 64 => seed = -1 :: [stability] seed
"pin-on-disk-77K" => "pin-on-disk" :: [ranking] friction ; pin-on-disk-77K
"Vespel SP 211" => "Vespel SP-212" :: [ranking] materials ; Did you mean Vespel SP 211?
"Vespel SP 211" => "Armalon" :: [ranking] candidates ; "Armalon" twice
[kinematics] => [bearing]\n[kinematics] :: line 18 ; a second time
race_friction = 0.1 => race_friction = 2024-01-01 :: [film] race_friction ; 2024-01-01
title = "A valid study" => extends = "study.toml" :: line 1: extends ; leads back
title = "A valid study" => extends = "le77" :: line 1: extends ; Did you mean le7?
title = "A valid study" => extends = 7 :: line 1: extends ; path
guidance = "outer"\n =>  :: land_clearance needs guidance ; land_stiffness needs ; land_restitution needs
[ranking]\n => [ranking]\ncandidates = [{ name = "Mine", friction = { air = 0.1 } }]\n :: exclude each other
"A valid study" => "A\u001b[31m study" :: line 1: title ; printable
"A valid study" => "A valid\u000astudy" :: line 1: title ; printable
"""
"""An edit of VALID, and the words that its refusal must have."""

LONG = {
    ("ball_count = 13", "ball_count = " + "9" * 4900): "study.toml",
    ("bore =", "x = " + "[\n" * 9000 + "]" * 3000 + "\nbore ="): "line 26 nests brackets",
    ("bore =", "x = " + "{a=" * 900 + "1" + "}" * 900 + "\nbore ="): "line 10 nests brackets",
    ("bore =", ".".join("a" * 1500) + " = 1\nbore ="): "line 10: [bearing] a",
    ("bore =", ("a." * 1500 + "a = 1\n") * 2 + "bore ="): "line 11 has a.a.a.",
    ("race_friction = 0.1", "race_friction = 0x" + "f" * 3900): "60 digits",
    ("ball_count = 13", "ball_count = 0x" + "f" * 3900): "60 digits",
    ('"50 mm"', "9" * 3900): "needs a unit of length",
}


@pytest.fixture
def refused(tmp_path):
    """Words that the refusal of an edited study must have; it names the file."""

    def with_words(old, new, words):
        assert old in VALID
        (tmp_path / "study.toml").write_text(VALID.replace(old, new, 1), encoding="utf-8")
        return refusal(["study.toml", *words], read_study, tmp_path / "study.toml", lines=0)

    return with_words


@pytest.mark.parametrize(("edit", "words"), table(EDITS))
def test_a_wrong_file_is_refused_with_place_rule_and_cure(edit, words, refused):
    """One change to a valid study; the one line names the file, the place, and what to do."""
    old, _, new = edit.partition(" =>")
    refused(old, new.removeprefix(" "), words)


@pytest.mark.parametrize(("old", "new"), LONG, ids=range(len(LONG)))
def test_what_no_person_writes_is_refused_at_once(old, new, refused):
    """Neither depth nor length takes time, memory or a long line."""
    refused(old, new, [LONG[old, new]])


def test_the_valid_study_is_read(tmp_path):
    """What the wrong files are edits of is itself right."""
    (tmp_path / "study.toml").write_text(VALID, encoding="utf-8")
    assert read_study(tmp_path / "study.toml").bearing.ball_count == 13


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ('title = "Cage"'.encode("utf-16"), "not UTF-8"),
        (b'title = "Cage"\n', "lacks: [operation], [bearing], [film]"),
        (b'title = """Cage\n', "not valid TOML"),
        (b"#!/bin/sh\necho $(true)\n", "line 2 is not valid TOML"),
    ],
)
def test_what_is_no_study_is_refused(content, words, tmp_path):
    """Whatever the bytes, the answer is one line."""
    (tmp_path / "study.toml").write_bytes(content)
    refusal([words], read_study, tmp_path / "study.toml")


def test_a_folder_a_pipe_and_a_missing_file_are_refused_at_once(tmp_path):
    """Nothing but a regular file is opened, so that a pipe without a writer does not hang."""
    os.mkfifo(tmp_path / "pipe.toml")
    for path, words in {
        tmp_path: "is a folder",
        tmp_path / "pipe.toml": "not a regular file",
        "/dev/null": "/dev/null is not a regular file. Save its output",
        tmp_path / "none.toml": "does not exist. Shipped examples: ball-218",
        "cryogenic_turbopump": "Did you mean cryogenic-turbopump?",
    }.items():
        refusal([words], read_study, path)


@pytest.mark.parametrize(
    "path", ["", "a\0b", "x" * 5000, "no/such/folder/x.toml", "two\nlines.toml", "\x1b[31m.toml"]
)
def test_a_strange_path_is_refused_in_one_line(path):
    """Empty, with a NUL, too long, or with control characters."""
    refusal([], read_study, path)


def test_thirty_mistakes_are_thirty_lines(tmp_path):
    """None is counted instead of shown."""
    path = tmp_path / "study.toml"
    path.write_text(VALID.replace("[film]", "[film]\n" + "".join(f"x{i} = 1\n" for i in range(30))))
    lines = refusal([], read_study, path, lines=30).split("\n")
    assert all(f"[film] x{i} " in line for i, line in enumerate(lines))


def test_a_stiffness_needs_a_value_or_a_modulus(tmp_path):
    """Neither is there: only what needs no cage is answered, and `check` refuses the study."""
    path = tmp_path / "study.toml"
    text = VALID.replace("[ranking]\n" + TABLE, IN_PLACE).replace('ball_cage_stiffness = "3e6 N/m"\n', "")
    text = text.replace('mass = "25 g"', 'mass = "25 g +- 10 %"')
    path.write_text(text)
    rule = r'study\.toml, line 26: \[cage\] ball_cage_stiffness is missing, and the candidate "Mine" has no'
    with pytest.warns(ValidityWarning, match=rf"^{rule} .*: the section is left out"):
        found = read_study(path)
    assert found.cage is None
    assert not found.distributions
    require(found, "bearing")
    for verb, sections in (("check", ()), ("rank", ("cage", "ranking")), ("simulate", ("cage",))):
        with pytest.raises(InputError, match=rf"^{rule}.* Give the stiffness or the material\.$"):
            require(found, verb, *sections)
    path.write_text(text.replace("[cage]", '[cage]\nmaterial = "Armalon"'))
    assert read_study(path).cage.ball_cage_stiffness is None


def test_extends_in_a_circle_is_refused(tmp_path):
    """Two files that extend each other."""
    (tmp_path / "a.toml").write_text('extends = "b.toml"\n')
    (tmp_path / "b.toml").write_text('extends = "a.toml"\n')
    refusal(["b.toml, line 1: extends leads back"], read_study, tmp_path / "a.toml")


def test_a_long_chain_of_extends_is_refused(tmp_path):
    """More files than anyone can follow."""
    for i in range(40):
        (tmp_path / f"{i}.toml").write_text(f'extends = "{i + 1}.toml"\n')
    (tmp_path / "40.toml").write_text(VALID)
    refusal(["chain of more than"], read_study, tmp_path / "0.toml")


def test_a_mistake_in_the_base_names_the_base(tmp_path):
    """A variant of a wrong file is refused where the mistake stands."""
    (tmp_path / "base.toml").write_text(VALID.replace('"300 daN"', "3000"))
    (tmp_path / "variant.toml").write_text('extends = "base.toml"\n')
    refusal(["base.toml, line 16: [operation] axial_load"], read_study, tmp_path / "variant.toml")


def test_a_verb_that_needs_a_section_says_which():
    """`simulate` without a cage."""
    with pytest.raises(InputError, match=r"\[cage\] is missing; `simulate` needs it\. See `separatrix new`"):
        require(read_study("le7"), "simulate", "bearing", "cage")
    with pytest.raises(InputError, match=r"\[cage\] and \[ranking\] are missing; `rank` needs them"):
        require(read_study("le7"), "rank", "cage", "ranking")


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
    assert {".".join(map(str, path)): line for path, line in lines.items()} == {
        "title": 1,
        "samples": 5,
        "after": 9,
        "film": 10,
        "film.thickness": 11,
        "film.note": 12,
        "ranking": 15,
        "ranking.candidates": 15,
        "ranking.candidates.0": 15,
        "ranking.candidates.0.name": 16,
        "ranking.candidates.1": 17,
        "ranking.candidates.1.material": 18,
        "ranking.candidates.1.material.density": 18,
    }
