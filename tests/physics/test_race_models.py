"""Strips and exact contact in the chain of a bearing."""

from dataclasses import replace
from functools import cache

import pytest
from cages import BEARING

from separatrix import InputError, solve
from separatrix.chain.contacts import race_tracks
from separatrix.chain.exact.slope import traction_slope
from separatrix.chain.race_traction import (
    beyond_strips,
    coated_ellipse,
    contact_problem,
    contact_traction,
    exact_slope,
    film_strain,
    pressure_slip,
)
from separatrix.study.study import (
    CageDesign,
    ContactPressure,
    Film,
    Material,
    Operation,
    PressureSlip,
    Race,
    Study,
    TractionModel,
    TractionSettings,
    Wear,
)

POINT = Operation(inner_speed=1570.8, axial_load=3000.0)
PTFE = Material(name="PTFE", elastic_modulus=4e9, poisson_ratio=0.38)
COATED = Film(race_friction=0.1, material=PTFE, thickness=1e-6)
EXACT = TractionSettings(model=TractionModel.EXACT)
CAGE = CageDesign(mass=0.025, pocket_clearance=6e-4, ball_cage_stiffness=3e6)


def film(E, nu, h=1e-6):
    """A film of another material and thickness."""
    return replace(COATED, thickness=h, material=Material(name="film", elastic_modulus=E, poisson_ratio=nu))


def study(film=COATED, **given):
    """A bearing with a film."""
    return Study(name="models", title="Models", bearing=BEARING, operation=POINT, film=film, **given)


def track(film=COATED, race=Race.OUTER):
    """One race of it."""
    state = solve(study(film)).bearing
    return race_tracks(BEARING, film, state)[race is Race.OUTER]


@cache
def outside(film=COATED, bearing=BEARING):
    """Sentences on where the strips leave their range."""
    state = solve(replace(study(film), bearing=bearing)).bearing
    return " ".join(beyond_strips(race_tracks(bearing, film, state), TractionSettings()))


def test_the_chain_takes_the_slopes_of_its_model():
    """Those of the exact contact itself, and C_mu and eta follow; strips are within 4 % of it here."""
    asked = study(traction=EXACT, cage=CAGE)
    found, plain = solve(asked), solve(replace(asked, traction=TractionSettings()))
    for race in Race:
        own = track(race=race)
        alone = traction_slope(contact_problem(own, EXACT), own.creep)
        curve = getattr(found.traction, race.value)
        assert curve.slope == alone.slope
        assert curve.slope_error == alone.slope_error
        other = getattr(plain.traction, race.value)
        assert curve.slope == pytest.approx(other.slope, rel=0.04)
        assert curve.slope != other.slope
        assert curve.traction_coefficient == pytest.approx(other.traction_coefficient, abs=0.03 * 0.1)
    assert found.restitution.race_damping != plain.restitution.race_damping


def test_the_curve_passes_free_rolling_with_its_slope():
    """At its middle increment 0 nothing is transmitted: 2e-5 of the friction, where the offset is found."""
    curve = contact_traction(track(), EXACT)
    middle = curve.creep_increment.size // 2
    assert curve.creep_increment[middle] == 0.0
    assert abs(curve.traction_coefficient[middle]) <= 2e-5 * 0.1
    assert (abs(curve.traction_coefficient) <= 0.1).all()


def test_where_a_soft_film_takes_the_strips_out_of_their_range():
    """Strain p0/M_c of the film; lateral force; slopes under the pressure of the coated bodies."""
    confined = 4e9 * (1.0 - 0.38) / ((1.0 + 0.38) * (1.0 - 2.0 * 0.38))
    assert film_strain(track(), 1e9) == pytest.approx(1e9 / confined, rel=1e-12)
    found = outside()
    assert "not linearly elastic" in found
    assert "across the groove" in found
    assert "The film changes the pressure" not in found
    thick = replace(COATED, thickness=1e-5)
    bare = Film(race_friction=0.1)
    assert film_strain(track(bare), 1e9) == 0.0
    assert "linearly elastic" not in outside(bare)
    assert 'consider [traction] pressure = "coated"' in outside(thick)
    assert "off those of the exact contact" in outside(thick)


def test_a_film_that_the_exact_contact_does_not_take_is_named_with_its_reason():
    """Too soft for this pressure: strips answer, the sentence says why not; asked for, it is refused."""
    soft = film(0.1e9, 0.4)
    found = outside(soft)
    assert found.startswith("The exact contact has no answer")
    assert "film strain p0/M_c must not exceed 1" in found
    with pytest.raises(InputError, match="film strain"):
        _ = solve(study(soft, traction=EXACT)).traction


def test_a_hard_thin_film_leaves_the_ellipse_of_hertz():
    """10 nm of steel's modulus: half lengths within 0.5 %, the cells of the pressure; the load is kept."""
    own = track(film(205e9, 0.285, 1e-8))
    found = coated_ellipse(own)
    assert found.semi_minor == pytest.approx(own.ellipse.semi_minor, rel=5e-3)
    assert found.semi_major == pytest.approx(own.ellipse.semi_major, rel=5e-3)
    assert found.load == own.ellipse.load
    loads = [one.semi_major * one.semi_minor * one.max_pressure for one in (found, own.ellipse)]
    assert loads[0] == pytest.approx(loads[1], rel=1e-12)


def test_the_pressure_of_coated_bodies_cures_the_strips_in_part():
    """3 um of 0.5 GPa: a longer contact, and slopes by strips that lie nearer to the exact ones."""
    own = track(film(0.5e9, 0.46, 3e-6))
    assert coated_ellipse(own).semi_minor > 1.15 * own.ellipse.semi_minor
    best = exact_slope(own, replace(EXACT, pressure=ContactPressure.COATED)).slope
    hertz, coated = (
        contact_traction(own, TractionSettings(pressure=pressure)).slope for pressure in ContactPressure
    )
    assert abs(coated - best) < 0.5 * abs(hertz - best)


def test_slip_by_the_pressure_moves_free_rolling():
    """Of a coated race, with the exact contact only."""
    included = replace(EXACT, pressure_slip=PressureSlip.INCLUDED)
    own = track()
    assert exact_slope(own, included).free_rolling_offset != exact_slope(own, EXACT).free_rolling_offset
    with pytest.raises(InputError, match=r'pressure_slip must be "neglected" in strips'):
        TractionSettings(pressure_slip=PressureSlip.INCLUDED)


def test_the_power_of_the_slip_is_that_of_the_spin_moment():
    """Free rolling at one race: M s, both over the rolling speed; Heathcote's slip takes 2 % beside."""
    inner = track(Film(race_friction=0.1), Race.INNER)
    found = exact_slope(inner, EXACT).solution
    assert found.dissipation == pytest.approx(abs(found.spin_moment * inner.creep.spin), rel=0.02)


def test_slip_by_the_pressure_is_that_of_the_plane():
    """Si3N4 on steel, bare: in the middle 2 beta p0/E* times a/(a + b); over xi_s = 2 mu p0/E*."""
    ceramic = Material(name="Si3N4", elastic_modulus=310e9, poisson_ratio=0.26, density=3200.0)
    bare, hybrid = Film(race_friction=0.1), replace(BEARING, ball_material=ceramic)
    pair = (ceramic, BEARING.ring_material)
    (n1, G1), (n2, G2) = ((m.poisson_ratio, 0.5 * m.elastic_modulus / (1 + m.poisson_ratio)) for m in pair)
    beta = 0.5 * abs((1 - 2 * n1) / G1 - (1 - 2 * n2) / G2) / ((1 - n1) / G1 + (1 - n2) / G2)
    state = solve(replace(study(bare), bearing=hybrid)).bearing
    outer = race_tracks(hybrid, bare, state)[1]
    share = outer.ellipse.semi_major / (outer.ellipse.semi_major + outer.ellipse.semi_minor)
    # k_x^2/k^2 takes that share of any pressure on nested ellipses, at their centre. No cell of 20 x 32 is in
    # the middle: 5 %. Equal bodies have none.
    assert pressure_slip(outer) == pytest.approx(share * beta / 0.1, rel=0.05)
    assert "pressure alone" in outside(bare, hybrid)
    assert pressure_slip(track(bare)) == 0.0
    assert "pressure alone" not in outside(bare)


def test_a_worn_film_may_be_nearly_incompressible():
    """It is in series; as a layer the exact contact would refuse it."""
    whole = film(1e9, 0.495)
    assert "must not exceed 0.49" in outside(whole)
    assert "no answer" not in outside(replace(whole, wear=Wear(friction=0.3, share=0.1)))
