"""Slopes of traction curves at free rolling, worn tracks, unlike bodies, stated forces."""

import math
import re
import runpy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from exact_cases import MU, P0, body, contact

from separatrix import Body, Creep, FrictionLaw, Layer, contact_ellipse, ellipse_of_axes, solid, worn_band
from separatrix.chain.exact.grid import elliptic_grid, elliptic_pressure
from separatrix.chain.exact.pressure import film_strain, pressure_slip
from separatrix.chain.exact.rolling import ContactProblem, creep_of_force, rigid_slip, rolling_contact, solve
from separatrix.chain.exact.slope import traction_slope
from separatrix.ground.errors import ConvergenceError

STEEL = solid(200e9, 0.285)
BARE = Body(base=STEEL)
MODULUS = 200e9 / 2.0 / (1.0 - 0.285**2)


def race(b, a, p0, spin, heathcote):
    """Contact of a bearing's race: half lengths [m], spin s a and curvature q a^2 [-]."""
    ellipse = ellipse_of_axes(2.0 / 3.0 * math.pi * a * b * p0, b, a, MODULUS)
    return ellipse, Creep(spin=spin / a, curvature=heathcote / a**2)


# A bearing of 11.1 mm balls at 15000 rpm and 3000 N, without race control
INNER = race(0.1267e-3, 1.135e-3, 1473e6, 0.0405, -0.0240)
OUTER = race(0.1562e-3, 1.164e-3, 1348e6, -0.0137, 0.0186)


def problem(ellipse, friction=MU, film=None, **given):
    """Ball on a race that may be coated."""
    coated = BARE if film is None else Body(base=STEEL, layers=(film,))
    law = FrictionLaw(coefficient=friction)
    return ContactProblem(ellipse=ellipse, bodies=(BARE, coated), friction=law, **given)


BARE_SLOPES = [(0.05, 1.833, 6.79), (0.1, 3.665, 13.65), (0.2, 7.33, 30.2), (0.3, 10.97, 41.07)]


@pytest.mark.parametrize(("mu", "inner", "outer"), BARE_SLOPES)
def test_slopes_of_a_bearing(mu, inner, outer):
    """Both races, bare: the numbers are known to 0.3 %, their inputs to three digits; 0.5 %."""
    for (ellipse, creep), expected in ((INNER, inner), (OUTER, outer)):
        found = traction_slope(problem(ellipse, mu), creep)
        assert found.slope == pytest.approx(expected, rel=5e-3)
        assert found.slope_error < 0.01 * found.slope
        assert abs(found.solution.traction_coefficient) < 2e-5 * mu
        assert found.solution.film_strain == 0.0


@pytest.mark.parametrize(
    ("film", "spin", "heathcote"),
    [
        (None, 0.0137, 0.0186),
        (None, 0.0, 0.0),
        (None, 0.1, 0.0),
        (Layer(thickness=1e-6, solid=solid(0.5e9, 0.46)), 0.0013, 0.0),
        (Layer(thickness=2e-6, solid=solid(0.5e9, 0.46)), 0.0, 0.0),
        (Layer(thickness=5e-6, solid=solid(4e9, 0.38)), 0.0137, 0.0186),
    ],
)
def test_the_slope_error_bounds_the_error(film, spin, heathcote):
    """Outer race at mu 0.1: 42 columns and 72 rows are within the reported error of the usual grid."""
    a = OUTER[0].semi_major
    creep = Creep(spin=spin / a, curvature=heathcote / a**2)
    usual = traction_slope(problem(OUTER[0], film=film), creep)
    fine = traction_slope(problem(OUTER[0], film=film), creep, columns=(30, 42), rows=72)
    assert abs(usual.slope - fine.slope) < usual.slope_error < 0.03 * usual.slope


def test_lateral_force_of_spin():
    """The strips have none: here 0.13 and 0.24 mu N at mu 0.1, opposite in the two races."""
    lateral = [
        traction_slope(problem(e), c, columns=(10, 14), rows=40).solution.lateral_force / (MU * e.load)
        for e, c in (INNER, OUTER)
    ]
    assert lateral == pytest.approx([0.13, -0.24], abs=0.01)


OWN_PRESSURE = [  # E [GPa], nu, thickness [um]; slopes on 128 columns and 160 rows
    (0.5, 0.46, 1, 11.989), (0.5, 0.46, 3, 8.877), (4.0, 0.38, 3, 13.957), (4.0, 0.38, 10, 12.642),
]  # fmt: skip


@pytest.mark.parametrize(("E", "nu", "thickness", "converged"), OWN_PRESSURE)
def test_slopes_of_own_pressure(E, nu, thickness, converged):
    """To 0.5 %, as asked, and to the error reported; under Hertz's pressure 3 um of 0.5 GPa have 6.25."""
    film = Layer(thickness=thickness * 1e-6, solid=solid(E * 1e9, nu))
    asked = problem(OUTER[0], film=film, own_pressure=True)
    found = traction_slope(asked, OUTER[1])
    # With the row ends by the root law alone, which a soft film does not follow, it is 5 % lower.
    assert abs(found.slope - converged) < min(found.slope_error, 5e-3 * converged)
    assert found.slope_error < 0.03 * found.slope
    assert found.solution.film_strain == film_strain(asked.bodies, found.solution.max_pressure)
    if converged == 8.877:
        assert found.solution.max_pressure == pytest.approx(1064e6, rel=5e-3)
        assert traction_slope(problem(OUTER[0], film=film), OUTER[1]).slope == pytest.approx(6.25, rel=0.01)


def test_symmetric_cases_roll_freely_without_offset():
    """No Heathcote slip: offset 0; no friction: no slope."""
    found = traction_slope(problem(INNER[0]), Creep(spin=20.0, curvature=0.0), columns=(8, 12), rows=24)
    assert found.free_rolling_offset == 0.0
    assert found.slope > 0.0
    idle = traction_slope(problem(INNER[0], 0.0), Creep(spin=0.0, curvature=0.0), columns=(8, 12), rows=24)
    assert idle.slope == 0.0


def test_free_rolling_that_is_not_found_is_an_error(monkeypatch):
    """With the force it came to."""
    from separatrix.chain.exact import slope as module

    monkeypatch.setattr(module, "LARGEST_STEPS", 1)
    with pytest.raises(ConvergenceError, match="Free rolling was not found in 1 steps"):
        traction_slope(problem(OUTER[0]), OUTER[1], columns=(8, 12), rows=24)


WORN = [(0.0, 3.64, 10.8), (0.1, 10.04, 21.1), (0.2, 11.07, 26.6), (0.5, 11.01, 33.6)]


def worn(ellipse, share):
    """Film of 3 um and 1.5 GPa at mu 0.1, worn off a band to steel at 0.3."""
    w, L = share * ellipse.semi_major, 3e-6 / solid(1.5e9, 0.4).shear_modulus
    friction, compliance = worn_band(w, worn=0.3, film=0.1), worn_band(w, worn=0.0, film=L)
    return problem(ellipse, friction, film_compliance=compliance)


@pytest.mark.parametrize(("share", "inner", "outer"), WORN)
def test_worn_track(share, inner, outer):
    """Slopes to 1.2 %: 0.8 % is what rows that meet the edges of the band leave against rows half as wide."""
    for (ellipse, creep), expected in ((INNER, inner), (OUTER, outer)):
        assert traction_slope(worn(ellipse, share), creep).slope == pytest.approx(expected, rel=0.012)


def test_bounds():
    """Cohesion, coefficient and shear strength: sums of the bound in full sliding."""
    made = contact(0.5, columns=20, rows=20)
    grid, p = made.grid, made.pressure
    law = FrictionLaw(coefficient=0.1, cohesion=0.02 * P0, shear_strength=0.07 * P0)
    g, f = law.bound(grid, p), grid.fraction
    assert g == pytest.approx(np.minimum(0.02 * P0 * f + 0.1 * p, 0.07 * P0 * f))
    same = rolling_contact(replace(made.problem, friction=law), columns=20, rows=20)
    slid = solve(same, rigid_slip(grid, longitudinal=0.1))
    assert slid.force == pytest.approx(-g.sum() * grid.cell_area, rel=1e-5)


def test_slip_of_the_pressure_on_a_circle():
    """Unlike half-spaces: u_r = -dc_rz p0 a^2/(3 r) [1 - (1 - r^2/a^2)^1.5] (Johnson 1985, 3.41b)."""
    soft, hard = body(0.3, G=1.0), body(0.3, G=5.0)
    grid = elliptic_grid(semi_minor=1.0, semi_major=1.0, columns=24, rows=24)
    p = elliptic_pressure(grid, semi_minor=1.0, semi_major=1.0, max_pressure=1.0)
    found = pressure_slip(grid, p, (soft, hard))
    dc = 0.5 * (1.0 - 2.0 * 0.3) * (1.0 - 1.0 / 5.0)
    x, y = np.broadcast_arrays(grid.x, grid.y[:, None])

    def u_over_r(r2):
        return -dc * 2.0 / 3.0 * (1.0 - np.maximum(1.0 - r2, 0.0) ** 1.5) / r2

    e = 1e-5
    moved = [(x + side * e) * u_over_r((x + side * e) ** 2 + y * y) for side in (1.0, -1.0)]
    W_x = -(moved[0] - moved[1]) / (2.0 * e)
    inside = np.hypot(x, y) < 0.9
    # 1 % of the largest: the periodic box and the linear interpolation.
    assert found[0][inside] == pytest.approx(0.5 * W_x[inside], abs=0.01 * dc)


def test_the_creep_of_a_stated_force():
    """Free rolling of equal bodies needs none; else the force is met as far as it is searched."""
    made = contact(0.5, columns=12, rows=12)
    sliding = float(made.bound.sum()) * made.grid.cell_area
    assert creep_of_force(made, 0.0)[0] == 0.0
    for force in (-0.5, 0.9):
        creep, one = creep_of_force(made, force, lateral=1e-5, spin=1e-5)
        assert one.force / sliding == pytest.approx(force, abs=1e-5)
        assert creep * force < 0.0
        slip = rigid_slip(made.grid, longitudinal=creep, lateral=1e-5, spin=1e-5)
        assert solve(made, slip).force == pytest.approx(one.force, rel=1e-4)
    with pytest.raises(ConvergenceError, match="No creep gives the stated force"):
        creep_of_force(made, 0.99, lateral=900.0)


def test_surfaces_that_are_steep_at_the_edge_are_noted():
    """Half-spaces describe the bodies to about 0.3 of the radius of the gap."""
    steep = contact_ellipse(1e4, 1e3, 1e3, 110e9)
    (note,) = rolling_contact(problem(steep), columns=4, rows=4).notes
    assert "of the radius of the gap there; half-spaces describe" in note


def test_the_example_of_the_page(tmp_path):
    """That of docs/theory/exact-contact.md has the six numbers beside it, to their digits."""
    page = Path(__file__).parents[2] / "docs" / "theory" / "exact-contact.md"
    text, script = page.read_text(encoding="utf-8"), tmp_path / "example.py"
    script.write_text(re.search(r"```python\n(.*?)```", text, re.DOTALL)[1])
    names = runpy.run_path(str(script))
    one, free = names["one"], names["free"]
    first = f"{one.traction_coefficient:.5f}, {one.lateral_force:.2f} N and {one.stick_share:.2f}"
    last = f"{free.slope:.2f}, {free.slope_error:.2f} and {free.free_rolling_offset:.2e}"
    assert f"The first three are {first}; the last three {last}." in text
