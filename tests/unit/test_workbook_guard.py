"""A workbook is judged before it is read: what its directory declares, and that its parts keep to it."""

import hashlib
import struct
import zipfile

import pytest
from minimal_xlsx import workbook, zipped

from separatrix.ground import sheet as workbook_files
from separatrix.ground.errors import InputError
from separatrix.ground.sheet import MOST_BYTES, MOST_RATIO, refuse_unsafe
from separatrix.study.reading import read_study

MEMBERS = {"one.xml": b"<a>first</a>" * 50, "folder/two.xml": bytes(range(256)) * 40}


def written(path, content):
    """Return the path of a file with this content."""
    path.write_bytes(content)
    return path


def patched_directory(content: bytes, name: str, offset: int, value: bytes) -> bytes:
    """Return a zip with bytes of a member's entry in the directory replaced."""
    at = content.rfind(b"PK\x01\x02", 0, content.rfind(name.encode()))
    changed = bytearray(content)
    changed[at + offset : at + offset + len(value)] = value
    return bytes(changed)


SIZE, FLAGS, METHOD = 24, 8, 10
"""Offsets in an entry of the directory (APPNOTE 6.3, 4.3.12)."""


def test_an_honest_workbook_passes(tmp_path):
    """Both kinds of part, stored and deflated, also beyond a piece of expansion."""
    for method in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        content = zipped(MEMBERS | {"a": noise(3 * 2**20) + b"end"}, method)
        refuse_unsafe(written(tmp_path / "good.xlsx", content))


def noise(length):
    """Return bytes that do not compress, the same each time."""
    return hashlib.shake_128(b"noise").digest(length)


def bomb(tmp_path, size, besides=0):
    """Return a file whose one member expands to `size` zeros, beside bytes that do not compress."""
    members = {"xl/bomb.xml": bytes(size)} | ({"noise": noise(besides)} if besides else {})
    return written(tmp_path / "bomb.xlsx", zipped(members))


def test_a_bomb_is_refused_by_what_is_declared(tmp_path):
    """More than 100:1 as a whole, more than 100:1 in a part of real size, or more than 512 MB."""
    with pytest.raises(InputError, match=r"^bomb\.xlsx must expand by at most 100:1; got \d+:1\."):
        refuse_unsafe(bomb(tmp_path, 5_000_000))
    path = bomb(tmp_path, 5_000_000, besides=200_000)
    assert 5_200_000 / path.stat().st_size < MOST_RATIO
    with pytest.raises(InputError, match="at most 100:1"):
        refuse_unsafe(path)
    content = patched_directory(zipped({"a": b"x"}), "a", SIZE, struct.pack("<I", MOST_BYTES + 2**20))
    with pytest.raises(InputError, match="must expand to at most 512 MB; got 513 MB"):
        refuse_unsafe(written(tmp_path / "big.xlsx", content))


def test_a_short_repetitive_part_is_not_a_bomb(tmp_path):
    """A part of less than a megabyte may exceed the ratio, as empty cells do, if the whole does not."""
    refuse_unsafe(bomb(tmp_path, 900_000, besides=20_000))


@pytest.mark.parametrize("declared", [10, 5_001])
def test_a_part_of_another_length_than_it_declares_is_refused(tmp_path, declared):
    """A part of 5 000 bytes that declares another size."""
    content = zipped({"a": b"xyz" * 1_666 + b"xy", "noise": noise(4_000)})
    path = written(tmp_path / "lies.xlsx", patched_directory(content, "a", SIZE, struct.pack("<I", declared)))
    with pytest.raises(InputError, match="not of the length or checksum it declares"):
        refuse_unsafe(path)


def test_a_hidden_bomb_is_expanded_by_one_piece_at_most(tmp_path, monkeypatch):
    """40 MB behind a declared size of 1 kB."""
    content = zipped({"a": bytes(40_000_000), "noise": noise(4_000)})
    path = written(tmp_path / "hidden.xlsx", patched_directory(content, "a", SIZE, struct.pack("<I", 1_000)))
    sizes = []
    usual = workbook_files.zlib.crc32

    def counted(piece, before=0):
        sizes.append(len(piece))
        return usual(piece, before)

    monkeypatch.setattr(workbook_files.zlib, "crc32", counted)
    with pytest.raises(InputError, match="not of the length"):
        refuse_unsafe(path)
    assert 0 < sum(sizes) <= workbook_files.PIECE


GOOD = zipped(MEMBERS)
WRONG = {
    "text": (b"time;friction\n", "is not a readable workbook: File is not a zip file. Open"),
    "cut short": (GOOD[:-30], "is not a readable workbook"),
    "without directory": (GOOD[: GOOD.find(b"PK\x01\x02")], "is not a readable workbook"),
    "two of a name": (zipped({"xl/a.xml": b"1", "XL/A.xml": b"2"}), "two parts of the same name"),
    "encrypted": (patched_directory(GOOD, "one.xml", FLAGS, b"\x01\x00"), "is encrypted"),
    "strong encryption": (patched_directory(GOOD, "one.xml", FLAGS, b"\x40\x00"), "is encrypted"),
    "bzip2": (patched_directory(GOOD, "one.xml", METHOD, b"\x0c\x00"), "that workbooks do not use"),
}


@pytest.mark.parametrize(("content", "words"), WRONG.values(), ids=WRONG)
def test_a_wrong_archive_is_refused_in_one_line(tmp_path, content, words):
    """Each breaks one rule; the refusal says which, with the name of the file, on one line."""
    with pytest.raises(InputError) as refusal:
        refuse_unsafe(written(tmp_path / "case.xlsx", content))
    text = str(refusal.value)
    assert text.startswith("case.xlsx ")
    assert words in text
    assert "\n" not in text


def test_too_many_parts_are_refused(tmp_path, monkeypatch):
    """A workbook has hundreds at most."""
    monkeypatch.setattr(workbook_files, "MOST_PARTS", 1)
    with pytest.raises(InputError, match="at most 1 parts; got 2"):
        refuse_unsafe(written(tmp_path / "many.xlsx", GOOD))


def test_a_fault_of_ours_is_not_one_of_the_workbook(tmp_path, monkeypatch):
    """A TypeError in our own code is raised; the same from inside of a damaged workbook is a refusal."""
    path = tmp_path / "study.xlsx"
    path.write_bytes(workbook({"bearing": [["key", "value"], ["ball_count", 13]]}))
    monkeypatch.setattr("separatrix.ground.workbook.COLUMNS", None)
    with pytest.raises(TypeError):
        read_study(path)
