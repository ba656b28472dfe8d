"""The reader of files, on a schema of its own: every refusal is tested here, each dialect by its table."""

from collections.abc import Mapping
from enum import Enum
from typing import Annotated, ClassVar, Literal

import pytest
from commands import changed, rows_of

from separatrix.ground import toml
from separatrix.ground.errors import InputError
from separatrix.ground.reader import read_text
from separatrix.ground.schema import (
    Fault,
    Only,
    Open,
    all_or_none,
    between,
    check,
    key,
    not_negative,
    one_of,
    positive,
    record,
)
from separatrix.ground.toml import Kind
from separatrix.ground.units import Metre, Newton, Ratio


class Shape(Enum):
    """Of a pocket."""

    ROUND = "round"
    SQUARE = "square"


@record
class Given:
    """A number with its source, in the unit of the key above."""

    SHORT: ClassVar = "value"

    value: Open = key()
    source: str | None = key(default=None)


@record
class Part:
    """Every kind of a key."""

    RULES: ClassVar = (one_of("angle", "clearance", required=True), all_or_none("across", "heights"))

    size: Metre = key(positive(1e-3, 1.0), hint="As drawn.")
    angle: Ratio | None = key(between(0.0, 1.0, open_high=True), default=None, without="by the clearance")
    clearance: Metre | None = key(not_negative(1.0), default=None)
    across: tuple[Metre, ...] = key(between(-1.0, 1.0), default=(), rising=True, length=(2, 3))
    heights: tuple[Metre, ...] = key(default=(), length=(2, 3))
    shape: Shape = key(default=Shape.ROUND)
    width: Metre | None = key(default=None, only=(Only("shape", (Shape.SQUARE,), "is of a square pocket"),))
    depth: Metre | None = key(
        default=None, only=(Only("shape", (Shape.SQUARE,), "a depth has no shape", ignored=True),)
    )
    count: int = key(between(3, 9), default=3)
    start: Ratio | None = key(default=None, needs=("count", "nothing starts"))
    load: tuple[Newton, Newton] | None = key(between(0.0, 9.0), default=None)
    state: Literal["wet", "dry"] = key(default="dry")
    spare: bool = key(default=False)
    names: tuple[str, ...] = key(default=(), letters=(1, 4))


@record
class File:
    """A file of parts."""

    FILE: ClassVar = Kind(noun="a file of parts", most_bytes=6000, empty="Write a [part].")

    title: str | None = key(default=None)
    part: Part = key()
    given: Annotated[Mapping[str, Given], "-"] = key(default={}, length=(1, 2))
    modulus: Annotated[tuple[Given, ...], "Pa"] = key(
        between(1.0, 1e12), default=(), single=True, distinct=("value", "source"), example='"5 GPa"'
    )
    pieces: Annotated[tuple[Given, ...], "-"] = key(default=(), length=(1, 2))


@check(Part)
def _not_both_large(size: Metre, clearance: Metre):
    if size + clearance > 1.0:
        yield Fault("clearance", "must leave room", "Take less.")


@check(Part, after=(_not_both_large,))
def _ratio_of_sizes(size: Metre, clearance: Metre):
    if 1.0 / (1.0 - size - clearance + 1e-12) > 50.0:
        yield Fault("size", "must be smaller")


@check(File)
def _titled(file: File):
    if file.title == "no":
        yield Fault("", "has no title", got="")


BASE = """\
[part]
size = "5 mm"
angle = 0.5
"""

WRONG = r"""
size = "5 mm" => :: line 1: [part] lacks: size.
angle = 0.5 => :: line 1: [part] lacks: angle (or clearance).
angle = 0.5 => sise = 1 :: line 3: [part] sise is not a valid key. Did you mean size?
                        :: line 1: [part] lacks: angle (or clearance).
angle = 0.5 => modulus = 1 :: line 3: [part] modulus is not a valid key. Known:
                        :: line 1: [part] lacks: angle (or clearance).
angle = 0.5 => angle = 1 :: line 3: [part] angle must be >= 0 and < 1; got 1.
angle = 0.5 => angle = nan :: line 3: [part] angle must be a finite number; got nan.
angle = 0.5 => angle = "half" :: line 3: [part] angle must be a plain number
angle = 0.5 => clearance = "-1 mm" :: line 3: [part] clearance must be >= 0; got "-1 mm".
angle = 0.5 => clearance = "999 mm" :: line 3: [part] clearance must leave room; got "999 mm". Take less.
angle = 0.5 => clearance = "994 mm" :: line 2: [part] size must be smaller; got "5 mm".
5 mm => 5 :: line 2: [part] size needs a unit of length; got "5". Write "5 mm".
5 mm => 0 mm :: line 2: [part] size must be > 0; got "0 mm". As drawn.
5 mm => 5 m :: line 2: [part] size must be <= 1 m; got "5 m". As drawn.
+ clearance = "1 mm" :: line 4: [part] clearance and angle exclude each other. Give one of the two.
+ across = ["1 mm", "2 mm"] :: line 1: [part] heights is missing. Give all of across, heights, or none.
+ across = ["2 mm", "1 mm"]\nheights = ["1 mm", "1 mm"]
    :: line 4: [part] across must be strictly increasing; got 1 mm after 2 mm.
+ across = ["2 m", "1 mm"]\nheights = ["1 mm"]
    :: line 4: [part] across[1] must lie between -1 m and 1 m; got "2 m".
    :: line 5: [part] heights must have 2 to 3 items; got 1 of them.
+ across = "1 mm"\nheights = ["1 mm", "1 m", 5] :: line 4: [part] across must be a list in [brackets]
    :: line 5: [part] heights[3] needs a unit of length; got 5.
+ shape = "oval" :: line 4: [part] shape must be "round" or "square"; got "oval".
+ width = "1 mm" :: line 4: [part] width is of a square pocket; got "1 mm".
+ depth = "1 mm" :: line 4: [part] depth needs shape: a depth has no shape.
+ count = 2 :: line 4: [part] count must be a whole number from 3 to 9; got 2.
+ count = 3.5 :: line 4: [part] count must be a whole number; got 3.5.
+ start = 0.5 :: line 4: [part] start needs count: without it nothing starts. Give it, or leave both out.
+ load = ["2 N", "1 N"] :: line 4: [part] load must have the lowest value first; got 1 N after 2 N.
+ load = ["2 N", "99 N"] :: line 4: [part] load must lie between 0 and 9 N; got 99 N.
+ load = ["2 N"] :: line 4: [part] load must be one quantity, or [lowest, highest]; got 1 of them.
+ state = "Wet" :: line 4: [part] state must be "wet" or "dry"; got "Wet".
+ spare = 1 :: line 4: [part] spare must be true or false
+ names = ["a", 5, "a name"] :: line 4: [part] names[2] must be text; got 5.
    :: line 4: [part] names[3] must be one line of 1 to 4 printable characters; got "a name".
^ title = "" :: line 1: title must be one line of 1 to 200 printable
^ title = "no" :: parts.toml has no title.
^ titel = "a" :: line 1: titel is not a key of a file of parts. Did you mean title?
^ part2 = {} :: line 1: [part2] is not a section of a file of parts. Did you mean part?
^ given = 5 :: line 1: given must be a table of names with their values; got 5.
^ given = {} :: line 1: [given] must have 1 to 2 names; got 0 of them.
^ given = { a = 1, " b" = 2 } :: line 1: [given]  b, its name, must not begin or end with a space; got " b".
^ given = { a = { valu = 1 } } :: line 1: [given] a.valu is not a valid key. Did you mean value?
^ given = { a = [1] } :: line 1: [given] a must be a table with value; got a list.
^ modulus = "5 mm" :: line 1: modulus.value needs a unit of pressure or modulus
^ modulus = "0 GPa" :: line 1: modulus.value must lie between 1 Pa and 1000 GPa; got "0 GPa".
^ modulus = ["1 GPa", "1 GPa"] :: line 1: modulus has two with the same value and source.
^ pieces = [1, 2, 3] :: line 1: pieces must have 1 to 2 items; got 3 of them.
^ size = 0,5 :: line 1 is not valid TOML: expected newline
"""
"""A change of the file, one added behind or (^) before it, and each line of the refusal, without the file."""


@pytest.mark.parametrize(("change", "lines"), rows_of(WRONG))
def test_every_mistake_is_a_line_with_place_rule_value_and_cure(change, lines):
    """No more, no fewer."""
    with pytest.raises(InputError) as refused:
        read_text(File, changed(BASE, change), "parts.toml")
    found = sorted(line.replace("parts.toml, ", "", 1) for line in str(refused.value).splitlines())
    assert len(found) == len(lines), found
    for line, start in zip(found, sorted(lines), strict=True):
        assert line.startswith(start)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "parts.toml is empty. Write a [part]."),
        ("# nothing\n", "is empty"),
        (BASE + "angle = 1\n", "parts.toml, line 4 has angle a second time"),
        ("[part\n", "parts.toml, line 1 is not valid TOML"),
        ("[part]\nsize = " + "[" * 40, "parts.toml, line 2 nests brackets more than 16 deep"),
        (BASE + "# " + "x" * 4001, "parts.toml, line 4 is longer than 4000 characters"),
        (BASE + "# \0", "parts.toml, line 4 contains a NUL character"),
        (BASE + "# x\n" * 2000, "parts.toml is larger than a file of parts can be, 5 kB"),
        (BASE + "# \xff", "parts.toml, line 4 is not UTF-8 text"),
    ],
)
def test_a_file_that_cannot_be_read_at_all_is_refused_in_one_line(tmp_path, text, words):
    """Before any key is looked at."""
    (tmp_path / "parts.toml").write_bytes(text.encode("latin-1"))
    with pytest.raises(InputError) as refused:
        read_text(File, toml.read_text(tmp_path / "parts.toml", File.FILE), "parts.toml")
    assert str(refused.value).startswith(words) or words in str(refused.value)


def test_a_right_file_has_the_place_of_every_value_and_notes():
    """A key without effect is noted and takes its default."""
    text = BASE + 'shape = "Round"\ndepth = "1 mm"\n[given.a]\nvalue = 1\n'
    loaded = read_text(File, text, "parts.toml")
    assert loaded.value == File(part=Part(size=0.005, angle=0.5), given={"a": Given(value=1.0)})
    assert loaded.places["part", "size"] == "parts.toml, line 2"
    assert ("part", "clearance") not in loaded.places
    assert loaded.places["given", "a", "value"] == "parts.toml, line 7"
    assert loaded.notes == ('parts.toml, line 5: [part] depth: not used, because shape is "Round".',)
    assert read_text(File, 'modulus = "5 GPa"\n' + BASE, "").value.modulus == (Given(value=5e9),)


def test_a_record_built_in_python_checks_itself():
    """By the rules of the file, under its own name; a text becomes the number in SI."""
    part = Part(size="5 mm", clearance=0.0, across=("1 mm", 0.5), heights=("1 mm", 2.0))
    assert (part.size, part.across) == (0.005, (0.001, 0.5))
    with pytest.raises(InputError) as refused:
        Part(size="5 N", angle=2.0, names=("a name",), count=True, shape="round")
    assert sorted(one.path for one in refused.value.problems) == [
        "Part.angle", "Part.count", "Part.names[1]", "Part.shape", "Part.size",
    ]  # fmt: skip


def test_a_file_of_mistakes_is_not_read_to_its_end():
    """A hundred lines, and one that states it."""
    text = "".join(f"a{i} = 1\n" for i in range(300)) + BASE
    with pytest.raises(InputError, match="was not read to its end: it has more than 100 mistakes") as refused:
        read_text(File, text, "parts.toml")
    assert len(refused.value.problems) == 101
