"""The verb `tribometer`, as a user runs it and as a function: logs, a column map, a friction file."""

import json
import os
import shlex
import signal
import subprocess
import sys

import numpy as np
import pytest
from commands import (
    PATIENCE,
    changed,
    column_map,
    document,
    log,
    read_friction,
    refusal,
    refusal_line,
    refused,
    rows_of,
    wait_until,
    written,
)
from test_reference_tables import missing

import separatrix
from separatrix import InputError, Operation, read_study, resolved, solve
from separatrix.chain.pocket_friction import PocketConditions, friction_in_pocket
from separatrix.friction.friction_fit import TestedFriction
from separatrix.front import main
from separatrix.verbs.tribometer import file_name

MAP = """
[test]
material = "Armalon"
counterface = "440C"
medium = "liquid nitrogen"
temperature = "77 K"
slip_speed = "2 m/s"
pin_diameter = "5 mm"
[files."b.csv"]
slip_speed = "4 m/s"
"""

BOTH = ["tribometer", "a.csv", "b.csv", "--map", "map.toml"]


@pytest.fixture
def logs(elsewhere, tmp_path):
    """Two logs and a column map, in the current folder."""
    log(tmp_path / "a.csv", 0.08, 1)
    log(tmp_path / "b.csv", 0.09, 2)
    (tmp_path / "map.toml").write_text(MAP)
    return tmp_path


def names(folder):
    """Names of all files below a folder."""
    return sorted(str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file())


def test_logs_become_a_friction_file_with_a_page_for_each(logs, capsys):
    """Text, exit status, files; the tests are those of the logs under the conditions of the map."""
    assert main([*BOTH, "--out", "friction.toml"]) == 0
    text = capsys.readouterr().out
    assert [word in text for word in ("friction.toml", "Armalon")] == [True, True]
    plots = [f"friction-plots/{n}.csv.{s}" for n in "ab" for s in ("png", "svg")]
    assert names(logs) == sorted(["a.csv", "b.csv", "map.toml", "friction.toml", *plots])
    first, second = read_friction(logs / "friction.toml")
    assert (first.source, first.slip_speed, second.slip_speed) == ("a.csv", (2.0, 2.0), (4.0, 4.0))
    assert first.pressure[0] == pytest.approx(20.0 / (np.pi * 2.5e-3**2))  # 20 N on a pin of 5 mm
    # the noise of 0.004 over a thousand rows leaves 0.0002; what is left of running-in is less than that
    assert [first.friction, second.friction] == pytest.approx([0.08, 0.09], abs=1e-3)
    assert first.standard_error < 1e-3
    assert first.reduced_by.startswith("separatrix ")


def test_python_and_json_answer_alike_and_nothing_is_written(logs, capsys):
    """The same numbers, tests as a friction file keeps them, progress up to its total; no new file."""
    before, steps = names(logs), []
    given = {"column_map": "map.toml", "progress": lambda *at: steps.append(at)}
    found = separatrix.tribometer(["a.csv", "b.csv"], **given)
    assert main(BOTH) == 0
    assert capsys.readouterr().out == found.summary()
    answer = document(capsys, *BOTH)
    assert answer == found.document()
    assert [file["source"] for file in answer["files"]] == ["a.csv", "b.csv"]
    assert answer["tests"][0]["friction_low"] < 0.08 < answer["tests"][0]["friction_high"]
    assert answer["fits"][0]["scatter_source"] == "its own tests, drawn towards the assumed 9 %"
    assert answer["friction_file"] is None
    assert missing("tribometer", answer) == set()
    assert (names(logs), steps[-1]) == (before, (1000, 1000))
    assert [test.friction for test in found.friction_tests] == [test.friction for test in found.tests]
    assert found.fit.of("Armalon", "liquid nitrogen, 440C").at().mean == pytest.approx(0.085, abs=1e-3)


def test_logs_that_do_not_say_what_slid_on_what_are_shown_but_not_written(logs, capsys):
    """Without a map: a table without materials; with --out a refusal that says where to say it."""
    assert main(["tribometer", "a.csv"]) == 0
    assert "steady friction" in capsys.readouterr().out
    assert main(["tribometer", "a.csv", "b.csv", "--out", "friction.toml"]) == 2
    line = capsys.readouterr().err
    assert line.startswith("separatrix: a.csv does not state: material, counterface, medium.")
    assert line.endswith("--map map.toml. 1 other file is refused too.\n")
    assert names(logs) == ["a.csv", "b.csv", "map.toml"]


WRONG = {  # what follows the verb, and the words of the line
    "no such file": ("nofile.csv", "nofile.csv cannot be read"),
    "a folder without logs": ("more2", "more2 is a folder without a log"),
    "a folder for a map": ("a.csv --map .", ": . is a folder"),
    "the same file twice": ("a.csv ./a.csv", "a.csv is named twice"),
    "a copy of a file": ("a.csv copy.csv", "copy.csv has the same content as a.csv"),
    "a copy of the same name": ("a.csv more/a.csv", "more/a.csv has the same content as a.csv"),
    "a copy with a comma": ("x,1.csv x,2.csv", "x,2.csv has the same content as x,1.csv"),
    "no such map": ("a.csv --map no.toml", "no.toml cannot be read: no such file"),
    "a wrong map": ("a.csv --map wrong.toml", "wrong.toml, line 2: [test] materal"),
    "two wrong of three": ("x.csv a.csv y.csv", "1 other file is refused too"),
    "out exists": ("a.csv --map map.toml --out map.toml", "map.toml exists already"),
    "out exists, whatever the logs": ("no.csv --map no.toml --out map.toml", "map.toml exists"),
    "out is no toml": ("a.csv --out friction.csv", "--out must name a file that ends in .toml"),
    "out is empty": ("a.csv --out ''", "--out needs the name of a file"),
    "a name too long": (f"a.csv --out {'x' * 300}/f.toml", "(the folder: File name too long)"),
    "a log of a name too long": ("x" * 300, "cannot be read: file name too long"),
    "out in a file": ("a.csv b.csv --map map.toml --out a.csv/f.toml", "cannot be written"),
    "running-in in newtons": ("a.csv --run-in '5 N'", "--run-in must be a time"),
    "running-in beyond": ("a.csv --run-in '5 h'", "a.csv: the end of running-in must lie before"),
    "running-in in cycles": ("a.csv --run-in '5 cycles'", "needs a column of cycles"),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_call_is_one_line_and_writes_nothing(logs, capsys, name):
    """Exit status 2, one line on standard error, nothing on standard output, no new file."""
    arguments, words = WRONG[name]
    (logs / "more").mkdir()
    (logs / "more2").mkdir()
    for copy in ("copy.csv", "more/a.csv", "x,1.csv", "x,2.csv"):
        (logs / copy).write_bytes((logs / "a.csv").read_bytes())
    (logs / "wrong.toml").write_text('[test]\nmateral = "X"\n')
    for wrong in ("x.csv", "y.csv"):
        (logs / wrong).write_text("nothing,of,interest\n")
    before = {path: (logs / path).read_bytes() for path in names(logs)}
    line = refused(capsys, "tribometer", *shlex.split(arguments))
    assert line.startswith("separatrix: ")
    assert words in line
    assert {path: (logs / path).read_bytes() for path in names(logs)} == before


def test_an_interrupt_leaves_no_friction_file(logs):
    """Ctrl-C while many logs are read: one line, status 130, nothing half written."""
    log(logs / "c0.csv", 0.1, 0, rows=3000)
    for i in range(1, 2000):  # half a minute of work on a fast machine
        os.link(logs / "c0.csv", logs / f"c{i}.csv")
    files = ["b.csv", *(f"c{i}.csv" for i in range(2000))]
    call = [sys.executable, "-m", "separatrix", "tribometer", *files, "--map", "map.toml", "--out", "f.toml"]
    process = subprocess.Popen(call, cwd=logs, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    wait_until((logs / "f-plots").exists)  # the folders are made before the first log is read
    os.kill(process.pid, signal.SIGINT)
    out, error = process.communicate(timeout=PATIENCE)
    assert (process.returncode, out) == (130, "")
    assert error == "separatrix: interrupted; no friction file was written.\n"
    assert not [*logs.glob("f[.-]*")]  # neither f.toml nor f-plots


def test_names_of_pages_are_names_of_files():
    """Whatever stands in the name of a log, its page stays in its folder."""
    assert file_name("../a b.xlsx, sheet 1") == "a-b.xlsx-sheet-1"
    assert file_name("...") == "test"


@pytest.mark.parametrize("more", [[], ["--json"]], ids=["text", "json"])
def test_a_pattern_that_fits_no_file_is_said_and_with_out_refused(logs, capsys, more):
    """Mistyped, it would lose a sample in silence; who looks at one log of many is only told."""
    (logs / "map.toml").write_text(f'{MAP}[files."zzz*.csv"]\nsample = "S1"\n')
    rule = 'map.toml: [files."zzz*.csv"] must fit a file that is named; got a.csv, b.csv.'
    command = [*BOTH, *more]
    assert main(command) == 0
    said = capsys.readouterr().out
    notes = json.loads(said)["notes"] if more else [" ".join(said.split())]
    assert rule in notes[0]
    assert len(notes) == 1
    (logs / "a.csv").write_text("no log")  # the map is refused before any log is read
    assert main([*command, "--out", "friction.toml"]) == 2
    said = capsys.readouterr().err
    assert said == f"separatrix: {rule} Mend it, or leave it out of this column map.\n"
    assert names(logs) == ["a.csv", "b.csv", "map.toml"]


def test_a_pattern_that_fits_one_of_the_files_is_not_complained_of(logs, capsys):
    """By its name or by its folder too; one that fits none of many names three of them."""
    assert document(capsys, *BOTH)["notes"] == []
    chosen = column_map({"files": {"one/*.csv": {"sample": "A"}, "x*": {"sample": "B"}}}, "map.toml")
    (wrong,) = chosen.unused([logs / "one" / f"{n}.csv" for n in range(5)])
    assert 'map.toml: [files."x*"] must fit a file that is named; got 0.csv, 1.csv, 2.csv and 2' in str(wrong)


def test_logs_of_one_name_in_two_folders_are_two_tests_each_with_its_own_conditions(tmp_path):
    """The end of running-in that the map states for one is not that of the other; the call goes before it."""
    logs = [tmp_path / "one", tmp_path / "two"]
    for place, friction in zip(logs, (0.1, 0.12), strict=True):
        place.mkdir()
        log(place / "a.csv", friction, rows=400)
    stated = column_map({"files": {"one/*.csv": {"run_in_end": "60 s"}}})
    first, second = separatrix.tribometer(logs, column_map=stated).tests
    assert (first.run_in_method, second.run_in_method == "given") == ("given", False)
    found = separatrix.tribometer(logs, column_map=stated, run_in="90 s").tests
    assert [test.run_in_end for test in found] == [90.0, 90.0]


def test_its_tables_and_pages_are_those_of_a_test(tmp_path):
    """One row for each test, in the order of the numbers in their names; its picture by its source."""
    log(tmp_path / "a2.csv", rows=400)
    log(tmp_path / "a10.csv", 0.12, rows=400)
    (tmp_path / "notes.md").write_text("none")
    found = separatrix.tribometer(tmp_path)
    table = found.to_dataframe()
    assert [*table["source"]] == ["a2.csv", "a10.csv"]
    assert [*table["friction"]] == [test.friction for test in found.tests]
    assert "a10.csv" in found.plot("a10.csv").get_suptitle()


@pytest.mark.parametrize(
    ("friction", "words"),
    [
        (0.0, "friction must be > 0; got 0. Its friction is zero in every row used: check"),
        (3.0, "friction must be <= 2; got 3. If a force was read as friction, map it as tangential"),
    ],
)
def test_a_test_that_a_friction_file_cannot_keep_is_refused_by_its_log(tmp_path, friction, words):
    """One line with the log's name, the rule, the value and the cure; no name of a class."""
    rows = "".join(f"{i},{friction}\n" for i in range(100))
    (tmp_path / "a.csv").write_text(f"time [s],COF\n{rows}")
    stated = column_map({"test": {"material": "Armalon", "counterface": "440C", "medium": "air"}})
    with pytest.raises(InputError) as caught:
        separatrix.tribometer(tmp_path / "a.csv", column_map=stated, complete=True)
    line = str(caught.value)
    assert line.startswith(f"a.csv: {words}")
    assert "\n" not in line


# Friction files written, read back and refused, and studies that rank by them.

GOOD = """\
[[test]]
material = "Armalon"
counterface = "440C"
medium = "liquid nitrogen"
friction = 0.08
"""
SMALL = f"""{GOOD}
[[test]]
material = "My compound"
counterface = "440C"
medium = "liquid nitrogen"
friction = 0.2
slip_speed = ["1 m/s", "5 m/s"]
temperature = "77 K"
sample = "s1"
"""
POCKET = PocketConditions(
    slip_speed=21.0, slip_speed_low=21.0, slip_speed_high=21.0, impact_force=80.0, pressure=1.5e8,
    max_pressure=2.25e8, contact_radius=4e-4,
)  # fmt: skip
TURNING = Operation(inner_speed=100.0, axial_load=10.0, temperature=77.0, fluid="liquid nitrogen")


def study(folder, text=SMALL, ranking=""):
    """A study beside a friction file."""
    written(folder, text, "friction.toml")
    return written(
        folder, f'extends = "cryogenic-turbopump"\n[ranking]\nfriction = "friction.toml"\n{ranking}\n'
    )


def test_a_study_ranks_the_materials_of_a_friction_file(tmp_path):
    """Environments and candidates in their order; a material of the library has its elastic record."""
    asked = read_study(study(tmp_path)).ranking
    assert asked.environments == ("liquid nitrogen, 440C",)
    assert [c.name for c in asked.candidates] == ["Armalon", "My compound"]
    assert asked.candidates[0].material.name == "Armalon"
    assert asked.candidates[1].material is None
    friction = asked.candidates[1].friction["liquid nitrogen, 440C"]
    assert friction.mean == pytest.approx(0.2, rel=1e-12)  # rounding of exp and log
    assert isinstance(friction.law, TestedFriction)
    assert "friction.toml, sha256" in friction.source


def test_a_study_may_rank_some_materials_and_assume_another_scatter(tmp_path):
    """The keys materials and friction_scatter hold for a file as for a table."""
    path = study(tmp_path, ranking='materials = ["My compound"]\nfriction_scatter = 0.2')
    asked = read_study(path)
    seen = solve(asked, asked.ranking.candidates[0]).frictions["liquid nitrogen, 440C"]
    assert seen.standard_error == pytest.approx(0.04, rel=1e-9)  # rounding
    assert seen.assumed_scatter


def test_a_study_takes_the_tests_at_its_temperature_and_says_how_many_it_leaves_out(tmp_path):
    """A test at 77 K and one at 295 K: mean, count and source are those of the cold one."""
    cold = SMALL.replace("friction = 0.08", 'friction = 0.08\ntemperature = "77 K"')
    warm = SMALL.split("[[test]]")[1].replace("0.08", '0.3\ntemperature = "295 K"')
    (candidate, _) = read_study(study(tmp_path, f"{cold}\n[[test]]{warm}")).ranking.candidates
    friction = candidate.friction["liquid nitrogen, 440C"]
    assert (friction.mean, friction.count) == (pytest.approx(0.08, rel=1e-12), 1)  # rounding of exp and log
    assert "1 of 2 tests, at other temperatures, left out" in friction.source


# Not tested as the pocket rubs.
@pytest.mark.parametrize("verb", [["stability"], ["simulate"], ["rank"], ["sensitivity", "--samples", "64"]])
def test_every_verb_has_the_same_friction_of_the_first_candidate(elsewhere, tmp_path, capsys, verb):
    """Tests at 1 and 5 m/s: that at 5, not their mean, in the cage that stands in its answer."""
    first, second = (f'{friction}\nslip_speed = "{v} m/s"' for friction, v in ((0.08, 1), (0.12, 5)))
    text = "".join(f"\n{GOOD.replace('0.08', one)}" for one in (first, second, second))
    few = '[stability]\nkicks = ["0.5 m/s"]\nruns = 2\nduration = "10 ms"\nrestitution_factors = [0.5]'
    path = study(tmp_path, text, few)
    answer = document(capsys, verb[0], str(path), *verb[1:], "--jobs", "1")
    cage, notes = answer["cage"], " ".join(answer["warnings"])
    if verb[0] in ("stability", "simulate"):
        assert "0.12 of Armalon in liquid nitrogen, 440C, extrapolated" in notes
    assert cage["ball_cage_friction"] == pytest.approx(0.12, rel=1e-6)  # the two at 5 m/s weigh alike


def test_the_cage_asks_for_what_its_pocket_rubs():
    """A table of 1 to 5 m/s at 77 K, a pocket at 21 m/s in the other medium: the mean stays, words say so."""
    table = read_study("cryogenic-turbopump").ranking.candidates[2]
    seen = friction_in_pocket(table.friction["gaseous nitrogen, 440C"], POCKET, TURNING, 0.09)
    assert (seen.mean, seen.standard_error) == (0.07, pytest.approx(0.0063))
    assert seen.standard_deviation == seen.standard_error  # stated without its tests: no number is added
    assert seen.extrapolation == (
        "slip speed in the pocket 21 m/s, tests cover 1 to 5 m/s: value at 5 m/s used",
        "test pressure unknown (pocket: 150 MPa)",
        "tested in gaseous nitrogen, not in liquid nitrogen",
    )


def test_the_shipped_study_rubs_at_25_metres_a_second():
    """The pocket of the shipped study: regression, 25.1 m/s and 157 MPa in an impact of the middle kick."""
    solution = solve(read_study("cryogenic-turbopump"))
    found = solution.pocket
    # 67.4 N are of half the mass of the ring, which an impact feels; the whole mass would press with 84 N
    assert solution.felt_mass == pytest.approx(0.5 * solution.inertia.mass, rel=1e-12)  # rounding
    # regressions to the digits of the numbers
    assert found.slip_speed == pytest.approx(25.124, rel=1e-4)
    assert found.pressure == pytest.approx(157.289e6, rel=1e-4)
    assert found.impact_force == pytest.approx(67.409, rel=1e-4)
    assert found.max_pressure == pytest.approx(1.5 * found.pressure)


def test_a_result_holds_every_test_behind_a_friction(tmp_path):
    """Whole, in SI, as the file may change; also of materials not ranked, as scatter is pooled over them."""
    found = resolved(read_study(study(tmp_path)))["ranking"]
    (test,) = found["candidates"][1]["friction"]["liquid nitrogen, 440C"]["tests"]
    assert (test["friction"], test["slip_speed"], test["sample"]) == (0.2, [1.0, 5.0], "s1")
    assert found["friction_scatter"]["value"] == 0.09
    assert found["other_tests"] == []
    json.dumps(found, allow_nan=False)
    found = resolved(read_study(study(tmp_path, ranking='materials = ["My compound"]')))["ranking"]
    assert [test["material"] for test in found["other_tests"]] == ["Armalon"]


def test_check_names_tests_that_sensitivity_refuses(tmp_path, capsys):
    """A mean that is known to ten times itself: the same line from both, and nothing of tests that tell."""
    assert document(capsys, "check", str(study(tmp_path)))["refusals"] == []
    path = str(study(tmp_path, SMALL.replace("0.08", "0.001\nstandard_error = 0.5", 1)))
    assert main(["sensitivity", path, "--json", "--samples", "64"]) == 2
    line = capsys.readouterr().err.removeprefix("separatrix: ").rstrip()
    assert line.startswith("Friction from tests of Armalon in liquid nitrogen, 440C must not scatter")
    assert {"verb": "sensitivity", "sentence": line} in document(capsys, "check", path)["refusals"]


WRONG_FILES = r"""
^title = "mine" :: friction.toml lacks: test. Write [[test]]
nitrogen => nitrogen, wet :: line 4: [[test]] medium must not hold a comma; got "liquid nitrogen, wet"
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


OF_THE_FILE = 'friction = "friction.toml"\n'
WRONG_STUDIES = {
    'friction = "other.toml"': ("[ranking] friction names no file", "other.toml"),
    'friction = "folder.toml"': ("names no file beside the study",),
    'friction = "pin-on-disk-77"': ("[ranking] friction is not a friction table", "separatrix tribometer"),
    OF_THE_FILE + 'materials = ["Armalom"]': ("that friction.toml lacks", "Did you mean Armalon?"),
    OF_THE_FILE + "friction_scatter = 9": ("must lie between 0.001 and 1", "got 9", "0.09 is 9 %"),
}


@pytest.mark.parametrize("ranking", WRONG_STUDIES)
def test_a_study_that_asks_wrongly_for_friction_is_refused_in_one_line(tmp_path, ranking):
    """The line names the study and its key."""
    (tmp_path / "folder.toml").mkdir()
    written(tmp_path, GOOD, "friction.toml")
    line = refusal_line(written(tmp_path, f'extends = "cryogenic-turbopump"\n[ranking]\n{ranking}\n'))
    assert line.startswith("study.toml")
    assert [word for word in WRONG_STUDIES[ranking] if word not in line] == [], line
