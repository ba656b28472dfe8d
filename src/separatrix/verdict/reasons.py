"""What the cage does at the end of its runs, and the sentences of reason behind a verdict."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from separatrix.cage.closed_forms import drift_rate_law, room
from separatrix.cage.outcome import GROWN, Cause, RunOutcome
from separatrix.ground.schema import Spelled
from separatrix.ground.units import Array, Metre, Newton, Ratio, Watt, format_number, format_quantity

if TYPE_CHECKING:
    from separatrix.cage.course import History
    from separatrix.cage.ensemble import Ensemble
    from separatrix.cage.moving_cage import MovingCage
    from separatrix.verdict.judgement import KickCount

Mask = NDArray[np.bool_]

LEFT, IN_WALL = 2.0, 0.1
"""Mean offset at which a calm cage has left its pockets: in half their clearances, and on a land also in
diameters of a ball. The balls yield along their orbits, so a wide land lets the cage move on with them; but
beyond half a wall of a fifth of a ball, a thin one by our guess, they are out of it. Where the diameters of a
cage are known each ball is followed to its edge."""

BEYOND_LAND: Ratio = 1.2
"""Offset over the room of the cage's centre beyond which the land's spring is the question, not the cage."""

BEYOND = 2.0
"""Offset that no cage survives, over the room of its centre (land or half pocket clearance, the larger)."""

OUTCOME_SENTENCES = {
    RunOutcome.SETTLES: "The cage comes to rest relative to the ball set, but for what its loads maintain.",
    RunOutcome.ROLLS: "The cage rolls in its pockets: a weak whirl, below what frame and loads can give it.",
    RunOutcome.WHIRLS: "Friction in the pockets sustains the motion, or makes it grow.",
    RunOutcome.DRIFTS: "The cage has no land, and nothing holds its centre.",
    RunOutcome.UNRESOLVED: "The run does not show where the motion ends.",
}

CAUSES = {
    Cause.LEFT_POCKET: "a ball reaches the edge of its pocket's wall; check [cage] diameters and clearances",
    Cause.NO_CONTACT: "nothing touches; raise [stability] duration or kicks",
    Cause.FALLING: "the motion still loses energy at the end; raise [stability] duration",
    Cause.LAND_FRICTION: "friction on the land, not in the pockets",
    Cause.NOT_FINITE: "the motion leaves the range of numbers; lower [stability] kicks or the stiffnesses",
}


def outcome_sentence(history: History, *, limit: Newton | None, rubbing_power: Watt) -> str:
    """Return in words where the motion of a run ends, and how the cage then moves, rolls or rubs.

    Beyond the `limit` of the races a force in a pocket means nothing.
    """
    outcome, cause = history.outcome, CAUSES.get(history.cause, "")
    said = OUTCOME_SENTENCES[outcome] + (f" Cause: {cause}." if cause else "")
    if outcome is RunOutcome.SETTLES and history.rubbing_force > 0.0:
        said = "Friction in the pockets does not sustain the motion; the cage moves on its land."
    if history.cause is Cause.LAND_FRICTION:
        said = "Friction on the land, not in the pockets, sustains the motion, or makes it grow."
    if history.cause is Cause.LEFT_POCKET:
        when = format_quantity(history.left_time, "s", 3)
        said = f"Ball {history.left_ball} reaches the edge of its pocket's wall at {when}: the model ends."
    if outcome is RunOutcome.ROLLS:
        pace = f"{history.whirl_frequency:.3g} Hz, fed {format_quantity(history.pocket_power, 'W', 3)}"
        largest = history.largest_contact_force
        force = format_quantity(largest, "N", 3)
        if limit is not None and largest > limit:
            force = f"above {format_quantity(limit, 'N', 3)}, whose friction is all that the races hold"
        said += f" It whirls at {pace}; the largest force in a pocket is {force}."
    if outcome in (RunOutcome.SETTLES, RunOutcome.ROLLS) and history.mean_offset > 0.0:
        said += f" Its centre is {format_quantity(history.mean_offset, 'm', 3)} from the axis on average"
        force, power = format_quantity(history.rubbing_force, "N", 3), format_quantity(rubbing_power, "W", 3)
        said += f", and it rubs on its land with {force}, {power}." if history.rubbing_force > 0.0 else "."
    return said


class CageMotion(Spelled):
    """What the cage does at the end of the runs; SETTLED: within its clearances; ROLLING: in its pockets."""

    SETTLED = "SETTLED"
    ROLLING = "ROLLING"
    ON_THE_LAND = "ON THE LAND"
    WHIRLING = "WHIRLING"
    DRIFTING = "DRIFTING"


def cage_motion(ensemble: Ensemble, kick: int) -> CageMotion | None:
    """Class of the motion that most runs from the kick at this place end in; None if most are unresolved."""
    outcome = ensemble.outcome[kick]
    counts = {one: int(np.count_nonzero(outcome == one)) for one in RunOutcome}
    unresolved, rolls = counts.pop(RunOutcome.UNRESOLVED), counts.pop(RunOutcome.ROLLS)
    counts[RunOutcome.SETTLES] += rolls
    most = max(counts, key=lambda one: (counts[one], one))
    if counts[most] < max(1, unresolved):
        return None
    if most != RunOutcome.SETTLES:
        return CageMotion.WHIRLING if most == RunOutcome.WHIRLS else CageMotion.DRIFTING
    settles = counts[most] - rolls
    if rolls > settles:
        return CageMotion.ROLLING
    rubs = ensemble.rubbing_force[kick][outcome == RunOutcome.SETTLES] > 0.0
    return CageMotion.ON_THE_LAND if 2 * np.count_nonzero(rubs) > settles else CageMotion.SETTLED


def ball_words(cage: MovingCage) -> str:
    """Ball of a cage, in words."""
    if cage.free_ball is not None:
        return "free"
    return "damper" if cage.traction is None else "one state"


def force_limit(cage: MovingCage, capacity: Newton | None = None) -> Newton:
    """Force of a pocket whose friction is all that the races hold of a ball [N].

    Beyond it damper and one state have no meaning. Infinite among free balls, without friction, and where
    nothing states what the races hold: `capacity`, f_BT (Q_i + Q_o) [N], or the law of traction.
    """
    held = cage.traction.capacity if cage.traction is not None else math.inf
    if cage.free_ball is not None or cage.ball_cage_friction == 0.0:
        return math.inf
    return (held if capacity is None else capacity) / cage.ball_cage_friction


def driven_by_land(ensemble: Ensemble) -> Mask:
    """Runs that whirl by friction on the land, while the pockets take energy, shape (kick, run)."""
    return np.asarray((ensemble.cause == Cause.LAND_FRICTION) & (ensemble.outcome == RunOutcome.WHIRLS))


def left_pockets(cage: MovingCage, ensemble: Ensemble) -> Mask:
    """Runs whose centre ended out of the pockets, or pressed far into the land, shape (kick, run)."""
    return np.asarray(ensemble.mean_offset > min(in_pockets(cage), on_land(cage)))


def in_pockets(cage: MovingCage) -> Metre:
    """Offset beyond which balls are out of their pockets [m]."""
    wall = 0.0 if math.isinf(cage.land_gap) else IN_WALL * cage.ball_diameter
    return max(LEFT * cage.half_play, wall) if cage.half_play > 0.0 else math.inf


def on_land(cage: MovingCage) -> Metre:
    """Offset beyond which a cage at rest is pressed far into its land [m]; of wider pockets, theirs."""
    return BEYOND_LAND * max(cage.land_gap, cage.half_play) or math.inf


def largest_room(cage: MovingCage) -> Metre:
    """Offset beyond which the model of land and pockets has no meaning [m]."""
    wide = max(room(cage), cage.half_play)
    return BEYOND * wide if wide > 0.0 else math.inf


def too_few(runs: int) -> str:
    """Return that no count of so few runs would decide."""
    return f"Too few runs for a verdict: {runs} from each disturbance; set [stability] runs to 4 or more."


def settles(cage: MovingCage, ensemble: Ensemble, kick: int) -> str:
    """Return what share of the runs from the worst kick settles or rolls, and how hard they roll or rub."""
    outcome, every = ensemble.outcome[kick], ensemble.outcome
    settled, rolling = outcome == RunOutcome.SETTLES, outcome == RunOutcome.ROLLS
    ends = "settle or roll in their pockets" if rolling.any() else "settle"
    share, speed = _share(settled | rolling), ensemble.kicks[kick]
    start = f"from the worst disturbance, {speed:g} m/s"
    if len(every) > 1 and ((every == RunOutcome.SETTLES) | (every == RunOutcome.ROLLS)).all():
        start = "from every disturbance"
    said = f"{share} of the runs {ends} {start}"
    if np.count_nonzero(rolling) > np.count_nonzero(settled):
        force = median(ensemble.largest_contact_force[kick][rolling])
        power = median(ensemble.pocket_power[kick][rolling])
        many = f"{100.0 * float(rolling.mean()):.0f} %"
        said += f"; {many} roll, with up to {_three(force)} N in a pocket, fed {_watt(power)} (medians)"
    elif (force := median(ensemble.rubbing_force[kick][settled])) > 0.0:
        speed = median(ensemble.rubbing_speed[kick][settled])
        power = cage.land_friction * median((ensemble.rubbing_force * ensemble.rubbing_speed)[kick][settled])
        rubs = f"{_three(force)} N at {_three(speed)} m/s ({_watt(power)})"
        said += f"; the cage then rubs on its land with {rubs}"
    return f"{said}.{few_driven(cage, ensemble)}{few_left(ensemble)}"


def whirls(cage: MovingCage, ensemble: Ensemble, kick: int, *, by_land: bool) -> str:
    """Return what share whirls from the worst kick, how fast, and what friction feeds it."""
    whirling = ensemble.outcome[kick] == RunOutcome.WHIRLS
    pace = float(np.median(ensemble.whirl_frequency[kick][whirling]))
    first = f"{_share(whirling)} of the runs from {ensemble.kicks[kick]:g} m/s whirl, at {_three(pace)} Hz "
    first += "in their judged part"
    fed = np.maximum(ensemble.pocket_power[kick], 0.0) + np.maximum(ensemble.land_power[kick], 0.0)
    power = fed[whirling & (fed > 0.0)]
    if not power.size:
        return f"{first}; the energy passes {GROWN:g} times that of disturbance and frame."
    what, force = "friction", ""
    if by_land:
        what = f"friction on the land, {cage.land_friction:g}, and not in the pockets,"
        force = f", with up to {_three(ensemble.largest_land_force[kick][whirling].max())} N there"
    return f"{first}; {what} feeds the cage {_watt(float(np.median(power)))}{force}."


def not_finite(ensemble: Ensemble) -> str:
    """Return in how many runs the motion left the range of numbers."""
    runs = ensemble.cause == Cause.NOT_FINITE
    return f"In {int(runs.sum())} of {runs.size} runs {CAUSES[Cause.NOT_FINITE]}."


def ends(count: KickCount) -> str:
    """Return how many runs settle, roll, whirl and drift."""
    parts = {"settle": count.settles, "roll": count.rolls, "whirl": count.whirls, "drift": count.drifts}
    return ", ".join(f"{n} {word}" for word, n in parts.items() if n)


def mixed(ensemble: Ensemble, counts: tuple[KickCount, ...], kick: int, *, is_sure: bool) -> str:
    """Return what the runs from the worst kick do; of unresolved ones also why.

    `is_sure` says that their share is neither that of a stable nor that of an unstable cage.
    """
    count, said = counts[kick], ends(counts[kick])
    if count.unresolved:
        said = f"{said}{', ' if said else ''}{count.unresolved} are unresolved"
        causes = ensemble.cause[kick][ensemble.outcome[kick] == RunOutcome.UNRESOLVED]
        most = Cause(int(np.bincount(causes).argmax()))
        seen = f"followed for {_three(ensemble.followed[kick].max())} s"
        if most == Cause.LEFT_POCKET:
            seen = _first_left(ensemble)
        return f"Of {count.runs} runs from {count.kick:g} m/s {said}: {CAUSES[most]} ({seen})."
    if is_sure:
        return (
            f"The start decides: of {count.runs} runs from {count.kick:g} m/s {said}; more runs would not "
            "change that, less friction would."
        )
    cure = "more may decide: raise [stability] runs"
    return f"No clear answer from {count.kick:g} m/s: of {count.runs} runs {said}; {cure}."


def few_left(ensemble: Ensemble) -> str:
    """Return in how many runs of a stable cage a ball reached the edge of its wall; empty if in none."""
    count = np.count_nonzero(ensemble.left_ball)
    if not count:
        return ""
    where = f"In {count} of {ensemble.outcome.size} runs a ball reached the edge of its pocket's wall"
    return f" {where} ({_first_left(ensemble)})."


def _first_left(ensemble: Ensemble) -> str:
    """The first ball, of all runs, at the edge of its wall, and when."""
    at = np.where(ensemble.left_ball > 0, ensemble.left_time, np.inf).argmin()
    ball, time = ensemble.left_ball.flat[at], float(ensemble.left_time.flat[at])
    return f"first ball {ball} after {format_quantity(time, 's', 3)}"


def taken_by_land(cage: MovingCage, ensemble: Ensemble) -> str:
    """Return how many runs that were followed for long whirl round the land in the end, and how hard."""
    taken = driven_by_land(ensemble)
    at = f"Followed for {_three(ensemble.followed.max())} s at a friction of {cage.ball_cage_friction:g}"
    said = f"{at}, {int(taken.sum())} of {taken.size} runs end whirling round the land"
    if not taken.any():
        return f"{said}."
    return (
        f"{said}: {_lively(ensemble, taken)}. Friction there, {cage.land_friction:g}, and not in the "
        "pockets, drives that; check [cage] land_friction."
    )


def few_driven(cage: MovingCage, ensemble: Ensemble) -> str:
    """Return how many runs of a stable cage whirl round the land, and how hard; empty if there is none."""
    driven = driven_by_land(ensemble)
    if not driven.any():
        return ""
    kicks = ", ".join(f"{kick:g}" for kick in ensemble.kicks[driven.any(axis=1)])
    return (
        f" From {kicks} m/s, {int(driven.sum())} runs whirl round the land by friction there, "
        f"{cage.land_friction:g}: {_lively(ensemble, driven)}."
    )


def _lively(ensemble: Ensemble, runs: Mask) -> str:
    energy, power = (median(values[runs]) for values in (ensemble.end_energy, ensemble.land_power))
    force = float(ensemble.largest_land_force[runs].max())
    return f"{format_quantity(energy, 'J', 3)}, fed {_watt(power)}, up to {_three(force)} N on the land"


def out_of_pockets(cage: MovingCage, ensemble: Ensemble, left: Mask) -> str:
    """Return how far off the centre ends, and whether its balls are out or its land is pressed in."""
    offset = float(ensemble.mean_offset[left].max())
    said = f"The motion settles, but the cage centre ends up to {_three(1e3 * offset)} mm off in "
    said += f"{int(left.sum())} of {left.size} runs, more than"
    if offset > in_pockets(cage):
        wall = f"{_three(1e3 * in_pockets(cage))} mm, where balls are out of their pockets"
        return f"{said} {wall}: the land is too wide to guide it."
    force = format_quantity(median(ensemble.rubbing_force[left]), "N", 3)
    what = "balls that lead and lag under radial load or moment" if cage.orbital_cosines else "its motion"
    return (
        f"{said} {_three(1e3 * on_land(cage))} mm, {BEYOND_LAND:g} times what land and pockets leave: {what} "
        f"press it into the land with {force}, and the land's stiffness decides where it stays."
    )


def beyond_room(cage: MovingCage, ensemble: Ensemble) -> str:
    """Return how far the centre went beyond what land and pockets leave."""
    offset, clearance = 1e3 * float(ensemble.largest_offset.max()), 1e3 * room(cage)
    return (
        f"The motion settles, but the cage centre reached {_three(offset)} mm, more than "
        f"{_three(1e3 * largest_room(cage))} mm (clearance {_three(clearance)} mm): no cage survives that; "
        f"lower [stability] kicks or check [cage] land_stiffness."
    )


def drift(cage: MovingCage, ensemble: Ensemble, kick: int) -> str:
    """Return how many runs left their pockets, and the rate of drift as measured and by the linear law."""
    limit = 2.0 * cage.half_play
    passed = int(np.count_nonzero(ensemble.largest_offset > limit))
    seen = f"its offset passed {_three(1e3 * limit)} mm, the pocket clearance, in {passed} of "
    seen += f"{ensemble.outcome.size} runs"
    if limit == 0.0:
        seen = "without pocket clearance nothing holds its centre"
    rate = drift_rate_law(cage)
    if rate > 0.0:
        measured = median(ensemble.drift_rate[kick][ensemble.outcome[kick] != RunOutcome.WHIRLS])
        seen += f", and by the linear law it grows e-fold every {_three(1.0 / rate)} s"
        seen += f" ({_three(rate)} 1/s; measured {_three(measured)} 1/s)"
    cure = 'If its pockets wrap round their balls, give [cage] pocket_shape = "spherical".'
    return f"The cage has no land and drifts: {seen}. {cure}"


def median(values: Array) -> float:
    """Median of some runs; 0 of none."""
    return float(np.median(values)) if values.size else 0.0


def _share(runs: Mask) -> str:
    return "All" if runs.all() else f"{100.0 * float(runs.mean()):.0f} %"


def _three(value: float) -> str:
    return format_number(value, 3)


def _watt(power: float) -> str:
    return format_quantity(power, "W", 3)
