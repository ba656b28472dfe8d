"""Study files: TOML whose every dimensional value is text with its unit (docs/reference/study-file.md)."""

from __future__ import annotations

import warnings
from pathlib import Path

from separatrix.errors import InputError, ValidityWarning
from separatrix.input_files import noting
from separatrix.study import Study
from separatrix.study_file.cautions import cautions
from separatrix.study_file.document import TEMPLATE, find, load, shipped_studies
from separatrix.study_file.kept import asked_by, keep, provenance_of
from separatrix.study_file.provenance import resolved
from separatrix.study_file.sections import LEFT_OUT, build_study
from separatrix.units import printable

__all__ = ["asked_by", "provenance_of", "read_study", "require", "resolved", "shipped_studies", "template"]


def read_study(study: str | Path) -> Study:
    """Study of a file, or of the shipped example of that name.

    Raises
    ------
    InputError
        Everything that is wrong with the file, a line each: place, rule, value, cure.

    Warns
    -----
    ValidityWarning
        It asks for more than the model is good for, or its cage is left out; what, and what to do.
    """
    path = find(study)
    # a folder of answers has this name: never dots alone
    name = printable(path.stem if path.stem.strip(".") else path.name, 100)
    with noting() as reading:
        built = build_study(load(path), name)
    for sentence in cautions(built):
        warnings.warn(sentence, ValidityWarning, stacklevel=2)
    return keep(built, path, reading)


def template() -> str:
    """A commented study to fill in, valid as it is: what `separatrix new` writes."""
    return TEMPLATE.read_text(encoding="utf-8")


def require(study: Study, verb: str, *sections: str) -> None:
    """Refuse a study that lacks a section which a verb needs; `check` refuses one that was left out, too.

    Raises
    ------
    InputError
        Names the missing sections, the verb, and where to see what they look like.
    """
    left_out: InputError | None = study.records.get(LEFT_OUT)
    if left_out is not None and (verb == "check" or "cage" in sections):
        raise left_out
    missing = [f"[{section}]" for section in sections if getattr(study, section) is None]
    if missing:
        rule = f"is missing; `{verb}` needs it" if len(missing) == 1 else f"are missing; `{verb}` needs them"
        raise InputError(f"{study.name}: {' and '.join(missing)}", rule, cure="See `separatrix new`.")
