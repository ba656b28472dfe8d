"""Logs of layouts that no map knows: read at once where all is clear, else through their draft."""

from __future__ import annotations

import re

import numpy as np
import openpyxl
import pytest

from separatrix.friction.logs import read_column_map, read_log
from separatrix.ground.errors import InputError

ROWS = 120
TIME = np.arange(ROWS) * 0.5
FRICTION = np.round(0.14 + 0.01 * np.sin(TIME), 5)
PREAMBLE = [f"Kennwert {i};{i * 3}" for i in range(38)] + ["Normalkraft;12,5 N", ""]


def table(head, row, *, above=(), comma=False):
    """Lines above, names, and a row for each time t, friction f, time of day h and number i."""
    rows = []
    for i, (t, f) in enumerate(zip(TIME, FRICTION, strict=True)):
        clock = f"{10 + i // 3600:02d}:{i // 60 % 60:02d}:{i % 60:02d}"
        one = row.format(t=t, f=f, i=i, h=clock, force=12.5 * f, milli=12500 * f, angle=i % 12 * 30)
        rows.append(one.replace(".", ",") if comma else one)
    return "\n".join([*above, *head, *rows, ""])


FIRST = {
    "a German pin on disk below forty lines": table(
        ["Zeit [s];Reibwert;Temperatur [°C]"], "{t};{f};23.5", above=PREAMBLE, comma=True
    ),
    "columns between blanks": table(["  Time (s)   Friction Coeff   Load (N)"], "  {t}   {f}   12.5"),
    "stamps of one zone": table(["stamp,mu,note"], "2026-03-01T{h}+01:00,{f},ok"),
    "forces between bars": table(["Gleitweg [m]|Reibkraft [mN]|Normalkraft [N]"], "{t}|{milli}|12.5"),
}
SECOND = {
    "names without units": table(["Time\tCOF\tLoad"], "{t}\t{f}\t12.5"),
    "dates that may be American": table(["Date and Time;COF"], "03/04/2026 {h};{f}"),
    "a time zone that changes": table(["datetime,COF"], "2026-03-29T{h}+01:00,{f}").replace(
        "T10:01:30+01:00", "T11:01:30+02:00"
    ),
    "two coefficients": table(["t [s];COF;mu"], "{t};{f};0.3"),
    "a remark among the rows": table(["t [s];COF"], "{t};{f}").replace("\n30.0;", "\npump off\n30.0;"),
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
    "a torque": (
        table(["t [s];Drehmoment [Nm];Fn [N]"], "{t};{f};50"),
        {'track_radius = "... mm"': 'track_radius = "20 mm"'},
    ),
}


def written(tmp_path, text):
    """A log in a file, and the place of its draft."""
    path = tmp_path / "log.txt"
    path.write_text(text, encoding="utf-8")
    return path, tmp_path / "log.txt.map.toml"


@pytest.mark.parametrize("what", FIRST)
def test_a_plain_file_with_clear_heads_takes_one_call(tmp_path, what):
    """Nothing is asked, and no draft is written."""
    path, draft = written(tmp_path, FIRST[what])
    (log,) = read_log(path)
    np.testing.assert_allclose(log.friction, FRICTION, rtol=1e-12)  # one or two roundings of the forces
    assert not draft.exists()


@pytest.mark.parametrize("what", SECOND)
def test_the_draft_as_written_reads_the_log(tmp_path, what):
    """One line says so; every guess is marked; the second call works."""
    path, draft = written(tmp_path, SECOND[what])
    with pytest.raises(InputError, match=r"^log\.txt has .*open question.*--map log\.txt\.map\.toml\.$"):
        read_log(path)
    assert draft.read_text("utf-8").count("# guess, check: ") >= 1
    (log,) = read_log(path, read_column_map(draft))
    np.testing.assert_array_equal(log.friction, FRICTION)
    assert np.diff(log.time).max() == pytest.approx(np.diff(log.time).min())


@pytest.mark.parametrize("what", EDITED)
def test_what_no_file_states_is_left_open_in_the_draft(tmp_path, what):
    """The draft as written is refused; with the one thing that it asks for, the log is read."""
    text, edits = EDITED[what]
    path, draft = written(tmp_path, text)
    with pytest.raises(InputError, match="open question"):
        read_log(path)
    with pytest.raises(InputError, match=re.escape("...")):
        read_log(path, read_column_map(draft))
    edited = draft.read_text("utf-8")
    for asked, answer in edits.items():
        assert asked in edited
        edited = edited.replace(asked, answer)
    draft.write_text(edited, "utf-8")
    (log,) = read_log(path, read_column_map(draft))
    np.testing.assert_allclose(log.friction, FRICTION, rtol=1e-12)  # one or two roundings of the forces


@pytest.mark.parametrize(("load", "comma"), [("1.000 N", True), ("1,000 N", False)])
def test_a_load_that_may_be_one_or_a_thousand_is_asked_and_not_used(tmp_path, load, comma):
    """Its mark may be a decimal sign or between thousands: both values are in the draft, as a remark."""
    path, draft = written(tmp_path, table(["t [s];COF"], "{t};{f}", above=[f"Load: {load}"], comma=comma))
    with pytest.raises(InputError, match=r"1000 N or 1\.000 N"):
        read_log(path)
    (log,) = read_log(path, read_column_map(draft))
    assert log.conditions.normal_force is None


def test_a_draft_keeps_what_is_stated_and_a_file_that_is_there(tmp_path):
    """Conditions of the map given are in the draft; a draft that was edited is not written over."""
    path, draft = written(tmp_path, SECOND["names without units"])
    given = tmp_path / "map.toml"
    given.write_text('[test]\nmaterial = "Armalon"\n\n[files."*.txt"]\nsample = "B3"\n')
    with pytest.raises(InputError, match="open question"):
        read_log(path, read_column_map(given))
    (log,) = read_log(path, read_column_map(draft))
    assert (log.conditions.material, log.conditions.sample) == ("Armalon", "B3")
    draft.write_text("# edited\n")
    with pytest.raises(InputError, match=r"There is a file log\.txt\.map\.toml"):
        read_log(path)
    assert draft.read_text() == "# edited\n"


@pytest.mark.parametrize("cell", ["XFD1048576", "XFD20000", "Z1048576", "A1048576"])
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
