"""Where the motion of a run ends, and when that is plain: by its energy and by the work of friction.

A look is about a hundredth of the duration. What frame and loads can give the cage without friction is its
drive energy. A motion that lasts or grows and that the friction of the pockets feeds is a whirl; one that
frame, loads or friction on the land keep up is not (docs/theory/cage.md).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple, Protocol

from separatrix.cage.closed_forms import (
    axial_drive_energy,
    drifts,
    drive_energy,
    moving_mass,
    room,
    time_unit,
)
from separatrix.cage.planar import Cause, RunOutcome
from separatrix.compiled import part

if TYPE_CHECKING:
    from separatrix.cage.planar import PlanarCage
    from separatrix.units import MetrePerSecond, Second

LOOKS, FEWEST_LOOKS = 100, 5
"""Looks in the duration of a run, up to twice as many, and the fewest of a very short one."""

BEAT = 25.0
"""Time from beat to beat, in radians of the motion with one ball in touch: some turns of a whirl."""

LONGEST, LONGEST_ADRIFT = 4, 20
"""A run whose end is not plain after its duration goes on, to this multiple of it at most: of a cage with a
land, and of one that drifts, whose weak whirl ends only when its centre has crept out of place."""

WINDOW = 10
"""Looks, and at least a turn of the ball set, over which the work of friction is weighed."""

LOOKS_ABOVE, LOOKS_EVEN, EVEN, FAR_ABOVE = 3, 12, 0.03, 3.0
"""Looks in a row at high energy, or alike within this share at this multiple of the drive energy or more,
that make the end plain. A motion near the drive energy is followed on: some come to rest after a second."""

LOOKS_FAR = 50
"""Looks in a row far above the drive energy, the later half no lower than the earlier, that make it plain
that a motion lasts although its energy varies. An undriven cage is never far above."""

TURNED_OVER, HELD = 10.0, 0.01
"""How often pocket friction has put in the energy of a motion that it feeds for a whole duration, and the
share of the room by which its mean offset may change: a whirl that unwinds creeps out of place first."""

FED, HALF = 6, 0.5
"""The last looks, whose work shows what feeds a motion of high energy; and the share that is most of it."""

GROWN, GROWS_ON, GROWS_AT_ONCE = 100.0, 10.0, 30.0
"""Multiples of the energy scale (the kick's, and what frame and loads give) beyond which a growing motion
does not turn back: at any time, in the mean of `LOOKS_ABOVE` looks, in the mean of one."""

STILL = 1e-4
"""Share of the energy of the kick, and of an impact as deep as the clearance, at which an undriven cage is at
rest."""

FALLS = 2.0 / 3.0
"""Energy in the last fifth of the longest run over that half way, below which the motion still falls."""

REST = 0.01
"""Share of the drive energy below which a cage is at rest, with any friction."""

RISES = 1.2
"""Ratio of the energy in the second half of a window to that in the first above which it rises."""

UNFED, PATIENCE = 0.25, 3
"""Share of what is put in that pocket friction may give, over a window, to a motion at rest; and the quiet
windows after which it may give half."""

FAR = 10.0
"""Mean offset, in half clearances of the pockets, at which a cage without a land has left them."""

PLACE, REACH = 0.05, 0.9
"""Shares of the land's clearance: by the first the mean offset of a cage in its place may change in half a
window; from the second on a cage that frame or loads move is at its land."""

UNKNOWN = -1
SETTLES, WHIRLS = int(RunOutcome.SETTLES), int(RunOutcome.WHIRLS)
UNRESOLVED = int(RunOutcome.UNRESOLVED)
BY_NOTHING, NO_CONTACT, FALLING = int(Cause.NONE), int(Cause.NO_CONTACT), int(Cause.FALLING)
BY_LAND = int(Cause.LAND_FRICTION)


class Works(Protocol):
    """The sources in a ledger of work, in the plane or in space, by which the end of a motion is judged."""

    pocket_friction: float
    land_friction: float
    ball_drive: float
    gravity: float
    moving_frame: float


class Look:
    """Tally of a look: integrals over its time unless stated."""

    kinetic: float
    offset: float
    offset_squared: float
    swept: float  # r x v
    turning: float  # |v|^2 times the turning rate of the velocity
    speed_squared: float
    mean_x: float
    mean_y: float
    offset_max: float  # largest squared offset
    force_max: float  # largest forces of pockets and land
    land_max: float
    steps: float  # number
    land_hits: float  # number
    pressed: float  # force of the land, and that times the sliding
    rubbed: float
    pocket_work: float  # work of both frictions, of balls that lead and lag, of gravity
    land_work: float
    ball_work: float
    gravity_work: float
    frame_work: float  # on a cage without clearance or land


class Memory:
    """What is remembered from look to look: how many in a row were so."""

    above: float  # high in energy
    alike: float  # like the first of them, and with contact
    level: float  # mean energy of that one
    quiet: float  # at or below the drive energy
    high: float  # far above it
    met: float  # with contact


class Limits(NamedTuple):
    """How long a run is, in looks, and its limits: energies are over the mass, in the engine's units."""

    beat: float  # time between two ends of a step that every run of this cage has, however long it is
    beats: int  # in a look
    looks: int  # in the duration
    most: int
    least: int  # made even where the end is plain before
    window: int
    place: float  # change of the mean offset that is none, in half a window; below 0 for a cage free to drift
    held: float  # that is none in half a duration
    reach: float  # mean offset from which a cage that frame or loads move has come to its land
    drifts: bool  # the centre is free to drift
    far: float  # mean offset at which that is plain
    drive: float
    still: float
    grown: float
    grows_on: float
    grows_at_once: float


def run_limits(cage: PlanarCage, kick: MetrePerSecond, duration: Second, *, least: bool = False) -> Limits:
    """Limits of a run; `least` follows it over its whole duration even where its end is plain before.

    A guided cage does not drift: its land limits the offset.
    """
    unit, landless = time_unit(cage), math.isinf(cage.land_gap)
    beat, beats, looks = beat_of(unit, duration)
    per_mass = unit**2 / moving_mass(cage)
    drive = drive_energy(cage) * per_mass
    is_moved_across = drive_energy(cage) > axial_drive_energy(cage)
    scale = energy_scale(cage, kick) * per_mass + drive
    turn = math.ceil(2.0 * math.pi / abs(cage.cage_speed) / (beat * beats)) if cage.cage_speed else 0
    pressed = 0.5 * cage.ball_cage_stiffness * cage.half_play**2 * per_mass
    kicked = 0.5 * (kick * unit) ** 2
    return Limits(
        beat=beat / unit,
        beats=beats,
        looks=looks,
        most=(LONGEST_ADRIFT if drifts(cage) else LONGEST) * looks,
        least=looks if least else 0,
        window=min(max(WINDOW, turn), looks),
        place=-1.0 if drifts(cage) else PLACE * room(cage),
        held=HELD * room(cage),
        reach=0.0 if landless or not is_moved_across else REACH * cage.land_gap,
        drifts=drifts(cage),
        far=FAR * cage.half_play if drifts(cage) and cage.half_play > 0.0 else math.inf,
        drive=drive,
        still=-1.0 if drive > 0.0 or not landless or drifts(cage) else STILL * min(kicked, pressed or kicked),
        grown=GROWN * scale,
        grows_on=GROWS_ON * scale,
        grows_at_once=GROWS_AT_ONCE * scale,
    )


def beat_of(unit: Second, duration: Second) -> tuple[Second, int, int]:
    """Time between two beats [s], beats in a look, and looks in the duration.

    A step ends at every beat, so that a motion is the same to the last bit however long it is followed, but
    for runs shorter than five beats. The last look ends with the duration, or less than a look after it.
    """
    beat = BEAT * unit
    if duration < FEWEST_LOOKS * beat:
        return duration / FEWEST_LOOKS, 1, FEWEST_LOOKS
    beats = max(1, math.floor(duration / (LOOKS * beat)))
    return beat, beats, math.ceil(duration / (beats * beat))


def energy_scale(cage: PlanarCage, kick: MetrePerSecond) -> float:
    """Energy beside which growth is judged early [J].

    The kick's, and what the frame and gravity do over the way that the cage has.
    """
    way = 2.0 * cage.half_play if math.isinf(cage.land_gap) else cage.land_gap
    moved = 0.5 * kick**2 + 0.5 * (cage.cage_speed * way) ** 2
    return moving_mass(cage) * moved + cage.mass * cage.gravity * way


@part
def book(looks: Sequence[Look], i: int, works: Works, sense: float, limits: Limits) -> None:
    """Take the work done so far out of look i at its start (`sense` -1), and into it at its end (1)."""
    look = looks[i]
    look.pocket_work += sense * works.pocket_friction
    look.land_work += sense * works.land_friction
    look.ball_work += sense * works.ball_drive
    look.gravity_work += sense * works.gravity
    if limits.drifts and limits.drive == 0.0:
        look.frame_work += sense * works.moving_frame


@part
def after_look(
    looks: Sequence[Look],
    i: int,
    energy: float,
    met: bool,
    touched: bool,
    at_speed: bool,
    limits: Limits,
    memory: Memory,
) -> int:
    """Outcome of a run that is plain after look i, by its energy with that of the springs, else `UNKNOWN`."""
    length, outcome = limits.beats * limits.beat, UNKNOWN
    if energy > limits.grown:
        outcome = high_end(looks, i + 1)
    elif touched and energy < limits.still:
        outcome = SETTLES
    elif touched and at_speed:
        outcome = plain_end(looks, i, length, met, limits, memory)
    if outcome == UNKNOWN and i + 1 == limits.most:
        outcome = end_by_trend(looks, i + 1, length, limits)
    return outcome


@part
def with_cause(
    looks: Sequence[Look], outcome: int, judged: int, touched: bool, limits: Limits
) -> tuple[int, int, int]:
    """Outcome of a run, the looks up to which it was judged, and its cause."""
    length, first = limits.beats * limits.beat, max(0, judged - FED)
    if not touched:
        return UNRESOLVED, judged, NO_CONTACT
    if outcome == UNRESOLVED:
        return outcome, judged, FALLING
    lively = outcome == SETTLES and mean_energy(looks, first, judged, length) > limits.drive
    return outcome, judged, BY_LAND if lively and fed(looks, first, judged)[2] > HALF else BY_NOTHING


@part
def mean_energy(looks: Sequence[Look], first: int, last: int, length: float) -> float:
    """Mean kinetic energy of the looks from `first` to before `last`, each of this length."""
    total = 0.0
    for i in range(first, last):
        total += looks[i].kinetic
    return total / ((last - first) * length)


@part
def mean_offset(looks: Sequence[Look], first: int, last: int, length: float) -> float:
    """Mean offset in the looks from `first` to before `last`."""
    total = 0.0
    for i in range(first, last):
        total += looks[i].offset
    return total / ((last - first) * length)


@part
def fed(looks: Sequence[Look], first: int, last: int) -> tuple[float, float, float]:
    """Work of pocket friction, and the shares of it and of the land's friction in what is put in."""
    pocket = land = balls = gravity = frame = 0.0
    for i in range(first, last):
        pocket += looks[i].pocket_work
        land += looks[i].land_work
        balls += looks[i].ball_work
        gravity += looks[i].gravity_work
        frame += looks[i].frame_work
    put_in = max(0.0, pocket) + max(0.0, land) + max(0.0, balls) + max(0.0, gravity) + max(0.0, frame)
    if put_in == 0.0:
        return pocket, 0.0, 0.0
    return pocket, pocket / put_in, land / put_in


@part
def high_end(looks: Sequence[Look], end: int) -> int:
    """`WHIRLS` if pocket friction feeds a motion that grows without limit, else `SETTLES`."""
    return WHIRLS if fed(looks, max(0, end - FED), end)[1] > HALF else SETTLES


@part
def plain_end(looks: Sequence[Look], i: int, length: float, met: bool, limits: Limits, memory: Memory) -> int:
    """Outcome that is plain after look i; `UNKNOWN` if none is."""
    mean = looks[i].kinetic / length
    memory.above = memory.above + 1 if mean > limits.grows_on else 0
    if memory.above >= LOOKS_ABOVE or mean > limits.grows_at_once:
        return high_end(looks, i + 1)
    if met and abs(mean - memory.level) <= EVEN * memory.level:
        memory.alike += 1
    else:
        memory.alike, memory.level = 1, mean
    driven = mean <= limits.drive
    if driven and looks[i].offset > limits.far * length:
        return SETTLES
    memory.quiet = memory.quiet + 1 if driven else 0
    high = mean > FAR_ABOVE * limits.drive
    memory.high = memory.high + 1 if high and limits.drive > 0.0 else 0
    even = high and memory.alike >= LOOKS_EVEN and mean >= memory.level
    if even or (memory.high >= LOOKS_FAR and keeps_up(looks, i + 1, length)):
        _, pockets, land = fed(looks, i + 1 - FED, i + 1)
        if max(pockets, land) > HALF:
            return WHIRLS if pockets > HALF else SETTLES
    memory.met = memory.met + 1 if met else 0
    if memory.met >= limits.looks and kept_up(looks, i + 1, length, limits):
        return WHIRLS
    if memory.quiet >= limits.looks:
        return at_rest(looks, i + 1, limits.looks, HALF, length, limits)
    if memory.quiet < limits.window or not arrived(looks, i + 1, length, limits):
        return UNKNOWN
    share = HALF if memory.quiet >= PATIENCE * limits.window else UNFED
    return at_rest(looks, i + 1, limits.window, share, length, limits)


@part
def keeps_up(looks: Sequence[Look], end: int, length: float) -> bool:
    """Whether the last half of the last `LOOKS_FAR` looks has no less energy than the half before."""
    middle = end - LOOKS_FAR // 2
    before = mean_energy(looks, end - LOOKS_FAR, middle, length)
    return mean_energy(looks, middle, end, length) >= (1.0 - EVEN) * before


@part
def kept_up(looks: Sequence[Look], end: int, length: float, limits: Limits) -> bool:
    """Whether pocket friction kept up the motion in its place for a whole duration, in both its halves."""
    first, middle = end - limits.looks, end - limits.looks // 2
    before, after = mean_energy(looks, first, middle, length), mean_energy(looks, middle, end, length)
    if limits.drifts or after < (1.0 - EVEN) * before or after <= REST * limits.drive:
        return False
    work, pockets, _ = fed(looks, first, middle)
    more, still, _ = fed(looks, middle, end)
    moved = abs(mean_offset(looks, middle, end, length) - mean_offset(looks, first, middle, length))
    return min(pockets, still) > HALF and work + more > TURNED_OVER * after and moved <= limits.held


@part
def at_rest(looks: Sequence[Look], end: int, quiet: int, share: float, length: float, limits: Limits) -> int:
    """`SETTLES` at rest, or where pocket friction put in at most this share over this many quiet looks."""
    first, half = end - limits.window, limits.window // 2
    mean = mean_energy(looks, first, end, length)
    if mean <= REST * limits.drive:
        early, late = (
            mean_energy(looks, first, first + half, length),
            mean_energy(looks, end - half, end, length),
        )
        return SETTLES if late <= RISES * early or mean <= REST**3 * limits.drive else UNKNOWN
    work, pockets, _ = fed(looks, end - quiet, end)
    return SETTLES if pockets <= share or work < mean else UNKNOWN


@part
def arrived(looks: Sequence[Look], end: int, length: float, limits: Limits) -> bool:
    """Whether the cage is in its place: on its land if anything moves it, and no further than before."""
    half = limits.window // 2
    late = mean_offset(looks, end - half, end, length)
    early = mean_offset(looks, end - 2 * half, end - half, length)
    return late >= limits.reach and abs(late - early) <= limits.place


@part
def end_by_trend(looks: Sequence[Look], end: int, length: float, limits: Limits) -> int:
    """Outcome of the longest run, by its last fifth and the looks half way."""
    n, middle = end // FEWEST_LOOKS, end // 2
    last = mean_energy(looks, end - n, end, length)
    before = mean_energy(looks, middle - n // 2, middle - n // 2 + n, length)
    work, pockets, land = fed(looks, end - n, end)
    if last <= limits.drive:
        return WHIRLS if pockets > HALF and work > last > REST * limits.drive else SETTLES
    if last >= FALLS * before:
        return WHIRLS if pockets > HALF else SETTLES
    return SETTLES if limits.drive == 0.0 or land > HALF else UNRESOLVED
