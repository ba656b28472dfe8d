"""`simulate`: follow one run of the ensemble, by default the first from the reference disturbance."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import isfinite, nan
from typing import TYPE_CHECKING, Annotated

from separatrix.ground.document import Part
from separatrix.ground.errors import InputError
from separatrix.ground.quantity import alone
from separatrix.ground.units import NUMBER, printable
from separatrix.present.blocks import (
    Cell,
    Column,
    Facts,
    Heading,
    Level,
    Note,
    Page,
    Picture,
    Table,
    View,
    facts,
    text_column,
)
from separatrix.present.figure import Figure
from separatrix.verbs.parts.answer_page import figure_heading, page_of
from separatrix.verbs.parts.chain_blocks import clearance_blocks
from separatrix.verbs.parts.refused import refused
from separatrix.verbs.parts.telling import quantity, said, told
from separatrix.verbs.parts.verdict_blocks import DIRECTIONS, power_facts
from separatrix.verbs.verb import Option, Verb

if TYPE_CHECKING:
    from separatrix.study.study import Study
    from separatrix.verbs.answer_records import SimulationAnswer

MOST_SHOWN = 20_000
"""Samples of a simulated run, at most: every step of a short one."""

STEADY = 0.5
"""Coherence from which tilt and offset have a phase worth a number."""

SINGLE = (
    "A single run is not evidence: another seed may end differently. See `separatrix stability` and "
    "`separatrix rank`."
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """Which run, from what."""

    kick: Annotated[
        str | float | None,
        Option('For instance "0.5 m/s" [default: the reference kick of the study].', "SPEED"),
    ] = None
    run: Annotated[int, Option("Which run of the ensemble.", "N")] = 0
    restitution_factor: Annotated[
        str | float | None,
        Option(
            "Damp the races so that eta is this, as at a point of a map [default: that of the study].", "ETA"
        ),
    ] = None
    animate: Annotated[str | None, Option("Also write an animation.", "gif")] = None


def compute(study: Study, options: Options) -> SimulationAnswer:
    """Follow one run of the ensemble, by default the first from the reference kick."""
    from separatrix.cage import analyse, settings_for
    from separatrix.cage import simulate as follow
    from separatrix.chain.solution import solve
    from separatrix.study.candidates import cage_candidate, require_friction
    from separatrix.verbs.answer_records import SimulationAnswer
    from separatrix.verbs.parts.cage_of_study import MOST_RUNS, cage_of, extrapolation_notes, kick_speed
    from separatrix.verdict.beyond_models import Moved, beyond_motion
    from separatrix.verdict.reasons import force_limit
    from separatrix.verdict.response import cage_at
    from separatrix.verdict.which_ball import transmitted_force

    if options.animate not in (None, "gif"):
        raise InputError("--animate", "must be gif", got=printable(options.animate))
    if not 0 <= options.run <= MOST_RUNS:
        raise InputError("--run", f"must lie between 0 and {MOST_RUNS}", got=str(options.run))
    given = None if options.kick is None else kick_speed(options.kick)
    solution = solve(study)
    require_friction(study)
    cage = cage_of(solution)
    settings = settings_for(study.stability, cage)
    eta = given_factor(options)
    if eta is not None:
        cage = cage_at(cage, eta, cage.ball_cage_friction)
    speed = settings.middle_kick if given is None else given
    history = follow(
        cage,
        kick=speed,
        run=options.run,
        seed=settings.seed,
        duration=settings.duration,
        ball_scatter=settings.ball_scatter,
        samples=MOST_SHOWN,
    )
    made_of = cage_candidate(study)
    name = made_of.name if made_of else "The cage"
    moved = [Moved(name, history.largest_contact_force, history.largest_offset)]
    limit = force_limit(cage, transmitted_force(solution))
    return SimulationAnswer(
        solution=solution,
        cage=cage,
        history=history,
        analysis=analyse(cage, history),
        kick=speed,
        run=options.run,
        given_restitution_factor=eta,
        force_limit=limit if isfinite(limit) else None,
        notes=(
            *solution.notes,
            *cage.notes,
            *extrapolation_notes(solution),
            *beyond_motion(solution, moved),
        ),
    )


def given_factor(options: Options) -> float | None:
    """Return the restitution factor in place of the study's; None without one."""
    if options.restitution_factor is None:
        return None
    text = str(options.restitution_factor).strip()
    eta = float(text) if re.fullmatch(NUMBER, text) else nan
    if not 0.0 <= eta <= 1.0:
        raise InputError("--restitution-factor", "must be a number from 0 to 1", printable(text))
    return eta


def refusals(study: Study) -> Iterator[str]:
    """Yield why the pocket has no friction."""
    from separatrix.study.candidates import require_friction

    if study.cage is not None:
        yield from refused(study, lambda solution: require_friction(solution.study))


def page(answer: Part) -> Page:
    """Return the page of `simulate`."""
    clearances = answer.chain.get("clearances")
    return page_of(
        answer,
        Note(f"{answer.outcome}: {answer.outcome_sentence}", "lead"),
        Heading("The run"),
        run_facts(answer),
        Heading("Motion: means of the judged part"),
        motion_facts(answer),
        Heading("Forces, rubbing and work"),
        force_facts(answer),
        pockets(answer),
        Picture("simulation", lambda: _figure(answer), _caption(answer)),
        View("moving-cage", lambda: _view(answer), "The moving cage: play, turn, zoom."),
        *(clearance_blocks(clearances) if clearances else []),
        Note(SINGLE, "caveat"),
    )


def run_facts(answer: Part) -> Facts:
    """Return what a run started from, and by what part it was judged."""
    law = ["; by the linear law {drift_rate_law}"] if answer.drift_rate_law else []
    return facts(
        ("Operation", "; ".join(figure_heading(answer)[1:])),
        ("Initial disturbance", said(answer, f"{{kick}}; run {answer.run} of seed {answer.seed}")),
        ("Pocket friction", f"{told(answer.cage, 'ball_cage_friction')}{_of_whom(answer)}"),
        ("Ball", _ball(answer.cage)),
        ("Race damping", _damping(answer)),
        ("Judged", said(answer, "{judged_from} to {followed}; the run has {run_length}")),
        ("Drift rate", said(answer, "".join(["{drift_rate}", *law]))),
        ("Energy balance", said(answer, "closes to {energy_imbalance} of the work done")),
    )


def _of_whom(answer: Part) -> str:
    """Return the candidate and environment that a friction is of, if it is not the study's own."""
    entry = answer.values["study"]["cage"]["ball_cage_friction"]
    if entry["value"] is not None or not entry.get("candidate"):
        return ""
    return f", {entry['candidate']} in {entry['environment']}"


def _ball(cage: Part) -> str:
    if "free_ball" in cage:
        return "free"
    return "one state" if "traction" in cage else "damper"


def _damping(answer: Part) -> str:
    if "given_restitution_factor" not in answer:
        return ""
    eta = told(answer, "given_restitution_factor")
    size = told(answer.cage, "race_damping") if "race_damping" in answer.cage else "infinite"
    return f"{size}, for a restitution factor of {eta} in place of the study's"


def motion_facts(answer: Part) -> Facts:
    """Return how the cage moves in the judged part."""
    whirl = "none: the motion does not last"
    if "whirl_frequency" in answer:
        sense = DIRECTIONS[answer.whirl_direction] or "without direction"
        seen = f"{{whirl_frequency}} {sense}, seen from the balls; the centre moves at {{whirl_speed}}"
        whirl = said(answer, seen)
    offset = "{largest_offset} at most; mean {mean_offset}, standard deviation {offset_spread} (0: a circle)"
    return facts(
        ("Offset", said(answer, offset)),
        ("Tilt", _tilt(answer)),
        ("Axial place", said(answer, "{axial_low} to {axial_high}") if "axial_low" in answer else None),
        ("Whirl", whirl),
        ("Orbit", _orbit(answer)),
        ("Cage slip", _slip(answer)),
        ("Clearance", _clearance(answer)),
    )


def _tilt(answer: Part) -> str:
    if "largest_tilt" not in answer:
        return ""
    cone = "without a steady phase to the offset"
    if "tilt_phase" in answer and (answer.tilt_coherence or 0.0) >= STEADY:
        cone = f"{told(answer, 'tilt_phase')} ahead of the offset (0: a forward cone)"
    return f"{told(answer, 'largest_tilt')} at most; {cone}"


def _orbit(answer: Part) -> str:
    found = [
        f"{part} {told(answer, name)}"
        for part, name in (("centre", "orbit_speed"), ("tilt", "cone_speed"))
        if name in answer
    ]
    turning = alone(answer.cage.cage_speed, quantity("orbit_speed"), answer.cage.unit("cage_speed"))
    return f"{', '.join(found)}; the ball set turns at {turning}"


def _slip(answer: Part) -> str:
    if "cage_slip" not in answer:
        return "the ball set is at rest"
    size = alone(abs(answer.cage_slip), quantity("cage_slip"), answer.unit("cage_slip"))
    return f"{size} {'ahead of' if answer.cage_slip < 0.0 else 'behind'} the ball set"


def _clearance(answer: Part) -> str:
    pockets = f"pockets {told(answer.chain, 'half_play')} each way"
    if "axial_half_play" in answer.cage:
        pockets += f", {told(answer.cage, 'axial_half_play')} along the axis"
    if _is_landless(answer):
        return f"{pockets}; no land"
    return f"{answer.cage.guidance} land {told(answer.cage, 'land_clearance')} in diameter; {pockets}"


def _is_landless(answer: Part) -> bool:
    return answer.cage.guidance == "ball" or "land_clearance" not in answer.cage


def force_facts(answer: Part) -> Facts:
    """Return the largest forces, and what feeds and brakes the motion."""
    pocket = told(answer, "largest_contact_force")
    if answer.force_exceeds_races:
        limit = told(answer, "force_limit")
        pocket = f"above what the races hold, {limit}: beyond it this model of a ball has no meaning "
        pocket += "(`--ball free` has)"
    land = "the cage has no land" if _is_landless(answer) else told(answer, "largest_land_force")
    impacts = f"{sum(answer.pocket_impacts):.0f} in pockets, {answer.land_impacts} at the land"
    heat = alone(
        sum(answer.pocket_rubbing_power),
        quantity("pocket_rubbing_power"),
        answer.unit("pocket_rubbing_power"),
    )
    return facts(
        ("Pocket, largest", pocket),
        ("Land, largest", land),
        ("Impacts", impacts),
        ("Impulse", _impulse(answer)),
        *power_facts(answer),
        ("Rubbing in the pockets", f"{heat} of heat, mean of the run"),
        ("Work on the cage", _works(answer)),
    )


def _impulse(answer: Part) -> str:
    places = (
        ("front_share", "in front of the ball"),
        ("rear_share", "behind it"),
        ("axial_share", "at its axial sides"),
    )
    return ", ".join(f"{told(answer, name)} {where}" for name, where in places if answer.get(name))


def _works(answer: Part) -> str:
    """Return the work of each source up to the end of the judged part, beyond which it is not added up."""
    last = max((at for at, time in enumerate(answer.time) if time <= answer.followed), default=-1)
    each = (
        f"{name.replace('_', ' ')} {alone(work[last], quantity('work'), answer.work.unit(name))}"
        for name, work in answer.work.values.items()
        if work[last]
    )
    left = alone(answer.kinetic_energy[last], quantity("kinetic_energy"), answer.unit("kinetic_energy"))
    until = "" if last == -1 else f"up to {told(answer, 'followed')}: "
    return f"{until}{', '.join(each) or 'none'}; kinetic energy then {left}"


POCKET = {
    "pocket_angle": "place",
    "half_play": "half the clearance",
    "pocket_impacts": "impacts",
    "impact_rate": "impact rate",
    "impacts_per_turn": "impacts per turn of the cage",
    "pocket_rubbing_power": "heat of rubbing",
}
"""Numbers of each pocket, with what stands above them."""


def pockets(answer: Part) -> Table:
    """Return a row for each pocket: its place, its clearance, its impacts and rubbing."""

    def column(name: str, head: str) -> Column:
        values, known, unit = answer.get(name), quantity(name), answer.unit(name)
        return Column(head, lambda place: Cell(values[place], known, unit))

    columns = (
        text_column("pocket", lambda place: str(place + 1)),
        *(column(name, head) for name, head in POCKET.items() if name in answer),
    )
    rows = tuple(range(len(answer.pocket_angle)))
    return Table("pockets", columns, rows, "Each pocket over the whole run.", Level.REPORT | Level.SHEET)


def _caption(answer: Part) -> str:
    more = " tilt of its axis," if "lean" in answer else ""
    return (
        f"The run: path and whirl of the cage centre, its offset,{more} the forces; up to the end of "
        "the judged part, which is shaded, kinetic energy and the work of each source since the start."
    )


def _figure(answer: Part) -> Figure:
    """Return path and whirl of the centre; offset, in space tilt, forces and energy against time."""
    from separatrix.verbs.parts import run_panels as panels

    rows = [
        (panels.orbit(answer), panels.spectrum(answer, title="b  Whirl: velocity of the centre")),
        (panels.offset(answer, "c  Offset"), panels.forces(answer, "d  Forces")),
    ]
    if "lean" in answer:
        rows.append((panels.tilt(answer, "e  Tilt"), panels.energy(answer, "f  Kinetic energy and work")))
        return Figure(rows=tuple(rows), heading=figure_heading(answer), alt=_caption(answer), height=2.2)
    last = (panels.energy(answer, "e  Kinetic energy and work"),)
    return Figure(rows=(*rows, last), heading=figure_heading(answer), alt=_caption(answer), height=2.2)


def _view(answer: Part) -> str:
    from separatrix.present.view import page as view
    from separatrix.verbs.parts.cage_scene import page_scene

    return view(figure_heading(answer), page_scene(answer))


def files(
    answer: Part, options: Options | None, progress: Callable[[int, int], None] | None
) -> Iterator[tuple[str, bytes]]:
    """Yield the moving cage as a GIF, beside the paths of centre and lean, if it is wanted."""
    if options is None or options.animate is None:
        return
    from separatrix.present.animation import animation
    from separatrix.verbs.parts.cage_scene import scene
    from separatrix.verbs.parts.run_panels import lean, orbit

    at = scene(answer)
    panels = [(orbit(answer, title="Cage centre, turning frame"), at.centre)]
    panels += [(lean(answer), at.lean)] if at.in_space else []
    yield "simulation.gif", animation(at, panels, figure_heading(answer), progress=progress)


VERB = Verb(
    name="simulate",
    epilog="An unresolved run states its reason.",
    compute=compute,
    page=page,
    options=Options,
    needs=("cage",),
    moves_a_cage=True,
    files=files,
    refusals=refusals,
)
