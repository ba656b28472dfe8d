"""A film that is worn in its track: friction and compliance across the groove, by strips and exactly."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from test_exact_slope import INNER, OUTER

from separatrix import Creep, InputError, shear_field, traction_curve, traction_slope
from separatrix.chain.film_compliance import Profile, film_compliance, track_of, worn_band
from separatrix.study.study import Film, Material, Race, Wear, Worn

SOFT = Material(name="soft film", elastic_modulus=1.5e9, poisson_ratio=0.4)
FILM = Film(race_friction=0.1, material=SOFT, thickness=3e-6)
L = film_compliance(FILM)


def slope(at, friction, compliance):
    """Slope of a race's curve by strips."""
    ellipse, creep = at
    return traction_slope(ellipse, creep, race_friction=friction, film_compliance=compliance)[0]


def band(at, share):
    """Friction 0.3 and no film over the middle share of a contact, 0.1 and the film beside it."""
    half = share * at[0].semi_major
    return worn_band(half, worn=0.3, film=0.1), worn_band(half, worn=0.0, film=L)


@pytest.mark.parametrize(
    ("share", "inner", "outer"),
    [(0.1, 10.04, 21.1), (0.2, 11.07, 26.6), (0.35, 11.06, 31.0), (0.5, 11.01, 33.6)],
)
def test_a_worn_band_steepens_the_curve(share, inner, outer):
    """Against the exact contact, of which strips know neither the coupling across the edges of the band."""
    # The numbers are those of two programs for the exact contact; strips come within 10 % of them, worst
    # where the band is narrow beside the contact's length along rolling (measured: -9.9, -3.8, +1.1, +0.5 %
    # outer).
    assert slope(INNER, *band(INNER, share)) == pytest.approx(inner, rel=0.06)
    assert slope(OUTER, *band(OUTER, share)) == pytest.approx(outer, rel=0.10)


def test_a_band_as_wide_as_the_contact_is_a_bare_race():
    """And one of no width the film; the profile makes a step only outside the contact: rounding."""
    wide, none = band(OUTER, 1.0), band(OUTER, 0.0)
    assert slope(OUTER, *wide) == pytest.approx(slope(OUTER, 0.3, 0.0), rel=1e-12)
    assert slope(OUTER, *none) == pytest.approx(slope(OUTER, 0.1, L), rel=2e-3)  # it ends panels at y = 0


@given(
    places=st.lists(st.floats(-0.99, 0.99), min_size=1, max_size=4, unique=True),
    friction=st.floats(0.02, 0.5),
    compliance=st.sampled_from([0.0, 1e-16, 1e-15]),
    spin=st.floats(-60.0, 60.0),
)
def test_a_profile_of_equal_values_is_a_number(places, friction, compliance, spin):
    """Cutting the contact in pieces changes nothing but the panels: 2e-3 of the slope, 2e-4 of the force."""
    ellipse, creep = OUTER[0], Creep(spin=spin, curvature=1e4)
    y = tuple(sorted(place * ellipse.semi_major for place in places))
    flat = [Profile(across=y, values=(value,) * len(y)) for value in (friction, compliance)]
    increments = np.linspace(-0.02, 0.02, 7)
    one, other = (
        traction_curve(ellipse, creep, race_friction=f, film_compliance=c, creep_increments=increments)
        for f, c in ((friction, compliance), flat)
    )
    assert other.slope == pytest.approx(one.slope, rel=2e-3)
    assert other.traction_coefficient == pytest.approx(one.traction_coefficient, abs=2e-4 * friction)


def test_full_sliding_takes_the_mean_friction_under_the_load():
    """Saturated: the integral of mu p over N, whose density is (3/4)(1 - y^2/a^2); 1e-6: Gauss panels."""
    friction, compliance = band(INNER, 0.3)
    how = {"race_friction": friction, "film_compliance": compliance}
    ends = np.array([-1.0, 1.0])
    curve = traction_curve(INNER[0], Creep(spin=0.0, curvature=0.0), creep_increments=ends, **how)
    inside = 0.75 * 2.0 * (0.3 - 0.3**3 / 3.0)
    expected = 0.3 * inside + 0.1 * (1.0 - inside)
    assert curve.traction_coefficient == pytest.approx([-expected, expected], rel=1e-6)


def test_the_shear_of_strips_has_the_friction_of_its_place():
    """Three strips, the middle one on the bare band: its bound is three times as high, and it is bare."""
    ellipse, creep = OUTER
    friction, compliance = band(OUTER, 0.2)
    worn = shear_field(ellipse, creep, race_friction=friction, film_compliance=compliance, strips=3, nodes=40)
    assert worn.bound / worn.pressure == pytest.approx(np.array([[0.1], [0.3], [0.1]]) * np.ones((3, 40)))
    assert (np.abs(worn.shear) <= worn.bound * (1.0 + 1e-12)).all()


def test_the_track_of_a_film():
    """A band of a width or a share of the contact, some film perhaps left in it; the other race is whole."""
    a = 1e-3

    def track(race=Race.INNER, **given):
        film = Film(race_friction=0.1, material=SOFT, thickness=3e-6, wear=Wear(friction=0.3, **given))
        return track_of(film, race, a)

    for form in ({"width": 4e-4}, {"share": 0.2}):
        assert track(**form) == (worn_band(2e-4, worn=0.3, film=0.1), worn_band(2e-4, worn=0.0, film=L))
    friction, compliance = track(share=0.2, thickness=1e-6)
    assert friction == worn_band(2e-4, worn=0.1, film=0.1)
    assert compliance.values == pytest.approx((L, L / 3.0, L / 3.0, L))
    assert track(share=0.0) == (0.1, L)
    assert track(share=1.0) == track(width=5e-3) == (0.3, 0.0)
    assert track(Race.OUTER, share=0.2, races=Worn.INNER) == (0.1, L)


def test_a_measured_profile_is_bare_between_two_places_without_film():
    """Friction of the bare race where the film is gone at both ends of a piece; compliance goes with it."""
    wear = Wear(friction=0.3, across=(-2e-4, -1e-4, 1e-4, 2e-4), thicknesses=(3e-6, 0.0, 0.0, 1.5e-6))
    film = Film(race_friction=0.1, material=SOFT, thickness=3e-6, wear=wear)
    friction, compliance = track_of(film, Race.OUTER, 1e-3)
    y = np.array([-5e-4, -1.5e-4, 0.0, 1.5e-4, 5e-4])
    assert friction.at(y) == pytest.approx([0.1, 0.1, 0.3, 0.1, 0.1])
    assert compliance.at(y) == pytest.approx([L, L / 2.0, 0.0, L / 4.0, L / 2.0])


def test_a_worn_film_is_one_that_there_is():
    """No film, or more left than there was; strips need friction everywhere."""
    wear = Wear(friction=0.3, share=0.1, thickness=2e-6)
    with pytest.raises(InputError, match=r"Film.wear needs a film that wears"):
        Film(race_friction=0.1, wear=wear)
    with pytest.raises(InputError, match=r"Film.wear.thickness must be at most the thickness .*, 1 um"):
        Film(race_friction=0.1, material=SOFT, thickness=1e-6, wear=wear)
    none = worn_band(1e-4, worn=0.0, film=0.1)
    with pytest.raises(InputError, match=r"race_friction must be > 0 everywhere"):
        traction_slope(*OUTER, race_friction=none, film_compliance=0.0)
