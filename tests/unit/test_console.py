"""The real command, as a process: help, version, pipes, full disks, encodings, interrupts."""

import gc
import json
import math
import os
import re
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import Future
from pathlib import Path

import pytest
from commands import COMMAND, PATIENCE, wait_until

from separatrix.front import console, main
from separatrix.ground.compiled import part
from separatrix.ground.compiling import COMPILING
from separatrix.ground.files import staged, writable_folder
from separatrix.verdict import long_jobs

VERBS = [
    *("new", "check", "bearing", "traction", "restitution", "mobility", "stability", "map", "simulate"),
    *("rank", "sensitivity", "sweep", "life", "tribometer", "compare"),
    *("reproduce", "report", "app", "materials"),
]
ROOT = Path(__file__).parents[2]


def run(*arguments: str, **options) -> subprocess.CompletedProcess:
    """Run the command and return what it said."""
    options = {"text": True, "timeout": PATIENCE} | options
    return subprocess.run([*COMMAND, *arguments], capture_output=True, check=False, **options)


def test_help_names_every_verb_in_the_order_of_the_chain():
    """It answers with status 0, nothing on standard error; `--version` is a line with name and version."""
    done = run("--help")
    assert (done.returncode, done.stderr) == (0, "")
    found = re.findall(r"^  (\w+)  +\w", done.stdout.partition("Commands:")[2], re.MULTILINE)
    assert found == ["demo", *VERBS]
    assert re.fullmatch(r"separatrix \d+\.\d+\.\d+\S*\n", run("--version").stdout)


@pytest.mark.parametrize("verb", VERBS)
def test_each_verb_has_help(verb, capsys):
    """All that take a study have the same four options."""
    assert main([verb, "--help"]) == 0
    said = capsys.readouterr().out
    common = ("--json", "--out", "--quiet", "--jobs") if "STUDY" in said else ("separatrix",)
    assert all(option in said for option in common)


def test_a_reader_that_goes_away_is_no_error():
    """`separatrix check ... | head -1`: status 0, no complaint."""
    command = [*COMMAND, "check", "cryogenic-turbopump", "--json", "--quiet"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        process.stdout.close()
        assert process.stderr.read() == b""
        assert process.wait(PATIENCE) == 0


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is always full")
def test_a_full_disk_is_said_in_one_line():
    """Standard output on a full disk: status 2, one line."""
    with open("/dev/full", "w") as full:
        said = {"stdout": full, "stderr": subprocess.PIPE, "text": True, "timeout": PATIENCE, "check": False}
        done = subprocess.run([*COMMAND, "check", "le7"], **said)
    assert done.returncode == 2
    assert done.stderr.startswith("separatrix: Standard output cannot be written")
    assert done.stderr.count("\n") == 1


@pytest.mark.parametrize(("study", "status"), [("le7", 0), ("nothing", 2)])
def test_closed_streams_do_not_crash(study, status):
    """Started with standard output and error closed, as some schedulers do."""
    code = "import os, sys; os.close(1); os.close(2); os.execv(sys.executable, sys.argv[1:])"
    command = [sys.executable, "-c", code, *COMMAND, "check", study]
    assert subprocess.run(command, capture_output=True, timeout=PATIENCE, check=False).returncode == status


@pytest.mark.parametrize(("encoding", "more"), [("ascii", ()), ("cp1252", ("--json",))])
def test_any_encoding_of_the_terminal_will_do(encoding, more, tmp_path):
    """A title outside the terminal's alphabet is spelled out, not a crash."""
    study = tmp_path / "study.toml"
    study.write_text('extends = "le7"\ntitle = "Gr\u00f6\u00dfe \u03b7 \u6c34"\n', encoding="utf-8")
    environment = os.environ | {"PYTHONIOENCODING": encoding}
    done = run("check", str(study), *more, env=environment, encoding=encoding)
    assert (done.returncode, done.stderr) == (0, "")
    assert not more or json.loads(done.stdout)["title"] == "Gr\u00f6\u00dfe \u03b7 \u6c34"


def test_a_name_that_is_no_text_is_refused_in_one_line():
    """A file name of bytes that are no UTF-8, and one with a line break and an escape."""
    for name in (b"\xff\xfe.toml", b"a\nb\x1b[31m"):
        done = run("check", os.fsdecode(name))
        assert done.returncode == 2
        assert done.stderr.count("\n") == 1
        assert "\x1b" not in done.stderr


def test_an_interrupt_is_one_line_and_status_130(tmp_path):
    """Ctrl-C in the middle of a long ensemble: soon over, one line, no traceback, nothing half-written."""
    study = tmp_path / "long.toml"
    study.write_text('extends = "cryogenic-turbopump"\n[stability]\nruns = 5000\nduration = "1 s"\n')
    out = tmp_path / "out"
    call = [*COMMAND, "stability", str(study), "--out", str(out)]
    process = subprocess.Popen(call, stderr=subprocess.PIPE, text=True)
    try:
        wait_until(out.exists)
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=PATIENCE)
    finally:
        process.kill()
    assert process.returncode == 130
    assert said.splitlines()[-1] == "separatrix: interrupted; runs that were finished are kept."
    assert all(line.startswith("separatrix: ") for line in said.splitlines())
    assert not out.exists()


def test_life_is_shown_where_there_is_no_terminal(monkeypatch, capsys):
    """A plain line now and then with how far the work is, by the clock; quiet is quiet."""
    monkeypatch.setattr(console, "LINE_EVERY", 0.02)
    before = threading.active_count()
    with console.progress_bar("rank case", quiet=False) as life:
        time.sleep(0.1)
        life(3, 12)
        time.sleep(0.1)
    lines = capsys.readouterr().err.splitlines()
    assert lines[0].startswith("separatrix: rank case: at work for 0.0")
    assert "separatrix: rank case: 25 % after 0." in lines[-1]
    assert threading.active_count() == before
    with console.progress_bar("rank case", quiet=True) as life:
        life(50, 100)
        time.sleep(0.1)
    assert capsys.readouterr() == ("", "")


def test_nothing_is_estimated_before_a_tenth_nor_of_unknown_work(monkeypatch):
    """And the time in which kernels are compiled is not work."""
    clock = [0.0]
    monkeypatch.setattr(console.time, "monotonic", lambda: clock[0])
    pace = console.Pace()
    for now, done, total in ((0.0, 0.0, 1.0), (12.0, 1.0, math.inf), (18.0, 9.0, 100.0)):
        clock[0] = now
        pace(done, total)
        assert pace.left is None
    COMPILING.on_start(None)
    clock[0] += 100.0
    COMPILING.on_end(None)
    clock[0] += 2.0
    pace(20.0, 100.0)
    assert pace.left == pytest.approx(80.0, rel=1e-12)  # a fifth took 20 s
    clock[0] += 80.0
    pace(20.0, 2000.0)
    assert pace.left == pytest.approx(9900.0, rel=1e-12)  # after a minute a hundredth is enough
    pace = console.Pace()
    for _ in range(2):
        pace(0.0, 400.0)
        clock[0] += 100.0
    assert pace.left is None


def test_compilation_is_told_once(capsys):
    """Before the first kernel; the garbage collector, which rests meanwhile, works again after it."""
    kernels = [part(lambda x: x + 1.0), part(lambda x: x + 2.0)]
    with console.progress_bar("rank case", quiet=False):
        assert [kernel(1.0) for kernel in kernels] == [2.0, 3.0]
    line = "separatrix: rank case: the solver is compiled once on this machine, about a minute in all.\n"
    assert capsys.readouterr().err == line
    assert gc.isenabled()
    assert COMPILING.heard == []


def test_staged_files_come_all_or_none(tmp_path):
    """A failure half-way leaves the old file and no new one."""
    (tmp_path / "a").write_text("old")
    with pytest.raises(RuntimeError), staged(tmp_path) as stage:
        raise RuntimeError((stage / "a").write_text("new"))  # after the first of two files
    assert [path.name for path in tmp_path.iterdir()] == ["a"]
    assert (tmp_path / "a").read_text() == "old"
    with staged(tmp_path) as stage:
        (stage / "a").write_text("new")
        (stage / "b").write_text("new")
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == {"a": "new", "b": "new"}


def test_a_folder_that_stays_empty_is_taken_away(tmp_path):
    """Folders made for an answer that never came are removed, older ones stay."""
    with pytest.raises(RuntimeError), writable_folder(tmp_path / "a" / "b"):
        raise RuntimeError
    assert list(tmp_path.iterdir()) == []
    (tmp_path / "mine").mkdir()
    with pytest.raises(RuntimeError), writable_folder(tmp_path / "mine"):
        raise RuntimeError
    assert (tmp_path / "mine").is_dir()


def test_the_commands_of_the_readme_exist():
    """Every `separatrix VERB` of README and docs is a verb."""
    texts = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]
    text = "\n".join(path.read_text() for path in texts)
    named = {*re.findall(r"^ *\$? ?separatrix (\w+)", text, re.MULTILINE)}
    assert named
    assert named <= set(VERBS)


def wait() -> None:
    """Wait in steps between which an interrupt is heard."""
    while True:
        time.sleep(0.01)


HELD = threading.Event()
"""Its wait is a kernel that hears nothing, as far as a test can wait."""


@pytest.fixture
def interrupted(monkeypatch):
    """An interrupt comes as soon as the result is waited for; a test worker may ignore signals."""

    class Interrupted(Future):
        def result(self, timeout=None):
            if not waited:
                waited.append(True)
                raise KeyboardInterrupt
            return super().result(timeout)

    waited = []
    monkeypatch.setattr(console, "Future", Interrupted)
    return waited


@pytest.mark.usefixtures("interrupted")
def test_an_interrupt_is_raised_in_the_work():
    """What it was about is not known any more."""
    with pytest.raises(KeyboardInterrupt) as caught:
        console.breakable(wait)
    assert not isinstance(caught.value, console.LeftBehind)


@pytest.mark.usefixtures("interrupted")
def test_work_that_hears_no_interrupt_is_left_behind(monkeypatch):
    """After its time, in a thread that does not keep the process."""
    monkeypatch.setattr(console, "PATIENCE", 0.1)
    before = threading.enumerate()
    with pytest.raises(console.LeftBehind):
        console.breakable(HELD.wait)
    (left,) = (one for one in threading.enumerate() if one not in before)
    HELD.set()
    left.join(60.0)
    assert left.daemon
    assert not left.is_alive()


@pytest.mark.usefixtures("interrupted")
def test_an_interrupt_of_a_long_job_sets_its_flag_and_keeps_its_answer():
    """It does not break in anywhere."""

    def compute(place):
        while place and not runner.stop.is_set:
            time.sleep(0.001)
        if place:
            raise long_jobs.Interrupted
        return "done"

    runner = long_jobs.Runner()
    with pytest.raises(long_jobs.Interrupted) as caught:
        console.breakable(lambda: runner.work_out(compute, [0, 1], into=dict))
    assert caught.value.finished in ({0: "done"}, None)
    assert long_jobs.AT_WORK == []
