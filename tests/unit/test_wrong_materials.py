"""Wrong library files and wrong calls of `materials`: a line a mistake, exit status 2."""

import pytest

from separatrix.cli import main
from separatrix.ground.errors import InputError
from separatrix.study.library import joined
from separatrix.study.library.reading import read_library
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


def modulus(text):
    """The material with another modulus."""
    return MATERIAL.replace(MODULUS, f"elastic_modulus = {text}")


def changed(text, old, new):
    """A valid file with one change."""
    assert old in text
    return text.replace(old, new)


EDITS = r"""
MATERIAL: ^ => title = 5\n :: title must be text; got 5
MATERIAL: cage_material => cage_materials :: Did you mean cage_material?
MATERIAL: cage_material => spring :: is not a kind of record
MATERIAL: ^ => density = 5\n :: is not a kind of record
MATERIAL: "Ours" => "" :: must be one line of 1 to 200 printable
MATERIAL: poisson_ratio => poisson_ration :: Did you mean poisson_ratio?
MATERIAL: DATUM => 5 :: must be a number with its source; got 5
MATERIAL: DATUM => "5 GPa" :: must be a number with its source; got "5 GPa"
MATERIAL: DATUM => { value = "5 GPa", confidence = "guess" } :: lacks: source
MATERIAL: DATUM => { value = "5 GPa", source = "our test" } :: lacks: confidence
MATERIAL: DATUM => { source = "our test", confidence = "guess" } :: lacks: value
MATERIAL: DATUM => { value = "5 GPa", source = "", confidence = "guess" } :: must be one line
MATERIAL: DATUM => { value = "5 GPa", source = "x", confidence = "guess" } :: must name a source
MATERIAL: DATUM => { value = "5 GPa", source = "our test", confidence = "sure" }
    :: must be one of measured, maker, literature, handbook, guess
MATERIAL: DATUM => { value = "5 GPa", source = "our test", confidence = "guess", temprature = "77 K" }
    :: Did you mean temperature?
MATERIAL: "5 GPa" => 5 :: Write "5 GPa"
MATERIAL: 5 GPa => 5,1 GPa :: needs a decimal point
MATERIAL: 5 GPa => 5 mm :: which is a length
MATERIAL: 5 GPa => 0 GPa :: left out, never given as 0
MATERIAL: 0.3 => 0 :: left out, never given as 0
MATERIAL: 5 GPa => -5 GPa :: must lie between 100 kPa and 5000 GPa
MATERIAL: 5 GPa => 1e6 GPa :: Check the unit
MATERIAL: 5 GPa => nan GPa :: must be a finite number
MATERIAL: 0.3 => 0.5 :: must lie between 0.001 and 0.499
MATERIAL: 0.3 => "0.3" :: Write 0.3 as a number
MATERIAL: "5 GPa", => "5 GPa", temperature = "-10 K", :: temperature must lie between
MATERIAL: "5 GPa", => "5 GPa", temperature = 77, :: needs a unit of temperature
MATERIAL: "5 GPa", => "5 GPa", temperature = ["300 K", "77 K"], :: must give the lower end first
MATERIAL: "5 GPa", => "5 GPa", temperature = ["1 K", "2 K", "3 K"],
    :: one quantity or a list of the lowest and the highest
MATERIAL: "5 GPa", => "5 GPa", range = ["6 GPa", "9 GPa"], :: must have the value between its ends
MATERIAL: "5 GPa", => "5 GPa", range = ["1 GPa"], :: a list of the lowest and the highest value
MATERIAL: "5 GPa", => "5 GPa", pressure = 5, :: needs a unit of pressure
MATERIAL: "5 GPa", => "5 GPa", medium = 5, :: medium must be text
MATERIAL: DATUM => [] :: must be 1 to 100 data
MATERIAL:  => composition = ["PEEK"]\n :: composition must be text
MATERIAL:  => replaces = "yes"\n :: must be true or false, without quotes
MATERIAL:  => replaces = true\n :: replaces a cage material that is not shipped
MATERIAL: Ours => Armalon :: has the name of a shipped cage material
MATERIAL: Ours => armalon :: has a name of Armalon (cage_materials.toml, line
MATERIAL: Ours => Ours  :: must not begin or end with a space
FLUID:  => aliases = ["ln2"]\n :: [fluid] slush has a name of liquid nitrogen (fluids.toml, line
FLUID:  => aliases = ["gaseous nitrogen"]\n :: [fluid] slush has a name of gaseous nitrogen (fluids.toml, line
MATERIAL:  => viscosity = 5\n :: is not a key of a cage material
MATERIAL:  => density = { value = "0.5 kg/m3", source = "our test", confidence = "guess" }\n
    :: must lie between 1 kg/m3
FLUID: liquid => slush :: must be "liquid" or "gas"
FLUID:  => coolprop = "REFPROP::N2"\n :: must be the plain name of a pure fluid
FLUID:  => aliases = "LN2"\n :: must be a list of 1 to 20 names
FLUID:  => elastic_modulus = { value = "5 GPa", source = "our test", confidence = "measured" }\n
    :: is not a key of a fluid
TABLE: source = "Report 5"\n =>  :: lacks: source
TABLE: 0.2 => 0.0 :: left out, never given as 0
TABLE: 0.2 => { mean = 1e-200, standard_deviation = 0.1 }
    :: mean must be >= 1e-05 where there is a standard deviation [-]; got 1e-200.
TABLE: 0.2 => -0.2 :: must lie between 0 and 2
TABLE: 0.2 => "0.2 N" :: must be a plain number
TABLE: 0.2 => 5 :: must lie between 0 and 2
TABLE: 0.2 => { mean = 0.2, count = 0 } :: must be a whole number from 1
TABLE: 0.2 => { mean = 0.2, sd = 1 } :: is not a key of this table
TABLE: ["air, 440C"] => ["air"] :: lacks an environment
TABLE: ["air, 440C"] => ["air, 440C", "air, 440C"] :: names an environment twice
TABLE: "air, 440C" = 0.2\n =>  :: in at least one environment
TABLE: environments => slip_speed = "1 mm"\nenvironments :: needs a unit of speed
TABLE: environments => enviroments :: Did you mean environments?
"""
"""A file, an edit of it, and words. DATUM is its modulus; a text alone is added behind, or at ^ before."""

OTHERS = {
    "an empty file": ("", "is empty"),
    "only a comment": ("# nothing\n", "is empty"),
    "no record": ('title = "Ours"\n', "has no record"),
    "no TOML": ("[cage_material\n", "is not valid TOML"),
    "a section of lists": ("[[film]]\nname = 1\n", "must contain records"),
    "a record without header": ("[cage_material]\nOurs = 5\n", "must be a record: keys with values; got 5"),
    "no modulus": (f'[film."F"]\n{RATIO}\n', "lacks: elastic_modulus"),
    "no Poisson's ratio": (f'[film."F"]\n{MODULUS}\n', "lacks: poisson_ratio"),
    "the same record twice": (MATERIAL + MATERIAL, "a second time"),
    "the same key twice": (
        changed(MATERIAL, MODULUS, f"{MODULUS}\n{MODULUS}"),
        "elastic_modulus a second time",
    ),
    "two data for one temperature": (
        modulus(f"[{MODULUS[18:]}, {MODULUS[18:].replace('5', '6')}]"),
        "two data for the same temperature",
    ),
    "one name in two spellings": (
        MATERIAL + MATERIAL.replace("Ours", "OURS"),
        'line 4: [cage_material] OURS has a name of Ours (ours.toml, line 1); got "OURS"',
    ),
    "a remark over two lines": (MATERIAL + 'remark = "a\\nb"\n', "must be one line"),
    "a fluid without phase": ('[fluid."x"]\nsubstance = "y"\n', "lacks: phase"),
    "a table without friction": (TABLE.partition('[friction_table."rig".f')[0], "lacks: friction"),
    "brackets without end": ("[film]\nx = " + "[" * 40, "brackets more than 16 deep"),
    "a line without end": (MATERIAL + "# " + "x" * 5000 + "\n", "is longer than 4000 characters"),
    "a NUL": (MATERIAL + "# \0\n", "NUL character"),
}


def cases():
    """Text of a wrong file, and words of its refusal."""
    files = {"MATERIAL": MATERIAL, "TABLE": TABLE, "FLUID": FLUID}
    for number, line in enumerate(EDITS.strip().replace("\n    ::", " ::").splitlines()):
        edit, _, words = line.partition(" :: ")
        base, _, edit = edit.replace(r"\n", "\n").partition(": ")
        old, _, new = edit.partition("=> ")
        old, text = old.removesuffix(" ").replace("DATUM", MODULUS.partition(" = ")[2]), files[base]
        wrong = changed(text, old, new) if old not in ("", "^") else new + text if old else text + new
        yield pytest.param(wrong, words, id=f"{number} {new[:40]}")
    for name, (text, words) in OTHERS.items():
        yield pytest.param(text, words, id=name)


@pytest.mark.parametrize(("text", "words"), list(cases()))
def test_a_wrong_library_is_refused_in_one_line(text, words, tmp_path):
    """File, mostly line, rule and value; nothing beside it appears."""
    path = tmp_path / "ours.toml"
    path.write_text(text)
    with pytest.raises(InputError) as refused:
        joined([read_library(path)])
    message = str(refused.value)
    assert words in message
    assert message.startswith("ours.toml")
    assert message.replace("\n", "").isprintable()
    assert len(message) < 600
    assert [p.name for p in tmp_path.iterdir()] == ["ours.toml"]


@pytest.mark.parametrize("text", [MATERIAL, TABLE, FLUID])
def test_the_files_that_are_changed_are_right(text, tmp_path):
    """So that each refusal is for its change alone."""
    path = tmp_path / "ours.toml"
    path.write_text(text)
    joined([read_library(path)])


STUDIES = {
    "a film that no library has": ('[film]\nmaterial = "Ourz"\n', "is not a film of the library"),
    "a near miss of a user's record": ('[cage]\nmaterial = "Oors"\n', "Did you mean Ours?"),
    "a near miss of a user's table": ('[ranking]\nfriction = "rigg"\n', "Did you mean rig?"),
    "a material that the table lacks": (
        '[ranking]\nfriction = "rig"\nmaterials = ["Armalon"]\n',
        "names a material that rig lacks",
    ),
    "a cage material for a ball": (
        '[bearing]\nball_material = "Ours"\n',
        "is not a bearing material of the library",
    ),
    "a library that is a number": ("library = 5\n", "must be the path of a file or a folder"),
    "a library that is missing": (
        'library = "no.toml"\n',
        'library does not name a file or folder; got "no.toml"',
    ),
    "an empty list": ("library = []\n", "must be one path or a list of 1 to 20"),
    "an empty folder": ('library = "empty"\n', "names a folder without a .toml file"),
    "a library that is a study": ('library = "case.toml"\n', "is not a kind of record"),
    "a library with an endless name": (f'library = "{"x" * 300}"\n', "does not name a file or folder"),
}


@pytest.mark.parametrize("what", STUDIES)
def test_a_study_that_names_a_wrong_record_is_refused_in_one_line(what, tmp_path):
    """Names of users' records get the same help as shipped ones."""
    text, words = STUDIES[what]
    (tmp_path / "materials.toml").write_text(MATERIAL + TABLE)
    (tmp_path / "empty").mkdir()
    top, _, sections = text.partition("[")
    (tmp_path / "case.toml").write_text(
        f'extends = "cryogenic-turbopump"\n{top}' + "[" * bool(sections) + sections
    )
    with pytest.raises(InputError) as refused:
        read_study(tmp_path / "case.toml")
    assert words in str(refused.value)
    assert str(refused.value).replace("\n", "").isprintable()


def test_a_study_beside_a_wrong_library_is_refused_for_the_library(tmp_path):
    """Even if it names nothing in it: what would have been replaced is not known."""
    (tmp_path / "materials.toml").write_text(changed(MATERIAL, "5 GPa", "5 mm"))
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


CALLS = {
    "no verb": ([], "Missing command"),
    "an unknown verb": (["lst"], "No such command 'lst'"),
    "an unknown kind": (["list", "--kind", "flim"], "Did you mean film?"),
    "a library that is missing": (
        ["list", "--library", "no.toml"],
        "--library does not name a file or folder",
    ),
    "no name": (["show"], "Missing argument 'NAME'"),
    "an unknown name": (["show", "440 C"], "Did you mean 440C?"),
    "an empty name": (["show", ""], "is not a record of the library"),
    "a name of another kind": (["show", "440C", "--kind", "film"], "is not a film of the library"),
    "a temperature without unit": (["show", "PTFE", "--temperature", "77"], 'Write "77 K"'),
    "a temperature of a length": (["show", "PTFE", "--temperature", "77 m"], "needs a unit of temperature"),
    "a temperature below zero": (["show", "PTFE", "--temperature", "-1 K"], "--temperature must lie between"),
}


@pytest.mark.parametrize("what", CALLS)
def test_a_wrong_call_is_refused_in_one_line(what, capsys):
    """Exit status 2, and nothing on standard output."""
    arguments, words = CALLS[what]
    assert main(["materials", *arguments]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert all(line.startswith("separatrix: ") for line in err.splitlines())
    assert words in err
