"""Raw tribometer logs in text come back to the last digit written, with their units and conditions."""

import hashlib
import math

import numpy as np
import pytest
import raw_logs
from commands import column_map
from hypothesis import given
from hypothesis import strategies as st
from raw_logs import as_written

from separatrix import InputError, read_log
from separatrix.friction.logs.column_map import ColumnMap
from separatrix.friction.logs.log import RawLog
from separatrix.friction.logs.names import ALIASES, MEANINGS, NAMES, ranks, scale_of
from separatrix.ground.units import UNITS

ROWS = 60
TIME = np.arange(ROWS) * 0.25
FRICTION = 0.12 + 0.02 * np.sin(np.arange(ROWS) * 0.7)
ULP = 4e-16  # a number in mN, um or gram-force is rounded once more on its way to SI


def read(tmp_path, content: bytes, columns: ColumnMap | None = None, name: str = "log.txt") -> RawLog:
    """The one log of a file with that content."""
    (log,) = read_all(tmp_path, content, columns, name)
    return log


def read_all(tmp_path, content: bytes, columns: ColumnMap | None = None, name: str = "log.txt"):
    """Every log of a file with that content."""
    path = tmp_path / name
    path.write_bytes(content)
    return read_log(path, columns)


ENCODINGS = ["utf-8", "utf-8-sig", "utf-16-le-mark", "utf-16-be-mark", "cp1252"]


@given(
    separator=st.sampled_from([";", "\t", ",", "  "]),
    decimal=st.sampled_from([".", ","]),
    encoding=st.sampled_from(ENCODINGS),
    digits=st.integers(1, 12),
    friction=st.lists(st.floats(0.0, 3.0), min_size=3, max_size=12),
)
def test_any_dialect_comes_back_or_is_asked_for(
    tmp_path_factory, separator, decimal, encoding, digits, friction
):
    """Whatever the numbers: the log is the one written, or the decimal sign is asked for; no other."""
    if separator == "," and decimal == ",":
        decimal = "."
    values = np.array(friction)
    columns = {"time [s]": np.arange(len(values)) * 0.5, "COF": values}
    content = raw_logs.plain_csv(
        columns, separator=separator, decimal=decimal, encoding=encoding, digits=digits
    )
    try:
        log = read(tmp_path_factory.mktemp("dialect"), content)
    except InputError as refusal:
        assert "decimal" in str(refusal)  # noqa: PT017
    else:
        np.testing.assert_array_equal(log.friction, as_written(values, digits))


@pytest.mark.parametrize(
    "mark", ["x", "\u00d7", "-", "NaN", "n.a.", "", "#N/A", "#DIV/0!", "1.#QNAN", "inf", " - "]
)
@pytest.mark.parametrize("separator", [";", "\t", ",", "  "])
def test_missing_values_are_left_out_and_counted(tmp_path, mark, separator):
    """Rows without friction are dropped, whatever the mark."""
    if mark == "" and separator == "  ":
        pytest.skip("nothing between blanks cannot be seen")
    friction = FRICTION.copy()
    friction[[0, 7, 8, ROWS - 1]] = np.nan
    columns = {"time [s]": TIME, "COF": friction, "other": TIME}
    log = read(tmp_path, raw_logs.plain_csv(columns, separator=separator, missing=mark))
    there = np.isfinite(friction)
    assert log.missing == 4
    np.testing.assert_array_equal(log.friction, as_written(FRICTION[there]))
    np.testing.assert_array_equal(log.time, as_written(TIME[there]))
    assert any("4 of 60 rows are left out" in note for note in log.notes)


@pytest.mark.parametrize("abscissa", ["time [s]", "distance [m]", "cycles"])
def test_a_row_without_its_abscissa_is_left_out(tmp_path, abscissa):
    """A friction that stands nowhere is of no use."""
    columns = {"time [s]": TIME, "distance [m]": TIME, "cycles": TIME}
    columns[abscissa] = np.where(np.arange(ROWS) == 30, np.nan, TIME)
    log = read(tmp_path, raw_logs.plain_csv(columns | {"COF": FRICTION}, missing="x"))
    assert log.missing == 1
    np.testing.assert_array_equal(log.friction, as_written(np.delete(FRICTION, 30)))


def csv(columns=None, **options) -> bytes:
    """A log of time and friction, or of other columns."""
    return raw_logs.plain_csv({"time [s]": TIME, "COF": FRICTION} if columns is None else columns, **options)


def lines(head: str, row: str) -> bytes:
    """A header over rows of the time {t} and the friction {f}, or {e}; in capitals with a comma."""
    rows = []
    for t, f in zip(TIME, FRICTION, strict=True):
        point = {"t": f"{t:.6f}", "f": f"{f:.6f}", "e": f"{10.0 * float(f'{f:.6f}'):.5f}e-01"}
        comma = {name.upper(): text.replace(".", ",") for name, text in point.items()}
        rows.append(row.format(**point, **comma))
    return "\n".join([head, *rows]).encode()


NAMES_OF_FRICTION = ("Reibwert \u00b5", "Coefficient of friction, \u00b5", "COF (\u03bc)", "Kinetic COF")
NAMES_OF_FRICTION += ("mu_k", "Coeff. frott.")
LONG_HEAD = [f"key {i};value {i}" for i in range(40)] + ["Load [N];Speed [m/s]", "50;2"]
BARE_HEAD = ["Samples;200;200", "X0;0.0;0.0", "Delta;0.5;0.5", "Unit;N;N"]
ONE = np.ones(ROWS)
FORCES = {"tangential_force": {"name": "Fx", "unit": "N"}, "normal_force": {"name": "Fz", "unit": "N"}}
BY_NUMBER = {"columns": {"time": {"name": 1, "unit": "s"}, "friction": 2}}
SECOND, ENDS = {"columns": {"friction": "mu"}}, {"format": {"ends": ["Summary"]}}
FORMAT = {"separator": ";", "decimal": ",", "header_line": 2, "units_below": True}

MORE = {"time [s]": TIME, "COF": FRICTION, "Fz [N]": FRICTION + 10.0}
DIALECTS = [",.", "|.", ";.", ";,", "\t.", "\t,", "   .", "  ,", " \t ."]
UNIT_STYLES = {
    "in brackets": ("Time [s];\u00b5 [-];Fn [mN]", ()),
    "in parentheses": ("Time (s);COF ();Load (mN)", ()),
    "after an underscore": ("Time_s;mu;Fn_mN", ()),
    "after a slash": ("Zeit / s;Reibwert;Normalkraft/mN", ()),
    "after in": ("Zeit in s;Reibungszahl;Normalkraft in mN", ()),
    "after a blank": ("temps s;coefficient de frottement;Fn mN", ()),
    "in a row": ("Time;COF;Fz", ("s", "-", "mN")),
    "in a row with brackets": ("Time;COF;Fz", ("[s]", "[-]", "[mN]")),
    "in a row with a gap": ("T;COF;Fz", ("sec", "", "mN")),
}
COLUMNS = (TIME, FRICTION, FRICTION)
TWO_MEANINGS = {"T [sec]": TIME, "t [\u00b0C]": 20 + TIME, "Friction [N]": FRICTION, "Load [N]": ONE}

MINUS = csv({"time [s]": TIME, "Ff [N]": FRICTION, "Fn [N]": -ONE}).replace(b"-", "\u2212".encode())
THE_SAME = {  # a log, or a log and its map
    "Anton Paar text": raw_logs.anton_paar(FRICTION, TIME),
    "Anton Paar text, nano": raw_logs.anton_paar(FRICTION, TIME, nano=True),
    "Rtec CSV": raw_logs.rtec(FRICTION, TIME),
    "Bruker UMT text": raw_logs.umt(FRICTION, TIME),
    "Phoenix Compend text": raw_logs.compend(FRICTION, TIME),
    **{
        f"{encoding}, {newline!r}": raw_logs.anton_paar(FRICTION, TIME, encoding=encoding, newline=newline)
        for encoding in ENCODINGS
        for newline in ("\n", "\r\n", "\r")
    },
    **{f"separator and decimal {of!r}": csv(MORE, separator=of[:-1], decimal=of[-1]) for of in DIALECTS},
    **{
        f"units {style}": csv(dict(zip(names.split(";"), COLUMNS, strict=True)), units=units, separator=";")
        for style, (names, units) in UNIT_STYLES.items()
    },
    "units of names with two meanings": csv(TWO_MEANINGS | {"Speed [rpm]": 60 * ONE}),
    "a table that is no log": (csv() + b"\nSummary\nLoad [N],Mean\n5,0.12\n6,0.13\n", ENDS),
    "in quotes, as spreadsheets write": lines('"time [s]";"COF"', '"{T}";"{F}"'),
    "decimal commas in quotes between commas": lines('"time, s","COF, -",note', '"{T}","{F}","a, b"'),
    "a remark in quotes leaves the commas of numbers": csv(
        separator=";", decimal=",", head=['"Probe 3, zweiter Lauf"', 'Ort;"Halle 2, links"']
    ),
    "a typographic minus": MINUS,
    "metadata of as many fields as the table": csv(separator=";", head=LONG_HEAD),
    "more words than numbers": lines("sample;phase;time [s];COF;status", "A3;steady;{t};{f};ok"),
    "dates beside the numbers": lines("date;step;time [s];COF", "2026-02-01 10:00:00;slide;{t};{f}"),
    "German dates beside decimal commas": lines("Datum;Zeit [s];Reibwert", "01.02.2026;{T};{F}"),
    "closing remarks": csv(tail=["", "stopped by operator", "Total 12:00"]),
    "empty lines between rows": csv().replace(b"\n2.0", b"\n\n  \n2.0", 1),
    "lines of fast data between rows": raw_logs.compend(FRICTION, TIME, fast_data_every=7),
    "numbers above the names, whose line the map states": (
        csv({"X": TIME, "Fx": FRICTION, "Fz": ONE}, separator=";", head=BARE_HEAD),
        {"columns": {"time": {"name": "X", "unit": "s"}} | FORCES, "format": {"header_line": 5}},
    ),
    "columns by number need no header": (csv().split(b"\n", 1)[1], BY_NUMBER),
    "forces of the map go before a coefficient": (
        csv({"time [s]": TIME, "COF": FRICTION * 9, "Fx [N]": FRICTION, "Fz [N]": ONE}),
        {"columns": {"tangential_force": "Fx"}},
    ),
    "lines of names and units by place": (lines("remark\nZeit;Reibwert\ns;-", "{T};{F}"), {"format": FORMAT}),
    "the second of two frictions": (csv({"time [s]": TIME, "COF": 2 * FRICTION, "mu": FRICTION}), SECOND),
    "forces named by words": csv({"t [s]": TIME, "Reibkraft FR [N]": FRICTION, "Normalkraft FN [N]": ONE}),
    "forces named by signs": csv({"t [s]": TIME, "F_t [N]": FRICTION, "F_n [N]": ONE}),
    **{
        f"friction named {name}": csv({"Time [sec.]": TIME, name: FRICTION}, separator=";")
        for name in NAMES_OF_FRICTION
    },
    **{
        f"{mark} before the names, {separator}": csv(
            {f"{mark}time [s]": TIME, "COF": FRICTION}, separator=separator
        )
        for mark in ("# ", "#", "% ")
        for separator in (";", "  ")
    },
    **{
        f"exponents with {letter}, {row}": lines("time [s];COF", row).replace(b"e-01", b"%b-01" % letter)
        for letter in (b"E", b"D", b"d")
        for row in ("{t};{e}", "{T};{E}")
    },
}

LOGGED = {  # columns beside friction and time
    "Anton Paar text, nano": {"normal_force": 5 * ONE, "tangential_force": as_written(FRICTION * 5e3) / 1e3},
    "Anton Paar text": {"distance": as_written(TIME * 0.1), "wear_depth": as_written(TIME * 1e-3) * 1e-6},
    "separator": {"normal_force": as_written(FRICTION + 10.0)},
    "units of": {"temperature": 293.15 + as_written(TIME)},
    "units": {"normal_force": as_written(FRICTION) / 1e3},
}


@pytest.mark.parametrize("what", THE_SAME)
def test_the_friction_written_is_read(tmp_path, what):
    """To the last digit, however it is written, and with whatever beside it, above it and below it."""
    content, given = THE_SAME[what] if isinstance(THE_SAME[what], tuple) else (THE_SAME[what], None)
    log = read(tmp_path, content, given and column_map(given))
    np.testing.assert_array_equal(log.friction, as_written(FRICTION))
    np.testing.assert_array_equal(log.time, as_written(TIME))
    assert (log.rows, log.missing, log.checksum) == (ROWS, 0, hashlib.sha256(content).hexdigest())
    assert log.format.startswith(what) or "text" not in what.split()[-1:]
    for name, values in next((of for key, of in LOGGED.items() if what.startswith(key)), {}).items():
        np.testing.assert_allclose(getattr(log, name), values, rtol=ULP)


ANTON_PAAR = raw_logs.anton_paar(FRICTION, TIME)
STROKES = ANTON_PAAR.replace("Angle [\u00b0]".encode("cp1252"), b"Linear Position [mm]")
RTEC = raw_logs.rtec(FRICTION, TIME)
GAPS = csv({"time [s]": TIME, "COF": FRICTION, "temp [C]": np.where(TIME < 1.25, np.nan, 20.0)})
PATTERNS = {
    "test": {"medium": "gaseous nitrogen", "counterface": "440C", "temperature": "77 K"},
    "files": {"armalon_*.txt": {"material": "Armalon"}, "*_ln2.txt": {"medium": "liquid nitrogen"}},
}
FOLDERS = {"files": {"armalon/*.csv": {"material": "Armalon"}, "a.csv": {"sample": "A"}}}
RADIUS = {"test": {"track_radius": "15 mm"}}
ANTON = {"slip_speed": 0.1, "normal_force": 5.0}
TURNING = {"slip_speed": 4 * math.pi * 0.02, "cycle_time": 0.5, "material": "Armalon"}
PIN = {"normal_force": "100 N", "pin_diameter": "6 mm"}
COLD = {"environment": "liquid nitrogen, 440C", "material": "Armalon", "temperature": 77.0}
CONDITIONS = {
    "Anton Paar, radius of the map": (ANTON_PAAR, RADIUS, ANTON | {"cycle_time": 2 * math.pi * 0.015 / 0.1}),
    "millinewtons": (raw_logs.anton_paar(FRICTION, TIME, nano=True), {}, {"normal_force": 5.0}),
    "a stroke's greatest speed is not its sliding speed": (STROKES, {}, {"slip_speed": None}),
    "Rtec": (RTEC, {"test": {"track_radius": "20 mm", "material": "Armalon"}}, TURNING),
    "a speed in rpm": (csv(TWO_MEANINGS | {"Speed [rpm]": 60 * ONE}), {}, {"cycle_time": 1.0}),
    "a measured column with gaps": (GAPS, {}, {"temperature": 293.15}),
    "the map before the column": (ANTON_PAAR, {"test": {"normal_force": "6 N"}}, {"normal_force": 6.0}),
    "pressure of a flat pin": (csv(), {"test": PIN}, {"pressure": 100.0 / (9.0 * math.pi) * 1e6}),
    "patterns, in the order written: armalon_3_ln2.txt": (csv(), PATTERNS, COLD),
    "a pattern with the folder: armalon/a.csv": (csv(), FOLDERS, {"material": "Armalon", "sample": "A"}),
    "a pattern with another folder: peek/a.csv": (csv(), FOLDERS, {"material": None, "sample": "A"}),
}


@pytest.mark.parametrize("what", CONDITIONS)
def test_conditions_are_those_of_the_map_and_the_file(tmp_path, what):
    """In SI, or None with a note: from its columns, [test] and each pattern that fits."""
    content, given, conditions = CONDITIONS[what]
    folder, _, name = what.partition(": ")[2].rpartition("/")
    (tmp_path / folder).mkdir(exist_ok=True)
    log = read(tmp_path / folder, content, column_map(given), name if "." in name else "log.txt")
    found = {key: getattr(log.conditions, key) for key in conditions}
    near = {key: pytest.approx(of, rel=1e-12) for key, of in conditions.items() if isinstance(of, float)}
    assert found == conditions | near  # rounding of units
    assert ("slip_speed below [test]" in "\n".join(log.notes)) == what.startswith("a stroke's")


def test_column_map_says_what_names_do_not(tmp_path):
    """By name or by number, with a unit and a sign."""
    content = raw_logs.plain_csv({"a": TIME, "b": FRICTION * 2e3, "c": np.full(ROWS, -2.0)})
    choices = {
        "time": {"name": "a", "unit": "min"},
        "tangential_force": {"name": 2, "unit": "mN"},
        "normal_force": {"name": "c", "unit": "N", "sign": -1},
    }
    log = read(tmp_path, content, column_map({"columns": choices}))
    np.testing.assert_array_equal(log.time, as_written(TIME) * 60.0)
    np.testing.assert_allclose(log.friction, as_written(FRICTION * 2e3) / 2e3, rtol=ULP)
    assert {column.why for column in log.columns} == {"column map"}


def test_what_stands_beside_the_numbers_is_kept(tmp_path):
    """A name without the file's mark of byte order, a column with gaps, why not."""
    assert read(tmp_path, csv(encoding="utf-8-sig")).columns[0].header == "time [s]"
    assert "comma, decimal comma" in read(tmp_path, lines('"t, s","mu"', '"{T}","{F}"')).format
    assert (read(tmp_path, GAPS).rows, np.isnan(read(tmp_path, GAPS).temperature).sum()) == (ROWS, 5)
    code = csv({"time [s]": TIME, "COF": FRICTION, "temp [C]": np.where(TIME == 1.25, -9.0, 20.0)})
    # a number until the map says that it is none
    assert np.nanmin(read(tmp_path, code).temperature) == 264.15
    known = column_map({"format": {"missing": ["-9"]}})
    assert np.isnan(read(tmp_path, code, known).temperature).sum() == 1


def test_each_step_of_a_file_is_a_log(tmp_path):
    """Time begins anew in each; 204 gram-force are 2 N; the map may name the tables that are wanted."""
    first, second = read_all(tmp_path, raw_logs.umt(FRICTION, TIME, steps=2, reciprocating=True))
    assert [first.source, second.source] == ["log.txt, run 1, step 1", "log.txt, run 1, step 2"]
    assert second.time[0] == 0.0
    np.testing.assert_allclose(first.normal_force, 2.0, rtol=1e-8)  # six decimals of 203.94 g
    np.testing.assert_array_equal(np.concatenate([first.friction, second.friction]), as_written(FRICTION))
    time = np.concatenate([TIME[:20], TIME[:40]])
    content = raw_logs.rtec(FRICTION, time, steps=[1] * 20 + [2] * 40)
    logs = read_all(tmp_path, content)
    assert [(log.source, log.rows) for log in logs] == [("log.txt, step 1", 20), ("log.txt, step 2", 40)]
    assert read(tmp_path, content, column_map({"format": {"tables": ["step 2"]}})).rows == 40


SIGN = np.where(np.arange(ROWS) % 20 < 10, 1.0, -1.0)
LOAD = np.where(np.isin(np.arange(ROWS), (3, 4)), -0.5, 10.0)
FEW = np.arange(ROWS) % 20 == 5
TEN = {"Ff [N]": FRICTION * 10.0}
TENFOLD = as_written(FRICTION * 10.0) / 10.0
BY_TEN = {"test": {"normal_force": "10 N"}}

MADE = {  # begin of a note: columns beside the time, the friction made of them, map
    "": ({"COF [%]": FRICTION * 100.0}, as_written(FRICTION * 100.0) / 100.0),
    "friction is |tangential force| / 10 N, the constant given": (TEN, TENFOLD, BY_TEN),
    "the column of normal force has no load in any row": (TEN | {"Fn [N]": 0.0 * ONE}, TENFOLD, BY_TEN),
    "the normal force is negative in the file": (TEN | {"Fn [N]": -10.0 * ONE}, TENFOLD),
    "2 rows without compression": (TEN | {"Fn [N]": LOAD}, TENFOLD[LOAD > 0]),
    "friction is negative in 30 of 60 rows": ({"COF": SIGN * FRICTION}, as_written(FRICTION)),
    **{
        f"friction is above 5 in 3 of 60 rows (up to {abs(code):.4g})": (
            {"COF": np.where(FEW, code, FRICTION)},
            as_written(FRICTION[~FEW]),
        )
        for code in (-999.0, 99.99, 9.9e37)  # for a missing value
    },
}


@pytest.mark.parametrize("note", MADE)
def test_friction_is_a_magnitude_made_from_what_is_logged(tmp_path, note):
    """With a note on what was done, and the rows left out counted; a code is not called negative."""
    columns, friction, *given = MADE[note]
    log = read(tmp_path, csv({"time [s]": TIME} | columns), column_map(*given) if given else None)
    np.testing.assert_allclose(log.friction, friction, rtol=ULP)
    assert log.missing == ROWS - len(friction)
    assert any(one.startswith(note) for one in log.notes) or not note
    assert any("negative" in one for one in log.notes) == ("negative" in note)


@pytest.mark.parametrize("units", [(), ("s", "-")])
def test_a_header_repeated_among_the_rows_does_not_divide_a_test(tmp_path, units):
    """On every page, say: time goes on, and it is one test, to its last row."""
    parts = [
        raw_logs.plain_csv({"time [s]": TIME[a:b], "COF": FRICTION[a:b]}, units=units)
        for a, b in ((0, 20), (20, 40), (40, ROWS - 1), (ROWS - 1, ROWS))
    ]
    for between in (b"", b"\n"):
        log = read(tmp_path, between.join(parts))
        np.testing.assert_array_equal(log.friction, as_written(FRICTION))
        np.testing.assert_array_equal(log.time, as_written(TIME))


def test_a_header_repeated_where_time_begins_anew_is_refused_and_with_a_line_between_begins_a_test(tmp_path):
    """Without a line between it is one table, in which time must not run backwards."""
    one, two = (raw_logs.plain_csv({"time [s]": TIME, "COF": f}) for f in (FRICTION, FRICTION + 0.1))
    with pytest.raises(InputError, match=r"time must not run backwards.* Split the file there"):
        read_all(tmp_path, one + two)
    first, second = read_all(tmp_path, one + b"test B\n" + two)
    np.testing.assert_array_equal(first.friction, as_written(FRICTION))
    np.testing.assert_array_equal(second.time, as_written(TIME))


def test_no_name_and_unit_have_two_meanings():
    """In the published table, a name together with any unit that fits one of its meanings fits no other."""
    every = {unit for table in UNITS.values() for unit in table}
    every |= {word for table in ALIASES.values() for group in table.values() for word in group.split("; ")}
    assert set(NAMES) == {*MEANINGS, "position"}
    assert len(NAMES["friction"]) == 1  # no second choice: of two columns none is taken
    for own, name in ((key, name) for key, groups in NAMES.items() for group in groups for name in group):
        known = ranks(name)
        assert own in known, f"{name} is not written as it is compared"
        for unit in every if len(known) > 1 else ():
            fitting = [meaning for meaning in known if scale_of(unit, meaning) is not None]
            assert len(fitting) <= 1, (name, unit, fitting)
