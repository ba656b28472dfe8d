"""Raw tribometer logs in text come back to the last digit written, with their units and conditions."""

from __future__ import annotations

import hashlib
import math

import numpy as np
import pytest
import raw_logs
from hypothesis import given, settings
from hypothesis import strategies as st
from raw_logs import as_written

from separatrix.friction.logs import described, read_log
from separatrix.friction.logs.column_map import ColumnMap, column_map
from separatrix.friction.logs.log import Conditions, RawLog
from separatrix.friction.logs.names import ALIASES, MEANINGS, NAMES, ranks, scale_of
from separatrix.ground.errors import InputError
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


FORMATS = {
    "Anton Paar text": raw_logs.anton_paar,
    "Rtec CSV": raw_logs.rtec,
    "Bruker UMT text": raw_logs.umt,
    "Phoenix Compend text": raw_logs.compend,
}


@pytest.mark.parametrize("format_name", FORMATS)
def test_friction_and_time_come_back_to_the_last_digit(tmp_path, format_name):
    """Every writer's numbers are read as the floats nearest to their decimals."""
    log = read(tmp_path, FORMATS[format_name](FRICTION, TIME))
    assert log.format.startswith(format_name)
    np.testing.assert_array_equal(log.friction, as_written(FRICTION))
    np.testing.assert_array_equal(log.time, as_written(TIME))
    assert log.rows == ROWS
    assert log.missing == 0


def test_checksum_is_that_of_the_file(tmp_path):
    """Provenance: SHA-256 of the bytes as they stand on the disk."""
    content = raw_logs.anton_paar(FRICTION, TIME)
    assert read(tmp_path, content).checksum == hashlib.sha256(content).hexdigest()


ANTON = raw_logs.anton_paar(FRICTION, TIME)
RTEC = raw_logs.rtec(FRICTION, TIME)
BARE_RTEC = raw_logs.rtec(FRICTION, TIME, metadata=False)
STROKE = ANTON.replace("Angle [\u00b0]".encode("cp1252"), b"Linear Position [mm]")
PATTERNS = {
    "test": {"medium": "gaseous nitrogen", "counterface": "440C", "temperature": "77 K"},
    "files": {
        "log*.txt": {"material": "Armalon"},
        "*g.txt": {"medium": "liquid nitrogen"},
        "other.txt": {"material": "PEEK"},
    },
}
ANTON_PAAR = {"sample": "A1", "slip_speed": 0.1, "normal_force": 5.0, "temperature": 295.15}
CONDITIONS = {
    "radius 15 mm at 10 cm/s": (ANTON, {}, ANTON_PAAR | {"cycle_time": 2 * math.pi * 0.015 / 0.1}),
    "forces in mN": (raw_logs.anton_paar(FRICTION, TIME, nano=True), {}, {"normal_force": 5.0}),
    "the greatest speed of strokes": (STROKE, {}, {"slip_speed": None}),
    "the map before the metadata": (ANTON, {"test": {"normal_force": "6 N"}}, {"normal_force": 6.0}),
    "keys over values, and 120 rpm on 20 mm": (
        RTEC,
        {"test": {"track_radius": "20 mm", "material": "Armalon"}},
        {"material": "Armalon", "sample": "disk 7", "slip_speed": 4 * math.pi * 0.02, "cycle_time": 0.5},
    ),
    "two keys over two values": (b"Sample,Operator\ndisk 7,nobody\n" + BARE_RTEC, {}, {"sample": "disk 7"}),
    "one key over one value": (b"Sample\ndisk 7\n" + BARE_RTEC, {}, {"sample": None}),
    "keys that end in a carriage return": (
        RTEC.replace(b"Recipe\r\ndisk", b"Recipe\rdisk"),
        {},
        {"sample": "disk 7"},
    ),
    "a velocity of 240, rpm or mm/s": (raw_logs.umt(FRICTION, TIME), {}, {"slip_speed": None}),
    "a flat pin of 6 mm under 100 N": (
        raw_logs.plain_csv({"time [s]": TIME, "COF": FRICTION}),
        {"test": {"normal_force": "100 N", "pin_diameter": "6 mm"}},
        {"pressure": 100.0 / (9.0 * math.pi) * 1e6},
    ),
    "keys that are no quantity": (
        raw_logs.plain_csv(
            {"time [s]": TIME, "COF": FRICTION},
            head=["Load: 50 N", "Pin diameter: 1/4 in", "Speed: as usual"],
        ),
        {},
        {"normal_force": 50.0, "slip_speed": None},
    ),
    "patterns of names in their order, after what holds for all": (
        raw_logs.plain_csv({"time [s]": TIME, "COF": FRICTION}),
        PATTERNS,
        {"environment": "liquid nitrogen, 440C", "material": "Armalon", "temperature": 77.0},
    ),
    "a pattern of this folder": (
        ANTON,
        {"files": {"logs/*.txt": {"material": "Armalon"}, "log.txt": {"sample": "A"}}},
        {"material": "Armalon", "sample": "A"},
    ),
    "a pattern of another folder": (
        ANTON,
        {"files": {"peek/*.txt": {"material": "PEEK"}, "log.txt": {"sample": "A"}}},
        {"material": None, "sample": "A"},
    ),
}
SAID = {
    "the greatest speed of strokes": "slip_speed below [test]",
    "a velocity of 240, rpm or mm/s": 'Velocity 240 has no unit; put slip_speed = "240 <unit>" under [test]\n'
    'Radius 15.000 has no unit; put track_radius = "15.000 mm" under [test]',
    "keys that are no quantity": 'Pin diameter 1/4 in is not understood; put pin_diameter = "..." with its '
    "unit under [test]\nSpeed as usual is not understood",
}


@pytest.mark.parametrize("what", CONDITIONS)
def test_conditions_are_in_si_with_words_on_what_is_not_understood(tmp_path, what):
    """From metadata, the column map and the names of files; of two decimals, and their products."""
    content, given, conditions = CONDITIONS[what]
    (tmp_path / "logs").mkdir()
    log = read(tmp_path / "logs", content, column_map(given))
    for key, value in conditions.items():
        expected = pytest.approx(value, rel=1e-12) if isinstance(value, float) else value
        assert getattr(log.conditions, key) == expected, key
    for words in SAID.get(what, "").splitlines():
        assert any(words in note for note in log.notes), words


def test_anton_paar_columns_are_in_si(tmp_path):
    """Distance and depth; the same test logged in mN has the same forces."""
    log = read(tmp_path, ANTON)
    np.testing.assert_array_equal(log.distance, as_written(TIME * 0.1))
    np.testing.assert_allclose(log.wear_depth, as_written(TIME * 1e-3) * 1e-6, rtol=ULP)
    log = read(tmp_path, raw_logs.anton_paar(FRICTION, TIME, nano=True))
    np.testing.assert_array_equal(log.normal_force, 5.0)
    np.testing.assert_allclose(log.tangential_force, as_written(FRICTION * 5e3) / 1e3, rtol=ULP)


ENCODINGS = ["utf-8", "utf-8-sig", "utf-16-le-mark", "utf-16-be-mark", "utf-16-le", "utf-16-be", "cp1252"]


@pytest.mark.parametrize(
    ("header", "unit"), [("Torque [Nm]", None), ("Drehmoment", "N mm"), ("Moment", "mNm")]
)
def test_a_torque_that_the_map_names_is_divided_by_the_radius(tmp_path, header, unit):
    """0.012 N m at 20 mm are 0.6 N, a friction of 0.06 under 10 N."""
    size = {"N mm": 1e3, "mNm": 1e3}.get(unit, 1.0)
    rows = "".join(f"{i},{size * 0.012:.6g},10\n" for i in range(20))
    named = {"name": header} | ({"unit": unit} if unit else {})
    chosen = column_map({"columns": {"tangential_force": named}, "test": {"track_radius": "20 mm"}})
    log = read(tmp_path, f"time [s],{header},Fz [N]\n{rows}".encode(), chosen)
    np.testing.assert_allclose(log.friction, 0.06, rtol=1e-14)  # rounding
    assert "divided by the radius of the track" in "\n".join(described(log))


@pytest.mark.parametrize("encoding", ENCODINGS)
@pytest.mark.parametrize("newline", ["\n", "\r\n", "\r"])
def test_every_encoding_gives_the_same_log(tmp_path, encoding, newline):
    """The Greek letter in the header and the degree sign in the metadata survive each encoding."""
    log = read(tmp_path, raw_logs.anton_paar(FRICTION, TIME, encoding=encoding, newline=newline))
    np.testing.assert_array_equal(log.friction, as_written(FRICTION))
    assert log.conditions.temperature == pytest.approx(295.15, rel=1e-12)


def test_encoding_after_a_long_ascii_head_is_still_seen(tmp_path):
    """A letter of Windows-1252 far below the header is no longer taken for UTF-8."""
    head = [f"remark {i}: {'a' * 90}" for i in range(250)] + ["place: K\u00f6ln"]
    columns = {"time [s]": TIME, "COF": FRICTION}
    content = raw_logs.plain_csv(columns, head=head, encoding="cp1252", separator="\t")
    assert read(tmp_path, content).metadata["place"] == "K\u00f6ln"


@pytest.mark.parametrize(
    ("separator", "decimal"),
    [
        (",", "."),
        ("|", "."),
        (";", "."),
        (";", ","),
        ("\t", "."),
        ("\t", ","),
        ("   ", "."),
        ("  ", ","),
        (" \t ", "."),
    ],
)
def test_separators_and_decimals_are_told_from_the_rows(tmp_path, separator, decimal):
    """Comma, semicolon, tab and runs of blanks, with decimal point or comma."""
    columns = {"time [s]": TIME, "COF": FRICTION, "Fz [N]": FRICTION + 10.0}
    log = read(tmp_path, raw_logs.plain_csv(columns, separator=separator, decimal=decimal))
    np.testing.assert_array_equal(log.friction, as_written(FRICTION))
    np.testing.assert_array_equal(log.normal_force, as_written(FRICTION + 10.0))


@given(
    separator=st.sampled_from([";", "\t", ",", "  "]),
    decimal=st.sampled_from([".", ","]),
    encoding=st.sampled_from(ENCODINGS),
    digits=st.integers(1, 12),
    friction=st.lists(st.floats(0.0, 3.0), min_size=3, max_size=12),
)
@settings(max_examples=60, deadline=None)
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


UNIT_STYLES = {
    "in brackets": ({"Time [s]": TIME, "\u00b5 [-]": FRICTION, "Fn [mN]": FRICTION}, ()),
    "in parentheses": ({"Time (s)": TIME, "COF ()": FRICTION, "Load (mN)": FRICTION}, ()),
    "after an underscore": ({"Time_s": TIME, "mu": FRICTION, "Fn_mN": FRICTION}, ()),
    "after a slash": ({"Zeit / s": TIME, "Reibwert": FRICTION, "Normalkraft/mN": FRICTION}, ()),
    "after in": ({"Zeit in s": TIME, "Reibungszahl": FRICTION, "Normalkraft in mN": FRICTION}, ()),
    "after a blank": ({"temps s": TIME, "coefficient de frottement": FRICTION, "Fn mN": FRICTION}, ()),
    "in a row": ({"Time": TIME, "COF": FRICTION, "Fz": FRICTION}, ("s", "-", "mN")),
    "in a row with brackets": ({"Time": TIME, "COF": FRICTION, "Fz": FRICTION}, ("[s]", "[-]", "[mN]")),
    "in a row with a gap": ({"T": TIME, "COF": FRICTION, "Fz": FRICTION}, ("sec", "", "mN")),
}


@pytest.mark.parametrize("style", UNIT_STYLES)
def test_units_are_found_wherever_they_stand(tmp_path, style):
    """Beside the name, or in a row of their own; mN come to N."""
    columns, units = UNIT_STYLES[style]
    log = read(tmp_path, raw_logs.plain_csv(columns, units=units, separator=";"))
    np.testing.assert_array_equal(log.time, as_written(TIME))
    np.testing.assert_array_equal(log.friction, as_written(FRICTION))
    np.testing.assert_allclose(log.normal_force, as_written(FRICTION) / 1e3, rtol=ULP)


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


def test_a_number_can_mean_missing(tmp_path):
    """-9 of a temperature is a number until the column map says that it is none."""
    temperature = np.where(np.arange(ROWS) == 5, -9.0, 20.0)
    content = raw_logs.plain_csv({"time [s]": TIME, "COF": FRICTION, "temp [C]": temperature})
    columns = column_map({"format": {"missing": ["-9"]}})
    assert np.nanmin(read(tmp_path, content).temperature) == 264.15
    assert np.isnan(read(tmp_path, content, columns).temperature).sum() == 1


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
FORMAT = {"separator": ";", "decimal": ",", "header_line": 2, "units_line": 4}

THE_SAME: dict[str, tuple[bytes, dict | None]] = {
    "in quotes, as spreadsheets write": (lines('"time [s]";"COF"', '"{T}";"{F}"'), None),
    "decimal commas in quotes between commas": (lines('"time, s","COF, -",note', '"{T}","{F}","a, b"'), None),
    "a remark in quotes leaves the commas of numbers": (
        csv(separator=";", decimal=",", head=['"Probe 3, zweiter Lauf"', 'Ort;"Halle 2, links"']),
        None,
    ),
    "a typographic minus": (
        csv({"time [s]": TIME, "Ff [N]": FRICTION, "Fn [N]": -ONE}).replace(b"-", "\u2212".encode()),
        None,
    ),
    "metadata of as many fields as the table": (csv(separator=";", head=LONG_HEAD), None),
    "more words than numbers": (lines("sample;phase;time [s];COF;status", "A3;steady;{t};{f};ok"), None),
    "dates beside the numbers": (lines("date;step;time [s];COF", "2026-02-01 10:00:00;slide;{t};{f}"), None),
    "German dates beside decimal commas": (lines("Datum;Zeit [s];Reibwert", "01.02.2026;{T};{F}"), None),
    "closing remarks": (csv(tail=["", "stopped by operator", "Total 12:00"]), None),
    "empty lines between rows": (csv().replace(b"\n2.0", b"\n\n  \n2.0", 1), None),
    "lines of fast data between rows": (raw_logs.compend(FRICTION, TIME, fast_data_every=7), None),
    "numbers above the names, whose line the map states": (
        csv({"X": TIME, "Fx": FRICTION, "Fz": ONE}, separator=";", head=BARE_HEAD),
        {"columns": {"time": {"name": "X", "unit": "s"}} | FORCES, "format": {"header_line": 5}},
    ),
    "columns by number need no header": (csv().split(b"\n", 1)[1], BY_NUMBER),
    "forces of the map go before a coefficient": (
        csv({"time [s]": TIME, "COF": FRICTION * 9, "Fx [N]": FRICTION, "Fz [N]": ONE}),
        {"columns": {"tangential_force": "Fx"}},
    ),
    "lines of names and units by their numbers": (
        lines("first remark\nZeit;Reibwert\nother remark\ns;-", "{T};{F}"),
        {"format": FORMAT},
    ),
    "a table that is no log, left out by its first line": (
        csv() + b"\nSummary\nLoad [N],Mean\n5,0.12\n6,0.13\n",
        {"format": {"ends": ["Summary"]}},
    ),
    "the second of two frictions by the map": (
        csv({"time [s]": TIME, "COF": 2 * FRICTION, "mu": FRICTION}),
        {"columns": {"friction": "mu"}},
    ),
    "forces named by words and signs": (
        csv({"t [s]": TIME, "Reibkraft FR [N]": FRICTION, "Normalkraft FN [N]": ONE}),
        None,
    ),
    "forces named by signs": (csv({"t [s]": TIME, "F_t [N]": FRICTION, "F_n [N]": ONE}), None),
    **{
        f"friction named {name}": (csv({"Time [sec.]": TIME, name: FRICTION}, separator=";"), None)
        for name in NAMES_OF_FRICTION
    },
    **{
        f"{mark} before the names, {separator}": (
            csv({f"{mark}time [s]": TIME, "COF": FRICTION}, separator=separator),
            None,
        )
        for mark in ("# ", "#", "% ")
        for separator in (";", "  ")
    },
    **{
        f"exponents with {letter}, {row}": (
            lines("time [s];COF", row).replace(b"e-01", letter.encode() + b"-01"),
            None,
        )
        for letter in "EDd"
        for row in ("{t};{e}", "{T};{E}")
    },
}


@pytest.mark.parametrize("what", THE_SAME)
def test_the_friction_written_is_read(tmp_path, what):
    """However it is written, and with whatever beside it, above it and below it."""
    content, given = THE_SAME[what]
    log = read(tmp_path, content, given and column_map(given))
    np.testing.assert_array_equal(log.friction, as_written(FRICTION))
    np.testing.assert_array_equal(log.time, as_written(TIME))


def test_what_stands_beside_the_numbers_is_kept(tmp_path):
    """Lines above, a name without the file's mark of byte order, a measured column with gaps, why not."""
    assert read(tmp_path, csv(separator=";", head=LONG_HEAD)).metadata["key 39"] == "value 39"
    assert read(tmp_path, csv(head=["# material: Armalon"])).conditions.material == "Armalon"
    assert read(tmp_path, csv(encoding="utf-8-sig")).columns[0].header == "time [s]"
    assert read(tmp_path, RTEC).metadata["Operator"] == "nobody"
    assert "comma, decimal comma" in read(tmp_path, lines('"t, s","mu"', '"{T}","{F}"')).format
    temperature = np.where(np.arange(ROWS) < 5, np.nan, 20.0)
    log = read(tmp_path, csv({"time [s]": TIME, "COF": FRICTION, "temp [C]": temperature}))
    assert (log.rows, np.isnan(log.temperature).sum(), log.conditions.temperature) == (ROWS, 5, 293.15)


SIGN = np.where(np.arange(ROWS) % 20 < 10, 1.0, -1.0)
LOAD = np.where(np.isin(np.arange(ROWS), (3, 4)), -0.5, 10.0)
FEW = np.arange(ROWS) % 20 == 5
TEN = {"time [s]": TIME, "Ff [N]": FRICTION * 10.0}
DEAD_WEIGHT = {"test": {"normal_force": "10 N"}}
TENTH = as_written(FRICTION * 10.0) / 10.0
MADE = {
    "percent": ({"time [s]": TIME, "COF [%]": FRICTION * 100}, None, as_written(FRICTION * 100) / 100, ""),
    "a load of the map": (
        TEN,
        DEAD_WEIGHT,
        TENTH,
        "friction is |tangential force| / 10 N, the constant given",
    ),
    "a load of the map and a column without load": (
        *(TEN | {"Fn [N]": 0.0 * ONE}, DEAD_WEIGHT, TENTH),
        "the column of normal force has no load in any row and is not used",
    ),
    "compression that counts negative": (
        *(TEN | {"Fn [N]": -10.0 * ONE}, None, TENTH),
        "the normal force is negative in the file: compression counts negative there",
    ),
    "rows without compression": (TEN | {"Fn [N]": LOAD}, None, TENTH[LOAD > 0], "2 rows without compression"),
    "strokes there and back": (
        *({"time [s]": TIME, "COF": SIGN * FRICTION}, None, as_written(FRICTION)),
        "friction is negative in 30 of 60 rows",
    ),
    **{
        f"a code of {code} for a missing value": (
            {"time [s]": TIME, "COF": np.where(FEW, code, FRICTION)},
            None,
            as_written(FRICTION[~FEW]),
            f"friction is above 5 in 3 of 60 rows (up to {abs(code):.4g})",
        )
        for code in (-999.0, 99.99, 9.9e37)
    },
}


@pytest.mark.parametrize("what", MADE)
def test_friction_is_a_magnitude_made_from_what_is_logged(tmp_path, what):
    """With a note on what was done, and the rows left out counted; a code is not called negative."""
    columns, given, friction, note = MADE[what]
    log = read(tmp_path, csv(columns), given and column_map(given))
    np.testing.assert_array_equal(log.friction, friction)
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


def test_a_header_repeated_where_time_begins_anew_begins_a_test(tmp_path):
    """Without a line between, or with one that names the test."""
    one, two = (raw_logs.plain_csv({"time [s]": TIME, "COF": f}) for f in (FRICTION, FRICTION + 0.1))
    for between in (b"", b"\n", b"test B\n"):
        first, second = read_all(tmp_path, one + between + two)
        np.testing.assert_array_equal(first.friction, as_written(FRICTION))
        np.testing.assert_array_equal(second.time, as_written(TIME))


def test_a_last_value_that_may_be_cut_off_is_noted(tmp_path):
    """With fewer digits than all others; a whole file has no such note."""
    notes = [read(tmp_path, content).notes for content in (csv(), csv()[:-4])]
    assert [any("may be cut off" in note for note in one) for one in notes] == [False, True]


def test_friction_is_tangential_over_normal_force(tmp_path):
    """Where no coefficient is logged, the magnitude of the ratio, row by row."""
    load = 10.0 + 0.1 * np.cos(TIME)
    stroke = np.sign(np.sin(TIME + 0.1))
    columns = {"time [s]": TIME, "Fx [N]": stroke * FRICTION * load, "Fz [N]": load}
    log = read(tmp_path, raw_logs.plain_csv(columns))
    np.testing.assert_array_equal(log.friction, np.abs(log.tangential_force) / log.normal_force)
    assert (log.tangential_force < 0.0).any()
    compend = read(tmp_path, raw_logs.compend(FRICTION, TIME, coefficient=False))
    np.testing.assert_array_equal(compend.friction, as_written(FRICTION * 20.0) / 20.0)
    assert log.conditions.normal_force == pytest.approx(np.median(load), abs=1e-6)  # six decimals


def test_umt_forces_are_grams_and_every_step_is_a_log(tmp_path):
    """204 gram-force are 2 N; time begins anew in each step."""
    first, second = read_all(tmp_path, raw_logs.umt(FRICTION, TIME, steps=2, reciprocating=True))
    assert first.source == "log.txt, run 1, step 1"
    assert second.source == "log.txt, run 1, step 2"
    assert second.time[0] == 0.0
    np.testing.assert_allclose(first.normal_force, 2.0, rtol=1e-8)  # six decimals of 203.94 g
    np.testing.assert_array_equal(np.concatenate([first.friction, second.friction]), as_written(FRICTION))


def test_rtec_steps_are_logs_of_their_own(tmp_path):
    """The timestamp begins anew with each step."""
    time = np.concatenate([TIME[:20], TIME[:40]])
    logs = read_all(tmp_path, raw_logs.rtec(FRICTION, time, steps=[1] * 20 + [2] * 40))
    assert [log.source for log in logs] == ["log.txt, step 1", "log.txt, step 2"]
    assert [log.rows for log in logs] == [20, 40]
    (second,) = read_all(
        tmp_path,
        raw_logs.rtec(FRICTION, time, steps=[1] * 20 + [2] * 40),
        column_map({"format": {"tables": ["step 2"]}}),
    )
    assert second.rows == 40


def test_unit_of_a_name_with_two_meanings_decides(tmp_path):
    """T in sec is time, T in degrees is temperature; speed in rpm is rotation; friction in N is a force."""
    columns = {
        "T [sec]": TIME,
        "t [\u00b0C]": 20 + TIME,
        "Friction [N]": FRICTION,
        "Load [N]": FRICTION * 0 + 1,
    }
    log = read(tmp_path, raw_logs.plain_csv(columns | {"Speed [rpm]": 60 + 0 * TIME}))
    np.testing.assert_allclose(log.temperature, 293.15 + as_written(TIME), rtol=ULP)
    np.testing.assert_array_equal(log.friction, as_written(FRICTION))
    assert log.conditions.cycle_time == pytest.approx(1.0, rel=1e-12)


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


def test_description_shows_columns_units_and_reasons(tmp_path):
    """What is shown before it is trusted."""
    text = "\n".join(described(read(tmp_path, raw_logs.umt(FRICTION, TIME))))
    assert "Bruker UMT text (utf-8, comma, decimal point), 60 rows, sha256" in text
    assert 'friction: column "COF" (its layout)' in text
    assert 'time: column "T" in sec (its layout)' in text
    assert 'not used: "Z"' in text
    assert "time from 0 s to 14.75 s" in text


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


def test_conditions_refuse_what_cannot_be():
    """A record that checks itself."""
    with pytest.raises(InputError, match=r"Conditions\.temperature must be > 0"):
        Conditions(temperature=-3.0)
