# ruff: noqa: E501  each wrong log and its message on a line
"""Wrong logs and column maps: each is refused in one line that says where, what, and what to do."""

import numpy as np
import pytest
import raw_logs
from commands import column_map, refusal_line, written

from separatrix.friction.logs import read_log
from separatrix.friction.logs.column_map import read_column_map

TIME = np.arange(20) * 0.5
FRICTION = 0.1 + 0.001 * np.arange(20)
FORCE = np.full(20, 10.0)


def csv(**options) -> bytes:
    """A sound log in CSV, or one with other columns."""
    return raw_logs.plain_csv(options.pop("columns", {"time [s]": TIME, "COF": FRICTION}), **options)


def lines(*rows: str) -> bytes:
    """A file of these lines."""
    return ("\n".join(rows) + "\n").encode()


def changed(content: bytes, line: int, text: str) -> bytes:
    """The content with one line (from 1) replaced."""
    rows = content.decode().split("\n")
    rows[line - 1] = text
    return "\n".join(rows).encode()


BACK = np.where(np.arange(20) == 12, 1.0, TIME)
BOTH = np.where(np.arange(20) % 2 == 0, 10.0, -10.0)

WRONG = {
    "an empty file": (b"", "log.txt is empty."),
    "a header only": (lines("time [s],COF"), "has no table of numbers with two columns or more"),
    "a binary file": (bytes(range(256)) * 20, "is not a text file (it has NUL or control characters)"),
    "an old Excel file": (b"\xd0\xcf\x11\xe0" + b"\0" * 600, "is an old Excel workbook, not text. Save it as .xlsx"),
    "a compressed file": (b"\x1f\x8b\x08" + b"a" * 99, "is compressed (gzip), not text. Unpack it first."),
    "a byte that Windows-1252 lacks": (csv() + b"caf\xe9 \x81\n", "line 22 cannot be read as cp1252 text; got byte 0x81"),
    "no header": (csv().split(b"\n", 1)[1], "has 2 open questions, the first: which column is the friction"),
    "a row with too few fields": (changed(csv(), 9, "3.5"), "line 9 has 1 fields where the rows before it have 2; got \"3.5\". Mend or delete this line."),
    "an invisible character between fields": (changed(csv(), 9, "3.5\ufeff0.1"), r'breaks the table; got "3.5\xfeff0.1". Delete it, or add below [format] of a column map: skip = ["3.5\U0000feff0.1"]'),
    "a last row cut off": (csv() + b"10.0", 'line 22 has 1 fields where the rows before it have 2; got "10.0"'),
    "text in a number column": (changed(csv(), 9, "3.5,abc"), 'line 9, column "COF" must be a number; got "abc"'),
    "a decimal comma in one row": (changed(csv(separator=";"), 9, "3,5;0,1"), 'has an open question: has points and commas in its numbers: "0.000000" and "3,5"'),
    "marks between thousands": (lines("time [s];COF", *(f"{i},000.5;0.1" for i in range(1, 9))), 'has an open question: has points and commas in its numbers: "1,000.5"'),
    "decimals or thousands": (lines("time [s];COF", *(f"{i},250;{i},125" for i in range(1, 9))), 'has an open question: does not show whether its marks are decimal signs or between thousands: "8,125"'),
    "a point among decimal commas far below": (csv(separator=";", decimal=",", columns={"time [s]": np.arange(4000), "COF": 0.1 + 0 * np.arange(4000)}) + b"4000,5;1.234\n", 'has an open question: has points and commas in its numbers: "1.234" and "0,000000"'),
    "time running backwards": (csv(columns={"time [s]": BACK, "COF": FRICTION}), "line 14 time must not run backwards; got 1 s after 5.5 s"),
    "the same header twice": (lines("time [s],COF,COF", *(f"{i},0.1,0.2" for i in range(9))), 'has 2 columns that could be the friction: columns "COF", "COF". State which below [columns] in a column map: friction = 2 or 3'),
    "no friction": (csv(columns={"time [s]": TIME, "a": FRICTION}), "has an open question: which column is the friction"),
    "a friction of unknown name": (csv(columns={"time [s]": TIME, "COF max": FRICTION, "COF min": FRICTION}), "has an open question: which column is the friction"),
    "friction in volts": (csv(columns={"time [s]": TIME, "COF [V]": FRICTION}), 'has an open question: column "COF [V]": the file writes "V"'),
    "friction that may be a force": (csv(columns={"time [s]": TIME, "friction": FRICTION}), 'has an open question: column "friction": the file states no unit'),
    "friction in percent without saying so": (csv(columns={"time [s]": TIME, "COF": FRICTION * 100}), "above 5 in more than a tenth of its rows: not a ratio of forces; got a median of 10.95. If it is in percent"),
    "a tangential force alone": (csv(columns={"time [s]": TIME, "Ff [N]": FORCE}), "has an open question: the log has no normal force"),
    "a normal force in grams": (csv(columns={"time [s]": TIME, "Ff [N]": FORCE, "Fz [g]": FORCE}), 'has an open question: column "Fz [g]": the file writes "g"'),
    "a torque": (csv(columns={"time [s]": TIME, "Torque [Nm]": FORCE, "Fz [N]": FORCE, "Radius [mm]": FORCE}), "has an open question: which column is the friction"),
    "a normal force of both signs": (csv(columns={"time [s]": TIME, "Ff [N]": FORCE, "Fz [N]": BOTH}), "has a normal force of both signs, so that the sign of compression is not certain; got 10 rows above zero, 10 below"),
    "no normal force in any row": (csv(columns={"time [s]": TIME, "Ff [N]": FORCE, "Fz [N]": 0.0 * FORCE}), 'has a normal force that is zero in every row. If the load is a dead weight, write normal_force = "... N" below [test]'),
    "temperatures below 0 K": (csv(columns={"time [s]": TIME, "COF": FRICTION, "T [K]": 0.0 * TIME - 20.0}), 'column "T [K]" has temperatures below absolute zero; got -20 K. State its true unit below [columns] in a column map: temperature = { name = "T [K]", unit = "..." }'),
    "time without unit": (csv(columns={"time": TIME, "COF": FRICTION}), 'has an open question: column "time": the file states no unit'),
    "time in what is not a format of dates": (csv(columns={"time [%s]": TIME, "COF": FRICTION}), 'has an open question: column "time [%s]": the file writes "%s"'),
    "two units of a column": (csv(columns={"time [min]": TIME, "COF": FRICTION}, units=("s", "-")), 'has an open question: column "time [min]": the file writes "s, min"'),
    "every friction missing": (csv(columns={"time [s]": TIME, "COF": FRICTION * np.nan}, missing="x"), "needs at least two rows with a friction and its abscissa; got 0 of 20 rows"),
    "statistics below the rows": (csv(separator=";") + b"Mean;0.12\n", 'must be a number; got "Mean". If that means a missing value, add below [format] in the column map: missing = ["Mean"]; if the table ends there, ends = ["Mean"].'),
    "dates for a time": (lines("time [s];COF;n", *(f"2026-02-{1 + i:02d};0.{100 + i};{i}" for i in range(9))), "has an open question: which column is the time"),
    "a time among times that is none": (lines("time;COF", "10:00:00;0.1", "10:00:01;0.1", "10:00;0.1", "late;0.1"), 'column "time": how are its times written? unit = "clock" for 10:00:01.5'),
    "times of two numbers": (lines("time;COF", *(f"10:{i:02d};0.{100 + i}" for i in range(9))), 'column "time": how are its times written?'),
    "a second table without header": (csv() + b"second run\n" + csv().split(b"\n", 1)[1], 'line 22 breaks the table; got "second run". Delete it, or add below [format] of a column map: skip = ["second run"]'),
}  # fmt: skip


@pytest.mark.parametrize("what", WRONG)
def test_a_wrong_log_is_refused_in_one_line(tmp_path, what):
    """The message is one line, names the file, and holds the words that help."""
    content, words = WRONG[what]
    message = refusal_line(written(tmp_path, content, "log.txt"), read_log)
    assert words in message
    assert message.startswith("log.txt")
    assert ".." not in message.replace("...", "")


WRONG_MAPS = {
    "an unknown meaning": ({"columns": {"friktion": "a"}}, "[columns] friktion is not the meaning of a column. Did you mean friction?"),
    "a column number of zero": ({"columns": {"time": 0}}, "must be the number of a column, counted from 1; got 0"),
    "a unit of something else": ({"columns": {"time": {"name": "a", "unit": "mm"}}}, "[columns] time.unit must be a unit such as s, ms"),
    "a format that dates do not have": ({"columns": {"time": {"name": "a", "unit": "%d.%Q"}}}, 'time.unit must be a unit such as s, ms, us, min, ...; got "%d.%Q". Write a format of dates like "%d.%m.%Y %H:%M:%S".'),
    "a format with the day twice": ({"columns": {"time": {"name": "a", "unit": "%d %d"}}}, "time.unit must be a unit such as s, ms"),
    "a sign of two": ({"columns": {"normal_force": {"name": "a", "sign": 2}}}, "sign must be 1 or -1; got 2"),
    "an unknown separator": ({"format": {"separator": ":"}}, '[format] separator must be "tab" or ";" or "," or "|" or "blanks"; got ":"'),
    "a column without a name": ({"columns": {"time": 0.5}}, "[columns] time.name must be the name or the number of a column; got 0.5. Write friction ="),
    "a column that is not there": ({"columns": {"time": "Zeit"}}, 'has an open question: no column "Zeit", which the column map names as time'),
    "one column for two meanings": ({"columns": {"time": "time [s]", "cycles": 1}}, 'column "time [s]" is both time and cycles in the column map'),
    "a torque as a force in N": ({"columns": {"tangential_force": {"name": "M [Nm]", "unit": "N"}}}, 'column "M [Nm]" is a torque, not a force. Divide it by the radius'),
    "comma for both": ({"format": {"separator": ",", "decimal": ","}}, "cannot have a comma both as separator and as decimal"),
    "a wrong encoding": ({"format": {"encoding": "utf-16"}}, "cannot be read as utf-16 text"),
    "a line that is no header": ({"format": {"header_line": 900}}, "header_line = 900 must be a line above the rows; got a file of 22 lines."),
    "a line of names of other length": ({"format": {"header_line": 3, "separator": ";"}}, "has 2 open questions, the first: which column is the friction"),
    "a table that is not there": ({"format": {"tables": ["step 9"]}}, 'has no table "step 9". It has one table, without a name.'),
    "a pattern of nothing": ({"files": {"/": {}}}, 'must be a pattern of names of files. Write "peek_*.csv".'),
    "area and diameter": (
        {"test": {"contact_area": "3 mm2", "pin_diameter": "2 mm", "normal_force": "3 N"}},
        "cannot have both a contact_area and a pin_diameter",
    ),
    "speeds that do not agree": (
        {"test": {"slip_speed": "1 m/s", "rotational_speed": "60 rpm", "track_radius": "20 mm"}},
        "has two values of slip speed that differ; got 1 m/s (column map) and 0.1257 m/s",
    ),
}  # fmt: skip


@pytest.mark.parametrize("what", WRONG_MAPS)
def test_a_wrong_column_map_is_refused_in_one_line(tmp_path, what):
    """When it is read, or when it does not fit the file."""
    document, words = WRONG_MAPS[what]
    columns = {"time [s]": TIME, "COF": FRICTION}
    if "M [Nm]" in str(document):
        columns = {"time [s]": TIME, "M [Nm]": FORCE, "Fz [N]": FORCE}
    path = written(tmp_path, csv(columns=columns), "log.txt")
    assert words in refusal_line(path, lambda path: read_log(path, column_map(document, "map.toml")))


def test_a_mark_between_thousands_is_not_taken_for_a_missing_value(tmp_path):
    """A quoted load of "20,217" mN beside friction with points."""
    path = written(tmp_path, lines("t [s],COF,Fn [mN]", *(f'{i},0.12,"20,217"' for i in range(9))), "log.txt")
    map_ = column_map({"format": {"decimal": "."}}, "map.toml")
    words = 'must be a number; got "20,217". If its mark is between thousands, export the log without such'
    assert words in refusal_line(path, lambda path: read_log(path, map_))


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"#" * 1_000_001, "is larger than a column map can be, 256 kB"),
        (b"[format]\nheader_line = 0x" + b"f" * 3900, "must be a whole number"),
        (b"[columns]\nfriction = 0x" + b"f" * 3900, "must be the number of a column"),
    ],
)
def test_a_file_that_is_no_column_map_is_refused(tmp_path, content, words):
    """Of a size that a person writes; a number of thousands of digits is not one of a line."""
    assert words in refusal_line(written(tmp_path, content, "map.toml"), read_column_map)


def test_what_is_too_large_is_refused(tmp_path):
    """Of 10 GB (a sparse file) only the length is looked at."""
    with (tmp_path / "long.csv").open("wb") as file:
        file.truncate(10_000_000_000)
    line = refusal_line(tmp_path / "long.csv", read_log)
    assert "long.csv is too large: at most 2 GB; got 10.0 GB" in line
