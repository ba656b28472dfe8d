"""Keys of a contact file and how the value of each is read."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import TypeVar

from separatrix.chain.traction.exact.contact import LARGEST_CREEP, LARGEST_SIDE, SMALLEST_SIDE
from separatrix.chain.traction.exact.flexibility import NEARLY_INCOMPRESSIBLE
from separatrix.contact_file.question import Motion
from separatrix.errors import InputError
from separatrix.toml_files import Reader, choice, list_of, quantity, ratio, text, truth, whole
from separatrix.units import NUMBER, parse, shown

Number = TypeVar("Number", float, int)
Made = TypeVar("Made")

MOST_CASES = 2000
LARGEST_MODULUS = 1e13  # [Pa]

_PER = re.compile(rf"({NUMBER}) ?(?:rad|1)/([a-z]+)([2²]?)")


def per_length(power: int) -> Reader[float]:
    """Read an inverse length to a power, like "0.2 1/mm", "0.2 rad/mm" or "3 1/mm2", in SI units."""
    unit = "1/mm" if power == 1 else "1/mm2"

    def read(value: object, where: str) -> float:
        found = _PER.fullmatch(value.strip()) if isinstance(value, str) and len(value) <= 60 else None
        if found is None or bool(found[3]) != (power == 2):
            cure = f'Write it like "0.2 {unit}".'
            raise InputError(where, f"must be a number in {unit}", shown(value), cure)
        return float(found[1]) / parse(f"1 {found[2]}", "m", where) ** power

    return read


def or_list(reader: Reader[Made]) -> Reader[tuple[Made, ...]]:
    """Read one value or a list of them: a batch."""

    def read(value: object, where: str) -> tuple[Made, ...]:
        if not isinstance(value, list):
            return (reader(value, where),)
        if not 1 <= len(value) <= MOST_CASES:
            raise InputError(where, f"must have 1 to {MOST_CASES} values", f"{len(value)}")
        return list_of(reader)(value, where)

    return read


def within(
    reader: Reader[Number], low: float, high: float, unit: str, *, open_low: bool = False
) -> Reader[Number]:
    """Read a number that must lie between two others."""

    def read(value: object, where: str) -> Number:
        found = reader(value, where)
        if not low <= found <= high or (open_low and found == low):
            ends = f"be above {low:g} and at most {high:g}" if open_low else f"lie from {low:g} to {high:g}"
            raise InputError(where, f"must {ends} [{unit}]", shown(value))
        return found

    return read


_LENGTH = within(quantity("m"), 0.0, 1e3, "m", open_low=True)
_MODULUS = within(quantity("Pa"), 0.0, LARGEST_MODULUS, "Pa", open_low=True)
_CREEP = or_list(within(ratio, -LARGEST_CREEP, LARGEST_CREEP, "-"))
_COEFFICIENT = within(ratio, 0.0, 100.0, "-")
_CELLS = within(whole, SMALLEST_SIDE, LARGEST_SIDE, "-")
_SOLID: dict[str, Reader[object]] = {
    "material": text,
    "elastic_modulus": _MODULUS,
    "shear_modulus": _MODULUS,
    "poisson_ratio": within(ratio, 0.0, 0.5, "-"),
}
BODY = _SOLID | {"layers": lambda value, _: value}
LAYER: Mapping[str, Reader[object]] = _SOLID | {
    "thickness": _LENGTH,
    "poisson_ratio": within(ratio, 0.0, NEARLY_INCOMPRESSIBLE, "-"),
}
SECTIONS: Mapping[str, Mapping[str, Reader[object]]] = {
    "contact": {
        "load": within(quantity("N"), 0.0, 1e12, "N", open_low=True),
        **dict.fromkeys(
            ("semi_axis_rolling", "semi_axis_lateral", "radius_rolling", "radius_lateral"), _LENGTH
        ),
    },
    "body_1": BODY,
    "body_2": BODY,
    "friction": {
        "coefficient": _COEFFICIENT,
        "across": list_of(quantity("m")),
        "coefficients": list_of(_COEFFICIENT),
        "cohesion": within(quantity("Pa"), 0.0, LARGEST_MODULUS, "Pa"),
        "shear_strength": _MODULUS,
    },
    "film": {
        "thickness": within(quantity("m"), 0.0, 1e3, "m"),
        "across": list_of(quantity("m")),
        "thicknesses": list_of(within(quantity("m"), 0.0, 1e3, "m")),
        "shear_modulus": _MODULUS,
        "roughness": within(quantity("m"), 0.0, 1e-3, "m"),
    },
    "motion": {"kind": choice(Motion)},
    "grid": {"columns": _CELLS, "rows": _CELLS},
    "pressure": {"own": truth, "coupled": truth, "two_way": truth},
}
"""Sections of a contact file and how each key is read; the keys of [motion] depend on its kind."""

_SHIFT = or_list(within(quantity("m"), -1e3, 1e3, "m"))
_ROLLS = {
    "kind": choice(Motion),
    "longitudinal": _CREEP,
    "lateral": _CREEP,
    "spin": or_list(per_length(1)),
    "curvature": or_list(per_length(2)),
}
MOTIONS: Mapping[Motion, Mapping[str, Reader[object]]] = {
    Motion.ROLLING: _ROLLS | {"slope": truth},
    Motion.TRANSIENT: _ROLLS | {"distance": or_list(_LENGTH)},
    Motion.SHIFT: {
        "kind": choice(Motion),
        "longitudinal": _SHIFT,
        "lateral": _SHIFT,
        "spin": or_list(within(quantity("rad"), -1e3, 1e3, "rad")),
    },
}
