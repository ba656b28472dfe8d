"""Adding records to a library file of the user: appended, checked as a whole, put in place at once."""

from __future__ import annotations

import json
import re
import shutil
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from separatrix.errors import InputError
from separatrix.library.collection import ALONE, FOLDER, beside, joined
from separatrix.library.reading import LIBRARY, SECTIONS, TOP, Content, library_of_text, read_library
from separatrix.toml_text import label_of, parsed, path_text, read_text


def add_records(source: Path, library: Path) -> Content:
    """Add the records of a file to a library file, which is made if it does not exist.

    What the library holds already stays as it is, byte for byte; the records of `source` are appended in one
    plain form. The whole is checked before it takes the place of the old file, at once or not at all.

    Returns
    -------
    Content
        What was added.

    Raises
    ------
    InputError
        Either file is wrong, a name exists already, or the library cannot be written.
    """
    target = _target(library, source)
    label, added = label_of(target), read_library(source)
    before = read_text(target, LIBRARY) if target.exists() else ""
    held = []
    if re.sub(r"#[^\n]*", "", before).strip() and not parsed(before, label, LIBRARY)[0].keys() <= set(TOP):
        held = [library_of_text(before, label)]  # more than comments and a title: it must be right as it is
    in_folder = target.parent.name == FOLDER
    others = [
        read_library(path)  # of those that a study reads together with the target
        for path in beside(target.parents[in_folder], besides=target)
        if in_folder or target.name == ALONE
    ]
    joined([*others, *held, added])
    data, _ = parsed(read_text(source, LIBRARY), label_of(source), LIBRARY)
    after = before.rstrip("\n") + ("\n\n" if before.strip() else "") + as_toml(data)
    wanted = {(record.kind, record.name) for part in (*held, added) for record in part.records}
    if {(record.kind, record.name) for record in library_of_text(after, label).records} != wanted:
        raise InputError(label, "cannot be added to: its form is unusual", cure="Add by hand.")
    try:  # write aside and rename over the target
        with tempfile.TemporaryDirectory(dir=target.parent, prefix=".separatrix-") as aside:
            new = Path(aside) / target.name
            new.write_text(after, encoding="utf-8", newline="\n")
            if target.exists():
                shutil.copymode(target, new)
            new.replace(target)
    except OSError as error:
        raise InputError(path_text(target), f"cannot be written ({error.strerror or error})") from error
    return added


def _target(library: Path, source: Path) -> Path:
    """The file to write, links followed; refused where it cannot be one of the user's libraries."""
    where = path_text(library)
    if library.is_dir():
        raise InputError(where, "is a folder", cure=f'Name a file in it: "{library / "ours.toml"}".')
    if library.suffix != ".toml":
        raise InputError(where, "must end in .toml", cure="A library is a TOML file.")
    target = library.resolve()
    if Path(__file__).resolve().parents[1] in target.parents:
        raise InputError(where, "belongs to separatrix", cure="Add to a library of your own.")
    if source.exists() and target == source.resolve():
        raise InputError(where, "is the file to add itself")
    if not target.parent.is_dir():
        raise InputError(where, "lies in a folder that does not exist", cure="Make the folder first.")
    return target


def as_toml(data: Mapping[str, Any]) -> str:
    """Records of a library file as TOML, each under its own header."""
    blocks = []
    for section in SECTIONS:
        for name, record in data.get(section, {}).items():
            header = f"{section}.{_key(name)}"
            tables = {header: {key: value for key, value in record.items() if key != "friction"}}
            tables |= {f"{header}.friction.{_key(n)}": row for n, row in record.get("friction", {}).items()}
            for title, items in tables.items():
                lines = [f"[{title}]", *(f"{_key(key)} = {_value(value)}" for key, value in items.items())]
                blocks.append("\n".join([*lines, ""]))
    return "\n".join(blocks)


def _key(key: str) -> str:
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else _value(key)


def _value(value: Any) -> str:
    if isinstance(value, bool | str):  # what JSON escapes, TOML escapes alike
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, dict):
        return f"{{ {', '.join(f'{_key(key)} = {_value(item)}' for key, item in value.items())} }}"
    if isinstance(value, list) and any(isinstance(item, dict) for item in value):
        return "\n".join(["[", *(f"  {_value(item)}," for item in value), "]"])
    return f"[{', '.join(map(_value, value))}]" if isinstance(value, list) else repr(value)
