"""How a log is reduced, and the friction of one test that comes out."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from separatrix import _check
from separatrix.errors import InputError
from separatrix.friction.logs.log import Conditions
from separatrix.friction.records import UNITS, place
from separatrix.units import Ratio


@dataclass(frozen=True, slots=True, kw_only=True)
class ReductionOptions:
    """How a log is reduced; the defaults suit most."""

    run_in_end: str | None = None
    """Where running-in ends, for instance ``"200 m"``, ``"10 min"`` or ``"500 cycles"``; None to find it."""
    axis: str | None = None
    """Abscissa of ends and drift; None for the first of distance, time, cycles that the log has."""
    whole_cycles: bool = True
    """Whether means are over whole cycles, where those are known."""
    find_cycle: bool = False
    """Whether the length of an unknown cycle is taken from the strongest line of the spectrum."""
    seizure_ratio: Ratio = 3.0
    """Friction over its usual level from which, if it stays, a contact counts as seized."""
    force_loss: Ratio = 0.5
    """Share of the usual normal force below which, if it stays, the load counts as lost."""
    stick_slip_ratio: Ratio = 0.1
    """Peak to peak over mean friction from which an oscillation is reported."""
    drift_ratio: Ratio = 0.02
    """Change over the steady part, over the mean, from which a significant drift is reported."""
    fewest_effective: Ratio = 20.0
    """Independent values below which a test is reported as too short."""

    def __post_init__(self) -> None:
        _check.settle(
            self._problems(),
            _check.between(self, "seizure_ratio", 1.0, 1000.0, open_low=True),
            _check.between(self, "force_loss", 0.0, 1.0, open_high=True),
            _check.between(self, "stick_slip_ratio", 0.0, 100.0),
            _check.between(self, "drift_ratio", 0.0, 100.0),
            _check.between(self, "fewest_effective", 2.0, 1e6),
        )

    @property
    def cut(self) -> tuple[str, float] | None:
        """Abscissa and place of the given end of running-in, in SI units."""
        return None if self.run_in_end is None else place(self.run_in_end, "ReductionOptions.run_in_end")

    def _problems(self) -> Iterator[InputError]:
        try:
            _ = self.cut
        except InputError as error:
            yield error
        if self.axis is not None and self.axis not in UNITS:
            yield _check.problem(self, "axis", f"must be one of {', '.join(UNITS)}")
        for name in ("whole_cycles", "find_cycle"):
            if not isinstance(getattr(self, name), bool):
                yield _check.problem(self, name, "must be true or false")


@dataclass(frozen=True, slots=True, kw_only=True)
class TestFriction:
    """Friction of one test, with its error and what a reader should know about it."""

    __test__ = False

    source: str
    checksum: str
    conditions: Conditions
    friction: Ratio
    """Mean over the steady part."""
    standard_error: Ratio
    """Of that mean: neighbouring values are alike, some running-in may be left, digits are few."""
    degrees_of_freedom: int
    """Of Student's t for its interval."""
    standard_deviation: Ratio
    """Of the means of whole cycles in the steady part; of its rows where no cycle is known."""
    effective_count: float
    """Independent values that would have the same standard error."""
    run_in_end: float
    """In the SI unit of `run_in_axis`; the steady part begins here."""
    run_in_axis: str
    """``"time"``, ``"distance"`` or ``"cycles"``."""
    run_in_method: str
    steady_end: float
    """Where the steady part ends, in the SI unit of `run_in_axis`."""
    rows: int
    steady_rows: int
    cycles: int
    """Whole cycles averaged; 0 where none are."""
    drift_rate: float
    """Change of friction per SI unit of `run_in_axis`, over the steady part."""
    drift_error: float
    """Standard error of `drift_rate`."""
    stick_slip_amplitude: Ratio
    """Peak to peak, of the strongest oscillation that is not the cycle's; 0 if none exceeds the noise."""
    stick_slip_frequency: float
    """Of that oscillation, per SI unit of `run_in_axis`; 0 if none exceeds the noise."""
    flags: tuple[str, ...] = ()

    @property
    def half_width(self) -> Ratio:
        """Half the 95 % interval of `friction`."""
        from separatrix.friction.reduction.steady import half_width

        return half_width(self.standard_error, self.degrees_of_freedom)

    @property
    def interval(self) -> tuple[Ratio, Ratio]:
        """Lower and upper end of the 95 % interval of `friction`."""
        return self.friction - self.half_width, self.friction + self.half_width
