r"""The equations of motion: rates of the cage and of every ball from the forces between them, and a step.

A runs' state is one column of numbers (`rows`); these functions take sixteen runs side by side. The plane is
space with tilt and axial motion held; the ball is a damper, has one state, or is free (`ball`).

A step is classical Runge-Kutta. The speed of a ball of one state is stiff in a slow bearing: there
:math:`C_f/m_e` is far above every other rate. Its linear part is taken exactly (exponential time differencing
of order 4, Cox and Matthews 2002), which is classical Runge-Kutta where that rate is small. Speed and spins
of a free ball are held by the slopes of its races (a W-method of order 3, docs/theory/cage.md).
"""

from __future__ import annotations

import math

import numpy as np

from separatrix.cage.ball import REST_PLACE, REST_SPEED, race_force, race_slopes, traction
from separatrix.cage.contact_force import (
    land_forces,
    level_depth,
    level_friction,
    pocket_depth,
    pocket_friction,
)
from separatrix.cage.frame import cage_rates, place
from separatrix.cage.rows import *
from separatrix.ground.compiled import inlined

QUARTER, SEVEN_EIGHTHS, TWENTY_THREE_EIGHTHS = (np.float32(x) for x in (1 / 4, 7 / 8, 23 / 8))


@inlined
def rates(s, d, of_balls, rates_of, a, p, places, strips, ball, space, level, lobe_number):
    """Rates `d` of the state `s`; `of_balls`, `rates_of`: their parts by ball; the sums of forces in `a`."""
    place(s, a, p, space)
    ball_rates(s, of_balls, rates_of, a, p, places, ball, space, level)
    land_forces(s, a, p, strips, lobe_number, space)
    cage_rates(s, d, a, p, space)


@inlined
def ball_rates(s, of_balls, rates_of, a, p, places, ball, space, level):
    """Rates of every ball, and the sums of what all of them do to the cage."""
    speed = (2 if space else 1) * LANES
    for e in range(LX):
        a[e] = ZERO
    for j in range(places.shape[0]):
        b, db, q = of_balls[j], rates_of[j], places[j]
        for l in range(LANES):
            c, n, radius, lever = q[COSINE + l], q[SINE + l], p[RADIUS + l], p[LEVER + l]
            ramp, turning = s[RAMP + l], s[VS + l] * p[PER_RADIUS + l]
            oz, o_r, ot = ramp * p[SPIN_Z + l], ramp * p[SPIN_R + l], ramp * p[SPIN_T + l]
            own = ramp * q[OWN_SPEED + l]  # speed of the free orbit against the ball set
            u = own
            if ball > DAMPER:
                u = own + b[speed + l]
            if ball == FREE:
                oz, o_r, ot = (
                    oz + b[speed + LANES + l],
                    o_r + b[speed + 2 * LANES + l],
                    ot + b[speed + 3 * LANES + l],
                )
            # place and velocity of the pocket less its ball's
            along = a[GY + l] * c - a[GX + l] * n + s[S + l] - b[LEAD + l]
            across, vz, wr, wt = p[OFFSET + l], ZERO, ZERO, ZERO
            vr, vt = a[GVX + l] * c + a[GVY + l] * n, a[GVY + l] * c - a[GVX + l] * n + s[VS + l]
            if space:
                across = s[Z + l] - radius * (a[GB + l] * c - a[GA + l] * n) - b[GROOVE + l]
                wr, wt = a[GWA + l] * c + a[GWB + l] * n, a[GWB + l] * c - a[GWA + l] * n
                vz = s[VZ + l] - radius * wt
            if level:
                depth, nt = level_depth(along, q[APART + l] + q[AROUND + l])
                push = p[STIFFNESS + l] * depth
                pr = vr - lever * turning * nt
                ez, er, slide = level_friction(p[FRICTION + l] * push, nt, lever, oz, o_r, pr, p[PIVOT + l])
                nz, nr, et, ft = ZERO, ZERO, ZERO, push * nt
                a[RUB + l] += er * pr
            else:
                outward = p[WRAPPED + l] * (a[GX + l] * c + a[GY + l] * n) + p[OUTWARD + l]
                around, apart, beside = q[AROUND + l], q[APART + l], p[BESIDE + l]
                depth, nz, nr, nt = pocket_depth(along, across, outward, around, apart, beside)
                push = (p[STIFFNESS + l] + p[HERTZ + l] * math.sqrt(depth)) * depth
                # velocity of the wall where it is touched: (w_r, w_t, turning) x lever n
                pz, pr = vz + lever * (wr * nt - wt * nr), vr + lever * (wt * nz - turning * nt)
                pt = vt + lever * (turning * nr - wr * nz)
                ez, er, et, slide = pocket_friction(
                    p[FRICTION + l] * push, nz, nr, nt, lever, oz, o_r, ot, u, pz, pr, pt, p[PIVOT + l]
                )
                ft, fz = push * nt + et, push * nz + ez
                a[RUB + l] += ez * pz + er * pr + et * pt
            q[FORCE + l], q[HEAT + l] = push, push * slide
            fr, twist = push * nr + er, nr * et - nt * er  # force outward; friction's couple over the lever
            a[FX + l] += fr * c - ft * n
            a[FY + l] += fr * n + ft * c
            a[FS + l] += ft + lever * p[PER_RADIUS + l] * twist
            uz = ZERO
            if space:
                uz = -(fz + p[GROOVE_STIFFNESS + l] * (b[GROOVE + l] - REST_PLACE)) * p[PER_GROOVE + l]
                db[GROOVE + l] = uz
                mr, mt = lever * (nt * ez - nz * et), lever * (nz * er - nr * ez) - radius * fz
                a[FZ + l] += fz
                a[MX + l] += mr * c - mt * n
                a[MY + l] += mr * n + mt * c
            if ball == DAMPER:
                u = own - ft * ramp * p[PER_DAMPING + l]
            db[LEAD + l] = u
            a[DRIVE + l] += push * (nz * uz + nt * u) if space else push * nt * u
            if ball == ONE_STATE:
                v, share = b[speed + l], q[SLOPE_SHARE + l]
                slope, per = p[SLOPE + l], a[PER_RAMP + l]
                bent = traction(v * per, slope * share, p[PER_KNEE + l] * q[KNEE_SHARE + l])
                bent += slope * v * (share * per - ONE)
                # its linear part at full speed, -HELD_RATE v, is taken exactly by the step
                db[speed + l] = p[HELD_RATE + l] * REST_SPEED - (ft + bent) * p[PER_BALL_MASS + l]
            if ball == FREE:
                per, v = a[PER_RAMP + l], b[speed + l]
                per_m, per_j, per_r = p[PER_OWN_MASS + l], p[PER_OWN_INERTIA + l], p[PER_RADIUS + l]
                om, w = ramp * p[ORBIT + l], v * per_r
                dz, dr = b[speed + LANES + l], b[speed + 2 * LANES + l]
                turn, side = (dz + w) * per, lever * ot * per
                fi, zi, ri, ti = race_force(p, INNER, l, v * per, turn, dr * per, side, lever)
                fo, zo, ro, to = race_force(p, OUTER, l, v * per, turn, dr * per, side, lever)
                held = q[CAPACITY_SHARE + l]
                gain = (held * (fi + fo) - ft) * per_m
                base_r, base_t = ramp * p[SPIN_R + l], ramp * p[SPIN_T + l]
                db[speed + l] = gain
                db[speed + LANES + l] = (held * (zi + zo) - lever * twist) * per_j - gain * per_r
                db[speed + 2 * LANES + l] = (
                    (lever * (nz * et - nt * ez) + held * (ri + ro)) * per_j + (om + w) * ot - om * base_t
                )
                pivoted = held * (ti + to) - lever * (nz * er - nr * ez)
                db[speed + 3 * LANES + l] = pivoted * per_j - (om + w) * o_r + om * base_r


@inlined
def hold_spins(s, of_balls, p, places, stiff, space):
    """Inverse of I - h J/4 for speed and spins of every free ball, into `stiff`; J: slopes by the races.

    The spin along the orbit is alone: its couplings to the others are left out.
    """
    speed = (2 if space else 1) * LANES
    for j in range(places.shape[0]):
        b, q, x = of_balls[j], places[j], stiff[j]
        for l in range(LANES):
            per, v, lever, per_r = ONE / s[RAMP + l], b[speed + l], p[LEVER + l], p[PER_RADIUS + l]
            dz, dr = b[speed + LANES + l], b[speed + 2 * LANES + l]
            side = lever * (s[RAMP + l] * p[SPIN_T + l] + b[speed + 3 * LANES + l]) * per
            v, turn, dr = v * per, (dz + v * per_r) * per, dr * per
            fs, fz, fr, zs, zz, zr, rs, rz, rr, ti = race_slopes(p, INNER, l, v, turn, dr, side, lever)
            gs, gz, gr, ys, yz, yr, us, uz, ur, to = race_slopes(p, OUTER, l, v, turn, dr, side, lever)
            share = QUARTER * p[STEP + l] * q[CAPACITY_SHARE + l] * per
            by_m, by_j = share * p[PER_OWN_MASS + l], share * p[PER_OWN_INERTIA + l]
            # slopes by v, at the same turn as the orbit's, by dz and dr
            f1, f2, f3 = by_m * (fs + gs), by_m * (fz + gz), by_m * (fr + gr)
            f1 += per_r * f2
            z1, z2, z3 = by_j * (zs + ys), by_j * (zz + yz), by_j * (zr + yr)
            z1 += per_r * z2
            r1, r2, r3 = by_j * (rs + us), by_j * (rz + uz), by_j * (rr + ur)
            r1 += per_r * r2
            z1, z2, z3 = z1 - per_r * f1, z2 - per_r * f2, z3 - per_r * f3
            f1, z2, r3 = ONE + f1, ONE + z2, ONE + r3
            c1, c2, c3 = z2 * r3 - z3 * r2, z3 * r1 - z1 * r3, z1 * r2 - z2 * r1
            det = ONE / (f1 * c1 + f2 * c2 + f3 * c3)
            x[l], x[LANES + l] = det * c1, det * (f3 * r2 - f2 * r3)
            x[2 * LANES + l], x[3 * LANES + l] = det * (f2 * z3 - f3 * z2), det * c2
            x[4 * LANES + l], x[5 * LANES + l] = det * (f1 * r3 - f3 * r1), det * (f3 * z1 - f1 * z3)
            x[6 * LANES + l] = det * c3
            x[7 * LANES + l], x[8 * LANES + l] = det * (f2 * r1 - f1 * r2), det * (f1 * z2 - f2 * z1)
            x[9 * LANES + l] = ONE / (ONE + by_j * (ti + to))


@inlined
def held_spins(stage, rates_of, stiff, before, space):
    """Replace the rates of speed and spins of every free ball in a stage by those held by `hold_spins`."""
    speed = (2 if space else 1) * LANES
    c1, c2 = ZERO, ZERO
    if stage == 1:
        c1 = -ONE
    elif stage == 2:
        c1, c2 = SEVEN_EIGHTHS, -TWENTY_THREE_EIGHTHS
    elif stage == 3:
        c1, c2 = QUARTER, -QUARTER
    for j in range(stiff.shape[0]):
        db, x, past = rates_of[j, speed:], stiff[j], before[j]
        for l in range(LANES):
            m, n, o = l + LANES, l + 2 * LANES, l + 3 * LANES
            w0, w1 = c1 * past[l] + c2 * past[4 * LANES + l], c1 * past[m] + c2 * past[4 * LANES + m]
            w2, w3 = c1 * past[n] + c2 * past[4 * LANES + n], c1 * past[o] + c2 * past[4 * LANES + o]
            g0, g1, g2 = db[l] + w0, db[m] + w1, db[n] + w2
            db[l] = x[l] * g0 + x[m] * g1 + x[n] * g2 - w0
            db[m] = x[o] * g0 + x[4 * LANES + l] * g1 + x[5 * LANES + l] * g2 - w1
            db[n] = x[6 * LANES + l] * g0 + x[7 * LANES + l] * g1 + x[8 * LANES + l] * g2 - w2
            db[o] = x[9 * LANES + l] * (db[o] + w3) - w3
        if stage < 2:
            for e in range(4 * LANES):
                past[4 * LANES * stage + e] = db[e]


@inlined
def stage_end(stage, s, t, d, q, h, sixth):
    """State `t` of the next stage, from the rates `d` of this one; after the last, `s` and `t`.

    `h`: length of the step, as often as there are numbers in the state, so that one loop does; `sixth`: 1/6
    in the precision of the state.
    """
    if stage < 3:
        keep, gain = ZERO if stage == 0 else ONE, ONE if stage == 0 else TWO
        ahead = ONE if stage == 2 else HALF
        for e in range(s.size):
            q[e] = keep * q[e] + gain * d[e]
            t[e] = s[e] + ahead * h[e] * d[e]
    else:
        for e in range(s.size):
            s[e] += sixth * h[e] * (q[e] + d[e])
            t[e] = s[e]


@inlined
def held_stage_end(stage, s, t, d, first, middle, held):
    """The same where balls have one state, whose decay is exact; `held`: gains of every number of the state.

    A number that does not decay takes the step of `stage_end`.
    """
    half, gain, whole, by_first, by_middle, by_last = held[0], held[1], held[2], held[3], held[4], held[5]
    for e in range(s.size):
        rate = d[e]
        if stage == 0:
            first[e] = rate
            t[e] = half[e] * s[e] + gain[e] * rate
        elif stage == 1:
            middle[e] = rate
            t[e] = half[e] * s[e] + gain[e] * rate
        elif stage == 2:
            middle[e] += rate
            t[e] = half[e] * (half[e] * s[e] + gain[e] * first[e]) + gain[e] * (TWO * rate - first[e])
        else:
            s[e] = whole[e] * s[e] + (by_first[e] * first[e] + by_middle[e] * middle[e] + by_last[e] * rate)
            t[e] = s[e]
