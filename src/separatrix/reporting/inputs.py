"""Inputs with their sources and confidence, and the provenance of the answers."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping

from separatrix.present.text.tables import ABSENT, number
from separatrix.reporting.kept import Kept
from separatrix.reporting.record import Block, Paragraph, Row, Section, Table, entry, facts

SECTIONS = ("bearing", "operation", "kinematics", "film", "traction", "cage", "stability")
PROPERTIES = {
    "elastic_modulus": "elastic modulus",
    "poisson_ratio": "Poisson's ratio",
    "density": "density",
    "compressive_strength": "compressive strength",
}


def inputs(kept: Mapping[str, Kept]) -> Section:
    """Return every input of the study with where it was given, and materials and frictions with sources."""
    study = next(iter(kept.values())).document["study"]
    rows = [row for section in SECTIONS for row in _rows(section, study.get(section) or {})]
    blocks: list[Block] = [Table(("input", "value", "given in"), tuple(rows), "Inputs of the study.", left=3)]
    materials = tuple(dict.fromkeys(_materials(study)))
    if materials:
        head = ("material", "property", "value", "confidence", "source")
        blocks.append(Table(head, materials, "Materials, at the temperature of the study.", left=5))
    if study.get("ranking"):
        blocks += _frictions(study["ranking"])
    return Section("Inputs and their sources", tuple(blocks))


def _rows(section: str, items: Row) -> Iterator[tuple[str, ...]]:
    for key, item in items.items():
        if not isinstance(item, dict) or "origin" not in item:
            continue
        value = str(item["name"]) if "name" in item else entry(item)
        if "distribution" in item:
            value += f" ({item['distribution']['words']})"
        yield f"{section}: {key.replace('_', ' ')}", value, str(item["origin"])


def _materials(study: Row) -> Iterator[tuple[str, ...]]:
    sections = [study.get(name) or {} for name in ("bearing", "film", "cage")]
    found = [one.get(key) for one in sections for key in ("ball_material", "ring_material", "material")]
    found += [one.get("material") for one in (study.get("ranking") or {}).get("candidates", [])]
    for one in found:
        if not isinstance(one, dict) or not one.get("name"):
            continue
        record = one.get("record") or {}
        for key, words in PROPERTIES.items():
            value = one.get(key) or {}
            if value.get("value") is None:
                continue
            place = (record.get("taken") or {}).get(key)
            taken = record["data"][key][place] if place is not None else {}
            source, confidence = taken.get("source"), taken.get("confidence")
            known = (confidence or one.get("confidence"), source or one.get("source"))
            yield str(one["name"]), words, entry(value), *(str(text or ABSENT) for text in known)


def _frictions(ranking: Row) -> Iterator[Block]:
    names = ranking["environments"]
    rows = []
    for one in ranking["candidates"]:
        cells = []
        for name in names:
            friction = one["friction"].get(name)
            spread = (friction or {}).get("standard_deviation")
            known = "not measured" if friction is None else number(friction["mean"])
            cells.append(known + (f" \u00b1 {spread:.2g}" if spread else ""))
        rows.append((str(one["name"]), *cells))
    caption = (
        f"Friction of the candidates as measured: mean, and standard deviation. From {ranking['origin']}."
    )
    yield Table(("candidate", *map(str, names)), tuple(rows), caption)
    sources = dict.fromkeys(
        f"{one['source']} ({one['confidence']})"
        for candidate in ranking["candidates"]
        for one in candidate["friction"].values()
        if one is not None
    )
    for source in sources:
        yield Paragraph(f"Source of the frictions: {source}.")


def provenance(kept: Mapping[str, Kept]) -> Section:
    """Return version, seed, command and checksums: what one needs to compute the answers again."""
    first = next(iter(kept.values())).document
    blocks: list[Block] = [
        facts(
            ("Study", f"{first['name']}: {first['title']}"),
            ("Version of separatrix", _each(kept, "separatrix_version")),
            ("Seed", _each(kept, "seed")),
        )
    ]
    commands = [(verb, _command(verb, one.document)) for verb, one in kept.items()]
    blocks.append(Table(("answer", "command"), tuple(commands), "Answers in this report.", left=2))
    known = first.get("provenance") or {}
    if known.get("versions"):
        blocks.append(facts(*((str(key), str(value)) for key, value in known["versions"].items())))
    files = {str(name): str(one.get("sha256") or "") for name, one in (known.get("files") or {}).items()}
    files = files or dict(_libraries(first["study"]))
    if files:
        head = ("file", "SHA-256")
        blocks.append(Table(head, tuple(files.items()), "Files that the study was read from.", left=2))
    return Section("Provenance", tuple(blocks))


def _each(kept: Mapping[str, Kept], key: str) -> str:
    return ", ".join(sorted({str(one.document[key]) for one in kept.values()}))


def _command(verb: str, document: Row) -> str:
    kept = document.get("provenance") or {}
    asked, entry = kept.get("command") or {}, str(kept.get("entry") or "")
    study = document["name"] if entry.startswith("shipped:") or not entry else entry
    given = {**(asked.get("question") or {}), **(asked.get("models") or {})}
    options: list[str] = []
    for key, value in given.items():
        flag = f"--{key.replace('_', '-')}"
        for one in value if isinstance(value, list) else [value]:
            if one not in (None, False):
                options += [flag] if one is True else [flag, shlex.quote(str(one))]
    return " ".join(["separatrix", verb, shlex.quote(str(study)), *options])


def _libraries(entry_of: object) -> Iterator[tuple[str, str]]:
    """Yield name and checksum of each library file behind a study."""
    if isinstance(entry_of, list):
        for one in entry_of:
            yield from _libraries(one)
    if isinstance(entry_of, dict):
        library = entry_of.get("library")
        if isinstance(library, dict) and library.get("sha256"):
            shipped = " (shipped with this version)" if library.get("shipped") else ""
            yield f"{library['file']}{shipped}", str(library["sha256"])
        for one in entry_of.values():
            yield from _libraries(one)
