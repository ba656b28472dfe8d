r"""The pocket of one ball, as power series: where the ball is in it, the force, and the friction.

Along the axis and along the orbit a pocket stands against its ball by
:math:`d_z = z - R\,\tau\cdot e_t - x_j` and :math:`d_t = r\cdot e_t + s - y_j`. A round part of radius
:math:`c` about :math:`(0, \mp b)` presses along :math:`\hat p = -w/|w|` with :math:`w = (d_z, d_t \pm b)` and
:math:`N = k(|w| - c)`; a flat along its normal. Friction :math:`f N` points along the sliding of the ball's
surface on the pocket: outward :math:`h(O_t p_z - O_z p_t) - v_r`, and across the force, along
:math:`\hat q = (-p_t, p_z)`, :math:`-h O_r - v\cdot\hat q`, with the ball's spin O and :math:`h = D/2`. The
ball's own speed of fractions of a metre a second is left out there.

Each stage of a coefficient runs over all contacts before the next begins: their sums do not wait for each
other.
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
def press_pockets(p: Numbers, parts: Parts, n: int) -> None:
    """Coefficient n of the penetration of all contacts, of the force and its direction."""
    for a in range(parts.listed[0]):
        i = parts.touching[a]
        if parts.kind[i] == ROUND_END:
            measure_round(p, parts, i, n)
        else:
            press_flat(p, parts, i, n)
    if n == 0:
        return
    for a in range(parts.listed[0]):
        i = parts.touching[a]
        if parts.kind[i] == ROUND_END:
            # |w| p = -w, coefficient by coefficient
            c = parts.contact[i]
            z = t = 0.0
            for m in range(1, n + 1):
                far = c[m, FAR]
                z += far * c[n - m, PZ]
                t += far * c[n - m, PT]
            c[n, PZ] = -(c[n, HERE_Z] + z) * c[0, PER_FAR]
            c[n, PT] = -(c[n, HERE_T] + t) * c[0, PER_FAR]


@inlined_kernel
def measure_round(p: Numbers, parts: Parts, i: int, n: int) -> None:
    """Coefficient n of the distance of a ball from the middle of the round part: |w|^2 = w_z^2 + w_t^2."""
    j = i // 2
    c, ball = parts.contact[i], parts.ball[j, n]
    c[n, HERE_Z], c[n, HERE_T] = ball[DZ], ball[DT]
    if n == 0:
        c[0, HERE_T] -= parts.region[j] * p.apart
        z, t = c[0, HERE_Z], c[0, HERE_T]
        far = math.sqrt(z * z + t * t)
        c[0, FAR], c[0, PER_FAR], c[0, PZ], c[0, PT] = far, 1.0 / far, -z / far, -t / far
        c[0, DEPTH] = far - p.around - parts.play[j]
    else:
        zz = tt = ff = 0.0
        for m in range(1, n):
            zz += c[m, HERE_Z] * c[n - m, HERE_Z]
            tt += c[m, HERE_T] * c[n - m, HERE_T]
            ff += c[m, FAR] * c[n - m, FAR]
        first = 2.0 * (c[0, HERE_Z] * c[n, HERE_Z] + c[0, HERE_T] * c[n, HERE_T])
        c[n, FAR] = 0.5 * (first + zz + tt - ff) * c[0, PER_FAR]
        c[n, DEPTH] = c[n, FAR]
    c[n, PUSH] = p.stiffness * c[n, DEPTH]


@inlined_kernel
def press_flat(p: Numbers, parts: Parts, i: int, n: int) -> None:
    """Coefficient n of the force of a flat, or of the two that grip a ball."""
    j = i // 2
    c, ball, along = parts.contact[i], parts.ball[j, n], i % 2 == 0
    side = 1.0 if parts.kind[i] == GRIPPED else float(parts.kind[i])
    depth = side * (ball[DT] if along else ball[DZ])
    if n == 0:
        depth -= p.around + parts.play[j] if along else p.beside
    c[n, DEPTH], c[n, PUSH] = depth, p.stiffness * depth
    c[n, PZ] = -side if n == 0 and not along else 0.0
    c[n, PT] = -side if n == 0 and along else 0.0


@inlined_kernel
def slide_pockets(p: Numbers, parts: Parts, now: Pace, n: int) -> None:
    """Coefficient n of the sliding of all contacts, outward and across the force."""
    for a in range(parts.listed[0]):
        i = parts.touching[a]
        c, ball = parts.contact[i], parts.ball[i // 2]
        spin = now.share * (p.spin_t * c[n, PZ] - p.spin_z * c[n, PT])
        axial = along = 0.0
        if n > 0:
            spin += now.rise * (p.spin_t * c[n - 1, PZ] - p.spin_z * c[n - 1, PT])
        if parts.kind[i] == ROUND_END:
            for m in range(n + 1):
                axial += ball[m, CZ] * c[n - m, PT]
                along += ball[m, CT] * c[n - m, PZ]
        else:
            axial, along = ball[n, CZ] * c[0, PT], ball[n, CT] * c[0, PZ]
        across = axial - along
        if n < 2:
            across -= p.spin_r * now[n]
        c[n, SLIDE_R], c[n, SLIDE_Q] = spin - ball[n, CR], across


@inlined_kernel
def rub_pockets(p: Numbers, parts: Parts, n: int) -> None:
    """Coefficient n of the friction of all contacts: |v|^2 = v_r^2 + v_q^2 + v_0^2, and G |v| = f N."""
    for a in range(parts.listed[0]):
        c = parts.contact[parts.touching[a]]
        if n == 0:
            c[0, SLIDE] = math.sqrt(c[0, SLIDE_R] ** 2 + c[0, SLIDE_Q] ** 2 + p.pivoting)
            c[0, PER_SLIDE] = 1.0 / c[0, SLIDE]
            continue
        rr = qq = vv = 0.0
        for m in range(1, n):
            rr += c[m, SLIDE_R] * c[n - m, SLIDE_R]
            qq += c[m, SLIDE_Q] * c[n - m, SLIDE_Q]
            vv += c[m, SLIDE] * c[n - m, SLIDE]
        first = 2.0 * (c[0, SLIDE_R] * c[n, SLIDE_R] + c[0, SLIDE_Q] * c[n, SLIDE_Q])
        c[n, SLIDE] = 0.5 * (first + rr + qq - vv) * c[0, PER_SLIDE]
    for a in range(parts.listed[0]):
        c = parts.contact[parts.touching[a]]
        share = 0.0
        for m in range(1, n + 1):
            share += c[m, SLIDE] * c[n - m, SHARE]
        c[n, SHARE] = (p.friction * c[n, PUSH] - share) * c[0, PER_SLIDE]
    for a in range(parts.listed[0]):
        c = parts.contact[parts.touching[a]]
        out = across = 0.0
        for m in range(n + 1):
            share = c[m, SHARE]
            out += share * c[n - m, SLIDE_R]
            across += share * c[n - m, SLIDE_Q]
        c[n, RUB_R], c[n, RUB_Q] = out, across


@inlined_kernel
def sum_pockets(parts: Parts, n: int) -> None:
    """Coefficient n of all contacts' forces along the axis and the orbit, and of their couples."""
    for a in range(parts.listed[0]):
        i = parts.touching[a]
        c = parts.contact[i]
        if parts.kind[i] != ROUND_END:
            z, t, out, across = c[0, PZ], c[0, PT], c[n, RUB_R], c[n, RUB_Q]
            c[n, FZ], c[n, FT] = c[n, PUSH] * z - across * t, c[n, PUSH] * t + across * z
            c[n, SPIN], c[n, LEAN] = -out * t, out * z
            continue
        push_z = push_t = rub_z = rub_t = spin = lean = 0.0
        for m in range(n + 1):
            z, t = c[n - m, PZ], c[n - m, PT]
            push_z += c[m, PUSH] * z
            push_t += c[m, PUSH] * t
            rub_z += c[m, RUB_Q] * t
            rub_t += c[m, RUB_Q] * z
            spin += c[m, RUB_R] * t
            lean += c[m, RUB_R] * z
        c[n, FZ], c[n, FT], c[n, SPIN], c[n, LEAN] = push_z - rub_z, push_t + rub_t, -spin, lean
