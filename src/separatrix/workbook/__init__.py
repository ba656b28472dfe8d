"""The answer of a ranking as a workbook, made from the saved document alone."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

__all__ = ["results_workbook"]


def results_workbook(document: Mapping[str, Any], path: Path) -> None:
    """Write a ranking, as `rank.json` holds it, as a workbook.

    One sheet for all environments and one for each, the stability curve, the evidence of the verdicts, the
    inputs with where each was given, the materials and frictions with their sources, and what made the
    answer. The same document gives the same bytes.

    Parameters
    ----------
    document : mapping
        What ``separatrix rank --json`` prints.
    path : Path
        The file to write.
    """
    from separatrix.workbook import about, curve, inputs, materials, ranking
    from separatrix.workbook_looks import new_workbook, workbook_bytes

    book = new_workbook()
    ranking.add(book, document)
    curve.add(book, document)
    ranking.add_evidence(book, document)
    inputs.add(book, document)
    materials.add(book, document)
    about.add(book, document)
    path.write_bytes(workbook_bytes(book))
