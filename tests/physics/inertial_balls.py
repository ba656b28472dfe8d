"""The planar cage among balls with inertia by another program: the equations as written, and scipy's DOP853.

It knows no events and no series and takes the cage's inputs only. Steps are as short as the tolerance asks
where a contact begins. The land's friction takes the sign of the sliding: for cages that do not stick.
"""

from typing import NamedTuple

import numpy as np
import small_step
from scipy.integrate import solve_ivp

CAGE = 6


class Course(NamedTuple):
    """A run at its times: centre and velocity, rotation, its rate, leads and own speeds of the balls."""

    position: np.ndarray
    velocity: np.ndarray
    rotation: np.ndarray
    rate: np.ndarray
    ball_lead: np.ndarray
    ball_speed: np.ndarray


def integrate(cage, *, kick, direction, ball_lead, times, rtol=1e-12, longest=np.inf) -> Course:
    """Follow the cage from the kick; the places of the balls at these times."""
    p, law, Z = small_step.numbers(cage), cage.traction, cage.ball_count
    start = np.zeros(CAGE + 2 * Z)
    start[0] = p.eccentricity
    start[2:4] = kick * np.cos(direction), kick * np.sin(direction)
    start[CAGE : CAGE + Z] = ball_lead
    # places to rtol of the clearance, speeds to rtol of the kick
    size = np.array([1e-4, 1e-4, kick, kick, 1e-4 / p.radius, kick / p.radius] + [1e-4] * Z + [kick] * Z)

    def rates(t, z):
        x, y, vx, vy, theta, spin = z[:CAGE]
        lead, u = z[CAGE : CAGE + Z], z[CAGE + Z :]
        ramped = t < p.ramp_time
        rise = (1.0 - p.ramp_start) / p.ramp_time if ramped else 0.0
        s = p.ramp_start + rise * t if ramped else 1.0
        late = max(0.0, t - p.ramp_time)
        turned = p.cage_speed * (late + (t - late) * (p.ramp_start if p.ramp_time else 1.0))
        if p.ramp_time:
            turned += p.cage_speed * 0.5 * (1.0 - p.ramp_start) / p.ramp_time * (t - late) ** 2
        W, dW = p.cage_speed * s, p.cage_speed * rise
        ex, ey = p.eccentricity * np.cos(theta), p.eccentricity * np.sin(theta)
        gx, gy, vgx, vgy = x - ex, y - ey, vx + ey * spin, vy - ex * spin
        away = gy * p.cos - gx * p.sin + p.radius * theta - lead
        excess = np.abs(away) - p.half_play
        N = np.where(excess > 0.0, p.stiffness * np.abs(excess) ** p.power, 0.0) * np.sign(away)
        fx = np.sum(N * p.sin - p.inward * N * p.cos)
        fy = np.sum(-N * p.cos - p.inward * N * p.sin)
        moment = -p.radius * np.sum(N)
        r = np.hypot(gx, gy)
        if r > p.gap:
            nx, ny = gx / r, gy / r
            push = max(0.0, p.land_stiffness * (r - p.gap) + p.land_damper * (nx * vgx + ny * vgy))
            ring = (p.ring_speed - p.cage_speed) * s * p.radius
            sliding = nx * vgy - ny * vgx + p.side * (p.radius * spin - ring)
            T = -p.land_friction * push * np.sign(sliding)
            fx, fy = fx - push * nx - T * ny, fy - push * ny + T * nx
            moment += p.side * T * p.radius
        moment += ey * fx - ex * fy
        at, drive = p.pocket_angle + turned, 0.0
        for h, (A, B) in enumerate(zip(p.cosines, p.sines, strict=True), start=1):
            drive = drive + s * (A * np.cos(h * at) + B * np.sin(h * at))
        out = np.empty_like(z)
        out[:2] = vx, vy
        out[2] = fx / p.mass + 2 * W * vy + W * W * x + dW * y + p.gravity * np.cos(turned)
        out[3] = fy / p.mass - 2 * W * vx + W * W * y - dW * x - p.gravity * np.sin(turned)
        out[4:CAGE] = spin, moment / p.inertia - dW
        out[CAGE : CAGE + Z] = u + drive
        out[CAGE + Z :] = (N - law.force(u / s)) / law.mass
        return out

    parts, begun, state = [], 0.0, start
    for end in sorted({min(p.ramp_time, times[-1]), times[-1]} - {0.0}):  # a ramp ends with a kink
        asked = times[(times >= begun) & (times < end)] if end < times[-1] else times[times >= begun]
        seen = np.union1d(asked, [end])
        run = solve_ivp(
            rates, (begun, end), state, "DOP853", seen, rtol=rtol, atol=rtol * size, max_step=longest
        )
        parts.append(run.y[:, np.isin(run.t, asked)])
        begun, state = end, run.y[:, -1]
    z = np.hstack(parts).T
    swing = p.eccentricity * np.stack([np.cos(z[:, 4]), np.sin(z[:, 4])], axis=1)
    balls = z[:, CAGE : CAGE + Z], z[:, CAGE + Z :]
    return Course(z[:, :2] - swing, z[:, 2:4], z[:, 4], z[:, 5], *balls)
