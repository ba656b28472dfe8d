"""Text of the library: lists of records, and whole records."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from separatrix.ground.units import Kelvin, format_quantity
from separatrix.study.library.records import CONDITIONS, UNITS, AnyRecord, Datum, Fluid, FrictionTable
from separatrix.told.tables import (
    ABSENT,
    facts,
    friction_table,
    heading,
    number,
    paragraph,
    quantity,
    section,
    table,
)

WORDS = {
    "poisson_ratio": "Poisson's ratio",
    "triple_temperature": "triple point",
    "boiling_temperature": "boiling point",
}
"""Properties whose key is not their name."""

POINTS = ("point", "critical temperature", "critical pressure")
"""Properties that do not depend on temperature."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Shown:
    """A record, and what of it serves at a temperature: a datum of each property of a solid."""

    record: AnyRecord
    taken_at: Kelvin | None = None
    taken: Mapping[str, int] = field(default_factory=dict)
    cautions: Sequence[str] = ()


def listed(records: Sequence[AnyRecord]) -> str:
    """Return every record in one table for each kind."""
    blocks = [heading("Library of materials")]
    for kind in dict.fromkeys(record.kind for record in records):
        headers: tuple[str, ...] = ("", "E", "nu", "density", "at", "confidence in E", "library")
        if kind == "fluid":
            headers = ("", "also", "phase", "boils at", "critical", "library")
        elif kind == "friction table":
            headers = ("", "materials", "environments", "confidence", "library")
        rows = [[one.name, *_row(one), one.file.label] for one in records if one.kind == kind]
        blocks.append(
            section(f"{kind.capitalize()}s", table(headers, rows, left=3 if kind == "fluid" else 1))
        )
    several = "Where a record has several data of one property the first is listed; `show NAME` has all."
    return "\n\n".join([*blocks, paragraph(several, indent="")]) + "\n"


def _row(record: AnyRecord) -> list[str]:
    """Return what the list has of a record between its name and its library."""
    content = record.content
    if isinstance(content, FrictionTable):
        sizes = (str(len(content.friction)), str(len(content.columns)))
        return [*sizes, content.confidence.partition(";")[0]]
    first = {key: data[0] for key, data in record.data.items()}
    if isinstance(content, Fluid):
        points = (first.get(f"{key}_temperature") for key in ("boiling", "critical"))
        return [
            ", ".join(content.aliases) or ABSENT,
            content.phase,
            *(_given(point, "K") for point in points),
        ]
    modulus, density = first["elastic_modulus"], first.get("density")
    count = len(record.data["elastic_modulus"])
    return [
        _given(modulus, "Pa") + (f" (first of {count})" if count > 1 else ""),
        number(first["poisson_ratio"].value),
        _given(density, UNITS["density"]),
        ABSENT if modulus.temperature is None else _span(modulus.temperature, "K"),
        modulus.confidence.partition(";")[0],
    ]


def _given(datum: Datum | None, unit: str) -> str:
    return ABSENT if datum is None else quantity(datum.value, unit)


def shown(records: Sequence[Shown]) -> str:
    """Return records whole."""
    return "\n\n".join(map(_whole, records)) + "\n"


def _whole(one: Shown) -> str:
    record, content, file = one.record, one.record.content, one.record.file
    keys = ("title", "composition", "substance", "phase", "remark", "source", "confidence")
    values = ((key, getattr(content, key, None)) for key in keys)
    about = [(key.capitalize(), str(value)) for key, value in values if value]
    if isinstance(content, FrictionTable):
        for key, limits in content.conditions.items():
            about.append((key.replace("_", " ").capitalize(), _span(limits, CONDITIONS[key])))
        whole = section("Friction", friction_table(content.columns, content.rows))
    else:
        whole = section("Data", *_data(record, one))
    if record.aliases:
        about.append(("Also", ", ".join(record.aliases)))
    origin = "shipped" if file.shipped else "of the user"
    about.append(("Library", f"{file.label}, {origin}, sha256 {file.checksum[:12]}..."))
    blocks = [heading(f"{record.name} ({record.kind})"), facts(about), whole]
    return "\n\n".join([*blocks, *(paragraph(f"Note: {caution}", indent="") for caution in one.cautions)])


def _data(record: AnyRecord, one: Shown) -> list[str]:
    """Return every datum of a record on lines of its own, those that serve with a mark."""
    lines = []
    for key, data in record.data.items():
        unit = UNITS[key]
        words = WORDS.get(key, key.replace("_", " "))
        for i, datum in enumerate(data):
            text = f"{words} {format_quantity(datum.value, unit, 5)}"
            if datum.range is not None:
                text += f" ({_span(datum.range, unit)})"
            at = "" if words.endswith(POINTS) else "at no stated temperature"
            parts = [
                at if datum.temperature is None else _span(datum.temperature, "K"),
                datum.medium,
                datum.form,
            ]
            if datum.pressure is not None:
                parts.append(format_quantity(datum.pressure, "Pa", 6))
            text = f"{', '.join([text, *filter(None, parts)])}; {datum.confidence}: {datum.source}"
            mark = "*" if i == one.taken.get(key) else " "
            lines.append(paragraph(text, first=f"{mark} ", indent="    "))
    if one.taken and one.taken_at is not None:
        lines.append(f"* serves at {format_quantity(one.taken_at, 'K')}")
    return lines


def _span(bounds: Sequence[float], unit: str) -> str:
    low, high = (format_quantity(bound, unit) for bound in bounds)
    return low if low == high else f"{low} to {high}"
