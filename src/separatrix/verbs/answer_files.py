"""The files of an answer: its document, text, dataset, figures and tables."""

from __future__ import annotations

import csv
import logging
import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from separatrix.ground.errors import grouped, harmless, json_text
from separatrix.ground.files import staged
from separatrix.ground.plain_data import NOTES, Group, plain, shape, units_of
from separatrix.told.answer import in_words

if TYPE_CHECKING:
    import xarray as xr

    from separatrix.ground.plain_data import Document
    from separatrix.study.study import Study
    from separatrix.verdict.long_jobs import Progress


def document(
    verb: str,
    answer: object,
    asked: Study,
    question: Mapping[str, object] | None = None,
) -> Document:
    """Return an answer as plain data: SI units, no NaN, None where something is absent.

    The resolved inputs of the study go into it with their sources; the notes of study and answer are its
    warnings.
    """
    from separatrix import __version__
    from separatrix.study.sources import provenance_of, resolved

    left_out: list[str] = []
    node = Group(shape(answer))
    body = plain(node, verb, left_out)
    warnings = [*notes_of(answer, asked)]
    if left_out:
        more = f" and {len(left_out) - 1} more" if left_out[1:] else ""
        warnings.append(
            f"A number is not finite and is left out: {left_out[0]}{more}. The inputs are far from those of "
            "a bearing, or this is a fault of separatrix."
        )
    return {
        "separatrix_version": __version__,
        "verb": verb,
        "name": asked.name,
        "title": asked.title,
        "study": plain(resolved(asked), "study"),
        "seed": asked.stability.seed,
        **body,
        "units": units_of(node),
        "warnings": warnings,
        "provenance": plain(provenance_of(asked, verb, question or {}), "provenance"),
    }


def notes_of(answer: object, asked: Study) -> tuple[str, ...]:
    """Return what the reading of a study and its answer note; of those alike but for numbers the first."""
    own: tuple[str, ...] = getattr(answer, NOTES, ())
    return tuple(grouped([*asked.notes, *own]))


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
        for suffix, content in ((".json", json_text(found) + "\n"), (".txt", in_words(*asked, full=True))):
            (stage / f"{verb}{suffix}").write_text(harmless(content), encoding="utf-8")
        if verb in WITHOUT_DATA or not found.get("complete", True):
            return
        # what follows takes seconds to load
        from separatrix import figures
        from separatrix.figures.animation import animate
        from separatrix.figures.view import write_page
        from separatrix.present.dataset_arrays import dataset, save

        logging.getLogger("matplotlib").setLevel(logging.ERROR)  # its remarks on fonts
        data = dataset(found)
        save(data, stage / f"{verb}.nc")
        if pictures:
            figures.save_all(figures.draw(verb, data), stage)
        if verb == "rank":
            write_ranking(found, data, stage / "rank.xlsx")
        if verb == "sweep":
            _write_sweep(data, stage)
        if verb == "simulate":
            write_page(data, stage / "simulation.html")
        if animation:
            animate(data, stage / "simulation.gif", progress=progress)


def write_ranking(found: Document, data: xr.Dataset, path: Path) -> None:
    """Write the tables of a ranking as sheets: its document's rows and values, its dataset's units."""
    from separatrix.ground.sheet import add_table, new_workbook, workbook_bytes

    stability = found["stability"] or {}
    places = [{"environment": one["name"]} | row for one in found["environments"] for row in one["materials"]]
    tables = (
        ("candidates", "material_", places),
        ("overall", "overall_", found["overall"]),
        ("stability curve", "", stability.get("curve") or ()),
        ("linear limit", "", stability.get("linear_limit") or ()),
    )
    book = new_workbook()
    for title, prefix, rows in tables:
        cells = [{name: _cell(value) for name, value in row.items()} for row in rows]
        names = [name for name in (cells or [{}])[0] if any(row[name] is not None for row in cells)]
        names.sort(key=[*LEADING, *names].index)
        heads = [_heading(name, _unit(data, prefix + name)) for name in names]
        if heads:
            add_table(book, title, heads, [[row[name] for name in names] for row in cells], keep_columns=2)
    rest = {key: value for key, value in found.items() if key not in ELSEWHERE}
    single = [(name, value, _unit(data, name.replace(".", "_"))) for name, value, *_ in _values(rest)]
    add_table(book, "answer", ("name", "value", "unit"), single)
    add_table(book, "inputs", ("name", "value", "unit", "origin"), _values(found["study"]))
    path.write_bytes(workbook_bytes(book))


LEADING = ("environment", "name", "rank", "verdict", "friction", "margin")
"""Columns of a table that come first."""

ELSEWHERE = (
    *("study", "environments", "overall", "stability", "own_curves", "chain", "cage", "provenance", "units"),
)
"""Keys of a ranking that are not on the sheet of its single values."""

WHOLE_RECORDS = ("record", "table")
"""Keys of a study under which records of the library are whole."""


def _values(item: object, name: str = "") -> Iterator[tuple[str, object, str | None, str | None]]:
    """Yield the dotted name of each value of a document, the value, its unit and its origin."""
    if isinstance(item, dict):
        rest = {key: one for key, one in item.items() if key not in WHOLE_RECORDS}
        if "value" in rest:
            yield name, _cell(rest.pop("value")), rest.pop("unit", None), rest.pop("origin", None)
        for key, one in rest.items():
            yield from _values(one, f"{name}.{key}" if name else key)
    elif isinstance(item, list) and any(isinstance(one, dict) for one in item):
        for number, one in enumerate(item, 1):
            yield from _values(one, f"{name}[{number}]")
    else:
        yield name, _cell(item), None, None


def _cell(value: object) -> object:
    """Return a value as one cell has it: several texts or numbers as one text, nothing of whole records."""
    if isinstance(value, list):
        return "; ".join(str(one) for one in value if not isinstance(one, dict | None)) or None
    return None if isinstance(value, dict) else value


def _unit(data: xr.Dataset, name: str) -> str | None:
    return data[name].attrs.get("units") if name in data.variables else None


def _heading(name: str, unit: str | None) -> str:
    return f"{name} [{unit}]" if unit else name


def _write_sweep(data: xr.Dataset, folder: Path) -> None:
    """Write the table of a sweep for spreadsheets and other programs: sweep.csv and sweep.xlsx."""
    from separatrix.ground.sheet import add_table, new_workbook, text_for_cell, workbook_bytes

    names = [str(name) for name in data.variables if data[name].dims == ("case",)]
    heads = [_heading(name, _unit(data, name)) for name in names]
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
