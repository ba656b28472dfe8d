"""A measured profile of a worn film: a CSV file of two columns, whose head has the units."""

from __future__ import annotations

import csv
import re
from pathlib import Path
from typing import Any, NamedTuple

from separatrix.ground.errors import InputError, noted, together
from separatrix.ground.reader import Elsewhere, Reading
from separatrix.ground.toml import KeyPath, Kind, path_text, text
from separatrix.ground.units import Metre, parse, shown

MOST_PLACES = 10_000
HEADS = ("y", "thickness")
_CURE = 'Write its first row like "y [mm],thickness [um]".'
_HEAD = re.compile(r"\s*(\w+)\s*\[([^\]]+)\]\s*")
PROFILE = Kind(noun="a profile of a film", most_bytes=5_000_000, empty=_CURE)


class Profile(NamedTuple):
    """Thickness of a film at places across its track."""

    across: tuple[Metre, ...]
    thicknesses: tuple[Metre, ...]


def read_profile(raw: Any, path: KeyPath, reading: Reading) -> Profile:
    """Profile of the file that a study names."""
    name = text(raw, "")
    content = reading.document.file(path, name, PROFILE)
    if content is None:
        cure = "It is looked for in the folder of the study."
        raise InputError("", "does not name a file", shown(Path(name).name), cure)
    try:
        return profile_of(content, path_text(Path(name)))
    except InputError as error:
        raise Elsewhere(error) from None


def profile_of(content: str, label: str) -> Profile:
    """Profile of the text of a table of two columns."""
    lines = enumerate(content.splitlines(), start=1)
    rows = [(n, row) for n, line in lines if (row := next(csv.reader([line]), []))]
    heads = [_HEAD.fullmatch(cell) for cell in rows[0][1]] if rows else []
    found = {head[1].casefold(): (i, head[2]) for i, head in enumerate(heads) if head is not None}
    if set(found) != set(HEADS) or len(heads) != len(HEADS):
        raise InputError(f"{label}, line 1", "must name two columns, y and thickness", cure=_CURE)
    if len(rows) - 1 > MOST_PLACES:
        raise InputError(label, f"must have at most {MOST_PLACES} rows", f"{len(rows) - 1}")
    columns: dict[str, list[float]] = {name: [] for name in HEADS}
    problems: list[InputError] = []
    for line, row in rows[1:]:
        with noted(problems):
            at = f"{label}, line {line}"
            if len(row) != len(HEADS):
                raise InputError(at, "must have two cells", f"{len(row)}")
            for name, (i, unit) in found.items():
                columns[name].append(parse(f"{row[i].strip()} {unit}", "m", f"{at}: {name}"))
    if problems:
        raise together(problems)
    return Profile(tuple(columns["y"]), tuple(columns["thickness"]))
