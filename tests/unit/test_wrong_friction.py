"""Wrong friction files, and studies that name them: each refused in one line that says what and where."""

import pytest
from commands import refusal, table

from separatrix.friction.file import FrictionTest, read_friction
from separatrix.friction.fit import fit_friction
from separatrix.ground.errors import InputError
from separatrix.study.reading import read_study

GOOD = '[[test]]\nmaterial = "Armalon"\ncounterface = "440C"\nmedium = "liquid nitrogen"\nfriction = 0.08\n'
WRONG_FILES = r"""
[[test]] => [test] :: line 1: [test] must be a list in [brackets]; got a table. Write [[test]]
^title = "mine" :: friction.toml lacks: test. Write [[test]]
^ :: friction.toml is empty. `separatrix tribometer
^test = [] :: line 1: test must have 1 to 10000 items; got 0 of them
^test = [1] :: line 1: test[1] must be a table with material, counterface, medium, friction; got 1
"Armalon" => "Armalon " :: line 2: [[test]] material must not begin or end with a space
nitrogen => nitrogen, wet :: line 4: [[test]] medium must not hold a comma; got "liquid nitrogen, wet"
+slip_speed = ["5 m/s", "1 m/s"] :: line 6: [[test]] slip_speed must have the lowest value first
+checksum = "a"\nsource = "a.csv"\nGOODchecksum = "a"\nsource = "a.csv"
    :: line 13: [[test]] checksum is that of test 1 once more. Each log counts once; remove one
+checksum = "a"\nsource = "a.csv"\nGOODchecksum = "a"\nsource = "b.csv"
    :: line 13: [[test]] checksum is that of test 1 once more
+\n[[test]]\nmaterial = "armalon"\ncounterface = "440C"\nmedium = "liquid  nitrogen"\nfriction = 1
    :: line 8: [[test]] material differs from that of test 1 only in capitals ; line 10: [[test]] medium
"""
"""A change of a good file, one added (+) or the file itself (^); place and rule of each mistake."""


@pytest.mark.parametrize(("change", "words"), table(WRONG_FILES))
def test_a_wrong_friction_file_is_refused_a_line_a_mistake(tmp_path, change, words):
    """The line names the file, the rule and the value; a study that names the file passes it on."""
    old, _, new = change.replace("GOOD", GOOD).partition(" => ")
    text = {"+": f"{GOOD}{old[1:]}\n", "^": f"{old[1:]}\n"}.get(old[0], GOOD.replace(old, new))
    (tmp_path / "friction.toml").write_text(text)
    (tmp_path / "study.toml").write_text(STUDY + 'friction = "friction.toml"\n')
    for read, name in ((read_friction, "friction.toml"), (read_study, "study.toml")):
        refusal(words, read, tmp_path / name, lines=len(words))


STUDY = 'extends = "cryogenic-turbopump"\n[ranking]\n'
WRONG_STUDIES = r"""
friction = "other.toml" :: [ranking] friction names no file ; other.toml
friction = "folder.toml" :: names no file beside the study
friction = "pin-on-disk-77" :: [ranking] friction is not a friction table ; separatrix tribometer
friction = "friction.toml"\nmaterials = ["Armalom"]
    :: materials names a material that friction.toml lacks ; Did you mean Armalon?
friction = "friction.toml"\nfriction_scatter = 0 :: friction_scatter must lie between 0.001 ; got 0
friction = "friction.toml"\nfriction_scatter = 9
    :: friction_scatter must lie between 0.001 and 1 ; got 9 ; 0.09 is 9 %
"""


@pytest.mark.parametrize(("ranking", "words"), table(WRONG_STUDIES))
def test_a_study_that_asks_wrongly_for_friction_is_refused_in_one_line(tmp_path, ranking, words):
    """The line names the study and its key."""
    (tmp_path / "friction.toml").write_text(GOOD)
    (tmp_path / "folder.toml").mkdir()
    (tmp_path / "study.toml").write_text(f"{STUDY}{ranking}\n")
    assert refusal(words, read_study, tmp_path / "study.toml").startswith("study.toml")


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
