"""Wrong library files and wrong calls of `materials`: a line a mistake, exit status 2."""

import shlex

import pytest
from commands import refusal, table

from separatrix.cli import main
from separatrix.ground.errors import InputError
from separatrix.study.library import with_files
from separatrix.study.reading import read_study

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
MATERIAL: "Ours" => "" :: line 1: [cage_material] "", its name, must be one line
MATERIAL: Ours => Ours  :: line 1: [cage_material] Ours , its name, must not begin or end with a space
MATERIAL: DATUM => 5
    :: line 2: [cage_material] Ours.elastic_modulus must be a table with value, source, confidence
MATERIAL: DATUM => [] :: line 2: [cage_material] Ours.elastic_modulus must have 1 to 100 items
MATERIAL: DATUM => [DATUM, DATUM]
    :: line 2: [cage_material] Ours.elastic_modulus has two with the same temperature, pressure
MATERIAL: "5 GPa", => "5 GPa", range = ["6 GPa", "9 GPa"],
    :: line 2: [cage_material] Ours.elastic_modulus.range must have the value between its ends
MATERIAL:  => replaces = true\n :: line 1: [cage_material] Ours replaces a cage material that is not shipped
MATERIAL: Ours => Armalon :: line 1: [cage_material] Armalon has the name of a shipped cage material
MATERIAL: Ours => armalon :: line 1: [cage_material] armalon has a name of Armalon (cage_materials.toml, line
MATERIAL:  => [cage_material.OURS]\nelastic_modulus = DATUM\npoisson_ratio = RATIO\n
    :: line 4: [cage_material] OURS has a name of Ours (ours.toml, line 1); got "OURS"
FLUID:  => aliases = ["ln2"]\n :: line 1: [fluid] slush has a name of liquid nitrogen (fluids.toml, line
FLUID:  => coolprop = "REFPROP::N2"\n :: line 4: [fluid] slush.coolprop must be the plain name of a pure fluid
TABLE: 0.2 => 0.0 :: line 8: [friction_table] rig.friction.Ours."air, 440C".mean must be above 0
TABLE: 0.2 => { mean = 1e-200, standard_deviation = 0.1 }
    :: line 8: [friction_table] rig.friction.Ours."air, 440C".mean must be >= 1e-05 where there is
TABLE: ["air, 440C"] => ["air, 440C", "air, 440C"]
    :: line 6: [friction_table] rig.environments names an environment twice
TABLE: "air, 440C" = 0.2\n =>  :: line 7: [friction_table] rig.friction.Ours must have 1 to 2000 names
TITLE:  => \n :: ours.toml has no record: it needs a section
TITLE: title = "Ours"\n => # nothing :: ours.toml is empty. `separatrix materials show 440C` shows
TITLE: title = "Ours"\n => [[film]]\nname = 1\n :: line 1: [[film]] must be a table of names with their values
"""
"""A file, an edit of it, place and rule of one line of its refusal. A text alone is added behind."""


FILES = {"MATERIAL": MATERIAL, "TABLE": TABLE, "FLUID": FLUID, "TITLE": 'title = "Ours"\n'}


@pytest.mark.parametrize(("edit", "words"), table(EDITS))
def test_a_wrong_library_is_refused_in_one_line(edit, words, tmp_path):
    """File, line, key and rule; nothing beside it appears."""
    for name, datum in (("DATUM", MODULUS), ("RATIO", RATIO)):
        edit = edit.replace(name, datum.partition(" = ")[2])
    base, _, edit = edit.partition(": ")
    old, _, new = edit.partition("=> ")
    old, text = old.removesuffix(" "), FILES[base]
    assert old in text
    path = tmp_path / "ours.toml"
    path.write_text(text.replace(old, new, 1) if old else text + new)
    assert refusal(words, with_files, [path]).startswith("ours.toml")
    assert [p.name for p in tmp_path.iterdir()] == ["ours.toml"]


@pytest.mark.parametrize("text", [MATERIAL, TABLE, FLUID])
def test_the_files_that_are_changed_are_right(text, tmp_path):
    """So that each refusal is for its change alone."""
    path = tmp_path / "ours.toml"
    path.write_text(text)
    with_files([path])


STUDIES = r"""
[film]\nmaterial = "Ourz" :: is not a film of the library
[cage]\nmaterial = "Oors" :: Did you mean Ours?
[ranking]\nfriction = "rigg" :: Did you mean rig?
[ranking]\nfriction = "rig"\nmaterials = ["Armalon"] :: names a material that rig lacks
[bearing]\nball_material = "Ours" :: is not a bearing material of the library
library = 5 :: library[1] must be text; got 5. Give the path of a file or a folder
library = "no.toml" :: library does not name a file or folder; got "no.toml"
library = [] :: library must have 1 to 20 items
library = "empty" :: names a folder without a .toml file
library = "case.toml" :: is not a key of a library of materials
library = "LONG" :: does not name a file or folder
"""


@pytest.mark.parametrize(("text", "words"), table(STUDIES))
def test_a_study_that_names_a_wrong_record_is_refused_in_one_line(text, words, tmp_path):
    """Names of users' records get the same help as shipped ones."""
    (tmp_path / "materials.toml").write_text(MATERIAL + TABLE)
    (tmp_path / "empty").mkdir()
    path = tmp_path / "case.toml"
    path.write_text(f'extends = "cryogenic-turbopump"\n{text.replace("LONG", "x" * 300)}\n')
    refusal(words, read_study, path, lines=0)


def test_a_study_beside_a_wrong_library_is_refused_for_the_library(tmp_path):
    """Even if it names nothing in it: what would have been replaced is not known."""
    (tmp_path / "materials.toml").write_text(MATERIAL.replace("5 GPa", "5 mm"))
    (tmp_path / "case.toml").write_text('extends = "cryogenic-turbopump"\n')
    with pytest.raises(InputError, match=r"^materials.toml, line 2: \[cage_material\] Ours.elastic_modulus"):
        read_study(tmp_path / "case.toml")


def test_one_name_in_two_libraries_is_refused(tmp_path):
    """Which one was meant is not guessed; both places are named."""
    (tmp_path / "materials").mkdir()
    for name in ("materials.toml", "materials/more.toml"):
        (tmp_path / name).write_text(MATERIAL)
    (tmp_path / "case.toml").write_text('extends = "cryogenic-turbopump"\n')
    with pytest.raises(InputError, match=r"more.toml, line 1.* is in materials.toml, line 1 too"):
        read_study(tmp_path / "case.toml")


CALLS = """
none :: Missing command
lst :: No such command 'lst'
list --kind flim :: Did you mean film?
list --library no.toml :: --library does not name a file or folder
show :: Missing argument 'NAME'
show "440 C" :: Did you mean 440C?
show "" :: is not a record of the library
show 440C --kind film :: is not a film of the library
show PTFE --temperature 77 :: Write "77 K"
show PTFE --temperature "77 m" :: needs a unit of temperature
show PTFE --temperature "-1 K" :: --temperature must lie between
"""


@pytest.mark.parametrize(("call", "words"), table(CALLS))
def test_a_wrong_call_is_refused_in_one_line(call, words, capsys):
    """Exit status 2, and nothing on standard output."""
    assert main(["materials", *(shlex.split(call) if call != "none" else ())]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert all(line.startswith("separatrix: ") for line in err.splitlines())
    assert words[0] in err
