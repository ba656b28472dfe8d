"""Logs as instruments write them, read at once where all is clear; others through their draft."""

import json
import re
from datetime import datetime, timedelta

import numpy as np
import openpyxl
import pytest
from commands import column_map, document, refused, written

from separatrix import InputError, reduce_log
from separatrix.friction.logs import UnmappedError, read_column_map, read_log
from separatrix.friction.logs.log import seconds
from separatrix.friction.logs.tables import is_clock, is_number
from separatrix.front import main

ROWS = 240
RNG = np.random.default_rng(6)
NOISE = 0.004 * RNG.standard_normal(ROWS)
STEADY = 0.12


def read(tmp_path, text, columns=None, name="log.txt"):
    """The logs of a file with that text."""
    path = written(tmp_path, text.encode("cp1252"), name)
    return read_log(path, None if columns is None else column_map(columns))


def te67(rows=ROWS):
    """Phoenix TE67: clock times, decimal commas, no units, a standstill and a ramp of the speed, a footer."""
    begin = datetime(2026, 4, 9, 23, 58)  # the test passes midnight
    names = "Time;This Step;Step Time;Test Time;Sliding Velocity;Load;Radius;Friction Force;"
    lines = ["Data file\t\tX.TSV", "", f"Test started at {begin:%H:%M:%S} on 2026-04-09"]
    lines.append("\t" + (names + "Friction Coefficient;Friction Force").replace(";", "\t") + "\t")
    for i in range(rows):
        speed = 0.15 * min(1.0, max(0.0, (i - 9) / 20.0))
        friction = STEADY + NOISE[i % ROWS] if speed else 0.01
        row = f";{begin + timedelta(seconds=i):%H:%M:%S};2;1800,;{i},;{speed:.3f};60,000;14;"
        row += f"{60 * friction:.2f};{friction:.5f};{60 * friction:.2f};"
        lines.append(row.replace(".", ",").replace(";", "\t"))
    return "\r\n".join([*lines, "Test completed at 00:30:00 on 2026-04-10", ""])


def test_te67_is_read_at_once_without_its_standstill_and_ramp(tmp_path):
    """Clock times are seconds, past midnight too; rows before the speed is reached do not count."""
    (log,) = read(tmp_path, te67(), name="log.tsv")
    assert log.time[-1] == ROWS - 1.0
    assert log.rows == ROWS - 27  # ten at rest, and seventeen until 90 % of the speed are reached
    assert any("27 of 240 rows are left out: standstill, reversals or ramps" in note for note in log.notes)
    assert reduce_log(log).friction == pytest.approx(STEADY, abs=4 * 0.004 / ROWS**0.5)  # 4 standard errors


def test_pcs_mtm_is_read_at_once(tmp_path):
    """Traction coefficient and step time stand twice, empty columns between them: the twin is checked."""
    head = "MTM311 Test Data File\n\nTest started at 19/08/2016 09:39:32\n\n"
    head += "Step 1 started at 19/08/2016 09:48:51\nStep type\tBOD_TIMED\tStep duration\t02:46:40\n"
    head += "Step Time (s)\tTraction Coeff (-)\t\tStep Time (s)\tSliding Speed (mm/s)\tTraction Coeff (-)\t\n"
    values = [f"{STEADY + one:.4f}" for one in NOISE]
    rows = [f"{10 * i}\t{one}\t\t{10 * i}\t100.0\t{one}\t" for i, one in enumerate(values)]
    tail = "\n\nAll steps completed, test completed normally at 19/08/2016 12:35:32"
    (log,) = read(tmp_path, head + "\n".join(rows) + tail)
    assert log.source == "log.txt, step 1"
    assert log.format.startswith("PCS Instruments text")
    assert log.conditions.slip_speed == pytest.approx(0.1, rel=1e-12)
    assert reduce_log(log).friction == pytest.approx(STEADY, abs=4 * 0.004 / ROWS**0.5)
    with pytest.raises(InputError, match=r"2 columns that could be the friction.* 2 or 6"):
        read(tmp_path, head + "\n".join([*rows[:-1], rows[-1].rpartition("0.1")[0] + "0.9\t"]) + tail)


def lvm(count=6):
    """LabVIEW measurement file: two segments of the same numbers, a name of comments without a column."""
    head = "LabVIEW Measurement\t\nSeparator\tTab\nDate\t2017/09/20\nTime\t11:29:14.71\n"
    head += "***End_of_Header***\t\n\t\n"
    block = "Channels\t2\t\t\t\nSamples\t2000\t2000\t\t\nX0\t0.0E+0\t0.0E+0\t\t\nDelta_X\t0.1\t0.1\t\t\n"
    block += "***End_of_Header***\t\t\t\t\nX_Value\tfx_N\tfz_N\tComment\n"
    block += "".join(f"{0.1 * i:.6f}\t{-0.2 - 0.01 * (i % 2):.6f}\t10.000000\n" for i in range(count))
    return head + block + "\n" + block


def test_labview_text_is_read_at_once_and_a_copy_of_a_table_counts_once(tmp_path):
    """The first good row is a row; friction is |fx|/fz; six rows give a mean with a wide interval."""
    (log,) = read(tmp_path, lvm())
    assert (log.format[:12], log.rows) == ("LabVIEW text", 6)
    assert any("has the same numbers and is left out" in note for note in log.notes)
    test = reduce_log(log)
    assert test.friction == pytest.approx(0.0205, rel=1e-9)
    assert any("has 6 rows: too few to see running-in" in flag for flag in test.flags)


@pytest.mark.parametrize(
    ("first", "second", "gap", "form"),
    [
        ("2026-02-01T10:00:00Z", "2026-02-01T10:00:00.25Z", 0.25, "iso"),
        ("31/01/2026 23:59:59", "01/02/2026 00:00:01", 2.0, "%d/%m/%Y %H:%M:%S"),
        ("1/31/2026 11:59:59 PM", "2/1/2026 12:00:01 AM", 2.0, "%m/%d/%Y %I:%M:%S %p"),
        ("19-Aug-2016 09:00:00", "19-Aug-2016 09:00:01", 1.0, "%d-%b-%Y %H:%M:%S"),
        ("23:59:58", "00:00:01", 3.0, "clock"),
        ("00:00:10.5", "00:01:00", 49.5, "clock"),
    ],
)
def test_times_as_text_become_seconds(first, second, gap, form):
    """Times of day, durations, dates in the usual orders, past midnight and the end of a month."""
    assert is_clock(first)
    assert seconds([first, second], form, frozenset())[0].tolist() == [0.0, gap]


@pytest.mark.parametrize(
    ("names", "rows"),
    [
        ("datetime,friction_coefficient", "2026-03-31T23:59:{0:02d}.500,0.1{0:02d}"),
        ("Date;Time;COF", "31.03.2026;10:00:{0:02d};0,1{0:02d}"),
        ("Elapsed [mm:ss];mu", "01:{0:02d};0,1{0:02d}"),
        ("Timestamp,DAQ.COF,Rotary.Position", "{0}.0,0.1{0:02d},0.{0:02d}"),
        ("# time(s) friction(mu) load(N)", "{0} 0.1{0:02d} 5.0"),
        ("Time [s];\u00c2\u00b5", "{0};0,1{0:02d}"),
        ("Zeit [s];Reibwert \u00b5;Last [N]", "{0};0,1{0:02d};5,0;"),
        ("Time;COF;Load\ns;-;N", "{0};0.1{0:02d};5.0;;"),
    ],
)
def test_columns_of_other_programs_are_understood(tmp_path, names, rows):
    """Times as text, units wherever they stand, a Greek letter in a wrong code, rows that end in separators.

    A symbol behind the name is not shown as the unit.
    """
    (log,) = read(tmp_path, "\n".join([names, *(rows.format(i) for i in range(60))]) + "\n")
    assert log.time.tolist() == [float(i) for i in range(60)]
    assert log.friction.tolist() == [float(f"0.1{i:02d}") for i in range(60)]
    assert next(one.unit for one in log.columns if one.meaning == "friction") in ("", "-")


FORCE_ONLY = "Laps\tFrictionForce\n" + "".join(f"{i}\t{1.2 + 0.01 * (i % 3)}\n" for i in range(60))


def test_a_force_without_unit_is_not_taken_for_the_friction(tmp_path):
    """Naming it all the same is refused; whoever insists that newtons are a coefficient reads a flag."""
    with pytest.raises(InputError, match=r'"FrictionForce" is a force by its name'):
        read(tmp_path, FORCE_ONLY, {"columns": {"friction": "FrictionForce"}})
    (log,) = read(tmp_path, FORCE_ONLY, {"columns": {"friction": {"name": "FrictionForce", "unit": "-"}}})
    assert any("is above 1, which dry sliding seldom reaches" in flag for flag in reduce_log(log).flags)


def stroke(number, sign=1.0, level=0.75, moving=60, set_force=-200):
    """One step of a UMT file: at rest, turning, sliding, at rest again with the force held."""
    rng = np.random.default_rng(number)
    slides = level + 0.02 * rng.standard_normal(moving)
    size = np.concatenate([np.full(8, 0.04), [0.2, 0.5], slides, 0.6 - 0.0005 * np.arange(20)])
    row = "{:.4f},{:.4f},{:.4f},{:.4f},{:.5f}"
    rows = [row.format(sign * 200 * f, set_force, 0.02 * i, 200 * f, f) for i, f in enumerate(size)]
    keys = f"Step No. {number}\n\nRadius = 3.9\nVelocity = {240 * sign:g}\nSet Force = {set_force}\n\n"
    return f"{keys}Fx,Fz,T,Ff,COF\ng,g,sec,g,\n\n" + "\n".join(rows) + "\n\n"


def umt(number, **settings):
    """A UMT file of one stroke there and back, numbered as one of a test."""
    head = f"Created by CETR UMT\nC:\\data\\disk 7_{number:03d}.tst\n\nRun # 1\nScript file C:\\wear.cts\n"
    return head + stroke(2 * number, 1.0, **settings) + stroke(2 * number + 1, -1.0, level=0.85, **settings)


def test_standstill_and_reversal_of_a_stroke_are_not_sliding(tmp_path):
    """Neither the rest with its held force nor the turn moves the mean: 0.75 and not 0.6."""
    logs = read(tmp_path, umt(1))
    assert [reduce_log(log).friction for log in logs] == pytest.approx([0.75, 0.85], abs=0.015)  # 4 errors
    assert all(55 <= log.rows <= 64 for log in logs)  # of 90; 60 slide


def reciprocating(rows_of_a_cycle, *, is_sine):
    """A log of 150 cycles of 2 s: friction 0.15 with the sign of the stroke, and the position."""
    time = (np.arange(150 * rows_of_a_cycle) + 0.13) * 2.0 / rows_of_a_cycle
    speed = np.sin(np.pi * time)
    if is_sine:
        position, friction = 5.0 - 5.0 * np.cos(np.pi * time), 0.15 * np.tanh(10.0 * speed)
    else:
        position, friction = 10.0 * np.abs(time % 2.0 - 1.0), -0.15 * np.sign(speed)
    rows = zip(time, 20.0 * friction, position, strict=True)
    table = "\n".join(f"{t:.4f},{f:.4f},20,{x:.4f}" for t, f, x in rows)
    return f"Time [s],Friction Force [N],Load [N],Position [mm]\n{table}\n"


@pytest.mark.parametrize("is_sine", [True, False])
@pytest.mark.parametrize("rows_of_a_cycle", [8, 10, 16, 20, 33, 50, 100])
def test_reversals_are_left_out_by_the_position_of_few_rows_too(tmp_path, rows_of_a_cycle, is_sine):
    """At half of the usual speed tanh(10 sin) is 0.998, so the mean is that of sliding to 0.2 %."""
    (log,) = read(tmp_path, reciprocating(rows_of_a_cycle, is_sine=is_sine))
    assert log.friction.mean() == pytest.approx(0.15, rel=0.002)
    assert any('by the position in column "Position [mm]"' in note for note in log.notes)


def test_a_position_that_jumps_within_no_time_still_shows_reversals_and_too_few_rows_are_reported(tmp_path):
    """Two rows 1e-320 s apart have no speed between them; the mean is that of sliding, as without them."""
    lines = reciprocating(20, is_sine=True).splitlines()
    lines[1:1] = ["0,3.0,20,0.0", "1e-320,3.0,20,0.5"]
    (log,) = read(tmp_path, "\n".join(lines))
    assert log.friction.mean() == pytest.approx(0.15, rel=0.002)
    assert log.rows < 0.8 * 150 * 20
    # three rows a stroke
    (log,) = read(tmp_path, reciprocating(6, is_sine=True))
    assert any('"Position [mm]" reverses once in 3 rows, fewer than 4' in note for note in log.notes)


@pytest.fixture
def strokes(elsewhere, tmp_path):
    """A folder of six files of strokes."""
    (tmp_path / "wear").mkdir()
    for number in range(1, 7):
        (tmp_path / "wear" / f"disk-{number}.csv").write_text(umt(number))
    (tmp_path / "wear" / "notes.md").write_text("no log")
    return tmp_path


@pytest.mark.parametrize(("logs", "more", "cycles"), [("wear", 11, 6), ("wear/disk-1.csv", 1, 0)])
def test_strokes_of_one_test_are_joined_by_their_header(strokes, capsys, logs, more, cycles):
    """Twelve strokes in six files of a folder, or two of one file, are one test: the mean of both ways."""
    (test,) = document(capsys, "tribometer", logs)["tests"]
    assert test["source"] == f"disk-1.csv, run 1, step 2 and {more} more"
    assert test["friction"] == pytest.approx(0.8, abs=0.02)
    assert test["cycles"] == cycles


def test_parts_under_other_loads_are_not_one_test(strokes, capsys):
    """A step at twice the load: the header keeps them apart, and --join refuses."""
    (strokes / "wear" / "disk-9.csv").write_text(umt(9, set_force=-400))
    assert len(document(capsys, "tribometer", "wear")["tests"]) == 2
    line = refused(capsys, "tribometer", "wear", "--join")
    assert "cannot be one test: their normal force differs" in line


def test_a_test_far_from_its_siblings_is_flagged(elsewhere, tmp_path, capsys):
    """0.4 among five of 0.12: three times the median of the others; the others draw no flag."""
    for number, level in enumerate([0.12, 0.125, 0.118, 0.4, 0.121]):
        rows = "".join(f"{i},{level + NOISE[i]:.5f}\n" for i in range(ROWS))
        (tmp_path / f"{number}.csv").write_text(f"time [s],COF\n{rows}")
    tests = document(capsys, "tribometer", *(f"{i}.csv" for i in range(5)))["tests"]
    words = "times the median of the other 4 tests"
    assert [sum(words in flag for flag in test["flags"]) for test in tests] == [0, 0, 0, 1, 0]


def test_numbers_beyond_all_range_are_reduced_or_left_out(tmp_path):
    """Two values of 1e-200, of which the square is zero; 1e10 N over 1e-300 N, a row without a friction."""
    rows = [f"{i},0.{100 + i % 7}" for i in range(60)]
    rows[30:32] = ["30,1e-200", "31,2e-200"]
    (log,) = read(tmp_path, "time [s],COF\n" + "\n".join(rows) + "\n")
    assert 0.09 < reduce_log(log).friction < 0.11
    rows = [f"{i},1.2,10" for i in range(60)]
    rows[30] = "30,1e10,1e-300"
    (log,) = read(tmp_path, "time [s],Ff [N],Fn [N]\n" + "\n".join(rows) + "\n")
    assert (log.rows, log.missing) == (59, 1)


def test_neither_many_digits_nor_many_tables_take_long(tmp_path):
    """Digits and a letter took the square of their number, hours; twenty thousand tables 1.7 GB."""
    assert not is_number("1" * 1_000_000 + "x")
    one = "time [s],COF\n0,0.1\n1,0.1\n2,0.1\n"
    with pytest.raises(InputError, match="has more than 2000 tables"):
        read(tmp_path, one * 2100)


# --- layouts that no map knows -------------------------------------------------------------------
TIME = np.arange(120) * 0.5
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
    path = written(tmp_path, SECOND[what], "log.txt")
    draft = draft_of(path)
    assert draft.read_text("utf-8").count("# guess, check: ") >= 1
    (log,) = read_log(path, read_column_map(draft))
    np.testing.assert_array_equal(log.friction, FRICTION)
    assert np.diff(log.time).max() == pytest.approx(np.diff(log.time).min())


@pytest.mark.parametrize("what", EDITED)
def test_what_no_file_states_is_left_open_in_the_draft(tmp_path, what):
    """The draft as written is refused; with the one thing that it asks for, the log is read."""
    text, edits = EDITED[what]
    path = written(tmp_path, text, "log.txt")
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
    path = written(tmp_path, text, "log.txt")
    with pytest.raises(InputError, match="breaks the table") as refusal:
        read_log(path)
    offered = re.search(r"skip = (\[.*\])", str(refusal.value))[1]
    (log,) = read_log(path, column_map({"format": {key: json.loads(offered)}}))
    np.testing.assert_array_equal(log.friction, FRICTION)


def test_the_command_writes_the_draft_and_keeps_what_is_stated(elsewhere, tmp_path, capsys):
    """Conditions of the map given are in the draft; one that was edited is not written over."""
    path = written(tmp_path, SECOND["names without units"], "log.txt")
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
