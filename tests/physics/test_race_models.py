"""Strips and exact contact in the chain of a bearing."""

from dataclasses import replace

import pytest
from cages import BEARING

from separatrix.chain import models
from separatrix.chain.contacts import race_tracks
from separatrix.chain.film_curves import exact_films, wear_curve
from separatrix.chain.models import compare_models
from separatrix.chain.race_curve import (
    coated_ellipse,
    contact_problem,
    exact_slope,
    race_curve,
    race_slope,
    strips,
)
from separatrix.chain.solution import solve
from separatrix.chain.traction import exact
from separatrix.ground.errors import InputError
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

pytestmark = pytest.mark.filterwarnings("ignore::separatrix.ground.errors.ValidityWarning")

POINT = Operation(inner_speed=1570.8, axial_load=3000.0)
PTFE = Material(name="PTFE", elastic_modulus=4e9, poisson_ratio=0.38)
COATED = Film(race_friction=0.1, material=PTFE, thickness=1e-6)
EXACT = TractionSettings(model=TractionModel.EXACT)
CAGE = CageDesign(mass=0.025, pocket_clearance=6e-4, ball_cage_stiffness=3e6)


def study(film=COATED, **given):
    """A bearing with a film."""
    return Study(name="models", title="Models", bearing=BEARING, operation=POINT, film=film, **given)


def track(film=COATED, race=Race.OUTER):
    """One race of it."""
    state = solve(study(film)).bearing
    return race_tracks(BEARING, film, state)[race is Race.OUTER]


def test_the_chain_takes_the_slopes_of_its_model():
    """Those of the exact contact itself, and C_mu and eta follow; strips are within 4 % of it here."""
    asked = study(traction=EXACT, cage=CAGE)
    found, plain = solve(asked), solve(replace(asked, traction=TractionSettings()))
    for race in Race:
        own = track(race=race)
        alone = exact.traction_slope(contact_problem(own, EXACT), own.creep)
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
    curve = race_curve(track(), EXACT)
    middle = curve.creep_increment.size // 2
    assert curve.creep_increment[middle] == 0.0
    assert abs(curve.traction_coefficient[middle]) <= 2e-5 * 0.1
    assert (abs(curve.traction_coefficient) <= 0.1).all()


def test_the_comparison_marks_the_model_in_use():
    """Each row has its slopes and damping; the used row is that of the chain."""
    asked = study(traction=replace(EXACT, pressure=ContactPressure.COATED), cage=CAGE)
    solution = solve(asked)
    found = compare_models(solution)
    assert [(row.model, row.pressure) for row in found.models] == [
        (model, pressure) for pressure in ContactPressure for model in TractionModel
    ]
    (used,) = (row for row in found.models if row.is_used)
    assert (used.model, used.pressure) == (TractionModel.EXACT, ContactPressure.COATED)
    assert used.inner_slope == solution.traction.inner.slope
    assert used.race_damping == solution.restitution.race_damping
    assert used.restitution_factor == solution.restitution.restitution_factor
    assert found.outer is not None
    confined = 4e9 * (1.0 - 0.38) / ((1.0 + 0.38) * (1.0 - 2.0 * 0.38))
    assert found.outer.film_strain == pytest.approx(found.outer.max_pressure / confined, rel=1e-12)
    assert any("not linearly elastic" in sentence for sentence in found.outside)
    assert any("across the groove" in sentence for sentence in found.outside)


def test_bare_races_have_two_models_and_a_lateral_force():
    """No film, no own pressure. The lateral forces of the races oppose each other, as their spins do."""
    found = compare_models(solve(study(Film(race_friction=0.1))))
    assert [row.model for row in found.models] == list(TractionModel)
    assert found.models[0].restitution_factor is None  # no cage
    assert found.inner is not None
    assert found.outer is not None
    assert found.inner.lateral_force * found.outer.lateral_force < 0.0
    assert found.inner.film_strain == 0.0
    assert not any("linearly elastic" in sentence for sentence in found.outside)


def test_a_film_that_the_exact_contact_does_not_take_is_a_row_with_its_reason():
    """Too soft for this pressure: strips answer, the exact rows say why not; asked for, it is refused."""
    soft = replace(COATED, material=Material(name="gum", elastic_modulus=0.1e9, poisson_ratio=0.4))
    found = compare_models(solve(study(soft)))
    rows = {(row.model, row.pressure): row for row in found.models}
    refused = rows[TractionModel.EXACT, ContactPressure.HERTZ]
    assert refused.inner_slope is None
    assert refused.race_damping is None
    assert "film strain p0/M_c must not exceed 1" in refused.reason
    assert rows[TractionModel.STRIPS, ContactPressure.HERTZ].inner_slope is not None
    assert found.inner is None
    with pytest.raises(InputError, match="film strain"):
        _ = solve(study(soft, traction=EXACT)).traction


def test_a_hard_thin_film_leaves_the_ellipse_of_hertz():
    """10 nm of steel's modulus: half lengths within 0.5 %, the cells of the pressure; the load is kept."""
    film = replace(
        COATED, thickness=1e-8, material=Material(name="hard", elastic_modulus=205e9, poisson_ratio=0.285)
    )
    own = track(film)
    found = coated_ellipse(own)
    assert found.semi_minor == pytest.approx(own.ellipse.semi_minor, rel=5e-3)
    assert found.semi_major == pytest.approx(own.ellipse.semi_major, rel=5e-3)
    assert found.load == own.ellipse.load
    loads = [one.semi_major * one.semi_minor * one.max_pressure for one in (found, own.ellipse)]
    assert loads[0] == pytest.approx(loads[1], rel=1e-12)


def test_the_pressure_of_coated_bodies_cures_the_strips_in_part():
    """3 um of 0.5 GPa: a longer contact, and slopes by strips that lie nearer to the exact ones."""
    soft = replace(
        COATED, thickness=3e-6, material=Material(name="soft", elastic_modulus=0.5e9, poisson_ratio=0.46)
    )
    own = track(soft)
    assert coated_ellipse(own).semi_minor > 1.15 * own.ellipse.semi_minor
    best = exact_slope(own, replace(EXACT, pressure=ContactPressure.COATED)).slope
    hertz, coated = (strips(own, pressure).slope for pressure in ContactPressure)
    assert abs(coated - best) < 0.5 * abs(hertz - best)


def test_slip_by_the_pressure_moves_free_rolling():
    """Of a coated race, with the exact contact only."""
    included = replace(EXACT, pressure_slip=PressureSlip.INCLUDED)
    own = track()
    assert exact_slope(own, included).free_rolling_offset != exact_slope(own, EXACT).free_rolling_offset
    with pytest.raises(InputError, match=r'pressure_slip must be "neglected" in strips'):
        TractionSettings(pressure_slip=PressureSlip.INCLUDED)


def test_a_worn_film_has_the_pressure_of_hertz():
    """Its thickness varies; it is in series."""
    worn = replace(COATED, wear=Wear(friction=0.3, share=0.1))
    with pytest.raises(InputError, match=r'TractionSettings.pressure must be "hertz"'):
        study(worn, traction=TractionSettings(pressure=ContactPressure.COATED))


def test_restitution_along_the_width_of_a_band():
    """It begins at the whole film, ends at bare steel, and holds the study's own where that is."""
    worn = replace(COATED, wear=Wear(friction=0.3, share=0.1))
    solution = solve(study(worn, cage=CAGE))
    curve = wear_curve(solution)
    assert curve is not None
    own = solution.restitution.restitution_factor
    assert curve.restitution_factor[curve.share == 0.1] == pytest.approx([own], rel=1e-12)
    # kinematics held: those of friction 0.1, of which the ends of this curve know
    whole = solve(study(COATED, cage=CAGE)).restitution.restitution_factor
    assert curve.restitution_factor[0] == pytest.approx(whole, rel=1e-12)
    assert curve.restitution_factor[-1] > own > whole
    assert curve.exact_share is None
    assert exact_films(solution) is None
    assert wear_curve(solve(study(COATED, cage=CAGE))) is None


def test_exact_points_stand_beside_the_curves(monkeypatch):
    """With the exact model: two films and two bands; a film that has no answer is left out."""
    from separatrix.chain import film_curves

    monkeypatch.setattr(film_curves, "EXACT_SHARES", (0.0, 0.2))
    monkeypatch.setattr(film_curves, "EXACT_THICKNESSES", (0.0, 1e-6, 3e-6))

    def slope(own, settings):
        if own.film.wear is None and own.film.thickness == 3e-6:
            raise InputError("film", "refused")
        return race_slope(own, settings)

    monkeypatch.setattr(film_curves, "race_slope", slope)
    worn = replace(COATED, wear=Wear(friction=0.3, width=2e-4))
    solution = solve(study(worn, cage=CAGE, traction=EXACT))
    curve, films = wear_curve(solution), exact_films(solution)
    assert curve is not None
    assert films is not None
    assert curve.exact_share.tolist() == [0.0, 0.2]
    at = [curve.restitution_factor[curve.share == share][0] for share in (0.0, 0.2)]
    assert curve.exact_restitution_factor == pytest.approx(at, abs=0.03)
    assert films.thickness.tolist() == [0.0, 1e-6]


def test_the_models_are_solved_once(monkeypatch):
    """The comparison takes the exact contact of the chain."""
    solution = solve(study(traction=EXACT, cage=CAGE))
    _ = solution.traction
    monkeypatch.setattr(exact, "traction_slope", None)  # a second solution would fail
    tracks = race_tracks(BEARING, COATED, solution.bearing)
    row = models._slopes(solution, tracks, TractionModel.EXACT, ContactPressure.HERTZ)
    assert row.inner_slope == solution.traction.inner.slope


def test_the_power_of_the_slip_is_that_of_the_spin_moment():
    """Free rolling at one race: M s V; Heathcote's slip, even in y, takes little of it beside: 2 %.

    The power per rolling speed, or a factor of two, would be far off.
    """
    found = compare_models(solve(study(Film(race_friction=0.1))))
    inner = solve(study(Film(race_friction=0.1))).bearing.inner
    assert found.inner is not None
    power = abs(found.inner.spin_moment * inner.creep.spin * inner.rolling_speed)
    assert found.inner.dissipation == pytest.approx(power, rel=0.02)


def test_slip_by_the_pressure_is_that_of_the_plane():
    """Si3N4 on steel, bare: in the middle 2 beta p0/E* times a/(a + b); over xi_s = 2 mu p0/E*.

    k_x^2/k^2 takes that share of any pressure on nested ellipses, at their centre. No cell of 20 x 32 is in
    the middle: 5 %. Equal bodies have none.
    """
    ceramic = Material(name="Si3N4", elastic_modulus=310e9, poisson_ratio=0.26, density=3200.0)
    hybrid = study(Film(race_friction=0.1))
    hybrid = replace(hybrid, bearing=replace(BEARING, ball_material=ceramic))
    pair = (ceramic, BEARING.ring_material)
    (n1, G1), (n2, G2) = ((m.poisson_ratio, 0.5 * m.elastic_modulus / (1 + m.poisson_ratio)) for m in pair)
    beta = 0.5 * abs((1 - 2 * n1) / G1 - (1 - 2 * n2) / G2) / ((1 - n1) / G1 + (1 - n2) / G2)
    found, ellipse = compare_models(solve(hybrid)), solve(hybrid).bearing.outer.ellipse
    share = ellipse.semi_major / (ellipse.semi_major + ellipse.semi_minor)
    assert found.outer is not None
    assert found.outer.pressure_slip == pytest.approx(share * beta / 0.1, rel=0.05)
    assert any("pressure alone" in sentence for sentence in found.outside)
    equal = compare_models(solve(study(Film(race_friction=0.1))))
    assert equal.outer is not None
    assert equal.outer.pressure_slip == 0.0
    assert not any("pressure alone" in sentence for sentence in equal.outside)


def test_the_model_in_use_always_has_its_row():
    """A hard film hardly changes the pressure: the coated one is compared where it is asked for."""
    hard = Material(name="hard", elastic_modulus=136e9, poisson_ratio=0.25)
    film = replace(COATED, thickness=1e-8, material=hard)
    assert len(compare_models(solve(study(film))).models) == 2
    asked = study(film, traction=TractionSettings(pressure=ContactPressure.COATED))
    assert [row.is_used for row in compare_models(solve(asked)).models] == [False, False, True, False]


def test_a_worn_film_may_be_nearly_incompressible():
    """It is in series; as a layer the exact contact would refuse it."""
    rubber = Material(name="rubber", elastic_modulus=1e9, poisson_ratio=0.495)
    whole = replace(COATED, material=rubber)
    rows = compare_models(solve(study(whole))).models
    assert "must not exceed 0.49" in rows[1].reason
    worn = compare_models(solve(study(replace(whole, wear=Wear(friction=0.3, share=0.1)))))
    assert worn.models[1].reason == ""
    assert worn.inner is not None


def test_a_band_with_slip_by_the_pressure(monkeypatch):
    """Strips beside it do without that slip, which they do not know."""
    from separatrix.chain import film_curves

    monkeypatch.setattr(film_curves, "EXACT_SHARES", (0.1,))
    worn = replace(COATED, wear=Wear(friction=0.3, share=0.1))
    included = replace(EXACT, pressure_slip=PressureSlip.INCLUDED)
    solution = solve(study(worn, cage=CAGE, traction=included))
    curve = wear_curve(solution)
    assert curve is not None
    own = solution.restitution.restitution_factor
    assert curve.exact_restitution_factor == pytest.approx([own], rel=1e-12)  # the same contact: rounding
