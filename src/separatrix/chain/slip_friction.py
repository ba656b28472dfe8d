"""Friction of a whole slip field over a contact ellipse, with its slopes.

Axes of the contact: t along rolling (orbital direction), n outward from the ball, y = t x n across the
groove. The slip of the ball over the race at height h(y) above the ball centre (deformed surface of radius
R_d) is

    v_t = c0 y + c1 h + c2,   v_y = c3 h - c0 x,

linear in the four coefficients c; the resultants are conjugate to them.
"""

from __future__ import annotations

import math

import numpy as np

from separatrix.ground.compiled import part
from separatrix.ground.units import Array


@part
def _mean_inverse(v1: float, v2: float, r1: float, r2: float, s2: float) -> tuple[float, float, float, float]:
    """Mean of 1/sqrt(v^2 + s^2) for v from v1 to v2, and its slopes with v1, v2 and s^2."""
    dv = v2 - v1
    if abs(dv) < 1e-2 * (r1 + r2):
        v = 0.5 * (v1 + v2)
        q = 1.0 / (v * v + s2)
        root = math.sqrt(q)
        mean = root * (1.0 + dv * dv * q * (2.0 - 3.0 * s2 * q) / 24.0)
        by_v = -0.5 * v * q * root
        bend = dv * root * q * (2.0 - 3.0 * s2 * q) / 12.0
        return mean, by_v - bend, by_v + bend, -0.5 * q * root
    if v1 + v2 < 0.0:  # the integrand is even: avoid cancellation in v + r
        mean = math.log(_sum(-v1, r1, s2) / _sum(-v2, r2, s2)) / dv
    else:
        mean = math.log(_sum(v2, r2, s2) / _sum(v1, r1, s2)) / dv
    by_s2 = -0.5 * (v2 / r2 - v1 / r1) / (s2 * dv)
    return mean, (mean - 1.0 / r1) / dv, (1.0 / r2 - mean) / dv, by_s2


@part
def _sum(v: float, r: float, s2: float) -> float:
    """Sum v + r for r = sqrt(v^2 + s^2), without cancellation."""
    return v + r if v > 0.0 else s2 / (r - v)


@part
def friction_resultants(
    c: Array, a: float, b: float, height: float, radius: float, smoothing: float, nodes: Array, out: Array
) -> None:
    """Resultants of v/sqrt(|v|^2 + smoothing^2) weighted by the Hertz pressure, per unit load.

    `out`, shape (5, 7): rows spin moment, moment of h v_t, force along t, moment of h v_y, force along y;
    column 0 the value, 1 to 4 its slopes with c, 5 its slope with ln(load) through a and b, 6 its slope with
    a speed of the ball across the groove, added to v_y.

    `nodes`, shape (2, node): places and weights along rolling. Across the groove are twice as many strips; in
    each the slip along t is linear in y and averaged exactly, so that a line of no slip may be anywhere.
    """
    out[:, :] = 0.0
    step = 1.0 / nodes.shape[1]
    for j in range(2 * nodes.shape[1]):
        e1, e2 = -1.0 + j * step, -1.0 + (j + 1) * step
        mean_square = (e1 * e1 + e1 * e2 + e2 * e2) / 3.0
        weight, s = 0.75 * (1.0 - mean_square) * step, math.sqrt(1.0 - mean_square)
        y1, y2, y = a * e1, a * e2, 0.5 * a * (e1 + e2)
        d1, d2, d = math.sqrt(radius**2 - y1**2), math.sqrt(radius**2 - y2**2), math.sqrt(radius**2 - y**2)
        h1, h2, h = height - radius + d1, height - radius + d2, height - radius + d
        v1, v2 = c[0] * y1 + c[1] * h1 + c[2], c[0] * y2 + c[1] * h2 + c[2]
        X = Y = xY = X1 = X2 = Xs = xXs = Y1 = Y2 = xY1 = xY2 = Ys = xYs = xxYs = 0.0
        for k in range(nodes.shape[1]):
            x, w = b * s * nodes[0, k], nodes[1, k]
            vy = c[3] * h - c[0] * x
            s2 = vy * vy + smoothing * smoothing
            r1, r2 = math.sqrt(v1 * v1 + s2), math.sqrt(v2 * v2 + s2)
            inv = 1.0 / (r1 + r2)
            tx = (v1 + v2) * inv
            A, A1, A2, As = _mean_inverse(v1, v2, r1, r2, s2)
            X += w * tx
            X1 += w * (1.0 - tx * v1 / r1) * inv
            X2 += w * (1.0 - tx * v2 / r2) * inv
            xs, ys = -w * tx * inv * vy * (1.0 / r1 + 1.0 / r2), w * (A + 2.0 * vy * vy * As)
            Xs += xs
            xXs += x * xs
            Y += w * vy * A
            Y1 += w * vy * A1
            Y2 += w * vy * A2
            xY += w * x * vy * A
            xY1 += w * x * vy * A1
            xY2 += w * x * vy * A2
            Ys += ys
            xYs += x * ys
            xxYs += x * x * ys
        # growth of the slip with ln(load): y, x grow by a third, h by y h'(y)/3
        g1, g2, g_h = c[0] * y1 - c[1] * y1 * y1 / d1, c[0] * y2 - c[1] * y2 * y2 / d2, -y * y / d
        by_load = (g1 / 3.0, g2 / 3.0, c[3] * g_h / 3.0, -c[0] / 3.0)
        ways = ((y1, y2, 0.0, -1.0), (h1, h2, 0.0, 0.0), (1.0, 1.0, 0.0, 0.0), (0.0, 0.0, h, 0.0), by_load)
        for k in range(7):  # value, then slopes along changes of v1, v2, and of v_y as lift + turn x
            dX, dY, dxY = X, Y, xY
            if k > 0:
                c1, c2, lift, turn = ways[k - 1] if k < 6 else (0.0, 0.0, 1.0, 0.0)
                dX = c1 * X1 + c2 * X2 + lift * Xs + turn * xXs
                dY = c1 * Y1 + c2 * Y2 + lift * Ys + turn * xYs
                dxY = c1 * xY1 + c2 * xY2 + lift * xYs + turn * xxYs
            out[0, k] += weight * (y * dX - dxY)
            out[1, k] += weight * h * dX
            out[2, k] += weight * dX
            out[3, k] += weight * h * dY
            out[4, k] += weight * dY
        out[0, 5] += weight * (y * X - xY) / 3.0
        out[1, 5] += weight * g_h / 3.0 * X
        out[3, 5] += weight * g_h / 3.0 * Y


def chebyshev_nodes(count: int) -> Array:
    """Places (fractions of the half chord) and weights, shape (2, node), of a semi-ellipse's quadrature."""
    theta = np.pi * np.arange(1, count + 1) / (count + 1)
    return np.stack((np.cos(theta), np.sin(theta) ** 2 * 2.0 / (count + 1)))


NODES, COARSE_NODES = chebyshev_nodes(24), chebyshev_nodes(8)
"""Quadrature over an ellipse; the same, coarse."""
