"""Logs in workbooks and in LabVIEW files become tables with the numbers, names and units written."""

import builtins
import sys

import numpy as np
import openpyxl
import pytest
from minimal_xlsx import Fault, Formula, Shown, parts, workbook, zipped

from separatrix.errors import InputError
from separatrix.tribometer import sheet_numbers, tdms, xlsx
from separatrix.tribometer.column_map import column_map
from separatrix.tribometer.reading import read_log

nptdms = pytest.importorskip("nptdms")

ROWS = [["Time", "COF", "Wear"], ["s", "-", "um"]]
NUMBERS = [[0.1 * i, 0.1 + 0.001 * (i % 7), float(i)] for i in range(40)]


def log(tmp_path, sheets):
    """Return the tables of a workbook with these sheets."""
    path = tmp_path / "log.xlsx"
    path.write_bytes(workbook(sheets))
    return xlsx.read_tables(path)


def logs(tmp_path, sheets, columns=None):
    """Return the logs of a workbook with these sheets."""
    path = tmp_path / "log.xlsx"
    path.write_bytes(workbook(sheets))
    return read_log(path, column_map(columns or {}))


def same(columns, numbers):
    """Whether columns hold these rows to the last bit, NaN where there is None."""
    expected = np.array([[np.nan if v is None else v for v in row] for row in numbers])
    return np.array_equal(np.array(columns).T, expected, equal_nan=True)


def test_a_table_comes_with_its_names_units_and_metadata(tmp_path):
    """Rows above the names are metadata: name, value, unit; numbers are those written, to the last bit."""
    above = [["Sample:", "Armalon 3"], ["Load", 10.0, "N"], []]
    (table,) = log(tmp_path, {"run 1": above + ROWS + NUMBERS})
    assert (table.name, table.headers, table.units) == ("run 1", ("Time", "COF", "Wear"), ("s", "-", "um"))
    assert table.metadata == {"Sample": "Armalon 3", "Load": "10 N"}
    assert same(table.columns, NUMBERS)


def test_each_sheet_with_a_table_is_one(tmp_path):
    """A sheet of remarks is passed over; the others come in the workbook's order."""
    sheets = {"b": ROWS + NUMBERS, "remarks": [["made by", "A. N."], ["date", 3.0]], "a": ROWS + NUMBERS[:5]}
    assert [(t.name, len(t.columns[0])) for t in log(tmp_path, sheets)] == [("b", 40), ("a", 5)]


def test_units_may_stand_in_brackets_or_nowhere(tmp_path):
    """A row of bracketed units is one of units; without it they are unknown, also beside names."""
    bracketed, plain = [["t", "mu"], ["[s]", "[-]"]], [["t [s]", "mu"]]
    numbers = [row[:2] for row in NUMBERS]
    assert log(tmp_path, {"a": bracketed + numbers})[0].units == ("s", "-")
    assert log(tmp_path, {"a": plain + numbers})[0].units == ("", "")


@pytest.mark.parametrize("mark", [None, "x", "-", "NaN", "n/a", Fault("#N/A"), Fault("#DIV/0!")])
def test_a_missing_value_is_nan(tmp_path, mark):
    """An empty cell, a mark or an error is no value; its row stays."""
    numbers = [list(row) for row in NUMBERS]
    numbers[5][1] = mark
    (table,) = log(tmp_path, {"a": ROWS + numbers})
    assert np.flatnonzero(np.isnan(table.columns[1])).tolist() == [5]
    assert len(table.columns[0]) == len(NUMBERS)


def test_times_of_day_become_seconds(tmp_path):
    """A cell formatted as time holds days: 1/86400 of one is a second (to rounding of the product)."""
    rows = [[Shown(0.5 + i / 86_400, 1), 0.1, float(i)] for i in range(5)]
    (table,) = log(tmp_path, {"a": [["Time", "COF", "n"], *rows]})
    assert table.units[0] == "s"
    assert np.diff(table.columns[0]) == pytest.approx(np.ones(4), abs=1e-10)


def test_dates_count_from_the_first(tmp_path):
    """A date of 2026 is 46 000 days: its seconds would hide those of the test."""
    rows = [[Shown(46_000.4 + i / 86_400, 1), 0.1] for i in range(5)]
    (table,) = log(tmp_path, {"a": [["Time", "COF"], *rows]})
    # a date near 46 000 days is kept to 7e-12 of one, which is 6e-7 s
    assert table.columns[0] == pytest.approx(np.arange(5.0), abs=1e-6)


@pytest.mark.parametrize("header", [["Time [s]", "COF [%]"], ["Time [s]", "COF"]])
def test_a_cell_shown_as_a_percentage_holds_a_fraction(tmp_path, header):
    """What shows 12 % is saved as 0.12, also below a header that says percent."""
    rows = [[float(i), Shown(0.12, 2)] for i in range(5)]
    (found,) = logs(tmp_path, {"a": [header, *rows]})
    assert found.friction.tolist() == [0.12] * 5


def test_words_stand_in_columns_that_are_not_read(tmp_path):
    """Sample and status in every row, remarks in some, a mean computed beside the table, cells of no name."""
    rows = [["A3", float(i), 0.1, "ok", "pump off" if i == 3 else None, None] for i in range(9)]
    rows[2][5], rows[4][5] = Formula("AVERAGE(C2:C9)"), 3.0
    (found,) = logs(tmp_path, {"a": [["Sample", "Time [s]", "COF", "Status", "Remark"], *rows]})
    assert found.time.tolist() == list(range(9))


def test_merged_headers_have_their_text_in_the_upper_row(tmp_path):
    """Time over two rows, and "Forces" over its two columns."""
    header = [["Time [s]", "Forces", None], [None, "Ff [N]", "Fn [N]"]]
    (found,) = logs(tmp_path, {"a": header + [[float(i), 1.0, 10.0] for i in range(5)]})
    assert found.friction.tolist() == [0.1] * 5


def test_rows_of_numbers_above_the_names_are_metadata(tmp_path):
    """A single row with its names above it, before the names of the table."""
    above = [["Load", "Speed"], [5.0, 2.0]]
    (table,) = log(tmp_path, {"a": above + ROWS + NUMBERS})
    assert table.headers == ("Time", "COF", "Wear")
    assert same(table.columns, NUMBERS)


def test_units_in_words_are_a_row_of_units(tmp_path):
    """As in text."""
    header = [["Zeit", "Reibwert", "Temperatur"], ["Minuten", "ohne", "Grad C"]]
    (found,) = logs(tmp_path, {"a": header + [[float(i), 0.1, 20.0] for i in range(5)]})
    assert found.time.tolist() == [60.0 * i for i in range(5)]
    assert found.conditions.temperature == 293.15


BARE = [[float(i), "OVL" if i == 2 else 0.1] for i in range(5)]
BY_NUMBER = {"columns": {"time": {"name": 1, "unit": "s"}, "friction": 2}}


@pytest.mark.parametrize(
    ("sheets", "given"),
    [
        ({"a": [["Time [s]", "COF"], *BARE]}, {}),
        ({"a": [["Time [s]", "COF"], ["seen by", "A. N."], *BARE]}, {"header_line": 1}),
        ({"a": [["Time", "COF"], ["made", "today"], ["s", "-"], *BARE]}, {"header_line": 1, "units_line": 3}),
        ({"a": [["Time [s]", "COF"], *BARE], "b": [[1.0, 2.0]] * 3}, {"tables": ["a"]}),
    ],
)
def test_the_column_map_is_heard_for_workbooks_too(tmp_path, sheets, given):
    """Marks of missing values, rows of names and units, the sheets to read."""
    (found,) = logs(tmp_path, sheets, {"format": {"missing": ["OVL"], **given}})
    assert found.time.tolist() == [0.0, 1.0, 3.0, 4.0]


def test_columns_of_a_sheet_may_be_given_by_their_numbers(tmp_path):
    """Without any names."""
    (found,) = logs(tmp_path, {"a": BARE}, BY_NUMBER | {"format": {"missing": ["OVL"]}})
    assert found.time.tolist() == [0.0, 1.0, 3.0, 4.0]


def test_headers_of_an_instrument_are_known_in_a_workbook(tmp_path):
    """Rtec's CSV saved as a workbook: its names, its timestamp in seconds, and its steps."""
    rows = [[float(i // 5), float(i % 5), 0.1 + 0.01 * i] for i in range(10)]
    found = logs(tmp_path, {"a": [["Step", "Timestamp", "DAQ.COF ()"], *rows]})
    assert [(one.source, one.rows) for one in found] == [
        ("log.xlsx, a, step 0", 5),
        ("log.xlsx, a, step 1", 5),
    ]


def test_a_formula_has_its_saved_value(tmp_path):
    """Nothing is computed again: the value saved with the formula is taken."""
    rows = [[float(i), Formula(f"D{i}/10", 0.1), 1.0] for i in range(5)]
    assert log(tmp_path, {"a": [["Time", "COF", "n"], *rows]})[0].columns[1].tolist() == [0.1] * 5


@pytest.mark.parametrize("gap", [False, True])
def test_many_rows_at_once_are_those_read_one_by_one(tmp_path, monkeypatch, gap):
    """The pattern over plain rows and the parser give the same numbers to the last bit, with gaps too."""
    random = np.random.default_rng(3)
    numbers = (random.normal(size=(3000, 3)) * 10.0 ** random.integers(-30, 30, (3000, 3))).tolist()
    if gap:
        for i in range(0, 3000, 7):
            numbers[i][i % 2 + 1] = None
    monkeypatch.setattr(sheet_numbers, "BLOCK", 50_000)
    path = tmp_path / "log.xlsx"
    path.write_bytes(workbook({"a": ROWS + numbers}))
    quick = xlsx.read_tables(path)[0].columns
    assert same(quick, numbers)
    monkeypatch.setattr(xlsx, "plain_numbers", lambda *_: None)
    assert np.array_equal(np.array(xlsx.read_tables(path)[0].columns), np.array(quick), equal_nan=True)


def test_plain_rows_are_indeed_read_at_once(tmp_path, monkeypatch):
    """Plain numbers, whatever stands beside them, never meet the row by row reading, seven times as slow."""
    monkeypatch.setattr(xlsx._Columns, "read", None)
    assert same(log(tmp_path, {"a": ROWS + NUMBERS})[0].columns, NUMBERS)
    noted = [[*row, "ok" if i % 3 else None, Formula("A1", 1.0)] for i, row in enumerate(NUMBERS)]
    (found,) = logs(tmp_path, {"a": [["Time [s]", "COF", "Wear [um]", "Status", "Sum"], *noted]})
    assert found.friction.tolist() == [row[1] for row in NUMBERS]


def test_dates_percentages_and_formulas_are_read_at_once_too(tmp_path, monkeypatch):
    """A column of one kind is cut out by the pattern, with the very numbers of reading row by row."""
    rows = [
        [Shown(0.5 + i / 7e4, 1), Shown(0.1 + 1e-3 * i, 2), Formula(f"B{i + 2}*3", 0.3 * i)]
        for i in range(50)
    ]
    rows[7][1] = rows[8][2] = None
    path = tmp_path / "log.xlsx"
    path.write_bytes(workbook({"a": [["Time", "COF", "Wear"], *rows]}))
    with monkeypatch.context() as slow:
        slow.setattr(xlsx, "plain_numbers", lambda *_: None)
        (one_by_one,) = xlsx.read_tables(path)
    monkeypatch.setattr(xlsx._Columns, "read", None)
    (at_once,) = xlsx.read_tables(path)
    assert at_once.units == one_by_one.units == ("s", "%", "")
    assert np.array_equal(np.array(at_once.columns), np.array(one_by_one.columns), equal_nan=True)
    assert at_once.columns[1][:2].tolist() == [10.0, 100.0 * 0.101]


@pytest.mark.parametrize("odd", [Formula("A1", 0.3), Shown(0.3, 2), "0.3"])
def test_a_cell_behind_words_is_not_passed_over(tmp_path, odd):
    """The pattern for words ends with their cell: what is no plain number in the next is read or refused."""
    rows = [[float(i), "ok", odd if i == 5 else 0.1] for i in range(9)]
    sheets = {"a": [["Time [s]", "Status", "COF"], *rows]}
    if isinstance(odd, Formula):
        assert logs(tmp_path, sheets)[0].friction[5] == 0.3
    else:
        with pytest.raises(InputError, match=r"cell C7 must be a number|column C holds both"):
            logs(tmp_path, sheets)


def test_what_openpyxl_writes_is_read(tmp_path):
    """Shared texts, styles and gaps as a usual writer makes them."""
    book = openpyxl.Workbook()
    sheet = book.active
    for row in (["Zeit", "Reibzahl"], ["s", "-"], *([float(i), 0.2] for i in range(9))):
        sheet.append(row)
    sheet["B7"] = None
    sheet["A1"].font = openpyxl.styles.Font(bold=True)
    book.save(tmp_path / "log.xlsx")
    (table,) = xlsx.read_tables(tmp_path / "log.xlsx")
    assert table.headers == ("Zeit", "Reibzahl")
    assert same(table.columns, [[float(i), None if i == 4 else 0.2] for i in range(9)])


def test_a_prefix_of_the_namespace_changes_nothing(tmp_path):
    """Some programs write ``<x:row>``; the parser reads it though the pattern does not."""
    found = parts({"a": ROWS + NUMBERS})
    text = (
        found["xl/worksheets/sheet1.xml"].replace("</", "</x:").replace("<", "<x:").replace("<x:/x:", "</x:")
    )
    found["xl/worksheets/sheet1.xml"] = text.replace("xmlns=", "xmlns:x=")
    (tmp_path / "log.xlsx").write_bytes(zipped(found))
    assert same(xlsx.read_tables(tmp_path / "log.xlsx")[0].columns, NUMBERS)


# LabVIEW


def measured(tmp_path, *objects):
    """Return the tables of a TDMS file with these objects."""
    path = tmp_path / "log.tdms"
    with nptdms.TdmsWriter(str(path)) as writer:
        writer.write_segment(list(objects))
    return tdms.read_tables(path)


def channel(name, values, **properties):
    """Return a channel of the group "Test"."""
    return nptdms.ChannelObject("Test", name, np.asarray(values), properties)


def test_a_group_is_a_table_with_units_and_metadata(tmp_path):
    """Channels are columns; properties of file and group are metadata, the group's winning."""
    (table,) = measured(
        tmp_path,
        nptdms.RootObject({"Operator": "A. N.", "Load": 5.0}),
        nptdms.GroupObject("Test", {"Load": 10.0}),
        channel("Time", [0.0, 1.0, 2.0], unit_string="s"),
        channel("COF", np.array([0.1, 0.25, 0.3], dtype=np.float32)),
    )
    assert (table.name, table.headers, table.units) == ("Test", ("Time", "COF"), ("s", ""))
    assert table.metadata == {"Operator": "A. N.", "Load": "10.0"}
    assert table.columns[1].dtype == np.float64
    assert table.columns[1].tolist() == np.array([0.1, 0.25, 0.3], dtype=np.float32).tolist()


def test_a_waveform_brings_its_time(tmp_path):
    """Start and increment of a waveform make the column of time that it lacks."""
    wave = {"wf_start_offset": 1.5, "wf_increment": 0.25, "unit_string": "-"}
    (table,) = measured(
        tmp_path, channel("COF", [0.1, 0.2, 0.3], **wave), channel("N", [5.0, 5.0, 5.0], **wave)
    )
    assert (table.headers, table.units) == (("time of the waveform", "COF", "N"), ("s", "-", "-"))
    assert table.columns[0].tolist() == [1.5, 1.75, 2.0]


@pytest.mark.parametrize("name", ["time", "Elapsed Time (s)", "Zeit"])
def test_a_channel_of_time_is_preferred_to_the_waveform(tmp_path, name):
    """Whatever the waveform says: its increment is 1 where nobody has set it."""
    wave = {"wf_increment": 1.0}
    (table,) = measured(tmp_path, channel(name, [0.0, 0.1], **wave), channel("COF", [0.1, 0.2], **wave))
    assert table.headers == (name, "COF")


def test_raw_values_are_scaled_as_the_file_says(tmp_path):
    """A linear scaling of whole numbers: 0.5 n + 1 exactly."""
    scale = {
        "NI_Scaling_Status": "unscaled",
        "NI_Number_Of_Scales": 1,
        "NI_Scale[0]_Scale_Type": "Linear",
        "NI_Scale[0]_Linear_Slope": 0.5,
        "NI_Scale[0]_Linear_Y_Intercept": 1.0,
        "NI_Scale[0]_Linear_Input_Source": 0xFFFFFFFF,
        "wf_increment": 0.1,
    }
    (table,) = measured(tmp_path, channel("Force", np.arange(4, dtype=np.int16), **scale))
    assert table.columns[1].tolist() == [1.0, 1.5, 2.0, 2.5]


def test_a_number_of_scalings_that_none_has_is_refused(tmp_path):
    """The library would count up to it: a thousand million scalings are refused before it does."""
    with pytest.raises(InputError, match=r"at most 100 scalings a channel; got 1000000000\."):
        measured(tmp_path, channel("COF", [0.1, 0.2], NI_Number_Of_Scales=10**9))


def test_points_in_time_become_seconds_since_the_first(tmp_path):
    """Time stamps are kept to the microsecond; 1e-6 s is their resolution in the writer."""
    moments = np.datetime64("2026-01-01T00:00:00") + np.arange(3) * np.timedelta64(250, "ms")
    (table,) = measured(tmp_path, channel("Time", moments), channel("COF", [0.1, 0.2, 0.3]))
    assert table.units[0] == "s"
    assert table.columns[0] == pytest.approx([0.0, 0.25, 0.5], abs=1e-6)


def test_channels_of_different_rate_are_different_tables(tmp_path):
    """Each length of a group is a table; texts and empty channels are left out."""
    tables = measured(
        tmp_path,
        channel("COF", [0.1, 0.2, 0.3], wf_increment=0.1),
        channel("Temperature", [77.0, 78.0], wf_increment=0.2),
        nptdms.ChannelObject("Test", "Remark", ["a", "b", "c"]),
    )
    assert [(t.name, t.headers) for t in tables] == [
        ("Test, 3 rows", ("time of the waveform", "COF")),
        ("Test, 2 rows", ("time of the waveform", "Temperature")),
    ]


def test_without_the_extra_the_message_says_which(tmp_path, monkeypatch):
    """NpTDMS is an extra: its absence is a refusal with the line to type."""
    usual = builtins.__import__

    def without(name, *rest):
        if name == "nptdms":
            raise ImportError(name)
        return usual(name, *rest)

    path = tmp_path / "log.tdms"
    path.write_bytes(b"TDSm")
    monkeypatch.delitem(sys.modules, "nptdms", raising=False)
    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(InputError, match=r"needs the package npTDMS\. pip install 'separatrix\[tdms\]'"):
        tdms.read_tables(path)


def test_a_damaged_measurement_file_is_refused_whatever_is_wrong(tmp_path):
    """300 files with random bytes changed or cut: each is read or refused on one line, nothing else."""
    wave = {"wf_increment": 0.1, "unit_string": "-"}
    measured(tmp_path, channel("COF", np.linspace(0.1, 0.2, 50), **wave), channel("N", np.arange(50), **wave))
    good = (tmp_path / "log.tdms").read_bytes()
    random = np.random.default_rng(7)
    refusals = []
    for number in range(300):
        changed = bytearray(good[: random.integers(len(good))] if number % 3 == 0 else good)
        for place in random.integers(max(len(changed), 1), size=0 if number % 3 == 0 else 3):
            changed[place] = random.integers(256)
        (tmp_path / "case.tdms").write_bytes(changed)
        try:
            tdms.read_tables(tmp_path / "case.tdms")
        except InputError as refusal:
            refusals.append(str(refusal))
    assert len(refusals) > 100
    assert not [text for text in refusals if "\n" in text]
