"""Numbers of docs/validation.md: the exact contact beside closed forms, other methods and published values.

Run with `PYTHONPATH=tests/physics:tests/literature python benchmarks/exact_accuracy.py`; half a minute. The
references are those of the tests.
"""

import math
import sys
import time
from itertools import chain

import numpy as np
from exact_cases import MU, body, contact, kalker, saturation, strip_force
from test_exact_contact import GALIN, coefficients
from test_exact_normal import COATED, coated_sphere, fredholm, spheres_on_two_grids
from test_exact_rolling import (
    CREEPS,
    ORDER,
    PARTIAL,
    PLANE,
    cauchy_slope,
    circle_area,
)
from test_exact_slope import BARE_SLOPES, INNER, OUTER, OWN_PRESSURE, WORN, problem, worn

from separatrix.chain.exact.influence import Layer, solid
from separatrix.chain.exact.rolling import ContactProblem, rolling_contact
from separatrix.chain.exact.slip import FrictionLaw
from separatrix.chain.exact.slope import traction_slope
from separatrix.chain.hertz import ellipse_of_axes


def say(*values):
    """Print with four digits behind the point, at once."""
    print(*(np.round(v, 4) if isinstance(v, (float, np.ndarray)) else v for v in values), flush=True)


def percent(found, exact):
    """Differences in per cent."""
    return " ".join(f"{100.0 * (f / e - 1.0):+7.2f}" for f, e in zip(found, exact, strict=True))


def kalker_table():
    """Kalker's coefficients on 1600 cells, and extrapolated over two grids by the second order."""
    print("## C11 C22 C23 C33: per cent at 40 x 40 | (4 f(80) - f(40))/3 | (4 f(160) - f(80))/3, b/a >= 0.5")
    for b, nu, *exact in GALIN:
        counts = (40, 80, 160) if b >= 0.5 else (40, 80)
        f = {n: np.delete(coefficients(b, nu, n, n), 3) for n in counts}
        values = [f[40]] + [(4.0 * f[2 * n] - f[n]) / 3.0 for n in counts[:-1]]
        say(b, nu, f[40], " | ".join(percent(v, exact) for v in values))
        if b > 1.0:
            say("   usual grid", percent(np.delete(coefficients(b, nu, None, None), 3), exact))


def partial_slip_table():
    """Largest differences of partial slip at 40 x 40 and extrapolated."""
    print("## partial slip: largest |difference| over mu N at 40 x 40, of 2 f(80) - f(40), and each")
    for b, nu, *expected in PARTIAL:
        found = []
        for cells in (40, 80):
            made, xs = contact(b, nu, columns=cells, rows=cells), saturation(nu)
            sliding, row = MU * made.problem.ellipse.load, []
            for (xi, eta, phi), wanted in zip(CREEPS, ORDER, strict=True):
                one = kalker(made, -xi * xs, -eta * xs, -phi * xs / math.sqrt(b))
                values = {"x": one.force, "y": one.lateral_force, "m": one.spin_moment / math.sqrt(b)}
                row += [values[key] / sliding for key in wanted]
            found.append(np.array(row))
        exact = np.array(list(chain.from_iterable(expected)))
        best = 2.0 * found[1] - found[0]
        print(b, np.abs(found[0] - exact).max().round(5), np.abs(best - exact).max().round(5))
        print("   ", (found[0] - exact).round(4))
        print("   ", (best - exact).round(4), flush=True)
    for lam, force in ((0.3, 0.695), (1.0, 0.522), (3.0, 0.297)):
        made = contact(0.2, film_compliance=lam * 0.2 * 0.75)
        found = kalker(made, xi=-0.5 * saturation(0.25)).force / (MU * made.problem.ellipse.load)
        print("film", lam, force, round(found, 4), flush=True)


def strips_table():
    """Carter, and the plane layer over 160 cells and extrapolated."""
    bare = body(0.25), body(0.25)
    for n in (20, 40, 80):
        force = strip_force(n, bare, creep=0.4 * 2.0 * MU * 0.75, bound=circle_area)
        print("Carter", n, force / (math.pi / 2.0 * MU))
    print("## plane layer by the Cauchy equation, n = 40, 160; per cent")
    worst, bare = np.zeros(2), math.pi / 2.0 / (1.0 - 0.285)
    for ratio, nu, expected in PLANE:
        for h, value in zip((0.03, 0.1, 0.3, 1.0), expected, strict=True):
            coated = body(0.285, (ratio, nu, h))
            exact, found = cauchy_slope(coated) / bare, []
            for n in (40, 160):
                base = strip_force(n, (body(0.285), body(0.285)))
                found.append(strip_force(n, (body(0.285), coated)) / base)
            error = 100.0 * (np.array(found) / exact - 1.0)
            worst = np.maximum(worst, np.abs(error))
            say(ratio, h, value, exact, np.array(found), error)
    say("largest", worst)


def spheres_table():
    """Coated spheres: approach and pressure at the centre."""
    print("## coated sphere: approach, centre pressure, radius; per cent, extrapolated over 32 and 64 cells")
    for ratio, h in COATED:
        coated, load, top = coated_sphere(ratio, h)
        a, d, p0 = fredholm(coated, load)
        found = spheres_on_two_grids(ratio, h, a)
        best = (4.0 * found[1] - found[0]) / 3.0
        exact = np.array((d, p0 / top))
        say(ratio, h, best[:2], exact, percent(best[:2], exact), found[1][2], a)


def loaded(load, b, a, G, nu, mu, *, cells=40, **given):
    """Equal bodies of shear modulus G that a load presses on an ellipse of half lengths b and a."""
    both, law = body(nu, G=G), FrictionLaw(coefficient=mu)
    pressed = ellipse_of_axes(load, b, a, G / (1.0 - nu))
    problem = ContactProblem(ellipse=pressed, bodies=(both, both), friction=law, **given)
    return rolling_contact(problem, columns=cells, rows=cells)


def contact_examples():
    """Public examples of CONTACT at 40 x 40 and extrapolated over 30 and 60."""
    print("## CONTACT: at 40, and 2 f(60) - f(30)")
    examples: tuple[tuple[dict[str, float], tuple[float, ...]], ...] = (
        ({}, (243.8, 0.255, 0.468, 0.640, 0.774)),
        ({"film_compliance": 1.25 / 8200.0}, (63.6,)),
    )
    for options, exact in examples:
        rows = {}
        for cells in (30, 40, 60):
            made = loaded(106700.0, 6.3035, 12.6076, 82000.0, 0.28, 0.33, cells=cells, **options)
            rows[cells] = np.array(
                [-kalker(made, 1e-5).force]
                + [-kalker(made, xi).force / (0.33 * 106700.0) for xi in (4e-4, 8e-4, 1.2e-3, 1.6e-3)]
            )[: len(exact)]
        best = 2.0 * rows[60] - rows[30]
        say(exact, rows[40], percent(rows[40], exact), best, percent(best, exact))
    found = []
    for cells in (30, 40, 60):
        made = loaded(82000.0, 8.0, 4.0, 82000.0, 0.28, 0.3, cells=cells)
        one = kalker(made, eta=-6.25e-4, phi=6.25e-4)
        found.append(np.array([abs(one.lateral_force) / (0.3 * 82000.0), abs(one.spin_moment)]))
    print("fastsim .625 47440:", found[1], 2.0 * found[2] - found[0], flush=True)


def slopes_table():
    """Slopes of a bearing's races."""
    print("## bare slopes: found, error reported, reference, per cent")
    for mu, *expected in BARE_SLOPES:
        for (ellipse, creep), value in zip((INNER, OUTER), expected, strict=True):
            s = traction_slope(problem(ellipse, mu), creep)
            lateral = s.solution.lateral_force / (mu * ellipse.load)
            say(mu, s.slope, s.slope_error, value, percent([s.slope], [value]), "lateral", lateral)
    print("## worn track")
    for share, *expected in WORN:
        for (ellipse, creep), value in zip((INNER, OUTER), expected, strict=True):
            s = traction_slope(worn(ellipse, share), creep)
            say(share, s.slope, s.slope_error, value, percent([s.slope], [value]))
    print("## own pressure, outer race, mu 0.1")
    for E, nu, h, ref in OWN_PRESSURE:
        film = Layer(thickness=h * 1e-6, solid=solid(E * 1e9, nu))
        s = traction_slope(problem(OUTER[0], film=film, own_pressure=True), OUTER[1])
        say(E, h, s.slope, s.slope_error, ref, s.solution.max_pressure / 1e6)


if __name__ == "__main__":
    tables = kalker_table, partial_slip_table, strips_table, spheres_table
    chosen = sys.argv[1:]
    for table in (*tables, contact_examples, slopes_table):
        if not chosen or table.__name__ in chosen:
            start = time.process_time()
            table()
            print(f"({time.process_time() - start:.1f} s of processor time)\n", flush=True)
