"""What an uncertain ranking answers."""

from __future__ import annotations

from dataclasses import dataclass

from separatrix.units import Array, MetrePerSecond, Ratio


@dataclass(frozen=True, slots=True, kw_only=True)
class InputRow:
    """One uncertain number: its name in the study, its distribution in words, and where that comes from.

    `source` is "study" where the study gives it, "measured" for the scatter of a measured friction, "assumed"
    for the default one, a guess; `moves_boundary` marks a number that changes the cage itself, so that the
    boundary moves with it, `moves_friction` one with which frictions from tests move. Mean and standard
    deviation are in SI.
    """

    name: str
    unit: str
    distribution: str
    source: str
    mean: float
    standard_deviation: float
    moves_boundary: bool
    moves_friction: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class UncertainMaterial:
    """One candidate in one environment, or over all of them; if not measured, only its name and the reason.

    Attributes
    ----------
    name : str
        The candidate.
    friction, friction_deviation : float or None
        Mean and standard deviation of the friction of the next cage [-].
    friction_scatter_assumed : bool or None
        Whether that scatter is the default one, a guess.
    extrapolation : tuple of str
        In what respect the friction was asked for where nothing was tested, in words.
    restitution_factor, restitution_factor_low, restitution_factor_high : float or None
        Median of the samples, and the ends between which nine in ten of them lie [-].
    restitution_threshold, restitution_threshold_low, restitution_threshold_high : float or None
        The same of the threshold [-].
    margin, margin_low, margin_high : float or None
        The same of the margin [-].
    verdict, nominal_threshold, nominal_margin
        Of the cage with every input at its central value; None if not measured.
    probability_stable, probability_stable_low, probability_stable_high : float or None
        Probability of STABLE, and its 95 % interval [-].
    probability_undecided, probability_undecided_low, probability_undecided_high : float or None
        The same of UNDECIDED [-].
    probability_unstable, probability_unstable_low, probability_unstable_high : float or None
        The same of UNSTABLE [-].
    probability_lowest_friction : float or None
        Probability that no other candidate has a lower friction; None if no other was measured [-].
    probability_best, probability_best_low, probability_best_high : float or None
        Probability of the largest threshold, and its 95 % interval; None if no other was measured [-].
    tie_group : int or None
        1 for the leader and those that cannot be told from it.
    reason : str
        A sentence with the numbers.
    """

    name: str
    friction: Ratio | None = None
    friction_deviation: Ratio | None = None
    friction_scatter_assumed: bool | None = None
    extrapolation: tuple[str, ...] = ()
    restitution_factor: Ratio | None = None
    restitution_factor_low: Ratio | None = None
    restitution_factor_high: Ratio | None = None
    restitution_threshold: Ratio | None = None
    restitution_threshold_low: Ratio | None = None
    restitution_threshold_high: Ratio | None = None
    margin: Ratio | None = None
    margin_low: Ratio | None = None
    margin_high: Ratio | None = None
    verdict: str | None = None
    nominal_threshold: Ratio | None = None
    nominal_margin: Ratio | None = None
    probability_stable: Ratio | None = None
    probability_stable_low: Ratio | None = None
    probability_stable_high: Ratio | None = None
    probability_undecided: Ratio | None = None
    probability_undecided_low: Ratio | None = None
    probability_undecided_high: Ratio | None = None
    probability_unstable: Ratio | None = None
    probability_unstable_low: Ratio | None = None
    probability_unstable_high: Ratio | None = None
    probability_lowest_friction: Ratio | None = None
    probability_best: Ratio | None = None
    probability_best_low: Ratio | None = None
    probability_best_high: Ratio | None = None
    tie_group: int | None = None
    reason: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class UncertainEnvironment:
    """The candidates in one environment, best first; those not measured come last."""

    name: str
    materials: tuple[UncertainMaterial, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class ConvergenceRow:
    """Probabilities of one candidate in one environment ("" over all of them) with the first so many samples.

    Attributes
    ----------
    name, environment : str
        Which one.
    probability_stable, probability_stable_low, probability_stable_high : ndarray
        With their 95 % interval, shape (size,) [-].
    probability_best, probability_best_low, probability_best_high : ndarray or None
        The same; None if no other was measured [-].
    """

    name: str
    environment: str
    probability_stable: Array
    probability_stable_low: Array
    probability_stable_high: Array
    probability_best: Array | None
    probability_best_low: Array | None
    probability_best_high: Array | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Cloud:
    """Some of the samples of one candidate in one environment, shape (sample,) each [-]."""

    name: str
    environment: str
    restitution_factor: Array
    friction: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class BoundaryLine:
    """Critical friction of the cage as it is against restitution factor, with its scatter and the band.

    Attributes
    ----------
    restitution_factor : ndarray
        Shape (node,) [-].
    critical_friction, critical_friction_low, critical_friction_high : ndarray
        At which half of the runs whirl from the reference kick, and its 95 % interval [-].
    stable_up_to, unstable_above : ndarray
        Between them a sample is UNDECIDED [-].
    """

    restitution_factor: Array
    critical_friction: Array
    critical_friction_low: Array
    critical_friction_high: Array
    stable_up_to: Array
    unstable_above: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class SurrogateError:
    """How well the fitted boundary foretells runs that it was not fitted to.

    Attributes
    ----------
    runs, held_out, cages : int
        Single runs that were spent, of them not used for the fit that was tried, and different cages.
    deviance, deviance_constant : float
        Mean of minus twice the log-likelihood of a held-out run; and of a law that knows only how many grow.
    predicted, whirling, counted : ndarray
        Calibration: mean foretold probability in each bin, and of how many runs how many grew, shape (bin,).
    misfit : float
        Standard deviation of ln f beyond the runs' own scatter, found in parts of the held-out runs; it is
        carried [-].
    error : float
        Standard deviation of ln f at the samples, misfit and coefficients together [-].
    decides : bool
        Whether that is small enough to decide anything.
    """

    runs: int
    held_out: int
    cages: int
    deviance: float
    deviance_constant: float
    predicted: Array
    whirling: Array
    counted: Array
    misfit: Ratio
    error: Ratio
    decides: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class BoundaryAnswer:
    """Boundary of one kind of cage: of which candidates, how it was found, and what that cost.

    `parameters` are the uncertain numbers with which it moves, if any; `surrogate` the fit about the traced
    curve.
    """

    candidates: tuple[str, ...]
    parameters: tuple[str, ...]
    runs: int
    line: BoundaryLine
    surrogate: SurrogateError
    drifts: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class UncertainRanking:
    """Answer of an uncertain ranking.

    `failed` samples have no answer, for the reasons in `notes`; they are left out. `boundary_draws` is the
    number of boundaries that the runs allow behind every interval, `runs` all runs that were spent.
    """

    samples: int
    failed: int
    notes: tuple[str, ...]
    default_scatter: Ratio
    inputs: tuple[InputRow, ...]
    environments: tuple[UncertainEnvironment, ...]
    overall: tuple[UncertainMaterial, ...]
    sizes: tuple[int, ...]
    convergence: tuple[ConvergenceRow, ...]
    clouds: tuple[Cloud, ...]
    boundaries: tuple[BoundaryAnswer, ...]
    boundary_draws: int
    kicks: tuple[MetrePerSecond, ...]
    runs: int
