"""Logs of layouts that no map knows: read at once where all is clear, else through their draft."""

from __future__ import annotations

import json
import re

import numpy as np
import openpyxl
import pytest
from commands import column_map

from separatrix.friction.logs import UnmappedError, read_column_map, read_log
from separatrix.front import main
from separatrix.ground.errors import InputError

ROWS = 120
TIME = np.arange(ROWS) * 0.5
FRICTION = np.round(0.14 + 0.01 * np.sin(TIME), 5)


def table(head, row):
    """Names, and a row for each time t, friction f, force and time of day h."""
    rows = []
    for i, (t, f) in enumerate(zip(TIME, FRICTION, strict=True)):
        rows.append(row.format(t=t, f=f, h=f"10:{i // 60:02d}:{i % 60:02d}", force=12.5 * f))
    return "\n".join([*head, *rows, ""])


SECOND = {
    "names without units": table(["Time\tCOF\tLoad"], "{t}\t{f}\t12.5"),
    "two coefficients": table(["t [s];COF;mu"], "{t};{f};0.3"),
}
EDITED = {
    "no load in the file": (table(["t [s];Ff [N]"], "{t};{force}"), {'"... N"': '"12.5 N"'}),
    "a time in ticks": (table(["time [ticks];COF"], "{t};{f}"), {'unit = "..."': 'unit = "s"'}),
    "no names": (
        table([], "{t};{f}"),
        {
            'friction = { name = 1, unit = "..." }': 'friction = { name = 2, unit = "-" }',
            'time = { name = 1, unit = "..." }': 'time = { name = 1, unit = "s" }',
        },
    ),
    "dates that may be American": (
        table(["Date and Time;COF"], "03/04/2026 {h};{f}"),
        {'unit = "..."': 'unit = "%d/%m/%Y %H:%M:%S"'},
    ),
}


def written(tmp_path, text):
    """A log in a file."""
    path = tmp_path / "log.txt"
    path.write_text(text, encoding="utf-8")
    return path


def draft_of(path, given=None, words="open question"):
    """The column map of the draft of a log that is not read at once, in a file."""
    with pytest.raises(UnmappedError, match=words) as refusal:
        read_log(path, given)
    draft = path.with_name("map.toml")
    draft.write_text(refusal.value.draft, encoding="utf-8")
    return draft


@pytest.mark.parametrize("what", SECOND)
def test_the_draft_as_written_reads_the_log(tmp_path, what):
    """Every guess is marked; the second call works."""
    path = written(tmp_path, SECOND[what])
    draft = draft_of(path)
    assert draft.read_text("utf-8").count("# guess, check: ") >= 1
    (log,) = read_log(path, read_column_map(draft))
    np.testing.assert_array_equal(log.friction, FRICTION)
    assert np.diff(log.time).max() == pytest.approx(np.diff(log.time).min())


@pytest.mark.parametrize("what", EDITED)
def test_what_no_file_states_is_left_open_in_the_draft(tmp_path, what):
    """The draft as written is refused; with the one thing that it asks for, the log is read."""
    text, edits = EDITED[what]
    path = written(tmp_path, text)
    draft = draft_of(path)
    with pytest.raises(InputError, match=re.escape("...")):
        read_log(path, read_column_map(draft))
    edited = draft.read_text("utf-8")
    for asked, answer in edits.items():
        assert asked in edited
        edited = edited.replace(asked, answer)
    draft.write_text(edited, "utf-8")
    (log,) = read_log(path, read_column_map(draft))
    np.testing.assert_allclose(log.friction, FRICTION, rtol=1e-12)  # one or two roundings of the forces


@pytest.mark.parametrize("key", ["skip", "ends"])
def test_a_broken_table_is_read_with_what_its_refusal_offers(tmp_path, key):
    """A remark among the rows is skipped; another table behind the first is the end of it."""
    text = table(["t [s];COF"], "{t};{f}")
    other = "\nSummary\nLoad [N];Mean\n5;0.12\n6;0.13\n"
    text = text.replace("\n30.0;", "\npump off\n30.0;") if key == "skip" else text + other
    path = written(tmp_path, text)
    with pytest.raises(InputError, match="breaks the table") as refusal:
        read_log(path)
    offered = re.search(r"skip = (\[.*\])", str(refusal.value))[1]
    (log,) = read_log(path, column_map({"format": {key: json.loads(offered)}}))
    np.testing.assert_array_equal(log.friction, FRICTION)


def test_the_command_writes_the_draft_and_keeps_what_is_stated(tmp_path, monkeypatch, capsys):
    """Conditions of the map given are in the draft; one that was edited is not written over."""
    path = written(tmp_path, SECOND["names without units"])
    monkeypatch.chdir(tmp_path)
    (tmp_path / "map.toml").write_text('[test]\nmaterial = "Armalon"\n\n[files."*.txt"]\nsample = "B3"\n')
    assert main(["tribometer", "log.txt", "--map", "map.toml"]) == 2
    line = capsys.readouterr().err
    assert "has an open question" in line
    assert line.endswith("and add: --map log.txt.map.toml.\n")
    draft = tmp_path / "log.txt.map.toml"
    (log,) = read_log(path, read_column_map(draft))
    assert (log.conditions.material, log.conditions.sample) == ("Armalon", "B3")
    draft.write_text("# edited\n")
    assert main(["tribometer", "log.txt"]) == 2
    assert "There is a file log.txt.map.toml" in capsys.readouterr().err
    assert draft.read_text() == "# edited\n"


@pytest.mark.parametrize("cell", ["XFD1048576", "XFD20000"])
def test_a_stray_cell_at_the_end_of_a_sheet_costs_nothing(tmp_path, cell):
    """The sheet is read by its used cells; the cell is no row of the table."""
    book = openpyxl.Workbook()
    book.active.append(["Time [s]", "COF"])
    for t, f in zip(TIME.tolist(), FRICTION.tolist(), strict=True):
        book.active.append([t, f])
    book.active[cell] = "x"
    book.save(tmp_path / "log.xlsx")
    (log,) = read_log(tmp_path / "log.xlsx")
    np.testing.assert_array_equal(log.friction, FRICTION)
