"""The files of an answer: its document, text, dataset, figures and tables."""

from __future__ import annotations

import csv
import json
import logging
import math
from pathlib import Path
from typing import TYPE_CHECKING

from separatrix.messages import harmless
from separatrix.present import in_words
from separatrix.staged import staged

if TYPE_CHECKING:
    import xarray as xr

    from separatrix.present.nodes import Document
    from separatrix.runner import Progress
    from separatrix.study import Study

WITHOUT_DATA = ("check",)
"""Verbs whose answer is its document and text alone."""


def save_answer(
    folder: Path,
    record: object,
    study: Study,
    found: Document,
    *,
    pictures: bool = True,
    animation: bool = False,
    progress: Progress | None = None,
) -> None:
    """Write the files of an answer into a folder, all or none; of an interrupted one its document and text.

    Parameters
    ----------
    folder : Path
        It exists.
    record, study : object, Study
        The answer and what was asked.
    found : dict
        The answer as `present.document` makes it.
    pictures : bool
        Whether the figures are written, too.
    animation : bool
        Whether a GIF of a simulation is written, too; `progress` receives how far it is.

    Raises
    ------
    InputError
        The folder cannot be written.
    """
    verb = str(found["verb"])
    asked = (verb, record, study, list(found["warnings"]))
    with staged(folder) as stage:
        for suffix, content in ((".json", written(found)), (".txt", in_words(*asked, full=True))):
            (stage / f"{verb}{suffix}").write_text(harmless(content), encoding="utf-8")
        if verb in WITHOUT_DATA or not found.get("complete", True):
            return
        # what follows takes seconds to load
        from separatrix import figures
        from separatrix.figures.animation import animate
        from separatrix.figures.view import write_page
        from separatrix.present import dataset, save
        from separatrix.workbook import results_workbook

        if verb == "rank":
            results_workbook(found, stage / "rank.xlsx")
        logging.getLogger("matplotlib").setLevel(logging.ERROR)  # its remarks on fonts
        data = dataset(*asked)
        save(data, stage / f"{verb}.nc")
        if pictures:
            figures.save_all(figures.draw(verb, data), stage)
        if verb == "sweep":
            _write_tables(data, stage)
        if verb == "simulate":
            write_page(data, stage / "simulation.html")
        if animation:
            animate(data, stage / "simulation.gif", progress=progress)


def written(found: Document) -> str:
    """Return a document as the text of its JSON file."""
    return json.dumps(found, indent=1, allow_nan=False) + "\n"


def _write_tables(data: xr.Dataset, folder: Path) -> None:
    """Write the table of a sweep for spreadsheets and other programs: sweep.csv and sweep.xlsx."""
    from separatrix.workbook_files import add_table, new_workbook, text_for_cell, workbook_bytes

    names = [str(name) for name in data.variables if data[name].dims == ("case",)]
    heads = [f"{name} [{unit}]" if (unit := data[name].attrs.get("units")) else name for name in names]
    rows = [
        [None if v == "" or (isinstance(v, float) and math.isnan(v)) else v for v in row]
        for row in zip(*(data[name].values.tolist() for name in names), strict=True)
    ]
    with (folder / "sweep.csv").open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(heads)
        writer.writerows([text_for_cell(v) if isinstance(v, str) else v for v in row] for row in rows)
    book = new_workbook()
    add_table(book, "Sweep", heads, rows, keep_columns=1)
    (folder / "sweep.xlsx").write_bytes(workbook_bytes(book))
