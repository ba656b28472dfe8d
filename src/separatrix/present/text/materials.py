"""Text of the library: lists of records, one record whole, what a file holds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from separatrix.present.text.tables import ABSENT, facts, heading, number, paragraph, quantity, section, table
from separatrix.units import format_quantity

Entry = Mapping[str, Any]
NUMBERS = ("elastic_modulus", "poisson_ratio", "density")
WORDS = {
    "elastic_modulus": "elastic modulus",
    "poisson_ratio": "Poisson's ratio",
    "density": "density",
    "viscosity": "viscosity",
    "heat_capacity": "heat capacity",
    "triple_temperature": "triple point",
    "boiling_temperature": "boiling point",
    "critical_temperature": "critical temperature",
    "critical_pressure": "critical pressure",
}
_POINTS = ("point", "critical temperature", "critical pressure")
"""Properties that are no function of temperature."""


def listed(document: Entry) -> str:
    """Return every record in one table for each kind."""
    kinds = dict.fromkeys(record["kind"] for record in document["materials"])
    blocks = [heading("Library of materials")]
    for kind in kinds:
        records = [record for record in document["materials"] if record["kind"] == kind]
        blocks.append(section(f"{kind.capitalize()}s", _TABLES.get(kind, _solids)(records)))
    several = "Where a record has several data of one property the first is listed; `show NAME` has all."
    return "\n\n".join([*blocks, paragraph(several, indent="")]) + "\n"


def _solids(records: Sequence[Entry]) -> str:
    headers = ("", "E", "nu", "density", "at", "confidence in E", "library")
    return table(headers, [_solid(record) for record in records])


def _solid(record: Entry) -> list[str]:
    first = {key: record["data"][key][0] for key in NUMBERS if key in record["data"]}
    modulus = first["elastic_modulus"]
    data = record["data"]["elastic_modulus"]
    several = f" (first of {len(data)})" if data[1:] else ""
    density = first.get("density")
    return [
        record["name"],
        quantity(modulus["value"], "Pa") + several,
        number(first["poisson_ratio"]["value"], 3),
        ABSENT if density is None else quantity(density["value"], "kg/m3"),
        _temperature(modulus),
        _sure(modulus["confidence"]),
        record["library"]["file"],
    ]


def _fluids(records: Sequence[Entry]) -> str:
    headers = ("", "also", "phase", "boils at", "critical", "library")
    return table(headers, [_fluid(record) for record in records], left=3)


def _fluid(record: Entry) -> list[str]:
    points = [record["data"].get(f"{key}_temperature") for key in ("boiling", "critical")]
    return [
        record["name"],
        ", ".join(record["aliases"] or ()) or ABSENT,
        record["phase"],
        *(ABSENT if not data else quantity(data[0]["value"], "K") for data in points),
        record["library"]["file"],
    ]


def _tables(records: Sequence[Entry]) -> str:
    rows = [
        [
            r["name"],
            str(len(r["friction"])),
            str(len(r["environments"])),
            _sure(r["confidence"]),
            r["library"]["file"],
        ]
        for r in records
    ]
    return table(("", "materials", "environments", "confidence", "library"), rows)


_TABLES = {"fluid": _fluids, "friction table": _tables}


def shown(document: Entry) -> str:
    """Return records whole."""
    return "\n\n".join(_record(record) for record in document["records"]) + "\n"


def _record(record: Entry) -> str:
    blocks = [heading(f"{record['name']} ({record['kind']})"), facts(_about(record))]
    if record["kind"] == "friction table":
        blocks.append(section("Friction", _friction(record)))
    else:
        blocks.append(section("Data", *_data(record)))
    if "state" in record:
        blocks.append(section("State", facts(_state(record["state"]))))
    blocks += [paragraph(f"Note: {caution}", indent="") for caution in record.get("cautions", ())]
    return "\n\n".join(blocks)


def _about(record: Entry) -> list[tuple[str, str]]:
    words = ("title", "composition", "substance", "phase", "remark", "source", "confidence")
    rows = [(key.capitalize(), str(record[key])) for key in words if record.get(key)]
    for key, item in record.get("conditions", {}).items():
        if item["value"] is not None:
            rows.append((key.replace("_", " ").capitalize(), _span(item["value"], item["unit"])))
    if record.get("aliases"):
        rows.append(("Also", ", ".join(record["aliases"])))
    library = record["library"]
    origin = "shipped" if library["shipped"] else "of the user"
    return [*rows, ("Library", f"{library['file']}, {origin}, sha256 {library['sha256'][:12]}...")]


def _data(record: Entry) -> list[str]:
    lines = []
    for key, data in record["data"].items():
        taken = record.get("taken", {}).get(key)
        for i, datum in enumerate(data):
            mark = "*" if i == taken else " "
            lines.append(paragraph(_datum(WORDS[key], datum), first=f"{mark} ", indent="    "))
    if "taken_at" in record:
        lines.append(f"* serves at {format_quantity(record['taken_at'], 'K')}")
    return lines


def _datum(words: str, datum: Entry) -> str:
    unit = datum["unit"]
    text = f"{words} {format_quantity(datum['value'], unit, 5)}"
    if datum["range"] is not None:
        text += f" ({_span(datum['range'], unit)})"
    unstated = "" if words.endswith(_POINTS) else "at no stated temperature"
    conditions = [_temperature(datum, unstated), datum["medium"], datum["form"]]
    if datum["pressure"] is not None:
        conditions.append(format_quantity(datum["pressure"], "Pa", 6))
    text = ", ".join([text, *filter(None, conditions)])
    return f"{text}; {datum['confidence']}: {datum['source']}"


def _friction(record: Entry) -> str:
    environments = record["environments"]
    letters = [f"{chr(ord('A') + i % 26)}{i // 26 or ''}" for i in range(len(environments))]
    rows = [
        [name, *(_mean(row.get(env)) for env in environments)] for name, row in record["friction"].items()
    ]
    return "\n".join([table(("", *letters), rows), facts(list(zip(letters, environments, strict=True)))])


def _mean(value: Entry | None) -> str:
    if value is None:
        return "not measured"
    spread = value["standard_deviation"]
    return number(value["mean"]) + ("" if spread is None else f" +/- {spread:.2g}")


def _state(state: Entry) -> list[tuple[str, str]]:
    rows = [
        (WORDS.get(key, key).capitalize(), _five(state[key]))
        for key in ("temperature", "pressure", "density", "viscosity", "heat_capacity")
    ]
    return [*rows, ("Phase", state["phase"]), ("Source", state["source"])]


def _five(item: Entry) -> str:
    return ABSENT if item["value"] is None else format_quantity(item["value"], item["unit"], 6)


def checked(document: Entry) -> str:
    """Return what a library file holds."""
    headers = ("kind", "name", "line", "numbers", "guesses", "no temperature")
    keys = ("numbers", "guesses", "without_temperature")
    rows = [
        [r["kind"], r["name"], str(r["line"] or ABSENT), *(str(r[key]) for key in keys)]
        for r in document["records"]
    ]
    count = len(rows)
    verdict = f"{document['file']} is a valid library: {count} record{'s'[: count != 1]}."
    return f"{table(headers, rows, left=2)}\n\n{verdict}\n"


def added(document: Entry) -> str:
    """Return what was added."""
    names = ", ".join(f"{record['kind']} {record['name']}" for record in document["records"])
    return f"Added to {document['library']}: {names}.\n"


def _span(bounds: Sequence[float], unit: str) -> str:
    low, high = (format_quantity(bound, unit) for bound in bounds)
    return low if low == high else f"{low} to {high}"


def _temperature(datum: Entry, otherwise: str = ABSENT) -> str:
    return otherwise if datum["temperature"] is None else _span(datum["temperature"], "K")


def _sure(confidence: str) -> str:
    return confidence.partition(";")[0]
