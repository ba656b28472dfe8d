"""What a user may set about the reduction of a log."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from separatrix import _check, units
from separatrix.errors import InputError
from separatrix.friction.logs.log import ABSCISSAE
from separatrix.units import Ratio

AXIS_UNITS = {"time": "s", "distance": "m", "cycles": "-"}
"""The SI unit of each abscissa."""

_CYCLES = re.compile(r" *([0-9]+(?:\.[0-9]*)?(?:e[+]?[0-9]{1,2})?) ?cycles? *")


@dataclass(frozen=True, slots=True, kw_only=True)
class ReductionOptions:
    """How a log is reduced; the defaults suit most."""

    run_in_end: str | None = None
    """Where running-in ends, for instance ``"200 m"``, ``"10 min"`` or ``"500 cycles"``; None to find it."""
    axis: str | None = None
    """Abscissa in which ends and drift are told; None for the first of distance, time, cycles there is."""
    whole_cycles: bool = True
    """Whether means are over whole cycles, where those are known."""
    find_cycle: bool = False
    """Whether the length of a cycle that nobody gave is taken from the strongest line of the spectrum."""
    seizure_ratio: Ratio = 3.0
    """Friction over its usual level from which, if it stays, a contact counts as seized."""
    force_loss: Ratio = 0.5
    """Share of the usual normal force below which, if it stays, the load counts as lost."""
    stick_slip_ratio: Ratio = 0.1
    """Peak to peak over mean friction from which an oscillation is told."""
    drift_ratio: Ratio = 0.02
    """Change over the steady part, over the mean, from which a significant drift is told."""
    fewest_effective: Ratio = 20.0
    """Independent values below which a test is told to be too short."""

    def __post_init__(self) -> None:
        _check.settle(
            _end_of_run_in(self),
            _axis(self),
            *(_switch(self, name) for name in ("whole_cycles", "find_cycle")),
            _check.between(self, "seizure_ratio", 1.0, 1000.0, open_low=True),
            _check.between(self, "force_loss", 0.0, 1.0, open_high=True),
            _check.between(self, "stick_slip_ratio", 0.0, 100.0),
            _check.between(self, "drift_ratio", 0.0, 100.0),
            _check.between(self, "fewest_effective", 2.0, 1e6),
        )

    @property
    def cut(self) -> tuple[str, float] | None:
        """Abscissa and place of the end of running-in that was given, in SI units."""
        return None if self.run_in_end is None else place(self.run_in_end)


def place(text: str) -> tuple[str, float]:
    """Return abscissa and value of a text such as ``"200 m"``, ``"10 min"`` or ``"500 cycles"``.

    Raises
    ------
    InputError
        It is none of these.

    Examples
    --------
    >>> place("10 min"), place("200 m"), place("500 cycles")
    (('time', 600.0), ('distance', 200.0), ('cycles', 500.0))
    """
    where = "ReductionOptions.run_in_end"
    rule = "must be a time, a distance or a number of cycles with its unit"
    cure = 'Write it like "10 min", "200 m" or "500 cycles".'
    if not isinstance(text, str) or not 0 < len(text) <= units.LONGEST:
        raise InputError(where, rule, units.shown(text), cure)
    if found := _CYCLES.fullmatch(text):
        return "cycles", float(found.group(1))
    spelling = re.sub(r"^[^A-Za-z]*(?:[eE][-+]?[0-9]+)? ?", "", text.strip())
    unit = next((unit for unit in ("s", "m") if spelling in units.UNITS[unit]), None)
    if unit is None:
        raise InputError(where, rule, units.shown(text), cure)
    value = units.parse(text, unit, where)
    if value < 0.0:
        raise InputError(where, "must not be negative", units.shown(text))
    return ("time" if unit == "s" else "distance"), value


def _end_of_run_in(options: ReductionOptions) -> Iterator[InputError]:
    if options.run_in_end is None:
        return
    try:
        place(options.run_in_end)
    except InputError as error:
        yield error


def _axis(options: ReductionOptions) -> Iterator[InputError]:
    if options.axis is not None and options.axis not in ABSCISSAE:
        yield _check.problem(options, "axis", f"must be one of {', '.join(ABSCISSAE)}")


def _switch(options: ReductionOptions, name: str) -> Iterator[InputError]:
    if not isinstance(getattr(options, name), bool):
        yield _check.problem(options, name, "must be true or false")
