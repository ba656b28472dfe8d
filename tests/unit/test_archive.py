"""Zip containers are judged by their directory; what is expanded never exceeds what it declared."""

import hashlib
import io
import struct
import zipfile

import pytest
from minimal_xlsx import zipped

from separatrix import archive
from separatrix.archive import MOST_BYTES, MOST_RATIO, open_archive
from separatrix.errors import InputError

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


SIZE, PACKED, FLAGS, METHOD, LOCAL = 24, 20, 8, 10, 42
"""Offsets in an entry of the directory (APPNOTE 6.3, 4.3.12)."""


def test_an_honest_archive_is_read_whole(tmp_path):
    """Both kinds of member, stored and deflated, come back byte for byte."""
    for method in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        found = open_archive(written(tmp_path / "good.xlsx", zipped(MEMBERS, method)))
        assert {name: found.read(name) for name in found.members} == MEMBERS


def test_a_large_member_comes_in_pieces(tmp_path):
    """No piece of a member is longer than `PIECE`, whatever its ratio; together they are the member."""
    content = noise(3 * archive.PIECE) + b"end"
    found = open_archive(written(tmp_path / "large.xlsx", zipped({"a": content})))
    pieces = list(found.pieces("a"))
    assert max(map(len, pieces)) <= archive.PIECE
    assert b"".join(pieces) == content


def noise(length):
    """Return bytes that do not compress, the same each time."""
    return hashlib.shake_128(b"noise").digest(length)


def bomb(tmp_path, size, besides=0):
    """Return a file whose one member expands to `size` zeros, beside bytes that do not compress."""
    members = {"xl/bomb.xml": bytes(size)} | ({"noise": noise(besides)} if besides else {})
    return written(tmp_path / "bomb.xlsx", zipped(members))


def test_a_bomb_is_refused_before_anything_is_expanded(tmp_path, monkeypatch):
    """More than 100:1 as a whole is refused by the directory alone."""
    monkeypatch.setattr(archive, "_expanded", None)
    with pytest.raises(InputError, match=r"^bomb\.xlsx would expand by more than 100:1.*; got \d+:1\."):
        open_archive(bomb(tmp_path, 5_000_000))


def test_a_bomb_among_honest_members_is_refused(tmp_path):
    """A member of real size keeps the ratio by itself, though the whole does."""
    path = bomb(tmp_path, 5_000_000, besides=200_000)
    assert 5_200_000 / path.stat().st_size < MOST_RATIO
    with pytest.raises(InputError, match=r"more than 100:1 in its part xl/bomb\.xml"):
        open_archive(path)


def test_a_short_repetitive_member_is_no_bomb(tmp_path):
    """A part of less than a megabyte may exceed the ratio, as empty cells do, if the whole does not."""
    assert open_archive(bomb(tmp_path, 900_000, besides=20_000)).read("xl/bomb.xml") == bytes(900_000)


def test_more_than_the_limit_is_refused_by_what_is_declared(tmp_path):
    """512 MB is the most that members may declare together, whatever the ratio."""
    content = patched_directory(zipped({"a": b"x"}), "a", SIZE, struct.pack("<I", MOST_BYTES + 2**20))
    with pytest.raises(InputError, match="would expand to more than 512 MB; got 513 MB"):
        open_archive(written(tmp_path / "big.xlsx", content))


@pytest.mark.parametrize("declared", [10, 5_000, 5_001, 100_000])
def test_a_member_is_never_read_beyond_what_it_declares(tmp_path, declared):
    """A member of 5 000 bytes that declares another size is refused; no more than a piece was expanded."""
    content = zipped({"a": b"xyz" * 1_666 + b"xy", "noise": noise(4_000)})
    content = patched_directory(content, "a", SIZE, struct.pack("<I", declared))
    found = open_archive(written(tmp_path / "lies.xlsx", content))
    if declared == 5_000:
        assert len(found.read("a")) == declared
        return
    with pytest.raises(InputError, match=f"is not of the {declared} bytes it declares"):
        found.read("a")


def test_a_hidden_bomb_stops_at_the_first_piece(tmp_path, monkeypatch):
    """40 MB behind a declared size of 1 kB: what is expanded before the refusal is one piece at most."""
    content = zipped({"a": bytes(40_000_000), "noise": noise(4_000)})
    content = patched_directory(content, "a", SIZE, struct.pack("<I", 1_000))
    sizes = []
    usual = archive._Inflate.__call__

    def counted(engine, packed):
        for piece in usual(engine, packed):
            sizes.append(len(piece))
            yield piece

    monkeypatch.setattr(archive._Inflate, "__call__", counted)
    found = open_archive(written(tmp_path / "hidden.xlsx", content))
    with pytest.raises(InputError, match="is not of the 1000 bytes"):
        found.read("a")
    assert sum(sizes) <= archive.PIECE


def twice() -> bytes:
    """Return a zip with two members whose names differ in case only."""
    return zipped({"xl/a.xml": b"1", "XL/A.xml": b"2"})


def overlapping() -> bytes:
    """Return a zip whose second member stands where the first one does."""
    return patched_directory(zipped({"a": b"12345", "b": b"12345"}), "b", LOCAL, struct.pack("<I", 0))


GOOD = zipped(MEMBERS)
WRONG = [
    ("text", b"time;friction\n", "case.xlsx is not a zip file, which a workbook is. Open"),
    ("empty", b"", "is not a zip file"),
    ("cut short", GOOD[:-30], "damaged zip file"),
    ("without directory", GOOD[: GOOD.find(b"PK\x01\x02")], "its directory is missing"),
    ("absolute name", zipped({"/etc/passwd": b"x"}), 'leads out of it; got "/etc/passwd"'),
    ("name of a drive", zipped({"C:/x": b"x"}), "leads out of it"),
    ("name that climbs", zipped({"xl/../../x": b"x"}), "leads out of it"),
    ("backslashes", zipped({"xl\\..\\x": b"x"}), "leads out of it"),
    ("control character in a name", zipped({"xl/\x07.xml": b"x"}), "leads out of it"),
    ("two of a name", twice(), "two parts of the same name"),
    ("overlap", overlapping(), "overlap"),
    ("encrypted", patched_directory(GOOD, "one.xml", FLAGS, b"\x01\x00"), "is encrypted"),
    ("strong encryption", patched_directory(GOOD, "one.xml", FLAGS, b"\x40\x00"), "is encrypted"),
    ("bzip2", patched_directory(GOOD, "one.xml", METHOD, b"\x0c\x00"), "compression that no workbook has"),
    ("archive inside", zipped({"xl/embeddings/a.zip": b"PK"}), "holds another archive"),
    ("workbook inside", zipped({"xl/embeddings/Sheet1.xlsx": b"PK"}), "holds another archive"),
]


@pytest.mark.parametrize(("content", "words"), [case[1:] for case in WRONG], ids=[case[0] for case in WRONG])
def test_a_wrong_archive_is_refused_in_one_line(tmp_path, content, words):
    """Each breaks one rule; the refusal says which, with the name of the file, on one line."""
    with pytest.raises(InputError) as refusal:
        open_archive(written(tmp_path / "case.xlsx", content))
    text = str(refusal.value)
    assert text.startswith("case.xlsx ")
    assert words in text
    assert "\n" not in text


@pytest.mark.parametrize("name", ["one.xml", "folder/two.xml"])
def test_a_damaged_member_is_refused_when_it_is_read(tmp_path, name):
    """A byte changed inside a deflated member is found by its checksum or by the expansion itself."""
    info = zipfile.ZipFile(io.BytesIO(GOOD)).getinfo(name)
    changed = bytearray(GOOD)
    changed[info.header_offset + 30 + len(name) + info.compress_size // 2] ^= 0xFF
    found = open_archive(written(tmp_path / "case.xlsx", bytes(changed)))
    with pytest.raises(InputError, match=r"damaged"):
        found.read(name)


def test_too_many_members_are_refused_before_the_directory_is_read(tmp_path, monkeypatch):
    """The end record's count and length are looked at first."""
    monkeypatch.setattr(zipfile, "ZipFile", None)
    content = bytearray(GOOD)
    end = content.rfind(b"PK\x05\x06")
    content[end + 10 : end + 12] = struct.pack("<H", 20_000)
    with pytest.raises(InputError, match="more than 10000 parts; got 20000"):
        open_archive(written(tmp_path / "many.xlsx", bytes(content)))


def test_a_missing_part_is_named(tmp_path):
    """Asking for a part that is not there is a refusal, not a KeyError."""
    with pytest.raises(InputError, match=r"lacks its part xl/workbook\.xml"):
        open_archive(written(tmp_path / "good.xlsx", GOOD)).read("xl/workbook.xml")
