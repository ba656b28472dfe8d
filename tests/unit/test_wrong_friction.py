"""Wrong friction files, and studies that name them: each refused in one line that says what and where."""

import pytest
from commands import changed, refusal, refusal_line, rows_of, written

from separatrix.friction.friction_file import FrictionTest, read_friction
from separatrix.friction.friction_fit import fit_friction
from separatrix.ground.errors import InputError

GOOD = """\
[[test]]
material = "Armalon"
counterface = "440C"
medium = "liquid nitrogen"
friction = 0.08
"""

WRONG_FILES = r"""
^test = [] :: line 1: test must have 1 to 10000 items; got 0 of them
"Armalon" => "Armalon " :: line 2: [[test]] material must not begin or end with a space
+slip_speed = ["5 m/s", "1 m/s"] :: line 6: [[test]] slip_speed must have the lowest value first
^title = "mine" :: friction.toml lacks: test. Write [[test]]
nitrogen => nitrogen, wet :: line 4: [[test]] medium must not hold a comma; got "liquid nitrogen, wet"
0.08 => "8 %" :: line 5: [[test]] friction must be a plain number, without a unit; got "8 %". Write 0.08
+checksum = "a"\nsource = "a.csv"\nGOODchecksum = "a"\nsource = "a.csv"
    :: line 13: [[test]] checksum is that of test 1 once more. Each log counts once; remove one
+checksum = "a"\nsource = "a.csv"\nGOODchecksum = "a"\nsource = "b.csv"
    :: line 13: [[test]] checksum is that of test 1 once more
+\n[[test]]\nmaterial = "armalon"\ncounterface = "440C"\nmedium = "liquid  nitrogen"\nfriction = 1
    :: line 8: [[test]] material differs from that of test 1 only in capitals or spaces; got "armalon"
    :: line 10: [[test]] medium differs from that of test 1 only in capitals or spaces
"""
"""A change of a good file, one added (+) or the file itself (^); place and rule of each mistake."""


@pytest.mark.parametrize(("change", "lines"), rows_of(WRONG_FILES))
def test_a_wrong_friction_file_is_refused_a_line_a_mistake(tmp_path, change, lines):
    """The line names the file, the rule and the value; a study that names the file passes it on."""
    named = written(tmp_path, 'extends = "cryogenic-turbopump"\n[ranking]\nfriction = "friction.toml"\n')
    text = changed("" if change[0] == "^" else GOOD, change.replace("GOOD", GOOD))
    wrong = written(tmp_path, text, "friction.toml")
    for found in (refusal(wrong, read_friction), refusal(named)):
        found = [line.replace("friction.toml, ", "", 1) for line in found.splitlines()]
        assert [line[: len(one)] for line, one in zip(found, lines, strict=True)] == lines


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
    "scatter in percent": (
        'friction = "friction.toml"\nfriction_scatter = 9',
        ("friction_scatter must lie between 0.001 and 1", "got 9", "0.09 is 9 %"),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", WRONG_STUDIES)
def test_a_study_that_asks_wrongly_for_friction_is_refused_in_one_line(tmp_path, name):
    """The line names the study and its key."""
    ranking, words = WRONG_STUDIES[name]
    (tmp_path / "friction.toml").write_text(GOOD)
    (tmp_path / "folder.toml").mkdir()
    (tmp_path / "study.toml").write_text(f'extends = "cryogenic-turbopump"\n[ranking]\n{ranking}\n')
    line = refusal_line(tmp_path / "study.toml")
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
