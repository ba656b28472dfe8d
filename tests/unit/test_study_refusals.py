"""Every wrong study file is refused with one line: place, rule, value, cure."""

import pytest
from commands import changed, refusal, rows_of, written

from separatrix.ground.errors import InputError
from separatrix.ground.toml import parsed
from separatrix.study.reading import read_study

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
    """Nothing but a regular file is opened."""
    assert "is a folder" in refusal(tmp_path)
    assert refusal("/dev/null").startswith("/dev/null is not a regular file. Save its output")
    assert "does not exist. Shipped examples: ball-218" in refusal(tmp_path / "none.toml")
    assert "Did you mean cryogenic-turbopump?" in refusal("cryogenic_turbopump")


def test_a_strange_path_is_refused_in_one_line():
    """Empty, with a NUL, too long, or with control characters."""
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
