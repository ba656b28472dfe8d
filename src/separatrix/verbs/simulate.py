"""`simulate`: follow one run of the ensemble, by default the first from the reference disturbance."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from typing import TYPE_CHECKING, Annotated

from separatrix.ground.plain_data import Part
from separatrix.present import view
from separatrix.present.blocks import Block, Facts, Heading, Level, Note, Page, Picture, View, facts
from separatrix.present.figure import Figure
from separatrix.present.quantity_text import fill, places_table, show
from separatrix.verbs.parts.answer_page import figure, figure_heading, page_of
from separatrix.verbs.parts.chain_blocks import clearance_blocks, heat_blocks
from separatrix.verbs.parts.verdict_blocks import DIRECTIONS, pocket_friction, power_facts
from separatrix.verbs.verb import Kick, Option, Verb

if TYPE_CHECKING:
    from separatrix.cage import History, MovingCage
    from separatrix.chain.solution import Solution
    from separatrix.study.study import Study
    from separatrix.verbs.cage_answers import SimulationAnswer

MOST_SHOWN = 20_000
"""Samples of a simulated run, at most: every step of a short one."""

STEADY = 0.5
"""Coherence from which tilt and offset have a phase worth a number."""

FREE = "free: with one state the motion lasts with forces above what the races hold"

SIGNS = (
    "A stable cage leaves the torque to balls and fluid. A whirl is heard, and shows by a torque that "
    "grows faster with speed than theirs, towards its square (Lewis and others, 44th AMS 2018)."
)

ETA = "Damp the races so that eta is this, as at a point of a map [default: that of the study]."
SINGLE = (
    "A single run is not evidence: another seed may end differently. See `separatrix stability` and "
    "`separatrix rank`."
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """Which run, from what."""

    kick: Kick = None
    run: Annotated[int, Option("Which run of the ensemble.", "N")] = 0
    restitution_factor: Annotated[str | float | None, Option(ETA, "ETA")] = None


def compute(study: Study, options: Options) -> SimulationAnswer:
    """Follow one run of the ensemble, by default the first from the reference disturbance."""
    from separatrix.cage import analyse, moving_cage, settings_for
    from separatrix.cage import simulate as follow
    from separatrix.cage.closed_forms import drift_rate_law
    from separatrix.chain.solution import solve
    from separatrix.study.candidates import cage_candidate, require_friction
    from separatrix.study.study import BallModel
    from separatrix.verbs.cage_answers import SimulationAnswer
    from separatrix.verbs.parts import cage_of_study as of
    from separatrix.verdict.beyond_models import Moved, beyond_motion
    from separatrix.verdict.critical_friction import cage_at
    from separatrix.verdict.judgement import transmitted_force
    from separatrix.verdict.parameter_axes import plain_number
    from separatrix.verdict.reasons import force_limit, outcome_sentence
    from separatrix.verdict.rig_signs import SLOWER, Followed, lasts, rig_signs, slower

    of.refuse_outside("--run", options.run, 0, of.MOST_RUNS)
    given, eta = None if options.kick is None else of.kick_speed(options.kick), None
    if options.restitution_factor is not None:
        eta = plain_number(str(options.restitution_factor).strip(), "--restitution-factor")
        of.refuse_outside("--restitution-factor", eta, 0.0, 1.0)
    solution = solve(study)
    require_friction(study)
    cage = of.cage_of(solution)
    settings = settings_for(study.stability, cage)
    cage = cage if eta is None else cage_at(cage, eta, cage.ball_cage_friction)
    speed = settings.middle_kick if given is None else given
    asked = {name: getattr(settings, name) for name in ("seed", "duration", "ball_scatter")}

    def followed(cage: MovingCage, kick: float, until: float | None = None) -> History:
        return follow(cage, kick=kick, run=options.run, samples=MOST_SHOWN, until=until, **asked)

    def grown(chain: Solution, cage: MovingCage, kick: float, found: History) -> Followed:
        if not lasts(found):
            return chain, cage, found
        if found.largest_contact_force > force_limit(cage, transmitted_force(chain)):
            cage = moving_cage(chain, cage.ball_cage_friction, BallModel.FREE)
        return chain, cage, followed(cage, kick, settings.duration)

    history, signs = followed(cage, speed), None
    may_change = solution.design.ball_model is BallModel.AUTO and eta is None and lasts(history)
    if may_change and history.largest_contact_force > force_limit(cage, transmitted_force(solution)):
        cage = moving_cage(solution, cage.ball_cage_friction, BallModel.FREE)
        history = followed(cage, speed)
    if eta is None and not study.operation.ramp_time:
        other, less = slower(solution), SLOWER * speed
        its = of.cage_of(other)
        slow = grown(other, its, less, followed(its, less))
        signs = rig_signs(grown(solution, cage, speed, history), slow)
    found, made_of = force_limit(cage, transmitted_force(solution)), cage_candidate(study)
    limit = found if isfinite(found) else None
    heat = cage.land_friction * history.rubbing_force * history.rubbing_speed
    name = made_of.name if made_of else "The cage"
    moved = Moved(name, history.largest_contact_force, history.largest_offset)
    notes = *(signs.heat.notes if signs and signs.heat else ()), *solution.notes, *cage.notes
    notes += *of.extrapolation_notes(solution), *beyond_motion(solution, [moved])
    return SimulationAnswer(
        solution=solution,
        cage=cage,
        kick=speed,
        run=options.run,
        given_restitution_factor=eta,
        outcome_sentence=outcome_sentence(history, limit=limit, rubbing_power=heat),
        force_limit=limit,
        force_exceeds_races=limit is not None and history.largest_contact_force > limit,
        drift_rate_law=drift_rate_law(cage),
        rubbing_power=heat,
        history=history,
        analysis=analyse(cage, history),
        signs=signs,
        notes=notes,
    )


def page(answer: Part) -> Page:
    """Return the page of `simulate`."""
    return page_of(
        answer,
        Note(f"{answer.outcome}: {answer.outcome_sentence}", "lead"),
        Heading("The run"),
        run_facts(answer),
        Heading("Motion and forces: means of the judged part"),
        motion_facts(answer),
        *sign_blocks(answer),
        places_table("pockets", answer, *POCKET, level=Level.REPORT | Level.SHEET, caption=POCKETS),
        Picture("simulation", lambda: _figure(answer), CAPTION),
        View("moving-cage", lambda: view.page(figure_heading(answer), view.scene(answer)), MOVING),
        *clearance_blocks(answer.chain.get("clearances")),
        Note(SINGLE, "caveat"),
    )


def run_facts(answer: Part) -> Facts:
    """Return what a run started from, and by what part it was judged."""
    cage, damping = answer.cage, None
    land = fill(cage, f"{cage.guidance} land {{land_clearance}} in diameter") if has_land(cage) else "no land"
    axial = fill(cage, ", {axial_half_play} along the axis") if "axial_half_play" in cage else ""
    axial += " and the radius" * (cage.pocket_shape == "spherical")
    if "given_restitution_factor" in answer:
        damping = show(cage, "race_damping") if "race_damping" in cage else "infinite"
        damping += fill(answer, ", for a restitution factor of {given_restitution_factor}, not the study's")
    judged = "{judged_from} to {followed}; the run has {run_length}"
    if answer.followed >= answer.run_length:  # which ends with its last sample
        judged = "{judged_from} to the end of the run, {run_length}"
    return facts(
        ("Operation", "; ".join(figure_heading(answer)[1:])),
        ("Initial disturbance", fill(answer, f"{{kick}}; run {answer.run} of seed {answer.seed}")),
        ("Pocket friction", pocket_friction(answer) or show(cage, "ball_cage_friction")),
        ("Ball", answer.values["study"]["cage"]["ball"]["value"] or FREE * ("free_ball" in cage)),
        ("Race damping", damping),
        ("Clearance", f"{land}; pockets {show(answer.chain, 'half_play')} each way{axial}"),
        ("Judged", fill(answer, judged)),
        ("Energy balance", fill(answer, "closes to {energy_imbalance} of the work done")),
    )


def has_land(cage: Part) -> bool:
    """Whether the ring guides the cage."""
    return cage.guidance != "ball" and "land_clearance" in cage


def motion_facts(answer: Part) -> Facts:
    """Return how the cage moves in the judged part, its largest forces, and what feeds and brakes it."""
    whirl, slip = "none that lasts", "the ball set is at rest"
    if answer.outcome == "SETTLES":
        whirl = "none: the pockets sustain no motion"
    if "whirl_frequency" in answer:
        sense = DIRECTIONS[answer.whirl_direction] or "without direction"
        whirl = f"{{whirl_frequency}} {sense}, seen from the balls; the centre moves at {{whirl_speed}}"
        if answer.followed < answer.run_length:
            whirl += ", and at {grown_speed} in the last fifth of the run"
    if "cage_slip" in answer:
        slip = "{cage_slip} of the ball set's speed (positive: the cage lags)"
    pocket = "{largest_contact_force}"
    if answer.force_exceeds_races:
        pocket = "above {force_limit}, whose friction is all that the races hold: beyond it this model of a "
        pocket += "ball has no meaning (`[cage] ball = 'free'` has)"
    tilt = "{largest_tilt} at most; without a steady phase to the offset"
    if "tilt_phase" in answer and (answer.tilt_coherence or 0.0) >= STEADY:
        tilt = "{largest_tilt} at most; {tilt_phase} ahead of the offset (0: a forward cone)"
    offset = "{largest_offset} at most; mean {mean_offset}, standard deviation {offset_spread} (0: a circle)"
    drift = "{drift_rate}; by the linear law {drift_rate_law}"  # 0 with a land
    return facts(
        ("Offset", fill(answer, offset)),
        ("Drift rate", fill(answer, drift) if answer.drift_rate_law else None),
        ("Tilt", fill(answer, tilt) if "largest_tilt" in answer else None),
        ("Axial place", fill(answer, "{axial_low} to {axial_high}") if "axial_low" in answer else None),
        ("Whirl", fill(answer, whirl)),
        ("Cage slip", fill(answer, slip)),
        ("Pocket force, largest", fill(answer, pocket)),
        ("Land force, largest", show(answer, "largest_land_force") if has_land(answer.cage) else "no land"),
        ("Impacts", f"{sum(answer.pocket_impacts):.0f} in pockets, {answer.land_impacts} at the land"),
        *power_facts(answer),
    )


def sign_blocks(answer: Part) -> list[Block]:
    """Return what a test rig sees of this run; nothing during a start-up."""
    if "bearing_torque" not in answer:
        return []
    line = "nothing that lasts"
    if "housing_frequency" in answer:
        line = fill(answer, "the third octave about {housing_frequency}, with {housing_share} of the power")
        if answer.signs_outcome == "SETTLES":
            line += ": the turn of the cage, whose centre stays off the axis"
    torque = (
        "{bearing_torque}, of it {cage_torque} by pockets and lands; {pocket_share} of the power at pockets"
    )
    law = f"none: at 0.8 of the speed the same run {answer.slower_outcome}, here it {answer.signs_outcome}"
    if "torque_exponent" in answer:
        law = "{torque_exponent} from 0.8 of the speed ({slower_torque}) on; without the cage {race_exponent}"
    balls = f"free, by which this run {answer.signs_outcome}" if answer.signs_with_free_balls else None
    return [
        Heading("Signs on a test rig"),
        facts(
            ("Balls", balls),
            ("Torque of the shaft", fill(answer, torque)),
            ("Loudest in the housing", line),
            ("Torque goes with speed to the power", fill(answer, law)),
        ),
        Note(SIGNS, level=Level.LONG),
        *heat_blocks(answer.get("heat")),
    ]


POCKET = ("pocket_angle", "half_play", "pocket_impacts", "impacts_per_turn", "pocket_rubbing_power")
POCKETS = "Each pocket over the whole run."
MOVING = "The moving cage: play, turn, zoom."
CAPTION = (
    "The run: path and whirl of the cage centre, its offset, the forces, in space the tilt of its axis; the "
    "judged part is shaded."
)


def _figure(answer: Part) -> Figure:
    """Return path and whirl of the centre; offset, forces and in space tilt against time."""
    from separatrix.verbs.parts import run_pictures as panels

    centre = panels.orbit(answer), panels.spectrum(answer)
    course = panels.offset(answer), panels.forces(answer)
    tilt = [(panels.tilt(answer),)] if "lean" in answer else []
    return figure(answer, centre, course, *tilt, height=2.2)


VERB = Verb(
    name="simulate",
    compute=compute,
    page=page,
    epilog="An unresolved run states its reason.",
    options=Options,
    needs=("cage",),
    moves_a_cage=True,
    links=("known_friction", "cage_motion", "coolant"),
)
