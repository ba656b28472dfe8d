"""A file that a user names is a regular one: a pipe or a device, which may never end, is not opened."""

import os

import pytest
from commands import refused

import separatrix
from separatrix.ground.errors import InputError
from separatrix.ground.files import size_of

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
@pytest.mark.parametrize("call", CALLS, ids=" ".join)
def test_no_verb_waits_for_a_pipe(capsys, call):
    """By its own name, by a link, with another ending, in a saved folder; a device without an end."""
    assert " is not a regular file. Save its output to a file, and name that.\n" in refused(capsys, *call)


def test_a_reader_that_is_called_by_itself_refuses_a_pipe_too(folder):
    """One that the verbs reach only after a check of their own."""
    with pytest.raises(InputError, match="is not a regular file"):
        separatrix.load(folder / "p.json")


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
