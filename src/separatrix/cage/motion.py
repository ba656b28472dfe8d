r"""The equations of motion: rates of the cage and of every ball from the forces between them, and a step.

A runs' state is one column of numbers (`rows`); these functions take sixteen runs side by side. The plane is
space with tilt and axial motion held; the ball is a damper, has one state, or is free (`ball`).

A step is classical Runge-Kutta. The speed of a ball of one state is stiff in a slow bearing: there
:math:`C_f/m_e` is far above every other rate. Its linear part is taken exactly (exponential time differencing
of order 4, Cox and Matthews 2002), which is classical Runge-Kutta where that rate is small.
"""

from __future__ import annotations

import math

from separatrix.cage.ball import REST_PLACE, REST_SPEED, race_force, traction
from separatrix.cage.frame import cage_rates, place
from separatrix.cage.land_force import land_forces
from separatrix.cage.pocket_force import level_depth, level_friction, pocket_depth, pocket_friction
from separatrix.cage.rows import *
from separatrix.ground.compiled import inlined


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
