"""The smallest workbooks, part by part, so that a test can make one wrong in one place."""

from __future__ import annotations

import io
import zipfile
from dataclasses import dataclass
from xml.sax.saxutils import escape

from openpyxl.utils import get_column_letter

SPREADSHEET = "application/vnd.openxmlformats-officedocument.spreadsheetml"
TYPES = (
    '<?xml version="1.0" encoding="UTF-8"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/'
    'content-types"><Default Extension="xml" ContentType="application/xml"/>'
    '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
    f'<Override PartName="/xl/workbook.xml" ContentType="{SPREADSHEET}.sheet.main+xml"/>'
    f'<Override PartName="/xl/styles.xml" ContentType="{SPREADSHEET}.styles+xml"/></Types>'
)
REL = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
PACKAGE = "http://schemas.openxmlformats.org/package/2006/relationships"
MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
ROOT = (
    f'<Relationships xmlns="{PACKAGE}">'
    f'<Relationship Id="r1" Type="{REL}/officeDocument" Target="xl/workbook.xml"/></Relationships>'
)
STYLES = (
    f'<styleSheet xmlns="{MAIN}"><numFmts count="1">'
    '<numFmt numFmtId="170" formatCode="hh:mm:ss.000"/></numFmts>'
    '<cellXfs count="3"><xf numFmtId="0"/><xf numFmtId="170"/><xf numFmtId="9"/></cellXfs></styleSheet>'
)


@dataclass(frozen=True)
class Formula:
    """A formula with the value saved with it, if there is one."""

    text: str
    value: float | str | None = None


@dataclass(frozen=True)
class Shown:
    """A number in a style: 1 a time of day, 2 a percentage."""

    value: float | None
    style: int


@dataclass(frozen=True)
class Fault:
    """A cell that shows an error."""

    text: str


def parts(sheets: dict[str, list[list[object]]]) -> dict[str, str]:
    """Return the parts of a workbook by their names."""
    numbered = list(enumerate(sheets.items(), 1))
    names = "".join(f'<sheet name="{escape(n)}" sheetId="{i}" r:id="r{i}"/>' for i, (n, _) in numbered)
    links = "".join(
        f'<Relationship Id="r{i}" Type="{REL}/worksheet" Target="worksheets/sheet{i}.xml"/>'
        for i, _ in numbered
    )
    links += f'<Relationship Id="styles" Type="{REL}/styles" Target="styles.xml"/>'
    found = {
        "[Content_Types].xml": TYPES,
        "_rels/.rels": ROOT,
        "xl/workbook.xml": f'<workbook xmlns="{MAIN}" xmlns:r="{REL}"><sheets>{names}</sheets></workbook>',
        "xl/_rels/workbook.xml.rels": f'<Relationships xmlns="{PACKAGE}">{links}</Relationships>',
        "xl/styles.xml": STYLES,
    }
    return found | {f"xl/worksheets/sheet{i}.xml": sheet(rows) for i, (_, rows) in numbered}


def sheet(rows: list[list[object]]) -> str:
    """Return the part of a sheet."""
    lines = (
        f'<row r="{r}">{"".join(cell(r, c, v) for c, v in enumerate(row, 1))}</row>'
        for r, row in enumerate(rows, 1)
    )
    return f'<worksheet xmlns="{MAIN}"><sheetData>{"".join(lines)}</sheetData></worksheet>'


def cell(row: int, column: int, value: object) -> str:
    """Return one cell; nothing for None."""
    at = f'r="{get_column_letter(column)}{row}"'
    if value is None:
        return ""
    if isinstance(value, Formula):
        if value.value == "":
            return f'<c {at} t="str"><f>{escape(value.text)}</f><v></v></c>'
        saved = "" if value.value is None else f"<v>{value.value!r}</v>"
        return f"<c {at}><f>{escape(value.text)}</f>{saved}</c>"
    if isinstance(value, Shown):
        saved = "" if value.value is None else f"<v>{value.value!r}</v>"
        return f'<c {at} s="{value.style}">{saved}</c>'
    if isinstance(value, Fault):
        return f'<c {at} t="e"><v>{value.text}</v></c>'
    if isinstance(value, bool):
        return f'<c {at} t="b"><v>{int(value)}</v></c>'
    if isinstance(value, str):
        return f'<c {at} t="inlineStr"><is><t>{escape(value)}</t></is></c>'
    return f"<c {at}><v>{value!r}</v></c>"


def zipped(members: dict[str, str | bytes], compression: int = zipfile.ZIP_DEFLATED) -> bytes:
    """Return a zip file of these members."""
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", compression) as target:
        for name, content in members.items():
            target.writestr(zipfile.ZipInfo(name), content, compression)
    return made.getvalue()


def workbook(sheets: dict[str, list[list[object]]], **more: str | bytes) -> bytes:
    """Return a workbook; further or other parts by their names, with / written as __ and . as _dot_."""
    extra = {name.replace("__", "/").replace("_dot_", "."): content for name, content in more.items()}
    return zipped(parts(sheets) | extra)
