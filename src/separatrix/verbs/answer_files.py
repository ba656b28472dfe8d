"""The document of an answer, and its files: its page as text, HTML, workbook and pictures, its arrays."""

from __future__ import annotations

import logging
from pathlib import Path
from typing import TYPE_CHECKING

from separatrix.ground.document import Document, part_of
from separatrix.ground.errors import grouped, harmless, json_text
from separatrix.ground.files import staged
from separatrix.verbs.verb import Tool, Verb

if TYPE_CHECKING:
    from separatrix.present.blocks import Page, Picture
    from separatrix.study.study import Study
    from separatrix.verbs import Computed


def document(verb: Verb, found: Computed) -> Document:
    """Return an answer as plain data: SI units, no NaN, None where something is absent.

    The resolved inputs of the study go into it with their sources; the notes of study and answer are its
    warnings.
    """
    from separatrix.ground.plain_data import Group, plain, shape, units_of
    from separatrix.study.sources import provenance_of
    from separatrix.verbs import chain_answers  # noqa: F401 - with the shapes of its records

    if verb.moves_a_cage:
        from separatrix.verbs import cage_answers  # noqa: F401

    left_out: list[str] = []
    study = found.study
    node = Group(shape(found.record))
    body = plain(node, verb.name, left_out)
    warnings = [*notes_of(found.record, study)]
    if left_out:
        more = f" and {len(left_out) - 1} more" if left_out[1:] else ""
        warnings.append(
            f"A number is not finite and is left out: {left_out[0]}{more}. The inputs are far from those of "
            "a bearing, or this is a fault of separatrix."
        )
    return {
        "verb": verb.name,
        "name": study.name,
        "title": study.title,
        **asked_by(study),
        **body,
        "units": units_of(node),
        "warnings": warnings,
        "provenance": plain(provenance_of(study, verb.name, found.question), "provenance"),
    }


def asked_by(study: Study) -> Document:
    """Return what each answer to a study has of the study, with this version."""
    from separatrix import __version__
    from separatrix.ground.plain_data import plain
    from separatrix.study.sources import resolved

    known = {"separatrix_version": __version__, "seed": study.stability.seed}
    return known | {"study": plain(resolved(study), "study")}


def notes_of(answer: object, asked: Study) -> tuple[str, ...]:
    """Return what the reading of a study and its answer note; of those alike but for numbers the first."""
    from separatrix.ground.plain_data import NOTES

    own: tuple[str, ...] = getattr(answer, NOTES, ())
    return tuple(grouped([*asked.notes, *own]))


def page_of_document(verb: Tool, found: Document, where: str = "The answer") -> Page:
    """Return the page of a document; one that is not what its page takes is refused under `where`."""
    from separatrix.verbs.saved_answers import refusing_damage

    with refusing_damage(where):
        return verb.page(part_of(found, where))


def save_answer(
    folder: Path, asked: Tool, found: Document, *, page: Page | None = None, pictures: bool = True
) -> None:
    """Write the files of an answer into a folder that exists, all or none.

    Of an interrupted one, and of `check`, these are its document and its text. `page` is that of the document
    if it has been made already; `pictures` says whether figures, and the page with them, are written, too.

    Raises
    ------
    InputError
        The folder cannot be written.
    """
    from separatrix.present.blocks import Level
    from separatrix.present.text import text

    page, name = page or page_of_document(asked, found), asked.name
    with staged(folder) as stage:
        (stage / f"{name}.json").write_text(harmless(json_text(found) + "\n"), encoding="utf-8")
        (stage / f"{name}.txt").write_text(harmless(text(page, Level.FULL)), encoding="utf-8")
        if not asked.writes_data or found.get("complete") is False:
            return
        from separatrix.present.dataset import dataset
        from separatrix.present.spreadsheet import spreadsheet

        (stage / f"{name}.xlsx").write_bytes(spreadsheet(page))
        if pictures:
            _draw(page, stage, name)
        if isinstance(asked, Verb):
            dataset(found).to_netcdf(stage / f"{name}.nc", engine="h5netcdf")


def save_pictures(folder: Path, page: Page) -> None:
    """Write the pictures of a page alone."""
    with staged(folder) as stage:
        _draw(page, stage, "")


def _draw(page: Page, stage: Path, name: str) -> None:
    """Write each picture, drawn once, and with a name the page with them."""
    from separatrix.present import draw
    from separatrix.present.blocks import Level, Picture, View
    from separatrix.present.html import html, picture_html

    logging.getLogger("matplotlib").setLevel(logging.ERROR)  # its remarks on fonts
    drawn: dict[str, str] = {}

    def picture(one: Picture) -> str:
        if one.name not in drawn:
            drawing = draw.save(one.figure(), stage / f"{one.name}.png", stage / f"{one.name}.svg")
            drawn[one.name] = picture_html(one, drawing)
        return drawn[one.name]

    for one in page.blocks:
        if isinstance(one, View):
            (stage / f"{one.name}.html").write_text(one.html(), encoding="utf-8")
        elif isinstance(one, Picture):
            picture(one)
    if name:
        level = Level.REPORT | Level.FULL
        (stage / f"{name}.html").write_text(html(page, level=level, picture=picture), encoding="utf-8")
