"""What sensitivity, next test and inverse questions answer."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from separatrix import _check
from separatrix.errors import InputError
from separatrix.units import Array, Ratio

SETTLED_LOW: Ratio = 0.05
SETTLED_HIGH: Ratio = 0.95
"""A case is undecided while its probability of STABLE lies strictly between these two."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Estimate:
    """A number with its 95 % interval."""

    value: float
    low: float
    high: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Factor:
    """Inputs that are varied as one: usually a single one."""

    name: str
    words: str
    inputs: tuple[int, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class SobolIndex:
    """Share of a variance that goes with one factor.

    `first` is the share that falls away on average once the factor is known, `total` what remains while all
    but the factor is known [-].
    """

    factor: str
    words: str
    first: Estimate
    total: Estimate


@dataclass(frozen=True, slots=True, kw_only=True)
class CaseSobol:
    """Sobol indices of one case.

    `margin` and `verdict` hold one index a factor, the largest total first; empty if the quantity never
    changes, as `margin_reason` or `verdict_reason` then says. Factors that do not enter the case are left
    out. `probability_stable` is the share of STABLE samples among them.
    """

    candidate: str
    environment: str
    probability_stable: Estimate
    margin_mean: Estimate
    margin_deviation: Ratio
    margin: tuple[SobolIndex, ...]
    verdict: tuple[SobolIndex, ...]
    margin_reason: str = ""
    verdict_reason: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class SobolAnswer:
    """Sobol indices of all cases, and what they cost.

    `samples` is n, `evaluations` the number of rows the model was asked for, `blocks` the independent
    randomisations behind the intervals; `fit_error` the share of the restitution factor's variance that the
    fitted stage misses in cross-validation, None where nothing was fitted.
    """

    cases: tuple[CaseSobol, ...]
    samples: int
    evaluations: int
    blocks: int
    seed: int
    fit_error: Ratio | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Measurement:
    """A test that might be made: one input, and how well it would be measured.

    Attributes
    ----------
    input : int
        Place of the input.
    error : float
        Standard deviation of the measured value about the true one [-], as a share of the true value. In
        words it is doubled: "to 10 %" is what a study writes as ``+- 10 %``, two standard deviations.
    repeats : int, optional
        Tests of that error whose mean is taken.
    reducible : float
        Share of the input's variance that is lack of knowledge. The rest, from one cage to the next, no
        measurement removes [-].
    """

    input: int
    error: Ratio = 0.05
    repeats: int = 1
    reducible: Ratio = 1.0

    def __post_init__(self) -> None:
        _check.settle(
            _check.whole(self, "input", 0, 100_000),
            _check.positive(self, "error", 1e-6, 10.0, hint="A tenth is 0.1."),
            _check.whole(self, "repeats", 1, 1000),
            _check.between(self, "reducible", 0.0, 1.0),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class CaseGain:
    """Probability that a test settles one undecided case, as stable or as not [-]."""

    candidate: str
    environment: str
    settles: Ratio
    settles_stable: Ratio
    settles_unstable: Ratio


@dataclass(frozen=True, slots=True, kw_only=True)
class TestGain:
    """What one test is expected to bring.

    `settled` is the expected number of undecided cases that it would settle; `unsettled` that of decided ones
    which it would open again; `avoided` the expected number of wrong verdicts that it would save, if each
    case is taken for what is likelier. `choice` is the expected rise of the margin of the material chosen by
    mean margin, summed over the environments [-]; `choice_perfect` the same if the input were known exactly.
    """

    __test__ = False  # pytest must not collect it

    name: str
    words: str
    measurement: Measurement
    settled: Estimate
    unsettled: Estimate
    avoided: Estimate
    choice: Estimate
    choice_perfect: Estimate
    cases: tuple[CaseGain, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class NextTest:
    """Tests ranked by the number of undecided cases they are expected to settle.

    `undecided` holds candidate and environment of those whose probability of STABLE lies between 5 and 95 %
    with its whole interval; `borderline` of those whose interval holds 5 or 95 %: with so many samples it
    cannot be said whether anything would settle them.
    """

    undecided: tuple[tuple[str, str], ...]
    borderline: tuple[tuple[str, str], ...]
    cases: int
    environments: int
    tests: tuple[TestGain, ...]
    samples: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Span:
    """Values of one quantity between two ends; `from_edge` and `to_edge` mark ends of what was searched."""

    low: float
    high: float
    from_edge: bool
    to_edge: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class AllowedFriction:
    """Which pocket friction a new material may have at most.

    `like` are the candidates whose pockets, but for the friction, the new material has; `all_alike` says that
    these are all. `most` is the largest friction with a probability of STABLE of `probability` or more, with
    its interval; `most_nominal` the largest that is stable with every input at its central value. Either is
    None if there is none, as the reason says. `spans` and `spans_nominal` are all stretches of friction that
    are allowed.
    """

    probability: Ratio
    scatter: Ratio
    searched: Ratio
    most: Estimate | None
    reason: str
    spans: tuple[Span, ...]
    most_nominal: Ratio | None
    reason_nominal: str
    spans_nominal: tuple[Span, ...]
    like: tuple[str, ...] = ()
    all_alike: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class FilmAxis:
    """A quantity of the film.

    Attributes
    ----------
    name, words, unit : str
        As in `Input`.
    values : ndarray
        Rising, at least two, shape (value,) [SI].
    own : float
        The study's own [SI].
    """

    name: str
    words: str
    unit: str
    values: Array
    own: float

    def __post_init__(self) -> None:
        _check.settle(_check.printable_text(self, "name"), _rising(self))


def _rising(axis: FilmAxis) -> _check.Problems:
    values = np.asarray(axis.values)
    if values.ndim != 1 or values.size < 2 or not np.isfinite(values).all() or (np.diff(values) <= 0).any():
        yield InputError(f"The axis {axis.name}", "must have at least two values, finite and rising")


@dataclass(frozen=True, slots=True, kw_only=True)
class RestitutionGrid:
    """Restitution factor over two quantities of the film, shape (y, x) [-].

    `holds_up_to` is the value of x beyond which the model of the film is not known to hold, None if there is
    none.
    """

    x: FilmAxis
    y: FilmAxis
    restitution_factor: Array
    holds_up_to: float | None = None

    def __post_init__(self) -> None:
        _check.settle(_fits(self))


def _fits(grid: RestitutionGrid) -> _check.Problems:
    factors, wanted = np.asarray(grid.restitution_factor), (len(grid.y.values), len(grid.x.values))
    if factors.shape != wanted:
        yield InputError(
            "RestitutionGrid.restitution_factor", f"must have the shape {wanted}", "", str(factors.shape)
        )
    elif grid.y.values[0] <= 0.0 or grid.x.values[0] < 0.0:
        yield InputError(
            "RestitutionGrid",
            "must have x >= 0 and y > 0",
            "",
            f"from {grid.x.values[0]:g} and {grid.y.values[0]:g}",
        )
    elif not ((factors >= 0.0) & (factors < 1.0)).all():
        yield InputError("RestitutionGrid.restitution_factor", "must lie in 0 <= eta < 1", "-")


@dataclass(frozen=True, slots=True, kw_only=True)
class RegionRow:
    """Stretches of x that keep a case stable at one value of y.

    `nominal` with all but the film at its centre, `probable` with the probability asked.
    """

    y: float
    nominal: tuple[Span, ...]
    probable: tuple[Span, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class StableRegion:
    """Where in the plane of two film quantities a case is stable.

    Attributes
    ----------
    probability_stable : ndarray
        Share of the samples that are STABLE, all but the film as drawn, shape (y, x) [-].
    rows : tuple of RegionRow
        One for each y.
    """

    candidate: str
    environment: str
    probability: Ratio
    grid: RestitutionGrid
    probability_stable: Array
    rows: tuple[RegionRow, ...]
