"""One ball in its two grooves: contact angles, normal loads, and the friction of each contact.

In the plane of a ball, (x, r) are the axial and outward components. V leads from the outer groove's centre of
curvature to the ball centre, A to the inner groove's; A - V leads from the ball to the inner groove's centre.

A groove is half a circle that goes on as two straight walls: no ball meets the missing half of the circle,
and the room of a ball stays convex. Contact angles so steep are refused once a bearing is solved.

Friction comes from the whole slip field over the ellipse. Axes of the contact: t along rolling (orbital
direction), n outward from the ball, y = t x n across the groove. The slip of the ball over the race at height
h(y) above the ball centre (deformed surface of radius R_d) is

    v_t = c0 y + c1 h + c2,   v_y = c3 h - c0 x,

linear in the four coefficients c; the resultants below are conjugate to them.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from separatrix.chain.equilibrium.problem import Problem
from separatrix.chain.hertz import approach_coefficient
from separatrix.ground.compiled import kernel, part
from separatrix.ground.units import Array


class Touch(NamedTuple):
    """One contact: angle as sine and cosine, load, its slopes, and the ellipse per load^(1/3)."""

    sine: float
    cosine: float
    length: float  # from ball centre to groove centre; infinite at a straight wall, where no angle changes
    load: float
    load_slope: float  # dQ/d(length)
    major_coefficient: float  # a = major_coefficient Q^(1/3)
    axis_ratio: float  # b/a


@part
def touch(p: Problem, side: float, axial: float, radial: float, guess: float) -> Touch:
    """Contact of a ball whose centre is (axial, radial) from the groove's; side -1 inner, +1 outer."""
    D = p.ball_diameter
    f = p.inner_conformity if side < 0.0 else p.outer_conformity
    at_wall = radial < 0.0
    radial = max(radial, 0.0)
    length = math.hypot(axial, radial)
    approach = length - (f - 0.5) * D
    # Without contact the angle is only nominal: turn it towards the radial direction as the gap opens.
    nominal_radial = radial - 2.0 * min(approach, 0.0)
    nominal = math.hypot(axial, nominal_radial)
    s, c = axial / nominal, nominal_radial / nominal
    rolling = 2.0 / (D * (1.0 + side * D * c / p.pitch_diameter))
    kappa, major, k = approach_coefficient(rolling, (2.0 - 1.0 / f) / D, p.modulus, guess)
    root = math.sqrt(max(approach, 0.0))
    length = math.inf if at_wall else length
    return Touch(s, c, length, kappa * root * max(approach, 0.0), 1.5 * kappa * root, major, k)


@kernel
def static_split(p: Problem, axial: float, radial: float) -> tuple[float, float, float]:
    """Ball centre V and load where both contacts are on one line (no inertia); A = (axial, radial)."""
    D, below = p.ball_diameter, 0.5 * min(radial, 0.0)  # between straight walls any height balances
    radial = max(radial, 0.0)
    length = math.hypot(axial, radial)
    s, c = (axial / length, radial / length) if length > 0.0 else (0.0, 1.0)
    approach = length - (p.inner_conformity + p.outer_conformity - 1.0) * D
    share = approach
    if approach > 0.0:
        gamma = D * c / p.pitch_diameter
        curved_i, curved_o = (2.0 - 1.0 / p.inner_conformity) / D, (2.0 - 1.0 / p.outer_conformity) / D
        k_i = approach_coefficient(2.0 / (D * (1.0 - gamma)), curved_i, p.modulus, 0.0)[0]
        k_o = approach_coefficient(2.0 / (D * (1.0 + gamma)), curved_o, p.modulus, 0.0)[0]
        soft_i, soft_o = k_i ** (-2.0 / 3.0), k_o ** (-2.0 / 3.0)
        share = approach * soft_o / (soft_i + soft_o)
        load = (approach / (soft_i + soft_o)) ** 1.5
    else:
        load = 0.0
    reach = (p.outer_conformity - 0.5) * D + share
    return reach * s, reach * c + below, load


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
    c: Array,
    a: float,
    b: float,
    height: float,
    radius: float,
    smoothing: float,
    cells: int,
    nodes: Array,
    out: Array,
) -> None:
    """Resultants of v/sqrt(|v|^2 + smoothing^2) weighted by the Hertz pressure, per unit load.

    `out`, shape (5, 7): rows spin moment, moment of h v_t, force along t, moment of h v_y, force along y;
    column 0 the value, 1 to 4 its slopes with c, 5 its slope with ln(load) through a and b, 6 its slope with
    a speed of the ball across the groove, added to v_y.

    `cells` strips across the groove, in each the slip along t is taken linear in y and averaged exactly, so
    that a line of no slip may be anywhere. `nodes`, shape (2, node): places and weights along rolling.
    """
    out[:, :] = 0.0
    eps2, step = smoothing * smoothing, 2.0 / cells
    J = np.empty((5, 3))  # slopes of a strip's resultants with v1, v2 and with the coefficients of v_y
    for j in range(cells):
        e1, e2 = -1.0 + j * step, -1.0 + (j + 1) * step
        mean_square = (e1 * e1 + e1 * e2 + e2 * e2) / 3.0
        weight = 0.75 * (1.0 - mean_square) * step
        s = math.sqrt(1.0 - mean_square)
        y1, y2, y = a * e1, a * e2, 0.5 * a * (e1 + e2)
        d1, d2, d = (
            math.sqrt(radius**2 - y1 * y1),
            math.sqrt(radius**2 - y2 * y2),
            math.sqrt(radius**2 - y * y),
        )
        h1, h2, h = height - radius + d1, height - radius + d2, height - radius + d
        v1, v2 = c[0] * y1 + c[1] * h1 + c[2], c[0] * y2 + c[1] * h2 + c[2]
        # growth of the slip with ln(load): y, x grow by a third, h by y h'(y) / 3
        g1, g2 = (c[0] * y1 - c[1] * y1 * y1 / d1) / 3.0, (c[0] * y2 - c[1] * y2 * y2 / d2) / 3.0
        h_growth = -y * y / d / 3.0
        X = Y = XY = 0.0
        X1 = X2 = Xs = Xxs = Y1 = Y2 = xY1 = xY2 = Ys = xYs = xxYs = 0.0
        for k in range(nodes.shape[1]):
            x, w = b * s * nodes[0, k], nodes[1, k]
            vy = c[3] * h - c[0] * x
            s2 = vy * vy + eps2
            r1, r2 = math.sqrt(v1 * v1 + s2), math.sqrt(v2 * v2 + s2)
            inv = 1.0 / (r1 + r2)
            tx = (v1 + v2) * inv
            A, A1, A2, As = _mean_inverse(v1, v2, r1, r2, s2)
            ty = vy * A
            X += w * tx
            Y += w * ty
            XY += w * x * ty
            X1 += w * (1.0 - tx * v1 / r1) * inv
            X2 += w * (1.0 - tx * v2 / r2) * inv
            xs = -w * tx * inv * vy * (1.0 / r1 + 1.0 / r2)
            Xs += xs
            Xxs += x * xs
            Y1 += w * vy * A1
            Y2 += w * vy * A2
            xY1 += w * x * vy * A1
            xY2 += w * x * vy * A2
            ys = w * (A + 2.0 * vy * vy * As)
            Ys += ys
            xYs += x * ys
            xxYs += x * x * ys
        value0, value1 = y * X - XY, h * X
        out[0, 0] += weight * value0
        out[1, 0] += weight * value1
        out[2, 0] += weight * X
        out[3, 0] += weight * h * Y
        out[4, 0] += weight * Y
        J[0, 0], J[0, 1] = y * X1 - xY1, y * X2 - xY2
        J[1, 0], J[1, 1] = h * X1, h * X2
        J[2, 0], J[2, 1] = X1, X2
        J[3, 0], J[3, 1] = h * Y1, h * Y2
        J[4, 0], J[4, 1] = Y1, Y2
        for row in range(5):
            if row == 0:
                by_lift, by_turn = y * Xs - xYs, y * Xxs - xxYs
            elif row < 3:
                f = h if row == 1 else 1.0
                by_lift, by_turn = f * Xs, f * Xxs
            else:
                f = h if row == 3 else 1.0
                by_lift, by_turn = f * Ys, f * xYs
            out[row, 1] += weight * (J[row, 0] * y1 + J[row, 1] * y2 - by_turn)
            out[row, 2] += weight * (J[row, 0] * h1 + J[row, 1] * h2)
            out[row, 3] += weight * (J[row, 0] + J[row, 1])
            out[row, 4] += weight * h * by_lift
            out[row, 6] += weight * by_lift
            growth = J[row, 0] * g1 + J[row, 1] * g2 + c[3] * h_growth * by_lift - c[0] * by_turn / 3.0
            out[row, 5] += weight * growth
        out[0, 5] += weight * value0 / 3.0
        out[1, 5] += weight * h_growth * X
        out[3, 5] += weight * h_growth * Y


def chebyshev_nodes(count: int) -> Array:
    """Places (fractions of the half chord) and weights, shape (2, node), of a semi-ellipse's quadrature."""
    theta = np.pi * np.arange(1, count + 1) / (count + 1)
    return np.stack((np.cos(theta), np.sin(theta) ** 2 * 2.0 / (count + 1)))
