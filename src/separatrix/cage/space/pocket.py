r"""The pocket of one ball, as power series: where the ball is in it, the force, and the friction.

Along the axis and along the orbit a pocket stands against its ball by
:math:`d_z = z - R\,\tau\cdot e_t - x_j` and :math:`d_t = r\cdot e_t + s - y_j`. A round part of radius
:math:`c` about :math:`(0, \mp b)` presses along :math:`\hat p = -w/|w|` with :math:`w = (d_z, d_t \pm b)` and
:math:`N = k(|w| - c)`; a flat along its normal. Friction :math:`f N` points along the sliding of the ball's
surface on the pocket: outward :math:`h(O_t p_z - O_z p_t) - v_r`, and across the force, along
:math:`\hat q = (-p_t, p_z)`, :math:`-h O_r - v\cdot\hat q`, with the ball's spin O and :math:`h = D/2`. The
ball's own speed of fractions of a metre a second is left out there.

All sums of a coefficient that do not wait for each other are taken in one loop over pairs of the lower ones,
m and n - m, which are read once; the middle one, if n is even, and what its own value adds follow.
"""

from __future__ import annotations

import math

from separatrix.cage.records import Pace
from separatrix.cage.space.records import (
    AXIAL,
    CR,
    CT,
    CZ,
    DEPTH,
    DT,
    DZ,
    FAR,
    FT,
    FZ,
    GA,
    GB,
    GONE,
    GRIPPED,
    GX,
    GY,
    HERE_T,
    HERE_Z,
    LEAD,
    LEAN,
    PER_FAR,
    PER_SLIDE,
    PT,
    PUSH,
    PZ,
    ROUND_END,
    RUB_Q,
    RUB_R,
    SHARE,
    SLIDE,
    SLIDE_Q,
    SLIDE_R,
    SPIN,
    VS,
    VZ,
    Numbers,
    Parts,
    S,
    Z,
)
from separatrix.compiled import inlined_kernel
from separatrix.units import Array


@inlined_kernel
def place_pocket(p: Numbers, parts: Parts, j: int, n: int) -> None:
    """Coefficient n of a pocket's place against its ball, and of its velocity."""
    cos, sin, now, ball, m = parts.cosine[j], parts.sine[j], parts.cage[n], parts.ball[j, n], n + 1
    after = parts.cage[m]
    along = now[GY] * cos - now[GX] * sin + now[S] - ball[LEAD]
    for k in range(2 * p.harmonics):
        along -= parts.drive[k, j] * now[GONE + k]
    ball[DT] = along
    ball[DZ] = now[Z] - (now[GB] * cos - now[GA] * sin) - ball[AXIAL]
    ball[CR] = m * (after[GX] * cos + after[GY] * sin)
    ball[CT] = m * (after[GY] * cos - after[GX] * sin) + now[VS]
    ball[CZ] = now[VZ] - m * (after[GB] * cos - after[GA] * sin)


@inlined_kernel
def expand_contact(p: Numbers, parts: Parts, i: int, now: Pace, n: int) -> None:
    """Coefficient n of the penetration of a contact, of its force, its friction and their couples."""
    if parts.kind[i] == ROUND_END:
        expand_round(p, parts, i, now, n)
    else:
        expand_flat(p, parts, i, now, n)


@inlined_kernel
def expand_flat(p: Numbers, parts: Parts, i: int, now: Pace, n: int) -> None:
    """Coefficient n of a flat, or of the two that grip a ball."""
    j = i // 2
    c, ball, along = parts.contact[i], parts.ball[j, n], i % 2 == 0
    side = 1.0 if parts.kind[i] == GRIPPED else float(parts.kind[i])
    z, t = (0.0, -side) if along else (-side, 0.0)
    depth = side * (ball[DT] if along else ball[DZ])
    out, across = -ball[CR], ball[CZ] * t - ball[CT] * z
    if n == 0:
        depth -= p.around + parts.play[j] if along else p.beside
    if n < 2:
        out += now[n] * (p.spin_t * z - p.spin_z * t)
        across -= p.spin_r * now[n]
    push = parts.stiff[i] * depth
    c[n, DEPTH], c[n, PUSH] = depth, push
    rub(p, c, push, out, across, n)
    out, across = c[n, RUB_R], c[n, RUB_Q]
    c[n, FZ], c[n, FT] = push * z - across * t, push * t + across * z
    c[n, SPIN], c[n, LEAN] = -out * t, out * z


@inlined_kernel
def expand_round(p: Numbers, parts: Parts, i: int, now: Pace, n: int) -> None:
    """Coefficient n of the round part of a pocket."""
    j = i // 2
    c, ball = parts.contact[i], parts.ball[j]
    z, t = ball[n, DZ], ball[n, DT]
    if n == 0:
        t -= parts.region[j] * p.apart
        far = math.sqrt(z * z + t * t)
        pz, pt, depth = -z / far, -t / far, far - p.around - parts.play[j]
        c[0, PER_FAR] = 1.0 / far
        push = parts.stiff[i] * depth
        push_z, push_t = push * pz, push * pt
        across = ball[0, CZ] * pt - ball[0, CT] * pz
    else:
        half = back_z = back_t = axial = along = push_z = push_t = 0.0
        for m in range(1, (n + 1) // 2):
            a, b, u, v = c[m], c[n - m], ball[m], ball[n - m]
            half += a[HERE_Z] * b[HERE_Z] + a[HERE_T] * b[HERE_T] - a[FAR] * b[FAR]
            back_z += a[FAR] * b[PZ] + b[FAR] * a[PZ]
            back_t += a[FAR] * b[PT] + b[FAR] * a[PT]
            axial += u[CZ] * b[PT] + v[CZ] * a[PT]
            along += u[CT] * b[PZ] + v[CT] * a[PZ]
            push_z += a[PUSH] * b[PZ] + b[PUSH] * a[PZ]
            push_t += a[PUSH] * b[PT] + b[PUSH] * a[PT]
        if n % 2 == 0:
            a, u = c[n // 2], ball[n // 2]
            half += 0.5 * (a[HERE_Z] * a[HERE_Z] + a[HERE_T] * a[HERE_T] - a[FAR] * a[FAR])
            back_z, back_t = back_z + a[FAR] * a[PZ], back_t + a[FAR] * a[PT]
            axial, along = axial + u[CZ] * a[PT], along + u[CT] * a[PZ]
            push_z, push_t = push_z + a[PUSH] * a[PZ], push_t + a[PUSH] * a[PT]
        # |w|^2 = w_z^2 + w_t^2 and |w| p = -w
        per, z0, t0 = c[0, PER_FAR], c[0, PZ], c[0, PT]
        far = (c[0, HERE_Z] * z + c[0, HERE_T] * t + half) * per
        pz, pt, depth = -(z + back_z + far * z0) * per, -(t + back_t + far * t0) * per, far
        push = parts.stiff[i] * depth
        push_z += c[0, PUSH] * pz + push * z0
        push_t += c[0, PUSH] * pt + push * t0
        axial += ball[0, CZ] * pt + ball[n, CZ] * t0
        along += ball[0, CT] * pz + ball[n, CT] * z0
        across = axial - along
    c[n, HERE_Z], c[n, HERE_T], c[n, FAR], c[n, PZ], c[n, PT] = z, t, far, pz, pt
    c[n, DEPTH], c[n, PUSH] = depth, push
    out = now.share * (p.spin_t * pz - p.spin_z * pt) - ball[n, CR]
    if n > 0:
        out += now.rise * (p.spin_t * c[n - 1, PZ] - p.spin_z * c[n - 1, PT])
    if n < 2:
        across -= p.spin_r * now[n]
    rub(p, c, push, out, across, n)
    rub_z = rub_t = spin = lean = 0.0
    for m in range((n + 1) // 2):
        a, b = c[m], c[n - m]
        rub_z += a[RUB_Q] * b[PT] + b[RUB_Q] * a[PT]
        rub_t += a[RUB_Q] * b[PZ] + b[RUB_Q] * a[PZ]
        spin += a[RUB_R] * b[PT] + b[RUB_R] * a[PT]
        lean += a[RUB_R] * b[PZ] + b[RUB_R] * a[PZ]
    if n % 2 == 0:
        a = c[n // 2]
        rub_z, rub_t = rub_z + a[RUB_Q] * a[PT], rub_t + a[RUB_Q] * a[PZ]
        spin, lean = spin + a[RUB_R] * a[PT], lean + a[RUB_R] * a[PZ]
    c[n, FZ], c[n, FT], c[n, SPIN], c[n, LEAN] = push_z - rub_z, push_t + rub_t, -spin, lean


@inlined_kernel
def rub(p: Numbers, c: Array, push: float, out: float, across: float, n: int) -> None:
    """Coefficient n of the friction of a contact: |v|^2 = v_r^2 + v_q^2 + v_0^2, and G |v| = f N."""
    c[n, SLIDE_R], c[n, SLIDE_Q] = out, across
    if n == 0:
        size = math.sqrt(out * out + across * across + p.pivoting)
        share = p.friction * push / size
        c[0, SLIDE], c[0, PER_SLIDE], c[0, SHARE] = size, 1.0 / size, share
        c[0, RUB_R], c[0, RUB_Q] = share * out, share * across
        return
    half = lag = rub_r = rub_q = 0.0
    for m in range(1, (n + 1) // 2):
        a, b = c[m], c[n - m]
        half += a[SLIDE_R] * b[SLIDE_R] + a[SLIDE_Q] * b[SLIDE_Q] - a[SLIDE] * b[SLIDE]
        lag += a[SLIDE] * b[SHARE] + b[SLIDE] * a[SHARE]
        rub_r += a[SHARE] * b[SLIDE_R] + b[SHARE] * a[SLIDE_R]
        rub_q += a[SHARE] * b[SLIDE_Q] + b[SHARE] * a[SLIDE_Q]
    if n % 2 == 0:
        a = c[n // 2]
        half += 0.5 * (a[SLIDE_R] * a[SLIDE_R] + a[SLIDE_Q] * a[SLIDE_Q] - a[SLIDE] * a[SLIDE])
        lag += a[SLIDE] * a[SHARE]
        rub_r, rub_q = rub_r + a[SHARE] * a[SLIDE_R], rub_q + a[SHARE] * a[SLIDE_Q]
    first, per = c[0, SLIDE_R] * out + c[0, SLIDE_Q] * across, c[0, PER_SLIDE]
    size = (first + half) * per
    share = (p.friction * push - lag - size * c[0, SHARE]) * per
    c[n, SLIDE], c[n, SHARE] = size, share
    c[n, RUB_R] = rub_r + c[0, SHARE] * out + share * c[0, SLIDE_R]
    c[n, RUB_Q] = rub_q + c[0, SHARE] * across + share * c[0, SLIDE_Q]
