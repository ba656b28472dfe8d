"""Marks for missing values in workbooks are read many rows at once, and no fault beside them is missed."""

import numpy as np
import pytest
from minimal_xlsx import MAIN, REL, Fault, parts, zipped

from separatrix.errors import InputError
from separatrix.tribometer import xlsx

LINK = f'<Relationship Id="q" Type="{REL}/sharedStrings" Target="sharedStrings.xml"/></Relationships>'
MARKS = (
    '<c r="B{}" t="inlineStr"><is><t> X </t></is></c>',
    '<c r="B{}" t="s"><v>1</v></c>',
    '<c r="B{}" s="1" t="e"><f>1/0</f><v>#DIV/0!</v></c>',
    '<c r="B{}" t="str"><f>IF(A1,"",1)</f><v></v></c>',
)


def marked(tmp_path, cells, old="", new=""):
    """Return the path of a workbook with a status beside the numbers and these cells for some of them.

    Row 900 is far behind the 32 kB that are read row by row in any case, to find the table.
    """
    rows = [[float(i), 0.1 + 0.001 * i, Fault("status")] for i in range(1000)]
    found = parts({"a": [["Time [s]", "COF", "Status"], *rows]})
    sheet = found["xl/worksheets/sheet1.xml"].replace(' t="e"><v>status<', ' t="s"><v>0<')
    for row, cell in enumerate(cells, 7):
        sheet = sheet.replace(f'<c r="B{row}"><v>{rows[row - 2][1]!r}</v></c>', cell.format(row))
    found["xl/worksheets/sheet1.xml"] = sheet.replace(old, new) if old else sheet
    links = "xl/_rels/workbook.xml.rels"
    found[links] = found[links].replace("</Relationships>", LINK)
    found["xl/sharedStrings.xml"] = f'<sst xmlns="{MAIN}"><si><t>run</t></si><si><t>n/a</t></si></sst>'
    (tmp_path / "log.xlsx").write_bytes(zipped(found))
    return tmp_path / "log.xlsx"


def test_marks_and_errors_among_the_numbers_are_read_at_once_too(tmp_path, monkeypatch):
    """Words of each kind that mean no value; a row of nothing but those is none, as when read row by row."""
    path = marked(tmp_path, MARKS, '<c r="A9"><v>7.0</v></c>', '<c r="A9" t="s"><v>1</v></c>')

    def read():
        return xlsx.read_tables(path, wanted=lambda *_: [0, 1])[0].columns[:2]

    with monkeypatch.context() as slow:
        slow.setattr(xlsx, "plain_numbers", lambda *_: None)
        one_by_one = np.array(read())
    monkeypatch.setattr(xlsx._Columns, "read", None)
    at_once = np.array(read())
    assert at_once.shape == (2, 999)
    assert np.flatnonzero(np.isnan(at_once[1])).tolist() == [5, 6, 7]
    assert np.array_equal(at_once, one_by_one, equal_nan=True)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("900", "9", "row 9 is out of order"),
        ('<c r="C900" t="s"><v>0<', '<c r="C899" t="s"><v>0<', "cell C899 is out of order"),
        ('<c r="C900" t="s"><v>0<', '<c r="C900" t="s"><v>2<', "there is no text number 2"),
        ('<c r="C900" t="s"><v>0<', '<c r="C900"><v>0.1.2<', '"0.1.2" is no number'),
        ('<c r="C900" t="s"><v>0<', '<c r="C900" t="str"><v>a & b<', "not well-formed"),
        ('<c r="B900"><v>', '<c r="B900" t="str"><v>', "cell B900 must be a number"),
    ],
)
def test_damage_beside_marks_is_refused(tmp_path, old, new, words):
    """What reading row by row refuses is not passed over by the pattern."""
    with pytest.raises(InputError, match=words):
        xlsx.read_tables(marked(tmp_path, MARKS, old, new), wanted=lambda *_: [0, 1])


def test_a_long_blank_takes_no_longer_than_its_length(tmp_path):
    """300 000 blanks before and after a mark: a pattern that tried every division would never end."""
    random = np.random.default_rng(5)
    blank = "".join(random.choice(list(" \t\n"), 300_000))
    cell = f'<c r="B{{}}" t="inlineStr"><is><t>{blank}x{blank}y</t></is></c>'
    with pytest.raises(InputError, match="cell B7 must be a number"):
        xlsx.read_tables(marked(tmp_path, [cell]), wanted=lambda *_: [0, 1])
