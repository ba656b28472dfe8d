"""Runs of the cage in space: from a start through looks to evidence."""

from __future__ import annotations

from collections.abc import Sequence

from separatrix.cage.records import Whole
from separatrix.cage.space.motion import advance
from separatrix.cage.space.records import AXIAL, LEAD, Motion, Numbers, Parts, SpaceLook, Works
from separatrix.cage.space.tally import held, kinetic
from separatrix.compiled import kernel
from separatrix.units import Array


@kernel
def follow_kernel(
    p: Numbers,
    parts: Parts,
    state: Sequence[Motion],
    works: Sequence[Works],
    look: Sequence[SpaceLook],
    hits: Whole,
    heat: Array,
    times: Array,
    out: Array,
) -> bool:
    """Follow a run from time to time; rows of `out`: state, energy, lead and place of every ball."""
    now, count = state[0], parts.moving.size
    for i in range(times.size):
        length = times[i] - now.clock
        if length > 0.0 and not advance(
            p, parts, now, works[0], works[1], look[0], hits, heat, length, 1e300
        ):
            return False
        row = out[i]
        row[0], row[1], row[2], row[3], row[4], row[5] = now.x, now.y, now.z, now.s, now.a, now.b
        row[6], row[7], row[8], row[9], row[10], row[11] = now.vx, now.vy, now.vz, now.vs, now.va, now.vb
        row[12] = kinetic(p, now) + held(p, parts)
        for j in range(count):
            row[13 + j], row[13 + count + j] = parts.ball[j, 0, LEAD], parts.ball[j, 0, AXIAL]
    return True
