"""Friction of one test: what a reduction gives and a friction table is fitted to."""

from __future__ import annotations

from dataclasses import dataclass

from separatrix.friction.logs.log import Conditions
from separatrix.units import Ratio


@dataclass(frozen=True, slots=True, kw_only=True)
class TestFriction:
    """Friction of one test, with its error and what a reader should know about it."""

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
    """Independent values that would give the same standard error."""
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
    """Peak to peak, of the strongest oscillation that is none of the cycle's; 0 if none stands out."""
    stick_slip_frequency: float
    """Of that oscillation, per SI unit of `run_in_axis`; 0 if none stands out."""
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


TestFriction.__test__ = False  # type: ignore[attr-defined]  # no class of tests, whatever its name says
