"""From the reduction of a log to the test that a friction file keeps."""

from __future__ import annotations

from separatrix.errors import InputError
from separatrix.friction.fit import FrictionTest
from separatrix.friction.fit.records import NAMES
from separatrix.friction.reduction.reduction import TestFriction


def friction_test(test: TestFriction, version: str) -> FrictionTest:
    """Test of a reduced log.

    Raises
    ------
    InputError
        The log and its column map do not say what slid on what, or the friction is not above zero.
    """
    known = test.conditions
    if missing := [name for name in NAMES if getattr(known, name) is None]:
        cure = "Give it under [test] of a column map: --map map.toml."
        raise InputError(test.source, f"does not say: {', '.join(missing)}", cure=cure)
    return FrictionTest(
        material=str(known.material),
        counterface=str(known.counterface),
        medium=str(known.medium),
        friction=test.friction,
        standard_error=test.standard_error,
        standard_deviation=test.standard_deviation,
        effective_count=test.effective_count,
        temperature=_point(known.temperature),
        slip_speed=_point(known.slip_speed),
        pressure=_point(known.pressure),
        sample=known.sample,
        test=known.test,
        run_in_end=test.run_in_end,
        run_in_axis=test.run_in_axis,
        flags=test.flags,
        source=test.source,
        checksum=test.checksum,
        reduced_by=f"separatrix {version}",
    )


def _point(value: float | None) -> tuple[float, float] | None:
    return None if value is None else (value, value)
