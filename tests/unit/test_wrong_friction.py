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


WRONG_FILES = {
    "empty": ("", ("is empty", "separatrix tribometer")),
    "no test": ('title = "mine"', ("holds no test", "[[test]]")),
    "one bracket": (text_of().replace("[[test]]", "[test]"), ("test must be 1 to", "[[test]]")),
    "test is a number": ("test = 3", ("line 1: test must be 1 to", "got 3")),
    "tests are numbers": ("test = [1]", ("must be a table", "got 1")),
    "tests without end": ("test = []", ("must be 1 to 10000", "0 tests")),
    "unknown section": (text_of() + "[tests]\n", ("line 6: tests is not a key", "Did you mean test?")),
    "title is a number": ("title = 3\n" + text_of(), ("title must be text",)),
    "not TOML": ("[[test]\n", ("line 1", "not valid TOML")),
    "decimal comma": (text_of(friction="0,08"), ("line 5", "Write a decimal point: 0.08")),
    "key twice": (text_of() + "friction = 0.1\n", ("line 6", "friction a second time")),
    "no material": (text_of(material=None), ("line 1: [[test]] lacks: material",)),
    "no medium and counterface": (text_of(medium=None, counterface=None), ("lacks: counterface, medium",)),
    "no friction": (text_of(friction=None), ("lacks: friction",)),
    "unknown key": (text_of(speed='"1 m/s"'), ("line 6", "speed is not a key", "Did you mean")),
    "friction is text": (text_of(friction='"0.08"'), ("line 5", "plain number", "as a number, not as text")),
    "friction 0": (text_of(friction="0"), ("line 5", "friction must be > 0", "logarithm")),
    "friction negative": (text_of(friction="-0.1"), ("friction must be > 0", "got -0.1")),
    "friction 3": (text_of(friction="3"), ("friction must be <= 2", "got 3")),
    "friction nan": (text_of(friction="nan"), ("friction must be a finite number", "got nan")),
    "friction true": (text_of(friction="true"), ("plain number", "got true")),
    "error negative": (text_of(standard_error="-0.01"), ("line 6", "standard_error must be >= 0")),
    "error with percent": (text_of(standard_error='"5 %"'), ("standard_error must be a plain number",)),
    "scatter infinite": (text_of(standard_deviation="inf"), ("standard_deviation must be a finite number",)),
    "count 0": (text_of(effective_count="0"), ("effective_count must be > 0",)),
    "speed without unit": (text_of(slip_speed="2"), ("slip_speed needs a unit of speed", '"2 m/s"')),
    "speed in mm": (text_of(slip_speed='"2 mm"'), ("slip_speed needs a unit of speed", "which is a length")),
    "speed 0": (text_of(slip_speed='"0 m/s"'), ("line 6", "slip_speed must lie between")),
    "speed with comma": (text_of(slip_speed='"2,5 m/s"'), ("decimal point, not a comma", '"2.5 m/s"')),
    "three speeds": (text_of(slip_speed='["1 m/s", "2 m/s", "3 m/s"]'), ("[lowest, highest]", "3 of them")),
    "speeds the wrong way": (text_of(slip_speed='["5 m/s", "1 m/s"]'), ("must name the lowest first",)),
    "speeds, one bare": (text_of(slip_speed='["1 m/s", 5]'), ("slip_speed, item 2,", "needs a unit")),
    "pressure as force": (text_of(pressure='"20 N"'), ("pressure needs a unit of pressure", "a force")),
    "pressure beyond": (text_of(pressure='"1e9 GPa"'), ("pressure must lie between", "1000 GPa")),
    "temperature 0": (text_of(temperature='"0 K"'), ("temperature must lie between 0.1 K",)),
    "comma in the medium": (text_of(medium='"air, dry"'), ("medium must not hold a comma", "got")),
    "material empty": (text_of(material='""'), ("material must be one line of 1 to 200",)),
    "material over lines": (text_of(material='"a\\nb"'), ("material must be one line",)),
    "running-in bare": (text_of(run_in_end="35"), ("run_in_end must be a time", '"200 m"')),
    "running-in in newtons": (text_of(run_in_end='"35 N"'), ("run_in_end must be a time", "500 cycles")),
    "flags as text": (text_of(flags='"drift"'), ("flags must be a list",)),
    "flag a number": (text_of(flags="[1]"), ("flags, item 1,", "must be text")),
    "the same log twice": (
        2 * text_of(checksum='"ab"', source='"a.csv"'),
        ("line 13", "checksum is that of test 1 once more", "remove one"),
    ),
    "a copy of a log": (
        text_of(checksum='"ab"', source='"a.csv"') + text_of(checksum='"ab"', source='"b.csv"'),
        ("line 13", "checksum is that of test 1 once more", "remove one"),
    ),
    "material with a space behind": (text_of(material='"Armalon "'), ("must not begin or end with a space",)),
    "material in other capitals": (
        text_of() + text_of(material='"armalon"'),
        ("line 7: [[test]].material differs from that of test 1", 'instance "Armalon"'),
    ),
    "medium with two spaces": (
        text_of() + text_of(medium='"liquid  nitrogen"'),
        ("line 9: [[test]].medium differs from that of test 1 only in capitals or spaces",),
    ),
}


@pytest.mark.parametrize("name", WRONG_FILES)
def test_a_wrong_friction_file_is_refused_in_one_line(tmp_path, name):
    """The line names the file, the rule and the value; a study that names the file passes it on."""
    text, words = WRONG_FILES[name]
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
        line = str(refused.value)
        assert "\n" not in line
        assert line.startswith("friction.toml")
        assert [word for word in words if word not in line] == [], line


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
