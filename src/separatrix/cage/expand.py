r"""The motion of one mode as a power series in time.

As long as no contact changes, the planar equations are solved by series whose coefficients follow one from
the other: :math:`f(t) = \sum_n f_n t^n` has the derivative :math:`\dot f_n = (n + 1) f_{n+1}`. For springs,
dampers and the turning frame the equations are linear and the series is the exponential of the mode, summed
until the next term is below rounding; the land's normal, the unbalance and Hertz springs only add products
and powers of series.

All linear pockets yield at one rate :math:`a = k/C_\mu`, so that the penetration of pocket j,
:math:`\dot q_j = \dot u_j - a q_j`, follows from what it was and from the cage's speeds, each filtered once:
:math:`q_j(t) = q_j(0)\,e(t) + E_y \cos\phi_j - E_x \sin\phi_j + E_s`. The forces of any number of pockets
sum to the same few series.

Symbols are those of docs/theory/cage.md; in a ramp all speeds, and the yielding of the balls, are a share
:math:`\lambda(t) = \lambda_0 + \lambda' t` of their values.
"""

from __future__ import annotations

from separatrix.cage.features import (
    harmonics,
    has_gravity,
    has_own_series,
    has_unbalance,
    needs_frame,
    needs_rotation,
)
from separatrix.cage.land import land_geometry, push_land, rub_land, slide_speed
from separatrix.cage.records import (
    CLEAR,
    FORWARD,
    ORDER,
    RELEASED,
    STICK,
    Balls,
    Coefficients,
    Pace,
    Room,
    Series,
    State,
    Sums,
)
from separatrix.cage.series import AFTER, product
from separatrix.cage.traction import own_forces
from separatrix.compiled import inlined_kernel, inner_kernel


@inlined_kernel
def gather(balls: Balls, waves: int, count: int, sums: Sums) -> None:
    """Sums over the pockets in touch; with a radial load also of the free speeds of each wave."""
    cc = cs = ss = c_ = s_ = qc = qs = q_ = 0.0
    for k in range(waves):
        sums.drive_c[k] = sums.drive_s[k] = sums.drive[k] = 0.0
    for i in range(count):
        j = balls.touching[i]
        c, s, q = balls.cosine[j], balls.sine[j], balls.penetration[j]
        cc += c * c
        cs += c * s
        ss += s * s
        c_ += c
        s_ += s
        qc += q * c
        qs += q * s
        q_ += q
        for k in range(waves):
            sums.drive_c[k] += balls.drive[k, j] * c
            sums.drive_s[k] += balls.drive[k, j] * s
            sums.drive[k] += balls.drive[k, j]
    sums.cc, sums.cs, sums.ss, sums.c, sums.s, sums.qc, sums.qs, sums.q = cc, cs, ss, c_, s_, qc, qs, q_


@inlined_kernel
def expand(p: Coefficients, balls: Balls, w: Series, state: State, now: Pace, room: Room) -> None:
    """Fill the series of the motion from the state in their first coefficients."""
    count, land, share, rise, sums = state.touching, state.land, now.share, now.rise, room.sums
    turning, second, radius = p.turning * share, (p.turning * share) ** 2, p.radius
    stiffness, friction, swiftness = p.stiffness, p.friction, p.swiftness
    yielding, softer = p.yielding * p.stiffness * share, p.yielding * p.stiffness * rise
    linear, own = not has_own_series(p) and count > 0, has_own_series(p) and count + state.coasting > 0
    rotating, leaning, framed, waves = needs_rotation(p), has_unbalance(p), needs_frame(p), 2 * harmonics(p)
    ramped, heavy, pressed = rise != 0.0, has_gravity(p), land != CLEAR and land != RELEASED
    if linear:
        gather(balls, waves, count, sums)
    cc, cs, ss, c, s, qc, qs, qq = sums.cc, sums.cs, sums.ss, sums.c, sums.s, sums.qc, sums.qs, sums.q
    x, y, vx, vy, vs = w[0].x, w[0].y, w[0].vx, w[0].vy, w[0].vs
    ex = ey = es = 0.0
    kept = 1.0
    w[0].ex = w[0].ey = w[0].es = 0.0
    w[0].kept = 1.0
    for k in range(waves):
        w[0].felt[k] = w[0].gone[k] = 0.0
    if pressed:
        land_geometry(p, w, room.lobes, 0)
    for n in range(ORDER + 1):
        after = AFTER[n]
        # dr/dt = v, ds/dt = R d(theta)/dt: the places one power ahead of the speeds
        dx, dy, ds = vx * after, vy * after, vs * after
        w[n + 1].x, w[n + 1].y, w[n + 1].s = dx, dy, ds
        next_x, next_y = dx, dy
        if rotating:
            rotate(w, radius, n + 1)
            if leaning:
                place_centre(w, p.eccentricity, n + 1)
                dx, dy = w[n + 1].gx, w[n + 1].gy
        if framed:
            turn_frame(w, max(2, waves), turning, p.turning * rise, n)
            drive_balls(w, waves, share, rise, n)
        fx = fy = torque = 0.0
        if linear:
            # sum_j q_j cos phi_j, sum_j q_j sin phi_j and sum_j q_j, of the penetrations
            # q_j = q_j(0) e + E_y cos phi_j - E_x sin phi_j + E_s - sum_k V_jk felt_k
            sum_cos = kept * qc + cc * ey - cs * ex + c * es
            sum_sin = kept * qs + cs * ey - ss * ex + s * es
            total = kept * qq + c * ey - s * ex + count * es
            for k in range(waves):
                felt = w[n].felt[k]
                sum_cos -= sums.drive_c[k] * felt
                sum_sin -= sums.drive_s[k] * felt
                total -= sums.drive[k] * felt
                # d felt/dt = d gone/dt - a felt
                w[n + 1].felt[k] = w[n + 1].gone[k] - yielding * felt * after
            # F = sum_j -k q_j (e_t + sigma f e_r),  T / (M R) = -sum_j k q_j
            fx = stiffness * (sum_sin - friction * sum_cos)
            fy = -stiffness * (sum_cos + friction * sum_sin)
            torque = -stiffness * total
            # dE/dt = v - a E and de/dt = -a e; in a ramp a = a_0 + a' t
            rate = yielding * after
            ex, ey, es, kept = dx - rate * ex, dy - rate * ey, ds - rate * es, -rate * kept
            if ramped and n > 0:
                rate = softer * after
                ex -= rate * w[n - 1].ex
                ey -= rate * w[n - 1].ey
                es -= rate * w[n - 1].es
                kept -= rate * w[n - 1].kept
                for k in range(waves):
                    w[n + 1].felt[k] -= rate * w[n - 1].felt[k]
            w[n + 1].ex, w[n + 1].ey, w[n + 1].es, w[n + 1].kept = ex, ey, es, kept
        elif own:
            fx, fy, torque = own_forces(p, balls, w, state, now, n)
        # What the frame adds: 2 v x Omega + Omega^2 r
        ax = 2.0 * turning * vy + second * x
        ay = -2.0 * turning * vx + second * y
        twist = 0.0
        if ramped:
            # in a ramp r x dOmega/dt besides, and -R dOmega/dt on the rotation
            jerk_x, jerk_y = spin_up_terms(w, turning, p.turning * rise, n)
            ax += jerk_x
            ay += jerk_y
            twist = -p.turning * rise * radius if n == 0 else 0.0
        if heavy:
            # gravity is fixed in space: it turns at -Omega
            ax += p.gravity * w[n].frame[0]
            ay -= p.gravity * w[n].frame[1]
        if pressed or leaning:
            w[n].fx, w[n].fy, w[n].torque = fx, fy, torque
        if pressed:
            w[n].frame_x, w[n].frame_y, w[n].frame_s = ax, ay, twist
            land_geometry(p, w, room.lobes, n + 1)
            press_land(p, w, land, now, n)
            fx, fy, torque = w[n].fx, w[n].fy, w[n].torque
        if leaning:
            torque += centre_torque(w, p.eccentricity, radius, n)
        x, y = next_x, next_y
        # M dv/dt = F + frame;  J d2(theta)/dt2 = T, with s = R theta and T over M R
        vx, vy, vs = (fx + ax) * after, (fy + ay) * after, (torque * swiftness + twist) * after
        w[n + 1].vx, w[n + 1].vy, w[n + 1].vs = vx, vy, vs


@inner_kernel
def place_centre(w: Series, eccentricity: float, n: int) -> None:
    """Coefficient n of the geometric centre, which the unbalance parts from the centre of mass."""
    # r_g = r - epsilon (cos theta, sin theta)
    w[n].gx = w[n].x - eccentricity * w[n].cos
    w[n].gy = w[n].y - eccentricity * w[n].sin


@inner_kernel
def centre_torque(w: Series, eccentricity: float, radius: float, n: int) -> float:
    """Coefficient n of the torque that forces at the geometric centre have about that of mass, over M R."""
    # T = -epsilon (cos theta, sin theta) x F
    return -eccentricity * (product(w.cos, w.fy, n) - product(w.sin, w.fx, n)) / radius


@inner_kernel
def spin_up_terms(w: Series, turning: float, spin_up: float, n: int) -> tuple[float, float]:
    """Coefficient n of the accelerations that a frame has more when its turning grows."""
    # With Omega = Omega_0 + Omega' t:
    # Omega' (y, -x) + 2 Omega' t (v_y, -v_x) + (2 Omega_0 Omega' t + Omega'^2 t^2) r
    ax, ay = spin_up * w[n].y, -spin_up * w[n].x
    if n > 0:
        ax += 2.0 * spin_up * (w[n - 1].vy + turning * w[n - 1].x)
        ay += 2.0 * spin_up * (-w[n - 1].vx + turning * w[n - 1].y)
    if n > 1:
        ax += spin_up * spin_up * w[n - 2].x
        ay += spin_up * spin_up * w[n - 2].y
    return ax, ay


@inner_kernel
def rotate(w: Series, radius: float, n: int) -> None:
    """Coefficient n, from 1, of the cosine and the sine of the rotation theta = s / R."""
    # d cos theta/dt = -sin theta ds/dt / R, d sin theta/dt = cos theta ds/dt / R
    cosine = sine = 0.0
    for i in range(1, n + 1):
        cosine -= i * w[i].s * w[n - i].sin
        sine += i * w[i].s * w[n - i].cos
    w[n].cos = cosine / (n * radius)
    w[n].sin = sine / (n * radius)


@inner_kernel
def turn_frame(w: Series, waves: int, turning: float, spin_up: float, n: int) -> None:
    """Coefficient n + 1 of the cosines and sines of the frame's turning and its multiples."""
    # With dalpha/dt = Omega_0 + Omega' t: d cos h alpha/dt = -h dalpha/dt sin h alpha, and the sine likewise
    for k in range(0, waves, 2):
        cosine, sine = -turning * w[n].frame[k + 1], turning * w[n].frame[k]
        if n > 0:
            cosine -= spin_up * w[n - 1].frame[k + 1]
            sine += spin_up * w[n - 1].frame[k]
        scale = (1 + k // 2) * AFTER[n]
        w[n + 1].frame[k], w[n + 1].frame[k + 1] = cosine * scale, sine * scale


@inner_kernel
def drive_balls(w: Series, waves: int, share: float, rise: float, n: int) -> None:
    """Coefficient n + 1 of the way that a ball goes by a free speed of the form of each wave."""
    # d gone_k/dt = lambda frame_k
    for k in range(waves):
        speed = share * w[n].frame[k]
        if n > 0:
            speed += rise * w[n - 1].frame[k]
        w[n + 1].gone[k] = speed * AFTER[n]


@inner_kernel
def press_land(p: Coefficients, w: Series, mode: int, now: Pace, n: int) -> None:
    """Add coefficient n of the land's force to the forces; a sticking one keeps the sliding at zero."""
    push_land(p, w, n)
    w[n].tangent = 0.0
    if mode == STICK:
        w[n].tangent = holding_force(p, w, now, n)
    else:
        # F_t = -mu P sign v_s
        w[n].tangent = (-1.0 if mode == FORWARD else 1.0) * p.land_friction * w[n].normal
    rub_land(p, w, n)


@inner_kernel
def holding_force(p: Coefficients, w: Series, now: Pace, n: int) -> float:
    """Coefficient n of the friction that keeps coefficient n + 1 of the sliding at zero.

    The coefficients of speeds and places that it uses are written anew afterwards.
    """
    # The sliding that comes of all other forces, and what a unit of friction does to it:
    # dv_s/dt = [...] + F_t (1 + (q - epsilon . n / R)^2 M R^2 / J)
    fx, fy, torque = w[n].fx, w[n].fy, w[n].torque
    rub_land(p, w, n)
    after = AFTER[n]
    twist = w[n].torque
    if has_unbalance(p):
        twist += centre_torque(w, p.eccentricity, p.radius, n)
    w[n + 1].vx = (w[n].fx + w[n].frame_x) * after
    w[n + 1].vy = (w[n].fy + w[n].frame_y) * after
    w[n + 1].vs = (twist * p.swiftness + w[n].frame_s) * after
    later = AFTER[n + 1]
    w[n + 2].x, w[n + 2].y, w[n + 2].s = w[n + 1].vx * later, w[n + 1].vy * later, w[n + 1].vs * later
    lever = p.land_side
    if has_unbalance(p):
        rotate(w, p.radius, n + 2)
        place_centre(w, p.eccentricity, n + 2)
        lever -= p.eccentricity * (w[0].cos * w[0].nx + w[0].sin * w[0].ny) / p.radius
    sliding = slide_speed(p, w, now, n + 1)
    w[n].fx, w[n].fy, w[n].torque = fx, fy, torque
    return -(n + 1) * sliding / (1.0 + lever * lever * p.swiftness)
