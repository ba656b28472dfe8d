r"""The motion of one mode as a power series in time.

As long as no contact changes, the planar equations are solved by series whose coefficients follow one from
the other. For springs, dampers and the turning frame the equations are linear and the series is the
exponential of the mode, summed until the next term is below rounding; the land's normal, the unbalance and
Hertz springs only add products and powers of series.

All linear pockets yield at one rate :math:`a = k/C_\mu`, so that the penetration of pocket j,
:math:`\dot q_j = \dot w_j - a q_j`, follows from what it was and from the cage's speeds, each filtered once:
:math:`q_j(t) = q_j(0)\,e(t) + E_y \cos\phi_j - E_x \sin\phi_j + E_s`. The forces of any number of pockets
sum to the same few series.

Lengths are in metres, time in units of the engine, forces over the mass, so that force and acceleration have
the unit of a length.
"""

from __future__ import annotations

import numpy as np

from separatrix.cage.land import land_geometry, push_land, rub_land, slide_speed
from separatrix.cage.series import ORDER, POWERS, product
from separatrix.cage.slots import (
    BALLS,
    CLEAR,
    COS,
    COSINE,
    DRIVE,
    ES,
    EX,
    EY,
    FELT,
    FORWARD,
    FRAME,
    FRAME_S,
    FRAME_X,
    FRAME_Y,
    FX,
    FY,
    GONE,
    GX,
    GY,
    KEPT,
    LIST,
    NORMAL,
    NX,
    NY,
    PENETRATION,
    RELEASED,
    SIDE,
    SIN,
    SINE,
    STICK,
    TANGENT,
    TORQUE,
    VX,
    VY,
    S,
    W,
    X,
    Y,
)
from separatrix.compiled import inner_kernel

AFTER = 1.0 / np.arange(1.0, POWERS + 1.0)
"""1 / (n + 1)."""


@inner_kernel
def gather(pockets, touch, waves, count, sums):  # type: ignore[no-untyped-def]
    """Sums over the pockets in touch: of directions and their products, and of penetrations.

    With a radial load also, for each harmonic, of the free speeds' cosines and sines, times the same.
    """
    for k in range(8 + 3 * waves):
        sums[k] = 0.0
    for i in range(count):
        j = touch[LIST, i]
        c, s = pockets[COSINE, j], pockets[SINE, j]
        sums[0] += c * c
        sums[1] += c * s
        sums[2] += s * s
        sums[3] += c
        sums[4] += s
        sums[5] += pockets[PENETRATION, j] * c
        sums[6] += pockets[PENETRATION, j] * s
        sums[7] += pockets[PENETRATION, j]
        for k in range(waves):
            sums[8 + 3 * k] += pockets[DRIVE + k, j] * c
            sums[9 + 3 * k] += pockets[DRIVE + k, j] * s
            sums[10 + 3 * k] += pockets[DRIVE + k, j]


@inner_kernel
def expand(p, pockets, touch, w, count, land, now, sums):  # type: ignore[no-untyped-def]
    """Fill the series of the motion from the state in their first coefficients.

    Parameters
    ----------
    p : Coefficients
        The cage.
    pockets, touch : ndarray
        Rows of numbers and of whole numbers by ball, as in `slots`.
    w : ndarray
        Series, shape (power, column).
    count : int
        How many pockets touch their balls.
    land : int
        Mode of the land.
    now : tuple of float
        Share of the full speed, and its rate.
    sums : ndarray
        Room for `gather`.
    """
    share, rise = now
    turning, second, radius = p.turning * share, (p.turning * share) ** 2, p.radius
    stiffness, friction, swiftness = p.stiffness, p.friction, p.swiftness
    yielding, softer = p.yielding * p.stiffness * share, p.yielding * p.stiffness * rise
    linear = p.hertz == 0.0 and count > 0
    rotating, leaning, framed, waves = p.needs_rotation, p.eccentricity != 0.0, p.needs_frame, 2 * p.harmonics
    ramped, heavy, pressed = rise != 0.0, p.gravity != 0.0, land != CLEAR and land != RELEASED
    gx, gy = (GX, GY) if leaning else (X, Y)
    if linear:
        gather(pockets, touch, waves, count, sums)
    cc, cs, ss, c, s, qc, qs, qq = sums[0], sums[1], sums[2], sums[3], sums[4], sums[5], sums[6], sums[7]
    x, y, vx, vy, vs = w[0, X], w[0, Y], w[0, VX], w[0, VY], w[0, W]
    ex = ey = es = 0.0
    kept = 1.0
    w[0, EX] = w[0, EY] = w[0, ES] = 0.0
    w[0, KEPT] = 1.0
    for k in range(waves):
        w[0, FELT + k] = w[0, GONE + k] = 0.0
    if pressed:
        land_geometry(p, w, gx, gy, 0)
    for n in range(ORDER + 1):
        after = AFTER[n]
        dx, dy, ds = vx * after, vy * after, vs * after
        w[n + 1, X], w[n + 1, Y], w[n + 1, S] = dx, dy, ds
        next_x, next_y = dx, dy
        if rotating:
            rotate(w, radius, n + 1)
            if leaning:
                place_centre(w, p.eccentricity, n + 1)
                dx, dy = w[n + 1, GX], w[n + 1, GY]
        if framed:
            turn_frame(w, max(2, waves), turning, p.turning * rise, n)
            drive_balls(w, waves, share, rise, n)
        fx = fy = torque = 0.0
        if linear:
            sum_cos = kept * qc + cc * ey - cs * ex + c * es
            sum_sin = kept * qs + cs * ey - ss * ex + s * es
            total = kept * qq + c * ey - s * ex + count * es
            for k in range(waves):
                felt = w[n, FELT + k]
                sum_cos -= sums[8 + 3 * k] * felt
                sum_sin -= sums[9 + 3 * k] * felt
                total -= sums[10 + 3 * k] * felt
                w[n + 1, FELT + k] = w[n + 1, GONE + k] - yielding * felt * after
            fx = stiffness * (sum_sin - friction * sum_cos)
            fy = -stiffness * (sum_cos + friction * sum_sin)
            torque = -stiffness * total
            rate = yielding * after
            ex, ey, es, kept = dx - rate * ex, dy - rate * ey, ds - rate * es, -rate * kept
            if ramped and n > 0:
                rate = softer * after
                ex -= rate * w[n - 1, EX]
                ey -= rate * w[n - 1, EY]
                es -= rate * w[n - 1, ES]
                kept -= rate * w[n - 1, KEPT]
                for k in range(waves):
                    w[n + 1, FELT + k] -= rate * w[n - 1, FELT + k]
            w[n + 1, EX], w[n + 1, EY], w[n + 1, ES], w[n + 1, KEPT] = ex, ey, es, kept
        elif count > 0:
            fx, fy, torque = hertz_forces(p, pockets, touch, w, gx, gy, count, share, rise, n)
        ax = 2.0 * turning * vy + second * x
        ay = -2.0 * turning * vx + second * y
        twist = 0.0
        if ramped:
            jerk_x, jerk_y = spin_up_terms(w, turning, p.turning * rise, n)
            ax += jerk_x
            ay += jerk_y
            twist = -p.turning * rise * radius if n == 0 else 0.0
        if heavy:
            ax += p.gravity * w[n, FRAME]
            ay -= p.gravity * w[n, FRAME + 1]
        if pressed or leaning:
            w[n, FX], w[n, FY], w[n, TORQUE] = fx, fy, torque
        if pressed:
            w[n, FRAME_X], w[n, FRAME_Y], w[n, FRAME_S] = ax, ay, twist
            land_geometry(p, w, gx, gy, n + 1)
            press_land(p, w, gx, gy, land, now, n)
            fx, fy, torque = w[n, FX], w[n, FY], w[n, TORQUE]
        if leaning:
            torque += centre_torque(w, p.eccentricity, radius, n)
        x, y = next_x, next_y
        vx, vy, vs = (fx + ax) * after, (fy + ay) * after, (torque * swiftness + twist) * after
        w[n + 1, VX], w[n + 1, VY], w[n + 1, W] = vx, vy, vs


@inner_kernel
def place_centre(w, eccentricity, n):  # type: ignore[no-untyped-def]
    """Coefficient n of the geometric centre, which the unbalance parts from the centre of mass."""
    w[n, GX] = w[n, X] - eccentricity * w[n, COS]
    w[n, GY] = w[n, Y] - eccentricity * w[n, SIN]


@inner_kernel
def centre_torque(w, eccentricity, radius, n):  # type: ignore[no-untyped-def]
    """Coefficient n of the torque that forces at the geometric centre have about that of mass, over M R."""
    return -eccentricity * (product(w, COS, FY, n) - product(w, SIN, FX, n)) / radius


@inner_kernel
def spin_up_terms(w, turning, spin_up, n):  # type: ignore[no-untyped-def]
    """Coefficient n of the accelerations that a frame has more when its turning grows."""
    ax, ay = spin_up * w[n, Y], -spin_up * w[n, X]
    if n > 0:
        ax += 2.0 * spin_up * (w[n - 1, VY] + turning * w[n - 1, X])
        ay += 2.0 * spin_up * (-w[n - 1, VX] + turning * w[n - 1, Y])
    if n > 1:
        ax += spin_up * spin_up * w[n - 2, X]
        ay += spin_up * spin_up * w[n - 2, Y]
    return ax, ay


@inner_kernel
def hertz_forces(p, pockets, touch, w, gx, gy, count, share, rise, n):  # type: ignore[no-untyped-def]
    """Coefficient n of the forces of Hertz pockets in touch, and n + 1 of their penetrations."""
    sum_cos = sum_sin = total = 0.0
    for i in range(count):
        j = touch[LIST, i]
        depth, force = BALLS + j, BALLS + pockets.shape[1] + j
        w[n, force] = hertz_power(p, w, depth, force, touch[SIDE, j], n)
        give = p.yielding * share * w[n, force]
        if n > 0:
            give += p.yielding * rise * w[n - 1, force]
        w[n + 1, depth] = (
            w[n + 1, gy] * pockets[COSINE, j]
            - w[n + 1, gx] * pockets[SINE, j]
            + w[n + 1, S]
            - give * AFTER[n]
        )
        for k in range(2 * p.harmonics):
            w[n + 1, depth] -= pockets[DRIVE + k, j] * w[n + 1, GONE + k]
        sum_cos += w[n, force] * pockets[COSINE, j]
        sum_sin += w[n, force] * pockets[SINE, j]
        total += w[n, force]
    return sum_sin - p.friction * sum_cos, -sum_cos - p.friction * sum_sin, -total


@inner_kernel
def hertz_power(p, w, depth, force, side, n):  # type: ignore[no-untyped-def]
    """Coefficient n of K |q|^1.5 with the sign of q."""
    start = w[0, depth]
    if n == 0:
        size = side * start
        return p.hertz * size * side * size**0.5
    total = 0.0
    for i in range(n):
        total += (1.5 * (n - i) - i) * w[n - i, depth] * w[i, force]
    return total / (n * start)


@inner_kernel
def rotate(w, radius, n):  # type: ignore[no-untyped-def]
    """Coefficient n, from 1, of the cosine and the sine of the rotation theta = S / R."""
    cosine = sine = 0.0
    for i in range(1, n + 1):
        cosine -= i * w[i, S] * w[n - i, SIN]
        sine += i * w[i, S] * w[n - i, COS]
    w[n, COS] = cosine / (n * radius)
    w[n, SIN] = sine / (n * radius)


@inner_kernel
def turn_frame(w, waves, turning, spin_up, n):  # type: ignore[no-untyped-def]
    """Coefficient n + 1 of the cosines and sines of the frame's turning and its multiples."""
    for k in range(0, waves, 2):
        c, s = FRAME + k, FRAME + k + 1
        cosine, sine = -turning * w[n, s], turning * w[n, c]
        if n > 0:
            cosine -= spin_up * w[n - 1, s]
            sine += spin_up * w[n - 1, c]
        scale = (1 + k // 2) * AFTER[n]
        w[n + 1, c], w[n + 1, s] = cosine * scale, sine * scale


@inner_kernel
def drive_balls(w, waves, share, rise, n):  # type: ignore[no-untyped-def]
    """Coefficient n + 1 of the way that a ball goes by a free speed of the form of each harmonic."""
    for k in range(waves):
        speed = share * w[n, FRAME + k]
        if n > 0:
            speed += rise * w[n - 1, FRAME + k]
        w[n + 1, GONE + k] = speed * AFTER[n]


@inner_kernel
def press_land(p, w, gx, gy, mode, now, n):  # type: ignore[no-untyped-def]
    """Add coefficient n of the land's force to the forces; a sticking one keeps the sliding at zero."""
    push_land(p, w, n)
    w[n, TANGENT] = 0.0
    if mode == STICK:
        w[n, TANGENT] = holding_force(p, w, gx, gy, now, n)
    else:
        w[n, TANGENT] = (-1.0 if mode == FORWARD else 1.0) * p.land_friction * w[n, NORMAL]
    rub_land(p, w, n)


@inner_kernel
def holding_force(p, w, gx, gy, now, n):  # type: ignore[no-untyped-def]
    """Coefficient n of the friction that keeps coefficient n + 1 of the sliding at zero.

    The coefficients of speeds and places that it uses are written anew afterwards.
    """
    fx, fy, torque = w[n, FX], w[n, FY], w[n, TORQUE]
    rub_land(p, w, n)
    after = AFTER[n]
    twist = w[n, TORQUE]
    if p.eccentricity != 0.0:
        twist += centre_torque(w, p.eccentricity, p.radius, n)
    w[n + 1, VX] = (w[n, FX] + w[n, FRAME_X]) * after
    w[n + 1, VY] = (w[n, FY] + w[n, FRAME_Y]) * after
    w[n + 1, W] = (twist * p.swiftness + w[n, FRAME_S]) * after
    for place, speed in ((X, VX), (Y, VY), (S, W)):
        w[n + 2, place] = w[n + 1, speed] * AFTER[n + 1]
    lever = p.land_side
    if p.eccentricity != 0.0:
        rotate(w, p.radius, n + 2)
        place_centre(w, p.eccentricity, n + 2)
        lever -= p.eccentricity * (w[0, COS] * w[0, NX] + w[0, SIN] * w[0, NY]) / p.radius
    sliding = slide_speed(p, w, gx, gy, now, n + 1)
    w[n, FX], w[n, FY], w[n, TORQUE] = fx, fy, torque
    return -(n + 1) * sliding / (1.0 + lever * lever * p.swiftness)
