"""A file that a user names is a regular one: a pipe or a device, which may never end, is not opened."""

import os

import pytest

import separatrix
from separatrix.friction.logs.binary import tdms_groups
from separatrix.front import main
from separatrix.ground.errors import InputError
from separatrix.ground.files import size_of
from separatrix.ground.sheet import refuse_unsafe

LOG = "time (s),friction coefficient\n" + "".join(f"{t},0.{10 + t % 2}\n" for t in range(100))
CALLS = {
    "a log": ["tribometer", "PATH"],
    "a column map": ["tribometer", "a.csv", "--map", "PATH"],
    "a saved simulation": ["compare", "PATH", "PATH", "--json"],
    "a study": ["check", "PATH"],
    "a library by option": ["materials", "list", "--library", "PATH"],
}


def refusal(capsys, call, path):
    """The one line with which a call with this path is refused; nothing is written."""
    before = sorted(os.listdir())
    assert main([path if word == "PATH" else word for word in call]) == 2
    line = capsys.readouterr().err
    assert line.count("\n") == 1
    assert sorted(os.listdir()) == before
    return line


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder to stand in, with a log, and pipes without a writer."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.csv").write_text(LOG)
    for name in ("p.toml", "p.xlsx", "p.json"):
        os.mkfifo(name)
    (tmp_path / "link.toml").symlink_to("p.toml")
    (tmp_path / "saved").mkdir()
    os.mkfifo("saved/simulate.json")
    return tmp_path


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize("path", ["p.toml", "link.toml"])
@pytest.mark.parametrize("call", CALLS.values(), ids=CALLS.keys())
def test_no_verb_waits_for_a_pipe(capsys, call, path):
    """By its own name or by a link, in every place where a file is named."""
    line = refusal(capsys, call, path)
    assert " is not a regular file. Save its output to a file, and name that.\n" in line
    assert "p.toml" in line or "link.toml" in line


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize(
    "call",
    [
        ["tribometer", "p.xlsx"],
        ["tribometer", "a.csv", "p.xlsx"],
        ["check", "p.xlsx"],
        ["compare", "p.json", "p.json"],
        ["compare", "saved", "saved"],
        ["tribometer", "/dev/zero"],
        ["tribometer", "a.csv", "--map", "/dev/zero"],
        ["compare", "/dev/zero", "/dev/zero"],
    ],
    ids=" ".join,
)
def test_neither_an_ending_nor_a_folder_nor_a_device_makes_a_difference(capsys, call):
    """A pipe that is named like a workbook or stands in a saved folder; a device without an end."""
    assert "is not a regular file. Save" in refusal(capsys, call, "")


@pytest.mark.parametrize(
    "read",
    [separatrix.load, refuse_unsafe, tdms_groups],
    ids=["load", "refuse_unsafe", "read_tables"],
)
def test_a_reader_that_is_called_by_itself_refuses_a_pipe_too(folder, read):
    """Those that the verbs reach only after a check of their own."""
    with pytest.raises(InputError, match="is not a regular file"):
        read(folder / "p.json")


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
