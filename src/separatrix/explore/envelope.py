"""The operating envelope of a sweep: its orders, its worst case, and the time that a duty spends where."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from separatrix.errors import InputError
from separatrix.study import Operation
from separatrix.units import Hertz, RadianPerSecond, Ratio

TIME_SHARE = "time_share"
"""Beside the parameters of a case: how long it lasts."""

ROUNDING = 1e-9
"""Cases that differ by a smaller share of their value are alike."""


class Case(Protocol):
    """What a swept case needs for its place in the envelope."""

    @property
    def case(self) -> int:
        """Its number."""

    @property
    def time_share(self) -> Ratio | None:
        """Share of the duty's time [-]."""

    @property
    def restitution_factor(self) -> Ratio | None:
        """Restitution factor [-]."""

    @property
    def margin(self) -> Ratio | None:
        """Threshold less the restitution factor [-]."""

    @property
    def probability_stable(self) -> Ratio | None:
        """Share of the runs that settle [-]."""

    @property
    def verdict(self) -> str | None:
        """Name of the verdict."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WorstCase:
    """The case nearest to instability, or farthest beyond it.

    Attributes
    ----------
    case : int
        Its number.
    quantity : str
        Which decides: "margin" (the lowest), without margins "probability_stable" (the lowest), without
        verdicts "restitution_factor" (the highest).
    value : float
        Of that quantity [-].
    compared, alike : int
        Cases that have it (the others were refused), and those that are as bad, this one included.
    """

    case: int
    quantity: str
    value: Ratio
    compared: int
    alike: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Duty:
    """Shares of the time of a duty cycle [-]; None where the quantity was not asked for.

    Attributes
    ----------
    below_margin : float or None
        In cases with a margin below zero.
    stable, unstable, undecided : float or None
        In cases with this verdict.
    refused : float
        In cases without the number that decides: nothing is known of these.
    """

    below_margin: Ratio | None
    stable: Ratio | None
    unstable: Ratio | None
    undecided: Ratio | None
    refused: Ratio


def orders(operation: Operation, ball_count: int, cage_speed: RadianPerSecond) -> dict[str, Hertz]:
    """Return the frequencies of shaft and cage, and of balls that pass a place of a ring.

    The shaft is the ring that turns faster; the cage turns with the ball set.
    """
    speeds = operation.inner_speed, operation.outer_speed, cage_speed
    inner, outer, cage = (speed / (2.0 * math.pi) for speed in speeds)
    return {
        "shaft_frequency": max(abs(inner), abs(outer)),
        "cage_frequency": abs(cage),
        "outer_pass_frequency": ball_count * abs(cage - outer),
        "inner_pass_frequency": ball_count * abs(inner - cage),
    }


def time_shares(cases: Sequence[Mapping[str, float]]) -> list[Ratio]:
    """Share of each case in the time of all; none where no case has one.

    Raises
    ------
    InputError
        One is below zero or not finite, or all are zero.
    """
    if TIME_SHARE not in cases[0]:
        return []
    given = [case[TIME_SHARE] for case in cases]
    for place, one in enumerate(given):
        if not 0.0 <= one < math.inf:
            raise InputError(f"Case {place}, {TIME_SHARE}", "must be a finite share or time >= 0", f"{one:g}")
    total = math.fsum(given)
    if not 0.0 < total < math.inf:
        raise InputError(TIME_SHARE, "must be above 0 in some case", f"a sum of {total:g}")
    return [one / total for one in given]


def worst_case(cases: Iterable[Case]) -> WorstCase | None:
    """Return the worst case, the first of those that are alike; None where no case has an answer."""
    known = list(cases)
    for quantity, sign in (("margin", 1.0), ("probability_stable", 1.0), ("restitution_factor", -1.0)):
        found = [(sign * value, one.case) for one in known if (value := getattr(one, quantity)) is not None]
        if found:
            value, case = min(found)
            alike = sum(math.isclose(one, value, rel_tol=ROUNDING) for one, _ in found)
            counts = {"compared": len(found), "alike": alike}
            return WorstCase(case=case, quantity=quantity, value=sign * value, **counts)
    return None


def duty(cases: Iterable[Case]) -> Duty | None:
    """Return the time spent below a margin of zero and in each verdict; None without shares of time."""
    known = [(one, one.time_share) for one in cases if one.time_share is not None]
    if not known:
        return None
    has_margins = any(one.margin is not None for one, _ in known)
    has_verdicts = any(one.verdict is not None for one, _ in known)
    decides = "margin" if has_margins else "verdict" if has_verdicts else "restitution_factor"

    def in_verdict(name: str) -> Ratio | None:
        return math.fsum(share for one, share in known if one.verdict == name) if has_verdicts else None

    below = math.fsum(share for one, share in known if one.margin is not None and one.margin < 0.0)
    return Duty(
        below_margin=below if has_margins else None,
        stable=in_verdict("STABLE"),
        unstable=in_verdict("UNSTABLE"),
        undecided=in_verdict("UNDECIDED"),
        refused=math.fsum(share for one, share in known if getattr(one, decides) is None),
    )
