"""Wrong library files and wrong calls of `materials`: a line a mistake, exit status 2."""

import pytest
from commands import changed, refusal, refusal_line, refused, rows_of, written

from separatrix.study.library import with_files

RATIO = 'poisson_ratio = { value = 0.3, source = "our test", confidence = "measured" }'
MODULUS = 'elastic_modulus = { value = "5 GPa", source = "our test", confidence = "measured" }'
MATERIAL = f'[cage_material."Ours"]\n{MODULUS}\n{RATIO}\n'
TABLE = """\
[friction_table."rig"]
title = "Rig"
source = "Report 5"
confidence = "measured"
temperature = "77 K"
environments = ["air, 440C"]
[friction_table."rig".friction."Ours"]
"air, 440C" = 0.2
"""
FLUID = '[fluid."slush"]\nsubstance = "nitrogen"\nphase = "liquid"\n'


EDITS = r"""
MATERIAL: DATUM => [DATUM, DATUM]
    :: line 2: [cage_material] Ours.elastic_modulus has two with the same temperature, pressure
MATERIAL: "5 GPa", => "5 GPa", range = ["6 GPa", "9 GPa"],
    :: line 2: [cage_material] Ours.elastic_modulus.range must have the value between its ends
MATERIAL: + replaces = true\n :: line 1: [cage_material] Ours replaces a cage material that is not shipped
MATERIAL: Ours => Armalon :: line 1: [cage_material] Armalon has the name of a shipped cage material
MATERIAL: Ours => armalon :: line 1: [cage_material] armalon has a name of Armalon (cage_materials.toml, line
MATERIAL: + [cage_material.OURS]\nelastic_modulus = DATUM\npoisson_ratio = RATIO\n
    :: line 4: [cage_material] OURS has a name of Ours (ours.toml, line 1); got "OURS"
FLUID: + aliases = ["ln2"]\n :: line 1: [fluid] slush has a name of liquid nitrogen (fluids.toml, line
FLUID: + coolprop = "REFPROP::N2"\n :: line 4: [fluid] slush.coolprop must be the plain name of a pure fluid
TABLE: 0.2 => 0.0 :: line 8: [friction_table] rig.friction.Ours."air, 440C".mean must be above 0
TABLE: 0.2 => { mean = 1e-200, standard_deviation = 0.1 }
    :: line 8: [friction_table] rig.friction.Ours."air, 440C".mean must be >= 1e-05 where there is
TABLE: ["air, 440C"] => ["air, 440C", "air, 440C"]
    :: line 6: [friction_table] rig.environments names an environment twice
TITLE: + \n :: ours.toml has no record: it needs a section
TITLE: title = "Ours"\n => [[film]]\nname = 1\n :: line 1: [[film]] must be a table of names with their values
"""
"""A file, an edit of it, place and rule of one line of its refusal."""
FILES = {"MATERIAL": MATERIAL, "TABLE": TABLE, "FLUID": FLUID, "TITLE": 'title = "Ours"\n'}


@pytest.mark.parametrize(("edit", "words"), rows_of(EDITS))
def test_a_wrong_library_is_refused_in_one_line(edit, words, tmp_path):
    """File, line, key and rule; nothing beside it appears."""
    base, _, edit = edit.partition(": ")
    for name, datum in (("DATUM", MODULUS), ("RATIO", RATIO)):
        edit = edit.replace(name, datum.partition(" = ")[2])
    text = changed(FILES[base], edit)
    message = refusal_line(written(tmp_path, text, "ours.toml"), lambda path: with_files([path]))
    assert words[0] in message
    assert message.startswith("ours.toml")
    assert [p.name for p in tmp_path.iterdir()] == ["ours.toml"]


STUDIES = {
    "a film that no library has": ('[film]\nmaterial = "Ourz"\n', "is not a film of the library"),
    "a near miss of a user's record": ('[cage]\nmaterial = "Oors"\n', "Did you mean Ours?"),
    "a near miss of a user's table": ('[ranking]\nfriction = "rigg"\n', "Did you mean rig?"),
    "a material that it lacks": ('[ranking]\nfriction = "rig"\nmaterials = ["Armalon"]\n', "that rig lacks"),
    "a cage material for a ball": ('[bearing]\nball_material = "Ours"\n', "is not a bearing material of"),
    "a library that is missing": ('library = "no.toml"\n', 'does not name a file; got "no.toml"'),
    "a library that is a study": ('library = "case.toml"\n', "is not a key of a library of materials"),
    "a library with an endless name": (f'library = "{"x" * 300}"\n', "does not name a file"),
}


@pytest.mark.parametrize("what", STUDIES)
def test_a_study_that_names_a_wrong_record_is_refused_in_one_line(what, tmp_path):
    """Names of users' records get the same help as shipped ones."""
    text, words = STUDIES[what]
    (tmp_path / "materials.toml").write_text(MATERIAL + TABLE)
    top, _, sections = text.partition("[")
    case = f'extends = "cryogenic-turbopump"\n{top}' + "[" * bool(sections) + sections
    assert words in refusal(written(tmp_path, case, "case.toml"))


def test_a_study_beside_a_wrong_library_is_refused_for_the_library(tmp_path):
    """Even if it names nothing in it: what would have been replaced is not known."""
    written(tmp_path, MATERIAL.replace("5 GPa", "5 mm"), "materials.toml")
    line = refusal_line(written(tmp_path, 'extends = "cryogenic-turbopump"\n'))
    assert line.startswith("materials.toml, line 2: [cage_material] Ours.elastic_modulus")


def test_one_name_in_two_libraries_is_refused(tmp_path):
    """Which one was meant is not guessed; both places are named."""
    for name in ("materials.toml", "more.toml"):
        written(tmp_path, MATERIAL, name)
    line = refusal_line(written(tmp_path, 'library = "more.toml"\nextends = "cryogenic-turbopump"\n'))
    assert "more.toml, line 1" in line
    assert "is in materials.toml, line 1 too" in line


CALLS = {
    "an unknown kind": (["list", "--kind", "flim"], "Did you mean film?"),
    "a library that is missing": (["list", "--library", "no.toml"], "--library does not name a file"),
    "no name": (["show"], "Missing argument 'NAME'"),
    "an unknown name": (["show", "440 C"], "Did you mean 440C?"),
    "an empty name": (["show", ""], "is not a record of the library"),
    "a name of another kind": (["show", "440C", "--kind", "film"], "is not a film of the library"),
}


@pytest.mark.parametrize("what", CALLS)
def test_a_wrong_call_is_refused_in_one_line(what, capsys):
    """Exit status 2, and nothing on standard output."""
    arguments, words = CALLS[what]
    line = refused(capsys, "materials", *arguments)
    assert line.startswith("separatrix: ")
    assert words in line
