"""Text for two simulations, or two rankings, side by side."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from separatrix.present.text.tables import (
    ABSENT,
    facts,
    heading,
    number,
    paragraph,
    quantity,
    section,
    significant,
    table,
)

Document = Mapping[str, Any]

COLUMNS = ("friction", "margin", "P(stable)", "verdict")

ROWS = (
    ("kick", "m/s", "kick"),
    ("end_energy", "J", "energy at the end"),
    ("largest_offset", "m", "largest offset"),
    ("largest_contact_force", "N", "largest pocket force"),
    ("largest_land_force", "N", "largest land force"),
)


def compare(document: Document, folder: Path | None) -> str:
    """Return the two answers in columns, and the inputs that differ."""
    blocks = _simulations(document) if document["of"] == "simulate" else _rankings(document)
    blocks.append(section("Inputs that differ", _differences(document["differences"])))
    if folder is not None:
        what = "Figure and data" if document["of"] == "simulate" else "Text and data"
        blocks.append(f"{what} are in {folder}/")
    return "\n\n".join(blocks) + "\n"


def _simulations(document: Document) -> list[str]:
    runs = document["runs"]
    rows = [
        [words, *(quantity(run.get(name), unit) for run in runs)]
        for name, unit, words in ROWS
        if any(name in run for run in runs)
    ]
    rows += [[name, *(str(run.get(name, ABSENT)) for run in runs)] for name in ("run", "seed", "outcome")]
    return [
        heading(" / ".join(run["title"] for run in runs)),
        section("Runs", table(("", "first", "second"), rows)),
    ]


RANKED = ("material", *(f"{name}\nfirst" if i == 0 else "\nsecond" for name in COLUMNS for i in (0, 1)))


def _rankings(document: Document) -> list[str]:
    """Return friction, margin, P(stable) and verdict of each material in both rankings."""
    names = zip(("first", "second"), document["rankings"], strict=True)
    named = [(which, f"{one['title']} ({one['path']}, seed {one['seed']})") for which, one in names]
    tables = [
        section(one["name"], table(RANKED, [_ranked(row) for row in one["materials"]]))
        for one in document["environments"]
    ]
    return [heading("Two rankings"), facts(named), *tables]


def _ranked(row: Document) -> list[str]:
    pair = [row[which] or {} for which in ("first", "second")]
    return [
        row["name"],
        *(number(one.get("friction")) for one in pair),
        *(ABSENT if one.get("margin") is None else f"{one['margin']:+.2f}" for one in pair),
        *(number(one.get("probability_stable"), 2) for one in pair),
        *(one.get("verdict") or ABSENT for one in pair),
    ]


def _differences(found: list[Document]) -> str:
    if not found:
        return paragraph("None.")
    rows = [[at["key"], _value(at, "first"), _value(at, "second")] for at in found]
    return table(("", "first", "second"), rows)


def _value(at: Document, which: str) -> str:
    value = at[which]
    if isinstance(value, float) and at["unit"]:
        return quantity(value, at["unit"])
    if isinstance(value, list):
        unit = at["unit"] or "-"
        shown = [quantity(one, unit) if isinstance(one, float) else str(one) for one in value]
        return ", ".join(shown) or ABSENT
    return significant(value) if isinstance(value, float) else ABSENT if value is None else str(value)
