"""Reading study files: TOML whose every dimensional value is text with its unit (docs/study-file.md)."""

from __future__ import annotations

import warnings
from pathlib import Path

from separatrix.errors import InputError, ValidityWarning
from separatrix.study import Study
from separatrix.study_file.cautions import cautions
from separatrix.study_file.document import Document, find, load
from separatrix.study_file.provenance import resolved
from separatrix.study_file.sections import build_study
from separatrix.study_file.shipped import shipped_studies, template
from separatrix.units import printable

__all__ = ["read_study", "require", "resolved", "shipped_studies", "template"]


def read_study(study: str | Path) -> Study:
    """Study of a file, or of the shipped example of that name.

    Raises
    ------
    InputError
        Everything that is wrong with the file, a line each: place, rule, value, cure.

    Warns
    -----
    ValidityWarning
        It asks for more than the model is good for; what, and what to do.
    """
    path = find(study)
    built = _built(load(path), _name_of(path))
    for sentence in cautions(built):
        warnings.warn(sentence, ValidityWarning, stacklevel=2)
    return built


def _name_of(path: Path) -> str:
    """Name of a study, and of the folder of its answers: the file's without its ending, never dots alone."""
    return printable(path.stem if path.stem.strip(".") else path.name, 100)


def _built(document: Document, name: str) -> Study:
    """The study of a document; what a workbook says wrong is refused by the cell."""
    try:
        return build_study(document, name)
    except InputError as error:
        if document.cells:
            from separatrix.study_file.workbook import in_cells

            raise in_cells(document, error) from None
        raise


def require(study: Study, verb: str, *sections: str) -> None:
    """Refuse a study that lacks a section which a verb needs.

    Raises
    ------
    InputError
        Names the missing sections, the verb, and where to see what they look like.
    """
    missing = [f"[{section}]" for section in sections if getattr(study, section) is None]
    if missing:
        rule = f"is missing; `{verb}` needs it" if len(missing) == 1 else f"are missing; `{verb}` needs them"
        raise InputError(f"{study.name}: {' and '.join(missing)}", rule, cure="See `separatrix new`.")
