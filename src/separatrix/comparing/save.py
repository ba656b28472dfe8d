"""The files of a comparison: its document, text and figures."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from separatrix.comparing.drawing import pictures
from separatrix.comparing.records import Comparison
from separatrix.comparing.saved import Saved
from separatrix.comparing.text import in_words
from separatrix.figures import save_all
from separatrix.messages import harmless
from separatrix.present import plain


def comparison_document(found: Comparison) -> dict[str, Any]:
    """Return a comparison as plain data, as ``--json`` prints it."""
    from separatrix import __version__
    from separatrix.present.json import null_if_not_finite

    with null_if_not_finite():
        return {"separatrix_version": __version__, "verb": "compare", **plain(found)}


def save_comparison(folder: Path, found: Comparison, first: Saved, second: Saved) -> None:
    """Write compare.json, compare.txt with every row, and the figures, where both have their arrays."""
    text = json.dumps(comparison_document(found), indent=1, allow_nan=False) + "\n"
    (folder / "compare.json").write_text(text, encoding="utf-8")
    (folder / "compare.txt").write_text(harmless(in_words(found, full=True)), encoding="utf-8")
    save_all(pictures(first, second), folder)
