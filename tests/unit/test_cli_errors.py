"""Wrong input: a line on standard error for each mistake, exit status 2, nothing written.

A file that a user names is a regular one: a pipe or a device, which may never end, is not opened.
"""

import json
import os
import shlex
from pathlib import Path

import pytest
from commands import SMALL, refused, rows_of
from test_study import VALID

import separatrix
from separatrix import InputError, RunOutcome
from separatrix.front import cli, main
from separatrix.ground.files import size_of

pytestmark = pytest.mark.usefixtures("elsewhere")


@pytest.mark.parametrize("verb", ["check", "rank"])
def test_eight_mistakes_are_eight_lines(verb, capsys):
    """Every verb names all of them, each on a line of its own, in the order of the file."""
    mistakes = {
        "bore": ('"50 mm"', '"50"'),
        "ball_material": ('"440C"', '"silicon carbide"'),
        "inner_speed": ('"15000 rpm"', '"40,000 rpm"'),
        "axial_load": ('"300 daN"', '"300"'),
        "material": ('"PTFE transfer film"', '"PTFE transfer"'),
        "mass": ('"25 g"', '"25"'),
        "runs": ("runs = 64", "runs = 0"),
        "friction": ('"pin-on-disk-77K"', '"pin-on-disk"'),
    }
    text = VALID
    for right, wrong in mistakes.values():
        text = text.replace(right, wrong)
    Path("study.toml").write_text(text)
    assert main([verb, "study.toml"]) == 2
    out, err = capsys.readouterr()
    assert (out, [path.name for path in Path().iterdir()]) == ("", ["study.toml"])
    for key, line in zip(mistakes, err.splitlines(), strict=True):
        assert line.startswith("separatrix: ")
        assert f"] {key} " in line


def test_first_words(capsys):
    """Without a command three lines: what it does, what to try, where more is; nothing is made."""
    assert main([]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 3
    assert all(word in one for one, word in zip(lines, ("cage", "separatrix demo", "--help"), strict=True))
    assert [*Path().iterdir()] == []


def test_demo_ranks_the_shipped_study(monkeypatch):
    """With the options of `rank`, and nothing else of its own."""
    asked = {}
    monkeypatch.setattr(cli, "run", lambda verb, given: asked.update(given, verb=verb.name) or 0)
    assert main(["demo", "--model", "paper", "--json"]) == 0
    assert (asked["verb"], asked["study"], asked["model"]) == ("rank", "cryogenic-turbopump", "paper")


USAGE = {
    "no study": (["bearing"], "STUDY"),
    "two studies": (["bearing", "le7", "le7"], "le7"),
    "unknown option": (["bearing", "le7", "--jsn"], "--jsn"),
    "no jobs": (["bearing", "le7", "--jobs", "0"], "--jobs"),
    "too many jobs": (["bearing", "le7", "--jobs", "1000000"], "--jobs"),
    "out without a folder": (["bearing", "le7", "--out"], "--out"),
    "new without a path": (["new"], "PATH"),
    "study with control characters": (["bearing", "a\x1b[31m\nb"], ""),
    "out that is a file": (["rank", "cryogenic-turbopump", "--out", "taken.toml"], "--out"),
    "out below a file": (["rank", "cryogenic-turbopump", "--out", "taken.toml/below"], "--out"),
    "default folder that is a file": (["bearing", "study.toml"], "--out"),
    "out from an unset variable": (["bearing", "le7", "--out", ""], "--out"),
    "out longer than a file system takes": (["check", "le7", "--out", "a" * 300], "--out"),
    "a wrong study, before its folder is made": (["bearing", "empty.toml", "--out", "deep/folder"], "empty"),
    "new over a file": (["new", "taken.toml"], "exists"),
    "new over a folder": (["new", "folder.toml"], "folder"),
    "new without its folder": (["new", "nowhere/mine.toml"], "nowhere"),
}
OPTIONS = r"""
simulate le7 --model full :: [cage] is missing; `--model` needs it
sweep le7 --model paper :: [cage] is missing; `--model` needs it
rank cryogenic-turbopump --model cube :: full, paper
map small.toml --y restitution_factor=0..1 :: restitution_factor twice
map small.toml --x kick=0.1..1m/s --kick '1 m/s' :: exclude each other
map small.toml --points 1 :: --points
map small.toml --runs 0 :: --runs
map small.toml --x cage.pocket_clearance=20..40mm:2 --points 2 :: no point that could be run
simulate cryogenic-turbopump --kick 2 :: needs a unit of speed
simulate cryogenic-turbopump --kick '0 m/s' :: must be >
simulate cryogenic-turbopump --kick '-1 m/s' :: must be >
simulate cryogenic-turbopump --run -1 :: --run must lie between
sweep momentum-wheel :: --vary is missing
sweep momentum-wheel --vary cage.mass=1..2g --cases c.csv :: exclude each other
sweep momentum-wheel --vary cage.mass=1..2g --vary cage.mass=1..2g :: must name each parameter once
sweep momentum-wheel --vary cage.mass=1..2g:1000 --vary film.thickness=1..2um:1000 :: at most 100000 cases
sweep momentum-wheel --cases nope.csv :: cannot be read
sensitivity cryogenic-turbopump --samples 0 :: must be a power of two from 64
sensitivity cryogenic-turbopump --samples -64 :: must be a power of two from 64
sensitivity cryogenic-turbopump --samples 32 :: must be a power of two from 64
sensitivity cryogenic-turbopump --samples 1000 :: Try 1024.
sensitivity cryogenic-turbopump --samples 131072 :: to 65536
sensitivity cryogenic-turbopump --samples 999999999999999999999999999999 :: to 65536
materials list --kind flim :: Did you mean film?
materials list --library no.toml :: --library does not name a file
materials show :: Missing argument 'NAME'
materials show '440 C' :: Did you mean 440C?
materials show '' :: is not a record of the library
materials show 440C --kind film :: is not a film of the library
"""
CALLED = USAGE | {call: (shlex.split(call), said) for call, (said,) in rows_of(OPTIONS)}


@pytest.mark.parametrize(("arguments", "said"), CALLED.values(), ids=CALLED)
def test_wrong_usage_is_refused_in_one_line(arguments, said, capsys):
    """Each misuse of the command line and of the options of a verb; what is there stays as it was."""
    Path("folder.toml").mkdir()
    Path("study.toml").write_text(VALID)
    Path("empty.toml").write_text("")
    Path("small.toml").write_text(SMALL)
    for taken in ("taken.toml", "study"):
        Path(taken).write_text("mine")
    line = refused(capsys, *arguments)
    assert said in line
    assert line.startswith("separatrix: ")
    assert Path("taken.toml").read_text() == Path("study").read_text() == "mine"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["chek"], "No such command 'chek'. Did you mean 'check'?"),
        (["materials", "lst"], "No such command 'lst'. Did you mean 'list'?"),
        (["xyzzy"], "No such command 'xyzzy'."),
    ],
)
def test_an_unknown_verb_is_answered_in_whole_sentences(arguments, said, capsys):
    """A question ends with its own mark, all else with a full stop."""
    assert refused(capsys, *arguments) == f'separatrix: {said} Try "separatrix --help".\n'


@pytest.mark.parametrize(
    ("verb", "option"), [("check", "--jobs"), ("map", "--points"), ("simulate", "--run")]
)
@pytest.mark.parametrize("value", ["two", "1.5", "", "9" * 5000])
def test_an_option_that_is_no_whole_number_is_refused_in_our_words(verb, option, value, capsys):
    """Where, rule, value and cure, whichever option takes the number."""
    line = refused(capsys, verb, "le7", option, value)
    shown = value if len(value) < 60 else "9" * 57 + "..."
    cure = "Write it in digits, or leave it out."
    assert line == f'separatrix: {option} must be a whole number; got "{shown}". {cure}\n'


def test_a_study_named_by_dots_alone_does_not_write_above(capsys):
    """The file `...toml` has the stem `..`: its default folder must not be the one above."""
    Path("below").mkdir()
    os.chdir("below")
    Path("...toml").write_text(VALID)
    assert "--out" in refused(capsys, "bearing", "...toml")
    assert [path.name for path in Path("..").iterdir()] == ["below"]


LOG = "time (s),friction coefficient\n" + "".join(f"{t},0.{10 + t % 2}\n" for t in range(100))
CALLS = [
    *(["tribometer", path] for path in ("p.toml", "link.toml", "p.xlsx", "/dev/zero")),
    *(["tribometer", "a.csv", "--map", path] for path in ("p.toml", "link.toml", "/dev/zero")),
    *(["compare", path, path] for path in ("link.toml", "p.json", "saved", "/dev/zero")),
    *(["check", path] for path in ("p.toml", "link.toml")),
    *(["materials", "list", "--library", path] for path in ("p.toml", "link.toml")),
    ["tribometer", "a.csv", "p.xlsx"],
]


@pytest.fixture
def folder(elsewhere, tmp_path):
    """A folder to stand in, with a log, and pipes without a writer."""
    (tmp_path / "a.csv").write_text(LOG)
    for name in ("p.toml", "p.xlsx", "p.json"):
        os.mkfifo(name)
    (tmp_path / "link.toml").symlink_to("p.toml")
    (tmp_path / "saved").mkdir()
    os.mkfifo("saved/simulate.json")
    return tmp_path


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize("call", CALLS, ids=" ".join)
def test_no_verb_waits_for_a_pipe(capsys, call):
    """By its own name, by a link, with another ending, in a saved folder; a device without an end."""
    assert " is not a regular file. Save its output to a file, and name that.\n" in refused(capsys, *call)


def test_the_size_of_a_regular_file_is_told_and_all_else_refused(folder):
    """Links are followed; no file, a name with a NUL or too long a name, a folder."""
    (folder / "link.csv").symlink_to("a.csv")
    assert size_of(folder / "link.csv", "it") == len(LOG)
    wrong = {
        folder / "none": "it cannot be read: no such file or directory.",
        folder / "a\0b": "it cannot be read: no such file.",
        folder / ("x" * 300): "it cannot be read: file name too long.",
        folder: "it is a folder, not a file. Name a file in it.",
    }
    for path, line in wrong.items():
        with pytest.raises(InputError) as caught:
            size_of(path, "it")
        assert str(caught.value) == line
    with pytest.raises(InputError, match="is not a regular file"):  # the verbs have a check of their own
        separatrix.load(folder / "p.json")


# Cages at the edge of what can be: each command answers, or refuses in one line and writes nothing.

BASE = """
extends = "cryogenic-turbopump"
[kinematics]
model = "outer race control"
[stability]
kicks = ["0.5 m/s"]
runs = 4
duration = "4 ms"
"""

ANSWERED = {
    "land tighter than the pockets": '[cage]\nland_clearance = "20 um"',
    "a land that returns nothing": "[cage]\nland_restitution = 0",
    "a land that returns all": "[cage]\nland_restitution = 1",
    "no land": '[cage]\nguidance = "ball"',
    "three balls": "[bearing]\nball_count = 3",
    "a ramp longer than the run": '[operation]\nramp_time = "50 ms"',
    "races that hardly hold the balls": "[film]\nrace_friction = 0.001",
    "races that grip the balls": "[film]\nrace_friction = 2",
}

SETTINGS = {
    "run of a week": ('duration = "168 h"', "duration must be <= 10000 s; got"),
    "run of an hour": ('duration = "1 h"', "for this cage; got 3600 s. Shorten the run"),
    "run of no time": ('duration = "1e-12 s"', "duration must be >= 0.001 us; got"),
}


def study(text: str, base: str = BASE) -> str:
    """Write the small study with some sections more; return its name."""
    Path("case.toml").write_text(base + text, encoding="utf-8")
    return "case.toml"


@pytest.mark.parametrize("case", ANSWERED)
def test_an_odd_cage_is_answered(case, capsys):
    """One document, an outcome with its sentence, and nothing said on standard error."""
    assert main(["simulate", study(ANSWERED[case]), "--json", "--quiet"]) == 0
    out, err = capsys.readouterr()
    found = json.loads(out)
    assert (err, found["outcome"] in RunOutcome.__members__) == ("", True)
    assert found["outcome_sentence"]


@pytest.mark.parametrize("verb", ["simulate", "stability", "rank", "map"])
@pytest.mark.parametrize("case", SETTINGS)
def test_an_ensemble_that_cannot_be_is_refused_in_one_line(case, verb, capsys):
    """Neither waited for nor begun."""
    text, said = SETTINGS[case]
    lines = [line for line in BASE.splitlines() if not line.startswith(text.partition(" ")[0])]
    few = ["--points", "8"] * (verb == "map")  # 10 000 points, each refused, may take longer than is silent
    assert said in refused(capsys, verb, study(text, "\n".join([*lines, ""])), *few)
