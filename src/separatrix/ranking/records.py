"""What a ranking answers."""

from __future__ import annotations

from dataclasses import dataclass

from separatrix.cage import KickCount
from separatrix.pocket_contact import PocketConditions
from separatrix.stability import StabilityCurve
from separatrix.units import (
    Hertz,
    Joule,
    Metre,
    MetrePerSecond,
    Newton,
    NewtonPerMetre,
    Ratio,
    Second,
    Watt,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class RankedMaterial:
    """One candidate in one environment; if it was not measured there, only its name and the reason.

    Attributes
    ----------
    name : str
        The candidate.
    friction, friction_error : float or None
        Mean pocket friction as the cage sees it, and its standard error [-].
    friction_deviation : float or None
        Of a new sample about that mean, a standard deviation, widened where nothing was tested; not
        overall [-].
    probability_lowest_friction : float or None
        That no other candidate's mean friction is lower there, by their standard errors; None if no other
        was measured there [-].
    friction_scatter_assumed : bool or None
        Whether the scatter is that of an unrepeated test, which nobody measured.
    extrapolation : tuple of str
        In what respect the friction was asked for where nothing was tested, in words.
    ball_cage_stiffness, restitution_factor : float or None
        Of its pocket [N/m], and of the chain with it [-].
    restitution_threshold, restitution_threshold_low, restitution_threshold_high : float or None
        Largest restitution factor at which it is stable, and its 95 % interval [-].
    margin : float or None
        Threshold less the chain's restitution factor [-].
    probability_stable, probability_low, probability_high : float or None
        Share of the runs from the worst kick that settle, and its 95 % interval [-].
    verdict : str or None
        STABLE, UNSTABLE or UNDECIDED.
    uncertain_verdict, uncertain_probability_stable, uncertain_probability_low, uncertain_probability_high
    uncertain_runs
        The same, and the runs from each kick, where every run draws its own bearing from the uncertain inputs
        of the study; None if it states none.
    rank : int or None
        By margin; those within the scatter of the best one share its rank.
    within_reach : bool or None
        Whether the threshold reaches the restitution factor that the paper grants solid lubrication.
    reason : str
        A sentence with the numbers.
    cage_motion : str or None
        CENTRED, ON THE LAND, WHIRLING or DRIFTING, as in `Judgement`; None if most runs are unresolved.
    by_kick : tuple of KickCount or None
        Where the runs from every kick end.
    worst_kick, growth_rate, growth_rate_low, growth_rate_high, largest_offset, mean_offset, orbit_evenness
    drift_rate, drift_rate_law, largest_contact_force, largest_land_force, pocket_impact_shares
    land_impact_share, whirl_frequency, whirl_direction, whirl_ratio, drive_energy, end_energy
    pocket_power, land_power, rubbing_force, rubbing_speed, rubbing_power, energy_imbalance, duration
    longest_run, runs
        Evidence of the verdict's ensemble, as in `Judgement`.
    """

    name: str
    friction: Ratio | None = None
    friction_error: Ratio | None = None
    friction_deviation: Ratio | None = None
    probability_lowest_friction: Ratio | None = None
    friction_scatter_assumed: bool | None = None
    extrapolation: tuple[str, ...] = ()
    ball_cage_stiffness: NewtonPerMetre | None = None
    restitution_factor: Ratio | None = None
    restitution_threshold: Ratio | None = None
    restitution_threshold_low: Ratio | None = None
    restitution_threshold_high: Ratio | None = None
    margin: Ratio | None = None
    probability_stable: Ratio | None = None
    probability_low: Ratio | None = None
    probability_high: Ratio | None = None
    verdict: str | None = None
    uncertain_verdict: str | None = None
    uncertain_probability_stable: Ratio | None = None
    uncertain_probability_low: Ratio | None = None
    uncertain_probability_high: Ratio | None = None
    uncertain_runs: int | None = None
    rank: int | None = None
    within_reach: bool | None = None
    reason: str
    cage_motion: str | None = None
    by_kick: tuple[KickCount, ...] | None = None
    worst_kick: MetrePerSecond | None = None
    growth_rate: float | None = None
    growth_rate_low: float | None = None
    growth_rate_high: float | None = None
    largest_offset: Metre | None = None
    mean_offset: Metre | None = None
    orbit_evenness: Ratio | None = None
    drift_rate: float | None = None
    drift_rate_law: float | None = None
    largest_contact_force: Newton | None = None
    largest_land_force: Newton | None = None
    pocket_impact_shares: tuple[Ratio, ...] | None = None
    land_impact_share: Ratio | None = None
    whirl_frequency: Hertz | None = None
    whirl_direction: int | None = None
    whirl_ratio: Ratio | None = None
    drive_energy: Joule | None = None
    end_energy: Joule | None = None
    pocket_power: Watt | None = None
    land_power: Watt | None = None
    rubbing_force: Newton | None = None
    rubbing_speed: MetrePerSecond | None = None
    rubbing_power: Watt | None = None
    energy_imbalance: Ratio | None = None
    duration: Second | None = None
    longest_run: Second | None = None
    runs: int | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class OwnCurve:
    """Critical friction with a candidate's own pocket, at each of `Ranking.own_eta` [-].

    0 where half the runs whirl without friction, the top of the searched frictions where none is enough.
    """

    name: str
    own_critical_friction: tuple[Ratio, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class RankedEnvironment:
    """The candidates in one environment, best first; those not measured come last."""

    name: str
    materials: tuple[RankedMaterial, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Ranking:
    """Answer of a ranking.

    `environment` is the bearing's own, the headline. `restitution_factor` is the chain's for
    `ball_cage_stiffness`, and so is the stability curve; where each candidate has a pocket stiffness, and so
    a restitution factor, of its own, these are those of `candidate`: the cage's material, or the first
    candidate where the study does not name it. `pocket` is what rubs there, `friction_scatter` what an
    unrepeated test is assumed to scatter. `overall` takes the mean friction over the measured environments.
    Where candidates differ in stiffness, each has its curve in `own_curves`, at the restitution factors
    `own_eta`. `notes` say where pocket forces or offsets leave the range of the model. `complete` is False if
    an interrupt left something out.
    """

    environment: str
    candidate: str
    restitution_factor: Ratio
    restitution_factor_free_spin: Ratio
    ball_cage_stiffness: NewtonPerMetre
    pocket: PocketConditions
    friction_scatter: Ratio
    solid_lubrication_limit: Ratio
    paper_statement: str
    environments: tuple[RankedEnvironment, ...]
    overall: tuple[RankedMaterial, ...]
    stability: StabilityCurve | None
    own_eta: tuple[Ratio, ...] | None
    own_curves: tuple[OwnCurve, ...] | None
    kicks: tuple[MetrePerSecond, ...]
    runs: int
    duration: Second
    notes: tuple[str, ...] = ()
    complete: bool
