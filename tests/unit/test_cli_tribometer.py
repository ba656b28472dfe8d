"""The verb `tribometer` as a user runs it: logs, a column map, a friction file, and a ranking from it."""

import json
import os
import shlex
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from commands import column_map, read_friction

from separatrix.front import main
from separatrix.study.reading import read_study
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


def log(path, friction=0.1, seed=1, rows=1500):
    """A CSV log: running-in from 0.2, then noise about a friction."""
    rng = np.random.default_rng(seed)
    time = 0.5 * np.arange(rows)
    values = friction + (0.2 - friction) * np.exp(-time / 40.0) + 0.004 * rng.standard_normal(rows)
    lines = (f"{t:.2f},{f:.5f},20.0" for t, f in zip(time, values, strict=True))
    path.write_text("time (s),friction coefficient,normal force (N)\n" + "\n".join(lines) + "\n")


@pytest.fixture
def logs(tmp_path, monkeypatch):
    """Two logs and a column map, in the current folder."""
    monkeypatch.chdir(tmp_path)
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
    assert "friction.toml" in text
    assert "Armalon" in text
    plots = [f"friction-plots/{n}.csv.{s}" for n in "ab" for s in ("png", "svg")]
    assert names(logs) == sorted(["a.csv", "b.csv", "map.toml", "friction.toml", *plots])
    first, second = read_friction(logs / "friction.toml")
    assert (first.source, first.slip_speed, second.slip_speed) == ("a.csv", (2.0, 2.0), (4.0, 4.0))
    # 20 N on a pin of 5 mm
    assert first.pressure[0] == pytest.approx(20.0 / (np.pi * 2.5e-3**2))
    # the noise of 0.004 over a thousand rows leaves 0.0002; what is left of running-in is less than that
    assert [first.friction, second.friction] == pytest.approx([0.08, 0.09], abs=1e-3)
    assert first.standard_error < 1e-3
    assert first.reduced_by.startswith("separatrix ")
    rank_beside(logs)


def rank_beside(logs):
    """Check that a study beside the friction file takes its candidates from it."""
    (logs / "s.toml").write_text('extends = "cryogenic-turbopump"\n[ranking]\nfriction = "friction.toml"\n')
    (candidate,) = read_study(logs / "s.toml").ranking.candidates
    found = candidate.friction["liquid nitrogen, 440C"]
    assert found.mean == pytest.approx(np.sqrt(0.08 * 0.09), abs=1e-3)  # as above
    seen = found.law.at(slip_speed=25.0, pressure=None, temperature=77.0, medium="liquid nitrogen")
    said = "slip speed in the pocket 25 m/s, tests cover 2 to 4 m/s: value at 4 m/s used"
    assert seen.extrapolation == (said,)


def test_json_is_one_document_and_writes_nothing(logs, capsys):
    """Keys of the contract: tests and files; no file beside the logs."""
    before = names(logs)
    assert main([*BOTH, "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert [file["source"] for file in document["files"]] == ["a.csv", "b.csv"]
    assert document["tests"][0]["friction_low"] < 0.08 < document["tests"][0]["friction_high"]
    assert document["fits"][0]["scatter_source"] == "its own tests, drawn towards the assumed 9 %"
    assert document["friction_file"] is None
    assert names(logs) == before


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
    "no jobs": ("a.csv --jobs 0", "--jobs must lie between 1"),
    "no files": ("", "Missing argument 'FILES...'"),
    "no such option": ("a.csv --material X", "No such option '--material'"),
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
    assert main(["tribometer", *shlex.split(arguments)]) == 2
    out, line = capsys.readouterr()
    assert out == ""
    assert line.startswith("separatrix: ")
    assert line.count("\n") == 1
    assert words in line
    assert {path: (logs / path).read_bytes() for path in names(logs)} == before


def test_an_interrupt_leaves_no_friction_file(logs):
    """Ctrl-C while many logs are read: one line, status 130, nothing half written."""
    for i in range(60):
        log(logs / f"c{i}.csv", 0.1, i, rows=3000)
    files = ["b.csv", *(f"c{i}.csv" for i in range(60))]
    call = [sys.executable, "-m", "separatrix", "tribometer", *files, "--map", "map.toml", "--out", "f.toml"]
    process = subprocess.Popen(call, cwd=logs, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 60.0
    while not (logs / "f-plots").exists() and time.monotonic() < deadline:
        time.sleep(0.01)  # the folders are made before the first log is read
    os.kill(process.pid, signal.SIGINT)
    out, error = process.communicate(timeout=60)
    assert process.returncode == 130
    assert out == ""
    assert error == "separatrix: interrupted; no answer was given.\n"
    assert not (logs / "f.toml").exists()
    assert not (logs / "f-plots").exists()


def test_names_of_pages_are_names_of_files():
    """Whatever stands in the name of a log, its page stays in its folder."""
    assert file_name("../a b.xlsx, sheet 1") == "a-b.xlsx-sheet-1"
    assert file_name("...") == "test"


def test_a_column_map_says_where_running_in_ends_in_each_file(logs, capsys):
    """One file's end is given, the other's is found; `--run-in` goes before the map."""
    (logs / "map.toml").write_text(f'{MAP}run_in_end = "5 min"\n')
    command = [*BOTH, "--json"]
    assert main(command) == 0
    first, second = json.loads(capsys.readouterr().out)["tests"]
    assert (first["run_in_method"] == "given", second["run_in_method"]) == (False, "given")
    assert second["run_in_end"] == 300.0
    assert main([*command, "--run-in", "6 min"]) == 0
    found = json.loads(capsys.readouterr().out)["tests"]
    assert [test["run_in_end"] for test in found] == [360.0, 360.0]


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
    line = f"separatrix: {rule} Mend it, or leave it out of this column map.\n"
    assert capsys.readouterr().err == line
    assert names(logs) == ["a.csv", "b.csv", "map.toml"]


def test_a_pattern_that_fits_one_of_the_files_is_not_complained_of(logs, capsys):
    """By its name or by its folder too; one that fits none of many names three of them."""
    assert main([*BOTH, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["notes"] == []
    chosen = column_map({"files": {"one/*.csv": {"sample": "A"}, "x*": {"sample": "B"}}}, "map.toml")
    (wrong,) = chosen.unused([logs / "one" / f"{n}.csv" for n in range(5)])
    assert 'map.toml: [files."x*"] must fit a file that is named; got 0.csv, 1.csv, 2.csv and 2' in str(wrong)
