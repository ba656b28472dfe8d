"""What each verb computes: the chain's record, and the curves that only its figures need."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from separatrix.errors import SeparatrixError, ValidityWarning
from separatrix.units import format_quantity

if TYPE_CHECKING:
    from collections.abc import Callable

    from separatrix.cage import History
    from separatrix.chain import BearingState, CageState, RaceContact, RestitutionState
    from separatrix.cli.console import Life
    from separatrix.ledger import Ledger
    from separatrix.lubrication import LubricationCurve
    from separatrix.ranking import Ranking
    from separatrix.stability import StabilityCurve
    from separatrix.study import Study
    from separatrix.traction import ShearField, TractionCurve
    from separatrix.units import Metre, MetrePerSecond, Ratio, Second

SPIN_ROLL_RATIOS = (0.0, 0.1, 0.2, 0.4, 0.8)
"""Pivoting-to-rolling ratios at which the traction curves are drawn, as in the paper's Fig. 7."""

SATURATED = 0.995
"""Share of the whole friction from which a traction curve counts as flat in a figure."""

STRIPS = 5
"""Strips in which the shear is shown."""

SAMPLES_A_WHIRL = 15
"""Samples of a simulated run in a period of the linear whirl."""

MOST_SAMPLES = 20_000


@dataclass(frozen=True, slots=True, kw_only=True)
class Work:
    """How the computing is to be done: threads, whom to tell how far it is, where runs are kept."""

    jobs: int
    progress: Life
    ledger: Ledger | None = None

    def expect(self, estimate: Callable[[], Second], *, at_most: bool = False) -> None:
        """Say what the work will take; less where an earlier call has kept runs."""
        self.progress.expect(estimate, at_most=at_most or (self.ledger is not None and self.ledger.goes_on))


@dataclass(frozen=True, slots=True, kw_only=True)
class CheckAnswer:
    """The bearing at standstill; None with the reason if its balance was not found."""

    static: BearingState | None
    static_reason: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class TractionAnswer:
    """Traction curves, as they are and at other pivoting-to-rolling ratios, and shear in free rolling."""

    race_friction: Ratio
    bearing: BearingState
    inner: TractionCurve
    outer: TractionCurve
    inner_others: tuple[TractionCurve, ...]
    outer_others: tuple[TractionCurve, ...]
    inner_shear: ShearField
    outer_shear: ShearField


@dataclass(frozen=True, slots=True, kw_only=True)
class RestitutionAnswer:
    """Restitution factor, and what it would be with other films; None without a film material."""

    state: RestitutionState
    film_thickness: Metre
    lubrication: LubricationCurve | None


@dataclass(frozen=True, slots=True, kw_only=True)
class StabilityAnswer:
    """Stability curve of the cage that the chain gives."""

    cage: CageState
    curve: StabilityCurve


@dataclass(frozen=True, slots=True, kw_only=True)
class SimulationAnswer:
    """One run of the ensemble, from one kick."""

    cage: CageState
    history: History
    kick: MetrePerSecond
    run: int


@dataclass(frozen=True, slots=True, kw_only=True)
class RankingAnswer:
    """The ranking, and the cage of its reference candidate for the numbers of the chain."""

    cage: CageState
    ranking: Ranking


def check(study: Study, work: Work) -> CheckAnswer:  # noqa: ARG001
    """The bearing at standstill, for its contact pressures.

    Warns
    -----
    ValidityWarning
        `sensitivity` refuses the friction that tests foretell in the pocket: its line.
    """
    from separatrix.chain import bearing_state

    _foretold_friction(study)
    at_rest = replace(study.operation, inner_speed=0.0, outer_speed=0.0)
    try:
        return CheckAnswer(static=bearing_state(replace(study, operation=at_rest)))
    except SeparatrixError as error:
        return CheckAnswer(static=None, static_reason=str(error))


def _foretold_friction(study: Study) -> None:
    """Warn where `sensitivity` refuses the friction that tests foretell in the pocket."""
    from separatrix.friction.fit import TestedFriction

    candidates = study.ranking.candidates if study.ranking and study.cage else ()
    if not any(isinstance(one.law, TestedFriction) for c in candidates for one in c.friction.values() if one):
        return
    from separatrix.draws import uncertain_inputs
    from separatrix.ranking.friction import as_pockets_see

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ValidityWarning)  # the chain is not what was asked for
            uncertain_inputs(as_pockets_see(study))
    except SeparatrixError as error:
        warnings.warn(f"`sensitivity` refuses this study: {error}", ValidityWarning, stacklevel=2)


def bearing(study: Study, work: Work) -> BearingState:  # noqa: ARG001
    """Ball equilibrium and the contacts of the most loaded ball."""
    from separatrix.chain import bearing_state

    return bearing_state(study)


def traction(study: Study, work: Work) -> TractionAnswer:  # noqa: ARG001
    """Traction curves, as they are and at other pivoting-to-rolling ratios."""
    from separatrix.chain import traction_state

    state = traction_state(study)
    inner = curves_by_ratio(study, state.bearing.inner, state.inner)
    outer = curves_by_ratio(study, state.bearing.outer, state.outer)
    return TractionAnswer(
        race_friction=study.film.race_friction,
        bearing=state.bearing,
        inner=inner[0],
        outer=outer[0],
        inner_others=inner[1:],
        outer_others=outer[1:],
        inner_shear=shear(study, state.bearing.inner),
        outer_shear=shear(study, state.bearing.outer),
    )


def curves_by_ratio(study: Study, at: RaceContact, curve: TractionCurve) -> tuple[TractionCurve, ...]:
    """Traction curves of one contact: at its own ratio, then at `SPIN_ROLL_RATIOS` with its sign.

    The creep increments go a quarter beyond those at which the contact's own curve is saturated.
    """
    import math
    from dataclasses import replace

    import numpy as np

    from separatrix.traction import film_compliance, traction_curve

    increments = np.linspace(-1.0, 1.0, 201) * _saturation(study, at, curve)
    own = at.creep.spin
    others = (math.copysign(ratio, own) * at.ellipse.curvature_rolling for ratio in SPIN_ROLL_RATIOS)
    return tuple(
        traction_curve(
            at.ellipse,
            replace(at.creep, spin=spin),
            race_friction=study.film.race_friction,
            film_compliance=film_compliance(study.film),
            creep_increments=increments,
        )
        for spin in (own, *others)
    )


def _saturation(study: Study, at: RaceContact, curve: TractionCurve) -> float:
    """Creep increment a quarter beyond the one at which a curve has its whole friction, either way."""
    import math

    import numpy as np

    from separatrix.traction import film_compliance, traction_curve

    widest = float(curve.creep_increment[-1])
    finer = traction_curve(
        at.ellipse,
        at.creep,
        race_friction=study.film.race_friction,
        film_compliance=film_compliance(study.film),
        creep_increments=widest * np.sinh(np.linspace(-6.0, 6.0, 201)) / math.sinh(6.0),
    )
    rising = np.abs(finer.traction_coefficient) < SATURATED * study.film.race_friction
    return min(1.25 * float(np.abs(finer.creep_increment[rising]).max()), widest)


def shear(study: Study, at: RaceContact) -> ShearField:
    """Shear in a few strips of a contact in free rolling (the paper's Fig. 6)."""
    from separatrix.traction import film_compliance, shear_field

    return shear_field(
        at.ellipse,
        at.creep,
        race_friction=study.film.race_friction,
        film_compliance=film_compliance(study.film),
        strips=STRIPS,
    )


def restitution(study: Study, work: Work) -> RestitutionAnswer:  # noqa: ARG001
    """Restitution factor from the traction slopes, and what other films would give.

    Warns
    -----
    ValidityWarning
        The factor is 0: the impact is overdamped.
    """
    from separatrix.chain import lubrication, restitution_state

    state = restitution_state(study)
    _say_if_overdamped(state)
    return RestitutionAnswer(
        state=state, film_thickness=study.film.thickness or 0.0, lubrication=lubrication(study, state)
    )


def _say_if_overdamped(state: RestitutionState) -> None:
    """Warn that eta is 0 and what follows from it."""
    found = state.restitution
    if found.restitution_factor == 0.0:
        damping, least = (format_quantity(c, "N s/m", 3) for c in (found.race_damping, found.least_damping))
        warnings.warn(
            f"eta = 0: impacts are overdamped, because C_mu = {damping} is below the limit sqrt(k_BC M_C)/2 "
            f"= {least}; every material has its full threshold as margin. C_mu falls as race friction falls "
            "and as speed rises. Test experience may differ: docs/theory/restitution.md.",
            ValidityWarning,
            stacklevel=2,
        )


def stability(study: Study, work: Work) -> StabilityAnswer:
    """Critical friction against restitution factor."""
    from separatrix.cage_choice import known_friction
    from separatrix.chain import cage_state
    from separatrix.cli.expected import expected_curve
    from separatrix.ranking.friction import cage_seen
    from separatrix.stability import stability_curve

    study = cage_seen(study)
    state = cage_state(study, friction=known_friction(study) or 0.0)  # the curve runs through all frictions
    work.expect(lambda: expected_curve(state.cage, state.stability, jobs=work.jobs, band=True))
    curve = stability_curve(
        state.cage, state.stability, jobs=work.jobs, progress=work.progress, ledger=work.ledger
    )
    return StabilityAnswer(cage=state, curve=curve)


def simulate(
    study: Study,
    work: Work,  # noqa: ARG001
    kick: MetrePerSecond | None = None,
    run: int = 0,
) -> SimulationAnswer:
    """Follow one run of the ensemble, by default the first from the reference kick."""
    from separatrix.cage import linear_whirl_frequency, simulate
    from separatrix.chain import cage_state
    from separatrix.ranking.friction import cage_seen

    state = cage_state(cage_seen(study))
    settings = state.stability
    speed = settings.middle_kick if kick is None else kick
    samples = SAMPLES_A_WHIRL * linear_whirl_frequency(state.cage) * settings.duration
    history = simulate(
        state.cage,
        kick=speed,
        run=run,
        seed=settings.seed,
        duration=settings.duration,
        ball_scatter=settings.ball_scatter,
        samples=int(min(max(samples, 1000), MOST_SAMPLES)),
    )
    _say_beyond_model(study, state, history)
    return SimulationAnswer(cage=state, history=history, kick=speed, run=run)


def _say_beyond_model(study: Study, state: CageState, history: History) -> None:
    """Warn where the run leaves the range of the model or of hardware."""
    from separatrix.cage_choice import cage_candidate
    from separatrix.ranking.plausible import beyond_motion
    from separatrix.ranking.records import RankedMaterial

    made_of = cage_candidate(study)
    run = RankedMaterial(
        name=made_of.name if made_of else "The cage",
        reason="",
        largest_contact_force=float(abs(history.contact_force).max()),
        largest_offset=float((history.position**2).sum(axis=1).max() ** 0.5),
    )
    for note in beyond_motion(study, state, [run]):
        warnings.warn(note, ValidityWarning, stacklevel=3)


def rank(study: Study, work: Work) -> RankingAnswer:
    """Verdict, margin, rank and reason of each candidate material."""
    from separatrix.cage_choice import reference_candidate, reference_friction, required_environment
    from separatrix.chain import cage_state
    from separatrix.cli.expected import expected_ranking
    from separatrix.ranking import rank, ranking_question
    from separatrix.ranking.friction import cage_seen

    question = ranking_question(study)
    required_environment(study, question)
    seen = cage_seen(study, marked=True)
    own = reference_candidate(study, question)
    state = cage_state(seen, material=own.material, friction=reference_friction(seen, question))
    _say_if_overdamped(state.restitution)
    work.expect(lambda: expected_ranking(study, jobs=work.jobs))
    found = rank(study, jobs=work.jobs, progress=work.progress, ledger=work.ledger)
    return RankingAnswer(cage=state, ranking=found)
