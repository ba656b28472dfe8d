"""Inputs in which two answers differ: keys of the study, then options of the command."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from separatrix.comparing.records import Difference

FRICTION = "cage.ball_cage_friction"
"""Key of the pocket friction, which a study may leave to its candidates."""

BESIDE = ("record", "table", "other_tests", "distribution")
"""Parts of a resolved study that are not inputs: whole records of the library."""

Inputs = Iterator[tuple[str, tuple[Any, str | None]]]
"""Names of inputs, each with its value and unit."""


def differences(first: Mapping[str, Any], second: Mapping[str, Any]) -> Iterator[Difference]:
    """Yield each input that differs between two sets of them."""
    for key in {**first, **second}:
        a, b = first.get(key, (None, None)), second.get(key, (None, None))
        if a[0] != b[0]:
            yield Difference(key=key, first=a[0], second=b[0], unit=a[1] or b[1])


def all_inputs(
    study: Mapping[str, Any], options: Mapping[str, Any], taken: Mapping[str, tuple[Any, str | None]]
) -> dict[str, tuple[Any, str | None]]:
    """Inputs of an answer: those of its study, its options, and what it took in their place."""
    found = dict(sorted(of_study(study), key=lambda pair: pair[0]))
    found |= {f"--{name}": (value, None) for name, value in options.items()}
    return found | {key: value for key, value in taken.items() if value[0] is not None}


def of_study(node: Mapping[str, Any], path: str = "") -> Inputs:
    """Yield name, value and unit of every input of a resolved study; of an uncertain one what is known."""
    if "value" in node:
        known = node.get("distribution")
        words = known.get("written") or known.get("words") if isinstance(known, Mapping) else None
        yield path, (words or node["value"], None if words else node.get("unit"))
        return
    if path and isinstance(node.get("name"), str):
        yield path, (node["name"], None)
    for key, item in node.items():
        if isinstance(item, Mapping) and key not in BESIDE:
            yield from of_study(item, f"{path}.{key}" if path else key)
        elif key == "candidates" and isinstance(item, list):
            yield from _frictions(item)


def _frictions(candidates: list[Any]) -> Inputs:
    for one in (one for one in candidates if isinstance(one, Mapping)):
        at = f"friction of {one.get('name')}"
        friction = one.get("friction")
        for environment, measured in friction.items() if isinstance(friction, Mapping) else ():
            if isinstance(measured, Mapping):
                yield f"{at} in {environment}", (measured.get("mean"), "-")
        if isinstance(one.get("material"), Mapping):
            yield from of_study(one["material"], f"material of {one.get('name')}")
