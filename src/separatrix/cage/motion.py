r"""The equations of motion: rates of the cage and of every ball, from the forces between them.

A runs' state is one column of numbers (`rows`); these functions take sixteen runs side by side. The plane is space with
tilt and axial motion held; the ball is a damper, has one state, or is free (`ball`).
"""

from __future__ import annotations

import math

from separatrix.cage.ball import REST_PLACE, REST_SPEED, race_force, traction
from separatrix.cage.frame import cage_rates, place
from separatrix.cage.land_force import land_forces
from separatrix.cage.pocket_force import friction_in_plane, level_depth, pocket_depth, pocket_depth_in_plane, pocket_friction
from separatrix.cage.rows import *  # noqa: F403
from separatrix.compiled import inlined


@inlined
def rates(s, d, a, p, places, strips, balls, ball, space, leans, hertz, lobe_number):
    """Rates `d` of the state `s`; what the forces add up to in `a`."""
    place(s, a, p, space)
    ball_rates(s, d, a, p, places, balls, ball, space, leans, hertz)
    land_forces(s, a, p, strips, lobe_number, space)
    cage_rates(s, d, a, p, space)


@inlined
def ball_rates(s, d, a, p, places, balls, ball, space, leans, hertz):
    """Rates of every ball, and the sums of what all of them do to the cage."""
    first, speed_row = (SPACE_STATES if space else PLANE_STATES) * LANES, 2 if space else 1
    size = (speed_row + (0 if ball == DAMPER else 1 if ball == ONE_STATE else 4)) * LANES
    for i in range(LX * LANES):
        a[i] = ZERO
    for j in range(balls):
        b, db = s[first + j * size : first + (j + 1) * size], d[first + j * size : first + (j + 1) * size]
        q = places[j * BALL_ROWS * LANES : (j + 1) * BALL_ROWS * LANES]
        for l in range(LANES):
            c, n, radius, lever = q[COSINE * LANES + l], q[SINE * LANES + l], p[RADIUS * LANES + l], p[LEVER * LANES + l]
            ramp, turning = s[RAMP * LANES + l], s[VS * LANES + l] * p[PER_RADIUS * LANES + l]
            oz, o_r, ot = ramp * p[SPIN_Z * LANES + l], ramp * p[SPIN_R * LANES + l], ramp * p[SPIN_T * LANES + l]
            own = ramp * q[OWN_SPEED * LANES + l]  # speed of the free orbit against the ball set
            u = own
            if ball > DAMPER:
                u = own + b[speed_row * LANES + l]
            if ball == FREE:
                oz, o_r, ot = oz + b[(speed_row + 1) * LANES + l], o_r + b[(speed_row + 2) * LANES + l], ot + b[(speed_row + 3) * LANES + l]
            # place and velocity of the pocket less its ball's
            along = a[GY * LANES + l] * c - a[GX * LANES + l] * n + s[S * LANES + l] - b[LEAD * LANES + l]
            wr, wt = ZERO, ZERO
            vr, vt = a[GVX * LANES + l] * c + a[GVY * LANES + l] * n, a[GVY * LANES + l] * c - a[GVX * LANES + l] * n + s[VS * LANES + l]
            vz = ZERO
            if space:
                across = s[Z * LANES + l] - radius * (a[GB * LANES + l] * c - a[GA * LANES + l] * n) - b[GROOVE * LANES + l]
                wr, wt = a[GWA * LANES + l] * c + a[GWB * LANES + l] * n, a[GWB * LANES + l] * c - a[GWA * LANES + l] * n
                vz = s[VZ * LANES + l] - radius * wt
                depth, nz, nt = pocket_depth(along, across, q[AROUND * LANES + l], q[APART * LANES + l], p[BESIDE * LANES + l])
            elif leans:
                depth, nz, nt = pocket_depth_in_plane(along, q[APART * LANES + l], p[LEAN_SINE * LANES + l], p[LEAN_COSINE * LANES + l])
            else:
                depth, nt = level_depth(along, q[APART * LANES + l])
            push = p[STIFFNESS * LANES + l] * depth
            if hertz:
                push *= math.sqrt(depth)
            if space or leans:
                # velocity of the wall where it is touched: (w_r, w_t, turning) x lever n
                pr, pt, pz = vr + lever * (wt * nz - turning * nt), vt - lever * wr * nz, vz + lever * wr * nt
                ez, er, et, slide = pocket_friction(
                    p[FRICTION * LANES + l] * push, nz, nt, lever, oz, o_r, ot, u, pz, pr, pt, p[PIVOT * LANES + l]
                )
                ft, fz = push * nt + et, push * nz + ez
                a[RUB * LANES + l] += ez * pz + er * pr + et * pt
            else:
                pr = vr - lever * turning * nt
                ez, er, slide = friction_in_plane(p[FRICTION * LANES + l] * push, nt, lever, oz, o_r, pr, p[PIVOT * LANES + l])
                ft = push * nt
                a[RUB * LANES + l] += er * pr
            q[FORCE * LANES + l], q[HEAT * LANES + l] = push, push * slide
            a[FX * LANES + l] += er * c - ft * n
            a[FY * LANES + l] += er * n + ft * c
            a[FS * LANES + l] += ft - lever * p[PER_RADIUS * LANES + l] * nt * er
            uz = ZERO
            if space:
                uz = -(fz + p[GROOVE_STIFFNESS * LANES + l] * (b[GROOVE * LANES + l] - REST_PLACE)) * p[PER_GROOVE * LANES + l]
                db[GROOVE * LANES + l] = uz
                mr, mt = lever * (nt * ez - nz * et), lever * nz * er - radius * fz
                a[FZ * LANES + l] += fz
                a[MX * LANES + l] += mr * c - mt * n
                a[MY * LANES + l] += mr * n + mt * c
            if ball == DAMPER:
                u = own - ft * ramp * p[PER_DAMPING * LANES + l]
            db[LEAD * LANES + l] = u
            a[DRIVE * LANES + l] += push * (nz * uz + nt * u) if space else push * nt * u
            if ball == ONE_STATE:
                v = b[speed_row * LANES + l]
                slope, per = p[SLOPE * LANES + l], ONE / ramp
                bent = traction(v * per, slope, p[PER_KNEE * LANES + l]) + slope * v * (per - ONE)
                # its linear part at full speed, -HELD_RATE v, is taken exactly by the step
                db[speed_row * LANES + l] = p[HELD_RATE * LANES + l] * REST_SPEED - (ft + bent) * p[PER_BALL_MASS * LANES + l]
            if ball == FREE:
                per, v = ONE / ramp, b[speed_row * LANES + l]
                per_m, per_j, per_r = p[PER_OWN_MASS * LANES + l], p[PER_OWN_INERTIA * LANES + l], p[PER_RADIUS * LANES + l]
                om, w = ramp * p[ORBIT * LANES + l], v * per_r
                dz, dr, dt = b[(speed_row + 1) * LANES + l], b[(speed_row + 2) * LANES + l], b[(speed_row + 3) * LANES + l]
                turn, side = (dz + w) * per, lever * ot * per
                fi, zi, ri, ti = race_force(p, INNER, l, v * per, turn, dr * per, side, lever)
                fo, zo, ro, to = race_force(p, OUTER, l, v * per, turn, dr * per, side, lever)
                gain = (fi + fo - ft) * per_m
                base_r, base_t = ramp * p[SPIN_R * LANES + l], ramp * p[SPIN_T * LANES + l]
                db[speed_row * LANES + l] = gain
                db[(speed_row + 1) * LANES + l] = (lever * nt * er + zi + zo) * per_j - gain * per_r
                couple_r, couple_t = (lever * (nz * et - nt * ez), -lever * nz * er) if space or leans else (-lever * nt * ez, ZERO)
                db[(speed_row + 2) * LANES + l] = (couple_r + ri + ro) * per_j + (om + w) * ot - om * base_t
                db[(speed_row + 3) * LANES + l] = (ti + to + couple_t) * per_j - (om + w) * o_r + om * base_r
