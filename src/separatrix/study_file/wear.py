"""Reader of [film.wear]: a band, or a measured profile of thickness in the study or in a CSV file."""

from __future__ import annotations

import csv
import re
from pathlib import Path
from typing import Any

from separatrix.errors import InputError, noted, together
from separatrix.film_design import MOST_PLACES, Wear, Worn
from separatrix.input_files import place
from separatrix.study_file import values
from separatrix.toml_files import (
    Kind,
    Reader,
    build,
    choice,
    list_of,
    path_text,
    quantity,
    read_text,
    table,
    text,
)
from separatrix.units import parse, shown

_CURE = 'Write its first row like "y [mm],thickness [um]".'
PROFILE = Kind(noun="a profile of a film", most_bytes=5_000_000, empty=_CURE)
HEADS = ("y", "thickness")
_HEAD = re.compile(r"\s*(\w+)\s*\[([^\]]+)\]\s*")

_READERS: dict[str, Reader] = {
    "friction": values.number("-"),
    "width": values.number("m"),
    "share": values.number("-"),
    "thickness": values.number("m"),
    "across": list_of(quantity("m")),
    "thicknesses": list_of(quantity("m")),
    "profile": text,
    "races": choice(Worn),
}


def wear(value: Any, where: str) -> Any:
    """Read the wear of a film, as `Uncertain` if a number of it is."""
    given, found = values.gathered(table(value, where, _READERS, ("friction",), "[film.wear]"))
    if "profile" in given:
        if {"across", "thicknesses"} & given.keys():
            rule = "and across with thicknesses exclude each other"
            raise InputError(f"{where}.profile", rule, cure="Give one of the two.")
        given["across"], given["thicknesses"] = read_profile(
            place(values.current_folder(), given.pop("profile")), f"{where}.profile"
        )
    made = build(Wear, given, where)
    return values.Uncertain(made, found) if found else made


def read_profile(path: Path, where: str) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Places across the groove and thicknesses there, of a table of two columns with their units [m].

    Raises
    ------
    InputError
        It is not there, or is not such a table: a line for each mistake.
    """
    if not path.is_file():
        cure = "It is looked for in the folder of the study."
        raise InputError(where, "does not name a file", shown(str(path.name)), cure)
    lines = enumerate(read_text(path, PROFILE).splitlines(), start=1)
    rows = [(number, row) for number, row in ((n, next(csv.reader([line]), [])) for n, line in lines) if row]
    label = path_text(path)
    heads = [_HEAD.fullmatch(cell) for cell in rows[0][1]] if rows else []
    found = {head[1].casefold(): (i, head[2]) for i, head in enumerate(heads) if head is not None}
    if set(found) != set(HEADS) or len(heads) != len(HEADS):
        raise InputError(f"{label}, line 1", "must name two columns, y and thickness", cure=_CURE)
    if len(rows) - 1 > MOST_PLACES:
        raise InputError(label, f"must have at most {MOST_PLACES} rows", f"{len(rows) - 1}")
    columns: dict[str, list[float]] = {name: [] for name in HEADS}
    problems: list[InputError] = []
    for number, row in rows[1:]:
        with noted(problems):
            at = f"{label}, line {number}"
            if len(row) != len(HEADS):
                raise InputError(at, "must have two cells", f"{len(row)}")
            for name, (i, unit) in found.items():
                columns[name].append(parse(f"{row[i].strip()} {unit}", "m", f"{at}: {name}"))
    if problems:
        raise together(problems)
    return tuple(columns["y"]), tuple(columns["thickness"])
