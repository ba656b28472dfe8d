"""A study with its uncertain inputs drawn: verdicts, what decides them, and what would have to be better."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from separatrix.cage.ensemble import Ensemble
from separatrix.chain.pocket_friction import with_scatter
from separatrix.ground.errors import InputError
from separatrix.ground.units import Array
from separatrix.study.candidates import ranking_question, reference_candidate, required_environment
from separatrix.study.distribution import described
from separatrix.study.study import Study
from separatrix.verdict.beyond_models import (
    NOT_FINISHED,
    Moved,
    Pocket,
    beyond_motion,
    not_finite,
    not_measured,
    pocket_of,
)
from separatrix.verdict.counting import RISK, RUNS, allowed_friction, counted, settles
from separatrix.verdict.drawn_frictions import DrawnBearings, drawn_bearings
from separatrix.verdict.draws import Case, UncertainInput
from separatrix.verdict.drivers import drivers, fitted, next_tests, reducible_shares
from separatrix.verdict.judgement import Judgement, Verdict
from separatrix.verdict.long_jobs import Load, Runner, scattered
from separatrix.verdict.ranking_records import MeanFriction, overall
from separatrix.verdict.uncertain_records import (
    AllowedFriction,
    Drivers,
    InputRow,
    NotDrawn,
    TestGain,
    UncertainEnvironment,
    UncertainMaterial,
    UncertainRow,
    UncertainStudy,
)

FEWEST = 64  # bearings below which no probability is worth a table
Counted = tuple[Judgement, Ensemble]


def uncertain_study(study: Study, bearings: int, *, runner: Runner | None = None) -> UncertainStudy:
    """Draw bearings from the uncertain inputs of a study and judge the cages of every candidate.

    Their number is best a power of two, and at least `FEWEST`. A friction without stated scatter has the
    study's default one, a guess. The numbers do not depend on the runner.

    Raises
    ------
    InputError
        Too few bearings, no candidates, or no draw makes a bearing.
    Interrupted
        With the answer to what was finished, if anything was.
    """
    ranking_question(study)
    if bearings < FEWEST:
        cure = "Powers of two spread most evenly: 512."
        raise InputError("--samples", f"must be at least {FEWEST}", got=str(bearings), cure=cure)
    drawn, runner = drawn_bearings(study, bearings), runner or Runner()
    inverse = _inverse(drawn, runner)
    pieces: dict[Case | str, Callable[[], object]] = {
        case: partial(counted, drawn, case, runner) for case in drawn.friction
    }
    pieces.update(inverse)

    def answer(found: Mapping[Case | str, object]) -> UncertainStudy:
        judged = {case: one for case in drawn.friction if isinstance(one := found.get(case), tuple)}
        answered = [found[key] for key in inverse if key in found]
        complete = len(found) == len(pieces)
        return replace(_answer(study, drawn, judged, answered, bearings), complete=complete)

    def load(key: Case | str) -> Load:
        """Work of a piece, in runs: an inverse question is a search from each kick."""
        return Load(len(drawn.kicks) * (len(drawn.runs) if isinstance(key, Case) else 2 * RUNS))

    return runner.work_out(lambda key: pieces[key](), scattered(pieces), into=answer, load=load)


def _answer(
    study: Study, drawn: DrawnBearings, judged: Mapping[Case, Counted], inverse: Sequence[object], asked: int
) -> UncertainStudy:
    """Record of what was computed, as if nothing was left out."""
    ranking = ranking_question(drawn.study)
    decided = {case: _drivers(drawn, case, one) for case, one in judged.items() if case.environment}
    undecided = [case for case in decided if judged[case][0].verdict is Verdict.UNDECIDED]
    environment = required_environment(study, ranking)
    own = _rows(drawn, environment, judged)
    moved = [
        Moved(row.name, found.largest_contact_force, found.largest_offset, found.by_kick)
        for row in own
        if isinstance(row, UncertainMaterial) and (found := row.judgement)
    ]
    central = drawn.central[reference_candidate(study, ranking).name]
    open_cases = {case: judged[case] for case in undecided if decided[case].shares}
    failed = len(drawn.failures)
    notes = (
        [f"{failed} of {asked} draws make no bearing and are left out: {drawn.failures[0]}"] if failed else []
    )
    chain = (note for one in drawn.central.values() for note in one.notes)
    return UncertainStudy(
        bearings=asked,
        failed=failed,
        stopped_risk=RISK,
        default_scatter=ranking.friction_scatter,
        environment=environment,
        inputs=tuple(map(_input_row, drawn.inputs)),
        environments=tuple(
            UncertainEnvironment(name=place, materials=_rows(drawn, place, judged))
            for place in ranking.environments
        ),
        overall=_rows(drawn, "", judged),
        drivers=tuple(decided.values()),
        undecided=tuple(map(_words, undecided)),
        next_tests=_next_tests(drawn, open_cases),
        allowed_friction=tuple(one for one in inverse if isinstance(one, AllowedFriction)),
        kicks=drawn.kicks,
        runs=sum(ensemble.outcome.size for _, ensemble in judged.values()),
        notes=(*chain, *notes, *beyond_motion(central, moved)),
        complete=True,
    )


def _inverse(drawn: DrawnBearings, runner: Runner) -> dict[str, Callable[[], object]]:
    """Inverse questions: a friction for each pocket."""
    ranking = ranking_question(drawn.study)
    alike: dict[Pocket, list[str]] = {}
    for name in dict.fromkeys(case.candidate for case in drawn.friction):
        alike.setdefault(pocket_of(drawn.central[name]), []).append(name)
    pieces: dict[str, Callable[[], object]] = {
        f"friction {names[0]}": partial(allowed_friction, drawn, names, ranking.friction_scatter, runner)
        for names in alike.values()
    }
    return pieces


def _rows(drawn: DrawnBearings, environment: str, judged: Mapping[Case, Counted]) -> tuple[UncertainRow, ...]:
    """Rows of an environment: verdicts first that are better, then the larger P(stable)."""
    ranking = ranking_question(drawn.study)
    means: dict[str, MeanFriction | None] = {}
    for candidate in ranking.candidates:
        places = (environment,) if environment else ranking.environments
        cases = [Case(candidate.name, place) for place in places]
        known = [drawn.stated[case] for case in cases if case in drawn.stated]
        means[candidate.name] = overall(with_scatter(one, ranking.friction_scatter) for one in known)
    measured = {name: one for name, one in means.items() if one is not None}
    rows = [_row(drawn, Case(n, environment), f, judged) for n, f in measured.items()]
    others = (NotDrawn(name=n, reason=not_measured(environment)) for n in means if n not in measured)
    return (*sorted(rows, key=_best_first), *others)


def _row(
    drawn: DrawnBearings,
    case: Case,
    mean: MeanFriction,
    judged: Mapping[Case, Counted],
) -> UncertainMaterial:
    """One candidate in one environment."""
    eta = np.quantile(_factors(drawn, case), (0.5, 0.05, 0.95))
    judgement = judged[case][0] if case in judged else None
    broken = not_finite(judgement) if judgement else NOT_FINISHED
    return UncertainMaterial(
        name=case.candidate,
        friction=mean.mean,
        friction_deviation=float(np.std(drawn.friction[case])),
        friction_scatter_assumed=mean.assumed,
        extrapolation=mean.extrapolation,
        restitution_factor=float(eta[0]),
        restitution_factor_low=float(eta[1]),
        restitution_factor_high=float(eta[2]),
        judgement=None if broken else judgement,
        reason=broken or (judgement.reason if judgement else ""),
    )


def _best_first(row: UncertainMaterial) -> tuple[int, float, float]:
    order = {Verdict.STABLE: 0, Verdict.UNDECIDED: 1, Verdict.UNSTABLE: 2}
    if row.judgement is None:
        return 3, 0.0, row.friction
    return order[row.judgement.verdict], -row.judgement.probability_stable, row.friction


def _factors(drawn: DrawnBearings, case: Case) -> Array:
    """Restitution factor of each bearing, shape (bearing,) [-]."""
    return np.array([one[case.candidate].restitution.restitution_factor for one in drawn.solved])


def _input_row(one: UncertainInput) -> InputRow:
    law = one.distribution
    return InputRow(
        name=one.key,
        unit=one.unit,
        distribution=law.text or described(law, one.unit),
        source=one.source,
        mean=law.mean,
        standard_deviation=law.standard_deviation,
    )


def _columns(drawn: DrawnBearings, case: Case) -> list[int]:
    """Inputs that may matter to a case: all but the frictions and materials of others."""
    own = (f"ranking.{case.candidate}.{case.environment}", f"ranking.{case.candidate}.material.")
    return [
        i
        for i, one in enumerate(drawn.inputs)
        if not one.key.startswith("ranking.") or one.key == own[0] or one.key.startswith(own[1])
    ]


def _drivers(drawn: DrawnBearings, case: Case, found: Counted) -> Drivers:
    """What decides a case, by a regression of its runs."""
    settled, columns = settles(found[1], found[0]), _columns(drawn, case)
    names = [drawn.inputs[i].key for i in columns]
    return drivers(case, names, drawn.scores[: settled.size, columns], settled)


def _next_tests(drawn: DrawnBearings, cases: Mapping[Case, Counted]) -> tuple[TestGain, ...]:
    """What measuring each input would settle of these cases."""
    asked = {}
    for case, (judged, found) in cases.items():
        settled, columns = settles(found, judged), _columns(drawn, case)
        scores = drawn.scores[: settled.size]
        b = np.zeros(1 + len(drawn.inputs))
        b[[0, *(1 + i for i in columns)]] = fitted(scores[:, columns], settled)
        asked[_words(case)] = (b, scores)
    return next_tests(drawn.inputs, reducible_shares(drawn.study, drawn.inputs), asked)


def _words(case: Case) -> str:
    return f"{case.candidate} in {case.environment}"
