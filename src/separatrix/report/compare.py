"""Text for two simulations side by side."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from separatrix.report.tables import ABSENT, heading, paragraph, quantity, section, significant, table

Document = Mapping[str, Any]

ROWS = (
    ("kick", "m/s"),
    ("energy_growth", "-"),
    ("largest_offset", "m"),
    ("largest_contact_force", "N"),
)


def compare(document: Document, folder: Path | None) -> str:
    """Return the two runs in columns, and the inputs that differ."""
    runs = document["runs"]
    rows = [[name.replace("_", " "), *(quantity(run.get(name), unit) for run in runs)] for name, unit in ROWS]
    rows += [[name, *(str(run.get(name, ABSENT)) for run in runs)] for name in ("run", "seed", "outcome")]
    blocks = [
        heading(" / ".join(run["title"] for run in runs)),
        section("Runs", table(("", "first", "second"), rows)),
        section("Inputs that differ", _differences(document["differences"])),
    ]
    if folder is not None:
        blocks.append(f"Figure and data are in {folder}/")
    return "\n\n".join(blocks) + "\n"


def _differences(found: list[Document]) -> str:
    if not found:
        return paragraph("None.")
    rows = [[at["key"], _value(at, "first"), _value(at, "second")] for at in found]
    return table(("", "first", "second"), rows)


def _value(at: Document, which: str) -> str:
    value = at[which]
    if isinstance(value, float) and at["unit"]:
        return quantity(value, at["unit"])
    return significant(value) if isinstance(value, float) else ABSENT if value is None else str(value)
