"""Wrong friction files, and studies that name them: each refused in one line that says what and where."""

import pytest

from separatrix.friction.file import FrictionTest, read_friction
from separatrix.friction.fit import fit_friction
from separatrix.ground.errors import InputError
from separatrix.study.reading import read_study

GOOD = {
    "material": '"Armalon"',
    "counterface": '"440C"',
    "medium": '"liquid nitrogen"',
    "friction": "0.08",
}


def text_of(**changes):
    """A friction file with one test: a good one, with some keys changed, added or (None) left out."""
    return "[[test]]\n" + "".join(f"{k} = {v}\n" for k, v in (GOOD | changes).items() if v is not None)


WRONG_FILES = r"""
material = "Armalon" => :: line 1: [[test]] lacks: material
^[[test]] => [test] :: line 1: [test] must be a list in [brackets]; got a table. Write [[test]]
^title = "mine" :: friction.toml lacks: test. Write [[test]]
^ :: friction.toml is empty. `separatrix tribometer
^test = [] :: line 1: test must have 1 to 10000 items; got 0 of them
^test = [1] :: line 1: test[1] must be a table with material, counterface, medium, friction; got 1
+[tests] :: line 6: [tests] is not a section of a friction file. Did you mean test?
+speed = "1 m/s" :: line 6: [[test]] speed is not a valid key. Did you mean
"Armalon" => "Armalon " :: line 2: [[test]] material must not begin or end with a space
"Armalon" => "" :: line 2: [[test]] material must be one line of 1 to 200
nitrogen => nitrogen, wet :: line 4: [[test]] medium must not hold a comma; got "liquid nitrogen, wet"
0.08 => 0 :: line 5: [[test]] friction must be > 0; got 0. Its logarithm is fitted
0.08 => 3 :: line 5: [[test]] friction must be <= 2; got 3
0.08 => "8 %" :: line 5: [[test]] friction must be a plain number, without a unit; got "8 %". Write 0.08
+standard_error = -0.01 :: line 6: [[test]] standard_error must be >= 0
+standard_deviation = inf :: line 6: [[test]] standard_deviation must be a finite number
+effective_count = 0 :: line 6: [[test]] effective_count must be > 0
+slip_speed = "0 m/s" :: line 6: [[test]] slip_speed must lie between 1e-09 m/s and 1000 m/s; got 0 m/s
+slip_speed = ["5 m/s", "1 m/s"] :: line 6: [[test]] slip_speed must have the lowest value first
+pressure = "20 N" :: line 6: [[test]] pressure needs a unit of pressure
+pressure = "1e9 GPa" :: line 6: [[test]] pressure must lie between 0.001 Pa and 1000 GPa
+temperature = "0 K" :: line 6: [[test]] temperature must lie between 0.1 K
+run_in_end = "35 N" :: line 6: [[test]] run_in_end must be a time, a distance or a number of cycles
+flags = [1] :: line 6: [[test]] flags[1] must be text
+checksum = "a"\nsource = "a.csv"\nGOODchecksum = "a"\nsource = "a.csv"
    :: line 13: [[test]] checksum is that of test 1 once more. Each log counts once; remove one
+checksum = "a"\nsource = "a.csv"\nGOODchecksum = "a"\nsource = "b.csv"
    :: line 13: [[test]] checksum is that of test 1 once more
+GOODfriction = 0.1 :: line 11 has friction a second time
+\n[[test]]\nmaterial = "armalon"\ncounterface = "440C"\nmedium = "liquid  nitrogen"\nfriction = 1
    :: line 8: [[test]] material differs from that of test 1 only in capitals or spaces; got "armalon"
    :: line 10: [[test]] medium differs from that of test 1 only in capitals or spaces
"""
"""A change of a good file, one added (+) or the file itself (^); place and rule of each mistake."""


def wrong_files():
    """Text of a wrong file, and the begin of each line of its refusal."""
    for number, line in enumerate(WRONG_FILES.strip().replace("\n    ::", " ::").splitlines()):
        change, *refusal = line.split(" :: ")
        change = change.replace(r"\n", "\n").replace("GOOD", text_of())
        old, arrow, new = change.removeprefix("^").partition(" =>")
        text = text_of() + change[1:] + "\n" if change[0] == "+" else change[1:] + "\n"
        yield pytest.param(
            text_of().replace(old, new.strip()) if arrow else text, refusal, id=f"{number} {old[:30]}"
        )


@pytest.mark.parametrize(("text", "refusal"), list(wrong_files()))
def test_a_wrong_friction_file_is_refused_a_line_a_mistake(tmp_path, text, refusal):
    """The line names the file, the rule and the value; a study that names the file passes it on."""
    (tmp_path / "friction.toml").write_text(text)
    (tmp_path / "study.toml").write_text(
        'extends = "cryogenic-turbopump"\n[ranking]\nfriction = "friction.toml"\n'
    )
    for read in (
        lambda: read_friction(tmp_path / "friction.toml"),
        lambda: read_study(tmp_path / "study.toml"),
    ):
        with pytest.raises(InputError) as refused:
            read()
        lines = [line.replace("friction.toml, ", "", 1) for line in str(refused.value).splitlines()]
        assert [line[: len(one)] for line, one in zip(lines, refusal, strict=True)] == refusal


WRONG_STUDIES = {
    "no such file": ('friction = "other.toml"', ("[ranking] friction names no file", "other.toml")),
    "a folder": ('friction = "folder.toml"', ("names no file beside the study",)),
    "no such table": (
        'friction = "pin-on-disk-77"',
        ("[ranking] friction is not a friction table", "separatrix tribometer"),
    ),
    "a material it lacks": (
        'friction = "friction.toml"\nmaterials = ["Armalom"]',
        ("materials names a material that friction.toml lacks", "Did you mean Armalon?"),
    ),
    "scatter 0": (
        'friction = "friction.toml"\nfriction_scatter = 0',
        ("friction_scatter must lie between 0.001", "got 0"),
    ),
    "scatter in percent": (
        'friction = "friction.toml"\nfriction_scatter = 9',
        ("friction_scatter must lie between 0.001 and 1", "got 9", "0.09 is 9 %"),
    ),
    "scatter as text": (
        'friction = "friction.toml"\nfriction_scatter = "9 %"', ("friction_scatter", "plain number"),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", WRONG_STUDIES)
def test_a_study_that_asks_wrongly_for_friction_is_refused_in_one_line(tmp_path, name):
    """The line names the study and its key."""
    ranking, words = WRONG_STUDIES[name]
    (tmp_path / "friction.toml").write_text(text_of())
    (tmp_path / "folder.toml").mkdir()
    (tmp_path / "study.toml").write_text(f'extends = "cryogenic-turbopump"\n[ranking]\n{ranking}\n')
    with pytest.raises(InputError) as refused:
        read_study(tmp_path / "study.toml")
    line = str(refused.value)
    assert "\n" not in line
    assert line.startswith("study.toml")
    assert [word for word in words if word not in line] == [], line


@pytest.mark.parametrize(
    ("ask", "words"),
    [
        (lambda _: fit_friction([]), "holds no test"),
        (lambda t: fit_friction([t], 0.0), "friction_scatter must lie between"),
        (lambda t: fit_friction([t], 9.0), "got 9"),
        (lambda t: fit_friction([t]).of("B", "air, 440C"), 'holds no test of "B" in "air, 440C"'),
    ],
)
def test_a_fit_that_cannot_be_is_refused(ask, words):
    """No test, no such scatter, no such material."""
    test = FrictionTest(material="A", counterface="440C", medium="air", friction=0.1)
    with pytest.raises(InputError, match=words):
        ask(test)
