"""How far an answer can be trusted, by the factors of NASA-STD-7009B (docs/credibility.md).

The levels of the program are data, `credibility.toml`; what a study adds is counted in its answers.
"""

from __future__ import annotations

import re
import tomllib
from collections import Counter
from collections.abc import Iterator, Mapping
from functools import cache, partial
from importlib.resources import files
from operator import itemgetter
from typing import Any

from separatrix.ground.document import Document
from separatrix.present.blocks import Block, Heading, Level, Table, facts, text_column

FACTORS = {
    "data_pedigree": "data pedigree",
    "verification": "verification",
    "validation": "validation",
    "development_review": "technical review",
    "development_process": "process",
}
"""Factors of a program's development, as the standard names them."""

CAPTION = (
    "Levels 0 to 4 of NASA-STD-7009B that the developers claim, assessed by nobody else; 0 is "
    "insufficient evidence. What each rests on, and what is missing: the documentation, page Credibility."
)

Json = Mapping[str, Any]


@cache
def claims() -> tuple[Json, ...]:
    """Return the claims of each part of the program: by factor its level, evidence, and what is missing."""
    found = tomllib.loads((files(__package__) / "credibility.toml").read_text(encoding="utf-8"))
    return tuple(found["whole"] | part for part in found["part"])


def credibility(documents: Mapping[str, Document]) -> list[Block]:
    """Return the levels of the program, and what the answers to one study add to them."""
    study = next(iter(documents.values()))["study"]
    levels = (text_column(words, partial(_level, key)) for key, words in FACTORS.items())
    columns = (text_column("part", itemgetter("name")), *levels)
    notes = {text for one in documents.values() for text in one["warnings"]}
    uncertain = ", ".join(one["name"] for one in study["uncertain_inputs"])
    varied = ", ".join(f"`{verb}`" for verb in ("sensitivity", "sweep", "map") if verb in documents)
    outside = f"{len(notes) or 'no'} notes on what is outside its range"
    return [
        Heading("Credibility", Level.REPORT),
        Table("credibility", columns, claims(), CAPTION, Level.REPORT),
        facts(
            ("Input pedigree", _pedigree(study)),
            ("Use assessment", outside + _extrapolated(documents.get("rank", {}))),
            ("Uncertain inputs", uncertain or "none is stated: intervals are counting noise"),
            ("Results robustness", f"varied by {varied}" if varied else "no input was varied"),
            ("Technical review", "of this use: to be stated by whoever uses the answer"),
            level=Level.REPORT,
        ),
    ]


def _level(factor: str, row: Json) -> int:
    return int(row[factor]["level"])


def _pedigree(study: Json) -> str:
    """How many inputs are stated or assumed, and how sure the numbers of materials and frictions are."""
    from separatrix.study.sources import inputs_of

    origins = [str(entry["origin"]) for *_, entry in inputs_of(study) if entry.get("value") not in (None, [])]
    assumed = sum(one.startswith("default") for one in origins)
    known = ", ".join(f"{count} {word}" for word, count in Counter(_confidences(study)).most_common())
    return f"{len(origins) - assumed} inputs stated, {assumed} by default; materials and frictions: {known}"


def _confidences(part: Any) -> Iterator[str]:
    """Yield how sure each number of the study's materials and frictions is; not the rest of their records."""
    from separatrix.study.library import CONFIDENCES

    if isinstance(part, Mapping):
        words = re.findall(r"\w+", str(part.get("confidence") or ""))
        yield from (word for word in words if word in CONFIDENCES)
        part = [one for key, one in part.items() if key not in ("record", "table", "other_tests")]
    for one in part if isinstance(part, list) else ():
        yield from _confidences(one)


def _extrapolated(ranked: Json) -> str:
    """In how many rows of a ranking the friction is extrapolated."""
    places = (one for one in ranked.get("environments", ()) if one["name"] == ranked["environment"])
    found = [row["extrapolation"] for one in places for row in one["materials"] if "extrapolation" in row]
    beyond = sum(map(bool, found))
    return f"; the friction of {beyond} of {len(found)} candidates is extrapolated" if found else ""
