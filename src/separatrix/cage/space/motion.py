"""Motion of the cage in space from event to event, each mode by its series."""

from __future__ import annotations

import math

from separatrix.cage.motion import MOST_STEPS, pace_at
from separatrix.cage.records import POWERS, Whole
from separatrix.cage.series import ROUNDING
from separatrix.cage.space.events import (
    LEAVE,
    MEET,
    NOTHING,
    REGION,
    SLIDE_OFF,
    STRIP,
    at_time,
    pocket_event,
    slide_event,
    strip_event,
)
from separatrix.cage.space.expand import expand, load, step_length
from separatrix.cage.space.land import dent_strip
from separatrix.cage.space.records import (
    ALONG,
    AXIAL,
    BALL_COLUMNS,
    BALLS,
    CAGE_COLUMNS,
    CLEAR,
    CONTACTS,
    DEPTH_L,
    DZ,
    FLAT_BACK,
    FLAT_FRONT,
    FORCE_X,
    GONE,
    LAST,
    LEAD,
    NONE,
    OUTER_CLEAR,
    OUTER_RIM,
    PRESSED,
    PUSH_L,
    RELEASED,
    RIMS,
    ROUND_END,
    SPEED,
    STATE,
    STRIP_COLUMNS,
    VA,
    VB,
    VS,
    VX,
    VY,
    VZ,
    A,
    B,
    Motion,
    Numbers,
    Parts,
    S,
    SpaceLook,
    Works,
    X,
    Y,
    Z,
)
from separatrix.cage.space.rim_events import EDGE, PASS, met_kind, rim_event
from separatrix.cage.space.tally import enter_step, kinetic
from separatrix.cage.space.two_points import change_edge, come_to_edge, mark_points, pass_edge, tend_edges
from separatrix.compiled import inlined_kernel, inner_kernel
from separatrix.units import Array


@inlined_kernel
def list_contacts(parts: Parts, edged: bool) -> None:
    """List the contacts that touch and the balls that move."""
    touching = active = rims = 0
    for j in range(parts.moving.size):
        if parts.moving[j] == 0:
            continue
        parts.active[active] = j
        active += 1
        for i in range(2 * j, 2 * j + 2):
            if parts.kind[i] != NONE and parts.kind[i] < OUTER_RIM:
                parts.touching[touching] = i
                touching += 1
    if edged:
        for i in range(parts.kind.size):
            if parts.kind[i] >= OUTER_RIM:
                parts.touching[touching + rims] = i
                rims += 1
    parts.listed[CONTACTS], parts.listed[BALLS], parts.listed[RIMS] = touching + rims, active, rims


@inlined_kernel
def finish(p: Numbers, parts: Parts, state: Motion, t: float) -> None:
    """State at the end of a step that lasts for t."""
    cage, here = parts.here[0], parts.here[1]
    last = parts.listed[LAST]
    at_time(parts.cage, last, t, CAGE_COLUMNS if p.needs_frame else FORCE_X, cage)
    state.x, state.y, state.z, state.s, state.a, state.b = (
        cage[X],
        cage[Y],
        cage[Z],
        cage[S],
        cage[A],
        cage[B],
    )
    state.vx, state.vy, state.vz, state.vs = cage[VX], cage[VY], cage[VZ], cage[VS]
    state.va, state.vb = cage[VA], cage[VB]
    state.clock += t
    for b in range(parts.listed[BALLS]):
        j = parts.active[b]
        at_time(parts.ball[j], last, t, ALONG + 1 if p.slides_from > 0.0 else STATE, here)
        ball = parts.ball[j, 0]
        ball[LEAD], ball[SPEED], ball[AXIAL] = here[LEAD], here[SPEED], here[AXIAL]
        if p.slides_from > 0.0:
            ball[ALONG] = here[ALONG]
    if p.harmonics > 0:
        for j in range(parts.moving.size):
            for k in range(2 * p.harmonics):
                parts.ball[j, 0, LEAD] += parts.drive[k, j] * cage[GONE + k]
    for i in range(parts.mode.size):
        if parts.mode[i] != CLEAR:
            at_time(parts.strip[i], last, t, STRIP_COLUMNS, here)
            parts.strip[i, 0, DEPTH_L], parts.strip[i, 0, PUSH_L] = here[DEPTH_L], here[PUSH_L]


@inlined_kernel
def settle_balls(p: Numbers, parts: Parts, works: Works) -> None:
    """Balls that touch nothing and hardly move come to rest in their orbit and their groove."""
    for b in range(parts.listed[BALLS]):
        j = parts.active[b]
        one, two = parts.kind[2 * j], parts.kind[2 * j + 1]
        if (one != NONE and one < OUTER_CLEAR) or (two != NONE and two < OUTER_CLEAR):
            continue
        ball = parts.ball[j]
        lead, speed, axial = ball[0, LEAD], ball[0, SPEED], ball[0, AXIAL]
        if abs(speed) > p.still or abs(axial) > p.resting:
            continue
        gone = 0.5 * (p.groove_stiffness * axial**2 + p.ball_mass * speed**2)
        works.races -= gone
        works.gross += gone
        for n in range(POWERS):
            for k in range(BALL_COLUMNS):
                ball[n, k] = 0.0
        ball[0, LEAD] = lead
        parts.moving[j] = one != NONE or two != NONE


@inlined_kernel
def change_creep(p: Numbers, parts: Parts, share: float, slides: int, works: Works) -> None:
    """Let a ball slide off, or creep again where it is slow; the races take or give its kinetic energy."""
    for b in range(parts.listed[BALLS]):
        j = parts.active[b]
        ball = parts.ball[j, 0]
        energy = 0.5 * p.ball_mass * ball[SPEED] ** 2
        if j == slides:
            parts.creeping[j] = 0
            works.races += energy
            works.gross += energy
            continue
        is_slow = abs(ball[SPEED]) <= share * p.knee
        if is_slow and parts.creeping[j] == 0 and abs(ball[ALONG]) < BACK * p.slides_from:
            parts.creeping[j] = 1
            works.races -= energy
            works.gross += energy


BACK = 0.98
"""Share of the force from which a ball slides below which it may creep again."""


@inlined_kernel
def change(
    p: Numbers,
    parts: Parts,
    event: int,
    which: int,
    becomes: int,
    look: SpaceLook,
    hits: Whole,
    edged: bool,
) -> None:
    """Change the mode of what ended a step."""
    if event == LEAVE:
        parts.kind[which] = NONE
    elif event == MEET:
        j = which // 2
        if edged and becomes < OUTER_RIM:
            becomes = met_kind(p, parts, which, becomes)
        if parts.moving[j] == 0:
            lead = parts.ball[j, 0, LEAD]
            for n in range(POWERS):
                for k in range(BALL_COLUMNS):
                    parts.ball[j, n, k] = 0.0
            parts.ball[j, 0, LEAD] = lead
        parts.kind[which], parts.moving[j] = becomes, 1
        if edged:
            parts.stiff[which] = p.stiffness
            if becomes >= OUTER_CLEAR:
                come_to_edge(p, parts, which)
        if becomes < OUTER_CLEAR:
            hits[j] += 1
            look.strikes += 1.0
    elif edged and event == EDGE:
        change_edge(p, parts, which, becomes)
    elif edged and event == PASS:
        pass_edge(p, parts, which, becomes)
    elif event == REGION:
        parts.region[which] = becomes
        one, two = 2 * which, 2 * which + 1
        if becomes == 0 and parts.kind[one] != NONE:
            parts.kind[two] = FLAT_FRONT if parts.ball[which, 0, DZ] > 0.0 else FLAT_BACK
            parts.kind[one], parts.stiff[two] = NONE, parts.stiff[one]
        elif becomes != 0 and parts.kind[two] != NONE:
            parts.stiff[one] = parts.stiff[two]
            parts.kind[one], parts.kind[two] = ROUND_END, NONE
    elif becomes == PRESSED:
        look.land_hits += parts.mode[which] == CLEAR
        parts.mode[which] = PRESSED
    else:
        if becomes != CLEAR:
            dent_strip(p, parts, which, 0)
            becomes = RELEASED if parts.strip[which, 0, DEPTH_L] > ROUNDING * p.land_gap else CLEAR
        parts.mode[which] = becomes


@inlined_kernel
def take_steps(
    p: Numbers,
    parts: Parts,
    state: Motion,
    works: Works,
    step: Works,
    look: SpaceLook,
    hits: Whole,
    heat: Array,
    length: float,
    ceiling: float,
    edged: bool,
) -> bool:
    """Advance the cage as `advance` does, where no edge can touch a ball or where one may."""
    done, taken = 0.0, 0
    most = MOST_STEPS * (1.0 + length * p.fastest)
    while done < length and kinetic(p, state) < ceiling:
        taken += 1
        if taken > most:
            return False
        now = pace_at(p, state.clock)  # type: ignore[arg-type]  # reads the ramp of either record
        list_contacts(parts, edged)
        load(p, parts, state)
        expand(p, parts, now, state.reach, edged)
        longest = step_length(p, parts)
        h = min(longest, length - done)
        if state.clock < p.ramp_time:
            h = min(h, p.ramp_time - state.clock)
        end, event, which, becomes = pocket_event(p, parts, h)
        if edged:
            end, event, which, becomes = rim_event(p, parts, h, end, event, which, becomes)
        end, event, which, becomes = strip_event(p, parts, h, end, event, which, becomes)
        end, event, which, becomes = slide_event(p, parts, now.share, h, end, event, which, becomes)
        enter_step(p, parts, now, h, end, end * h / longest, works, step, look, heat)
        finish(p, parts, state, end * h)
        if edged and parts.listed[RIMS] > 0:
            mark_points(parts, end * h)
        done = length if event == NOTHING and h == length - done else done + end * h
        # What the next step may last: about twice the last ones where events end them
        state.reach = 2.0 * h if event == NOTHING else 0.5 * state.reach + end * h
        if event == STRIP or (edged and event != NOTHING):
            load(p, parts, state)
        if p.slides_from > 0.0:
            change_creep(p, parts, now.share, which if event == SLIDE_OFF else -1, works)
        if event != NOTHING and event < SLIDE_OFF:
            change(p, parts, event, which, becomes, look, hits, edged)
        if edged and parts.listed[RIMS] > 0:
            load(p, parts, state)
            tend_edges(p, parts)
        settle_balls(p, parts, works)
    look.steps += taken
    return True


@inner_kernel
def advance_on_walls(
    p: Numbers,
    parts: Parts,
    state: Motion,
    works: Works,
    step: Works,
    look: SpaceLook,
    hits: Whole,
    heat: Array,
    length: float,
    ceiling: float,
) -> bool:
    """Advance a cage whose pockets have no edges: compiled without them."""
    return bool(take_steps(p, parts, state, works, step, look, hits, heat, length, ceiling, edged=False))


@inner_kernel
def advance_on_edges(
    p: Numbers,
    parts: Parts,
    state: Motion,
    works: Works,
    step: Works,
    look: SpaceLook,
    hits: Whole,
    heat: Array,
    length: float,
    ceiling: float,
) -> bool:
    """Advance a cage whose pockets have edges."""
    return bool(take_steps(p, parts, state, works, step, look, hits, heat, length, ceiling, edged=True))


@inner_kernel
def advance(
    p: Numbers,
    parts: Parts,
    state: Motion,
    works: Works,
    step: Works,
    look: SpaceLook,
    hits: Whole,
    heat: Array,
    length: float,
    ceiling: float,
) -> bool:
    """Advance the cage by a time, in place; False if more events came than any motion has.

    Parameters
    ----------
    p, parts, state
        The cage, its parts and their modes, and its state.
    works, step, look, hits, heat
        Work since the start, room for that of a step, tally of this look, impacts of every pocket and the
        integral of force times sliding speed there.
    length, ceiling : float
        Time to advance, and the kinetic energy above which to stop.
    """
    if p.margin < math.inf:
        return bool(advance_on_edges(p, parts, state, works, step, look, hits, heat, length, ceiling))
    return bool(advance_on_walls(p, parts, state, works, step, look, hits, heat, length, ceiling))
