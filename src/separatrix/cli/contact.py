"""The verb `contact`: one contact without a bearing, from a file of its own."""

from __future__ import annotations

import contextlib
import json
from pathlib import Path
from typing import TYPE_CHECKING

from separatrix.cli.console import answer, progress_bar
from separatrix.messages import harmless
from separatrix.staged import staged, writable_folder

if TYPE_CHECKING:
    from separatrix.contact_file.question import ContactAnswer

HELP = "Tractions and slip of one rolling contact, without a bearing."
EPILOG = (
    "FILE is a contact file (TOML), or an input file of CONTACT, module 3, whose name ends in .inp. A case "
    "that does not converge is a row with its reason."
)
FILE_HELP = "A contact file, or an input file of CONTACT (.inp)."
OUT_HELP = "Folder for figures and data [default: named after FILE; none with --json]."


def contact(path: Path, folder: Path | None, *, as_json: bool, quiet: bool) -> int:
    """Read, solve, print and write one contact; return the exit status.

    Raises
    ------
    InputError
        The file is wrong, or the folder cannot be written; nothing is written.
    """
    from separatrix.contact_file import read_contact
    from separatrix.contact_file.solving import solve_cases
    from separatrix.messages import grouped, noted_warnings
    from separatrix.present.contact import contact as document
    from separatrix.present.text.contact import contact as in_words

    with noted_warnings() as notes, contextlib.ExitStack() as stack:
        asked = read_contact(path)
        if folder is None and not as_json:
            folder = Path(path.stem)
        if folder is not None:
            stack.enter_context(writable_folder(folder))
        with progress_bar(f"contact {path.name}", quiet=quiet) as progress:
            found = solve_cases(asked, progress)
        kept = grouped(notes)
        text = json.dumps(document(found, kept), indent=1, allow_nan=False) + "\n"
        words = in_words(found, kept)
        answer(text if as_json else words if not quiet else in_words(found, []))
        if folder is None:
            return 0
        with staged(folder) as stage:
            _write(found, kept, {"contact.json": text, "contact.txt": words}, stage)
        if not as_json and not quiet:
            answer(f"\nFigures and data are in {folder}/\n")
    return 0


def _write(found: ContactAnswer, notes: list[str], texts: dict[str, str], folder: Path) -> None:
    import logging

    from separatrix import figures
    from separatrix.present import save
    from separatrix.present.contact import contact_dataset

    logging.getLogger("matplotlib").setLevel(logging.ERROR)
    for name, content in texts.items():
        (folder / name).write_text(harmless(content), encoding="utf-8")
    data = contact_dataset(found, notes)
    save(data, folder / "contact.nc")
    figures.save_all(figures.draw("contact", data), folder)
