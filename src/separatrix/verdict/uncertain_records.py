"""The records of a sensitivity analysis."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from separatrix.ground.units import MetrePerSecond, Ratio, Rows
from separatrix.verdict.judgement import Judgement


@dataclass(frozen=True, slots=True, kw_only=True)
class InputRow:
    """One uncertain input with its distribution."""

    name: str  # its key in the study
    unit: str  # of mean and standard deviation, SI
    distribution: str  # in words
    source: str  # study, measured, or assumed (a guess)
    mean: float  # of the distribution
    standard_deviation: float  # of the distribution


@dataclass(frozen=True, slots=True, kw_only=True)
class UncertainMaterial:
    """One measured candidate in one environment, or over all of them."""

    name: str  # of the candidate
    friction: Ratio  # mean of the friction of a new cage
    friction_deviation: Ratio  # standard deviation of the friction of a new cage
    friction_scatter_assumed: bool  # whether that is the default, a guess
    extrapolation: tuple[str, ...]  # in what respect the friction is extrapolated beyond its tests
    restitution_factor: Ratio  # median over the bearings
    restitution_factor_low: Ratio  # 5 % quantile of the bearings
    restitution_factor_high: Ratio  # 95 % quantile of the bearings
    judgement: Judgement | None = None  # each run with its own bearing; null where `reason` states why
    reason: str  # a sentence with the numbers


@dataclass(frozen=True, slots=True, kw_only=True)
class NotDrawn:
    """A candidate without a measured friction in this environment."""

    name: str  # of the candidate
    reason: str  # which test is missing


UncertainRow = UncertainMaterial | NotDrawn


@dataclass(frozen=True, slots=True, kw_only=True)
class UncertainEnvironment:
    """The candidates in one environment, best first; those not measured come last."""

    name: str  # medium and counterface
    materials: Annotated[tuple[UncertainRow, ...], Rows("material", "material_", label="name")]
    """A row for each candidate, best first."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Share:
    """Part of a variance that one input brings, and its 95 % interval [-]."""

    name: str  # the input; chance is that of the single run
    share: Ratio  # of the variance
    share_low: Ratio  # lower end of the 95 % interval
    share_high: Ratio  # upper end of the 95 % interval


@dataclass(frozen=True, slots=True, kw_only=True)
class Drivers:
    """Which inputs decide whether a bearing of one case settles."""

    name: str  # of the candidate
    environment: str  # of the case
    shares: tuple[Share, ...]
    """Of the variance of the logit of P(settles), largest first, chance last; empty where `reason` states
    why."""
    reason: str  # why there are no shares; empty otherwise
    skill: Ratio | None  # part of the deviance that the fit removes, on bearings left out


@dataclass(frozen=True, slots=True, kw_only=True)
class TestGain:
    """How many undecided cases measuring one input settles on average, and which with what probability."""

    name: str  # the input to measure
    settled: Ratio  # mean number of cases that get a verdict
    cases: tuple[str, ...]  # that may get one
    chances: tuple[Ratio, ...]  # probability that it does, for each case


@dataclass(frozen=True, slots=True, kw_only=True)
class AllowedFriction:
    """Largest pocket friction of a new material at which a bearing settles with a probability."""

    names: tuple[str, ...]  # candidates whose pockets it is for
    probability: Ratio  # wanted, to settle
    scatter: Ratio  # assumed of a new cage, as a share of the mean
    friction: Ratio | None  # largest mean friction; null where `reason` states why
    friction_low: Ratio | None  # lower end of the 95 % interval
    friction_high: Ratio | None  # upper end of the 95 % interval
    reason: str  # why there is no limit; empty if there is


@dataclass(frozen=True, slots=True, kw_only=True)
class UncertainStudy:
    """Answer of `sensitivity`; a case whose verdict is decided early has fewer runs."""

    bearings: int  # drawn for each case
    failed: int  # of these, that do not make a bearing
    stopped_risk: Ratio  # largest probability that an ended case would decide otherwise
    default_scatter: Ratio  # of an unrepeated friction test, as a share of the mean
    environment: str  # the bearing's own
    inputs: Annotated[tuple[InputRow, ...], Rows("input", "input_", label="name")]
    """A row for each uncertain input."""
    environments: Annotated[tuple[UncertainEnvironment, ...], Rows("environment", label="name")]
    """The candidates in each."""
    overall: Annotated[tuple[UncertainRow, ...], Rows("material", "overall_", label="name")]
    """With the mean friction over all environments."""
    drivers: tuple[Drivers, ...]  # inputs that decide each case
    undecided: tuple[str, ...]  # cases without a verdict
    next_tests: tuple[TestGain, ...]  # best first
    allowed_friction: tuple[AllowedFriction, ...]  # of a new material
    kicks: Annotated[tuple[MetrePerSecond, ...], ("kick",)]
    runs: int  # of each bearing, from each disturbance
    notes: tuple[str, ...]  # what was left out and why, a sentence each
    complete: bool  # false if an interrupt left something out
