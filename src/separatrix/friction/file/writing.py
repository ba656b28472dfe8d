"""Write a friction file that a person can read and change."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from decimal import Decimal
from pathlib import Path

from separatrix.errors import InputError
from separatrix.friction.file.reading import AXES
from separatrix.friction.file.refusal import exists_already
from separatrix.friction.fit import FrictionTest
from separatrix.friction.fit.records import NAMES

HEADER = """\
# Friction of cage materials from tests, as `separatrix tribometer` writes it and a study reads it:
#     [ranking]
#     friction = "friction.toml"
# One [[test]] for each test. Required: material, counterface, medium, friction. The rest may be left out.
# slip_speed, pressure (mean contact pressure) and temperature: a quantity with its unit as text, or
# ["lowest", "highest"]. standard_error is that of this test's mean; standard_deviation that of the means
# of its whole cycles. Tests of one specimen name the same sample. Change or add what you know; a test that
# should not count is removed, or commented out.
"""

_UNITS = {"temperature": (1.0, "K"), "slip_speed": (1.0, "m/s"), "pressure": (1e6, "MPa")}
_TEXTS = ("source", "checksum", "reduced_by")


def friction_text(tests: Sequence[FrictionTest]) -> str:
    """Content of a friction file."""
    return "\n".join([HEADER, *("\n".join(["[[test]]", *_lines(test), ""]) for test in tests)])


def write_friction(tests: Sequence[FrictionTest], path: Path) -> None:
    """Write a friction file; what is read back is the same to the last bit.

    Raises
    ------
    InputError
        There is something of that name already, or it cannot be written.
    """
    try:
        with path.open("x", encoding="utf-8") as file:
            file.write(friction_text(tests))
    except FileExistsError:
        raise exists_already(path) from None
    except OSError as error:
        raise InputError(str(path), f"cannot be written ({error.strerror or error})") from None


def _lines(test: FrictionTest) -> Iterator[str]:
    for name in NAMES:
        yield f"{name} = {_text(getattr(test, name))}"
    for name in ("friction", "standard_error", "standard_deviation", "effective_count"):
        value = getattr(test, name)
        if value is not None:
            yield f"{name} = {_number(value)}"
    for name, (size, unit) in _UNITS.items():
        limits = getattr(test, name)
        if limits is not None:
            yield f"{name} = {_interval(limits, size, unit)}"
    for name in ("sample", "test"):
        if getattr(test, name) is not None:
            yield f"{name} = {_text(getattr(test, name))}"
    if test.run_in_end is not None and test.run_in_axis is not None:
        yield f"run_in_end = {_text(f'{_number(test.run_in_end)} {AXES[test.run_in_axis]}')}"
    if test.flags:
        yield f"flags = [{', '.join(_text(flag) for flag in test.flags)}]"
    for name in _TEXTS:
        if getattr(test, name) is not None:
            yield f"{name} = {_text(getattr(test, name))}"


def _text(value: str) -> str:
    """Basic string of TOML: JSON's escapes are among its own."""
    return json.dumps(value, ensure_ascii=False)


def _number(value: float) -> str:
    """Shortest text that reads back as the same float."""
    return repr(float(value))


def _interval(limits: tuple[float, float], size: float, unit: str) -> str:
    low, high = (f"{_scaled(value, size)} {unit}" for value in limits)
    return _text(low) if low == high else f"[{_text(low)}, {_text(high)}]"


def _scaled(value: float, size: float) -> str:
    """Value in another unit, in exact decimal arithmetic: read back it is the same float."""
    exact = Decimal(repr(value)) / Decimal(size)
    plain = f"{exact.normalize():f}"
    return plain if len(plain) <= 24 else f"{exact:e}"
