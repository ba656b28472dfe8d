"""A table of measured friction of a library file."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from separatrix.errors import InputError
from separatrix.library.records import CONDITION_UNITS, FrictionTable
from separatrix.library.words import BLANK, confidence_of, long_text, raw, span, yes_or_no
from separatrix.measured_friction import refuse_scatter_about_zero
from separatrix.study import Friction
from separatrix.toml_values import Reader, build, nearest, ratio, table, text, whole
from separatrix.units import printable, shown

MOST_MATERIALS = 2000
_TABLE = (
    *("title", "source", "confidence", "remark", "replaces", "environments", "friction"),
    *CONDITION_UNITS,
)
_CONDITION_LIMITS = {
    "temperature": (1e-3, 5000.0),
    "slip_speed": (1e-9, 1e4),
    "normal_force": (1e-9, 1e9),
    "pressure": (1e-3, 1e12),
}


def friction_table(item: Mapping[str, Any], at: str, common: dict[str, Any]) -> FrictionTable:
    """Read a table of measured friction: its words, its conditions, and a row for each material."""
    given = table(item, at, dict.fromkeys(_TABLE, raw), ("title", "source", "confidence", "friction"))
    words: dict[str, str] = {}
    for key in ("title", "source", "remark"):
        words |= {key: long_text(given[key], f"{at}.{key}")} if key in given else {}
    words["confidence"] = confidence_of(given["confidence"], f"{at}.confidence")
    conditions = {
        key: span(unit, given[key], f"{at}.{key}", *_CONDITION_LIMITS[key])
        for key, unit in CONDITION_UNITS.items()
        if key in given
    }
    rows = _rows(given["friction"], f"{at}.friction", words)
    environments = _environments(given.get("environments"), rows, f"{at}.environments")
    friction = {name: {env: row.get(env) for env in environments} for name, row in rows.items()}
    replaces = yes_or_no(given.get("replaces", False), f"{at}.replaces")
    known: dict[str, Any] = {**common, **words, "environments": environments, "friction": friction}
    return FrictionTable(replaces=replaces, conditions=conditions, **known)


def _rows(value: Any, where: str, words: Mapping[str, str]) -> dict[str, dict[str, Friction]]:
    if not isinstance(value, dict) or not 0 < len(value) <= MOST_MATERIALS:
        cure = 'Write a section [friction_table."NAME".friction."MATERIAL"] for each.'
        rule = f"must hold the friction of 1 to {MOST_MATERIALS} materials"
        raise InputError(where, rule, shown(value), cure)
    return {name: _row(text(name, where), row, where, words) for name, row in value.items()}


def _row(name: str, value: Any, where: str, words: Mapping[str, str]) -> dict[str, Friction]:
    at = f'{where}."{printable(name)}"'
    if not isinstance(value, dict) or not value:
        rule = "must give the friction in at least one environment"
        raise InputError(at, rule, shown(value), 'Write "liquid nitrogen, 440C" = 0.11.')
    return {env: _friction(item, f'{at}."{text(env, at)[:60]}"', words) for env, item in value.items()}


def _friction(value: Any, where: str, words: Mapping[str, str]) -> Friction:
    readers: dict[str, Reader] = {"mean": ratio, "standard_deviation": ratio, "count": whole}
    given = (
        table(value, where, readers, ("mean",)) if isinstance(value, dict) else {"mean": ratio(value, where)}
    )
    if given["mean"] == 0.0:
        raise InputError(where, "must be above 0", "0", BLANK)
    known = {**given, "source": words["source"], "confidence": words["confidence"]}
    return refuse_scatter_about_zero(build(Friction, known, where), where)


def _environments(value: Any, rows: Mapping[str, Mapping[str, Friction]], where: str) -> tuple[str, ...]:
    """Environments in the order of the file, or as the key gives them, which must then name all."""
    used = tuple(dict.fromkeys(env for row in rows.values() for env in row))
    if value is None:
        return used
    if not isinstance(value, list) or not all(isinstance(env, str) for env in value):
        raise InputError(where, "must be a list of names in quotes", shown(value))
    if unknown := [env for env in used if env not in value]:
        cure = nearest(unknown[0], value) if value else ""
        raise InputError(where, "lacks an environment that the table uses", shown(unknown[0]), cure)
    if len(set(value)) < len(value):
        raise InputError(where, "names an environment twice")
    return tuple(value)
