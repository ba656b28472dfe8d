"""The verb `compare`: two answers of one verb side by side."""

from __future__ import annotations

import json
from pathlib import Path

from separatrix.cli.console import answer
from separatrix.staged import staged, writable_folder

HELP = "Two answers of one verb side by side: what differs, and by more than counting noise?"
EPILOG = "A and B are folders of answers, their .json, .nc or .html files, of any verb with a study."


def compare(first: Path, second: Path, out: Path | None, *, as_json: bool, full: bool) -> int:
    """Compare two saved answers, draw them together, and return the exit status.

    Parameters
    ----------
    first, second : Path
        Folder of answers, or one of their files.
    out : Path or None
        Folder of the files; without it none is written with `as_json`.
    as_json : bool
        Whether to print the document instead of the tables.
    full : bool
        Every row.

    Raises
    ------
    InputError
        One of them is not an answer, they answer different questions, or the folder cannot be written.
    """
    from separatrix.comparing.pair import compared, pair_of
    from separatrix.comparing.save import comparison_document, save_comparison
    from separatrix.comparing.saved import read_answers
    from separatrix.comparing.text import in_words

    one, other, also = pair_of(read_answers(first), read_answers(second))
    found = compared(one, other, also)
    folder = out or (None if as_json else Path("compare"))
    where = "" if folder is None else f"\nText, data and figures are in {folder}/\n"
    if folder is not None:
        with writable_folder(folder), staged(folder) as stage:
            save_comparison(stage, found, one, other)
    if as_json:
        answer(json.dumps(comparison_document(found), indent=1, allow_nan=False) + "\n")
    else:
        answer(in_words(found, full=full) + where)
    return 0
