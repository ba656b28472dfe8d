"""Sheets of the materials and the frictions behind an answer, each with its source and confidence."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from separatrix.workbook_looks import WRAPPED, Look, add_sheet, headings, put, widths

if TYPE_CHECKING:
    from openpyxl import Workbook

MATERIAL_HEADINGS = (
    *("used for", "name", "modulus (GPa)", "Poisson's ratio (-)", "density (kg/m3)"),
    *("confidence", "source"),
)
FRICTION_HEADINGS = (
    *("material", "environment", "mean (-)", "standard deviation (-)", "tests"),
    *("confidence", "source"),
)
ROLES = {
    ("bearing", "ball_material"): "balls",
    ("bearing", "ring_material"): "rings",
    ("film", "material"): "film",
    ("cage", "material"): "cage",
}
FORMATS = ("General", "General", "0.###", "0.###", "0.####")
Row = tuple[object, ...]


def add(book: Workbook, document: Mapping[str, Any]) -> None:
    """Add both sheets."""
    study = document["study"]
    _sheet(book, "materials", MATERIAL_HEADINGS, _materials(study))
    _sheet(book, "frictions", FRICTION_HEADINGS, _frictions(study))


def _sheet(book: Workbook, name: str, names: tuple[str, ...], rows: Iterator[Row]) -> None:
    sheet = add_sheet(book, name)
    headings(sheet, names)
    for number, row in enumerate(rows, 2):
        for column, value in enumerate(row, 1):
            look = Look(number_format=FORMATS[column - 1]) if column <= len(FORMATS) else WRAPPED
            put(sheet, number, column, value, look)
    widths(sheet, 20, 30, 13, 13, 13, 30, 90)


def _materials(study: Mapping[str, Any]) -> Iterator[Row]:
    for (section, key), role in ROLES.items():
        material = (study.get(section) or {}).get(key)
        if material and material.get("name") is not None:
            yield _material(role, material)
    for candidate in (study.get("ranking") or {}).get("candidates", ()):
        if candidate.get("material"):
            yield _material(f"candidate {candidate['name']}", candidate["material"])


def _material(role: str, material: Mapping[str, Any]) -> Row:
    modulus = material["elastic_modulus"]["value"]
    return (
        role,
        material["name"],
        None if modulus is None else modulus / 1e9,
        material["poisson_ratio"]["value"],
        material["density"]["value"],
        material.get("confidence"),
        material.get("source"),
    )


def _frictions(study: Mapping[str, Any]) -> Iterator[Row]:
    for candidate in (study.get("ranking") or {}).get("candidates", ()):
        for environment, friction in candidate["friction"].items():
            if friction is None:
                yield (candidate["name"], environment, "not measured")
            else:
                numbers = (friction.get(key) for key in ("mean", "standard_deviation", "count"))
                words = (friction.get("confidence"), friction.get("source"))
                yield (candidate["name"], environment, *numbers, *words)
