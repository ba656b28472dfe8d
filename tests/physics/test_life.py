"""Slow time: films, pockets, and when a cage becomes unstable: exact cases and published numbers."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from mobile_balls import study_of
from scipy.special import ndtr, ndtri

import separatrix
from separatrix import Cause, LifeTable, RunOutcome, StabilitySettings, moving_cage, run_ensemble, solve
from separatrix.chain.contacts import bearing_state
from separatrix.study.study import KinematicModel, Race, WearRates
from separatrix.verdict import wear_life
from separatrix.verdict.critical_friction import PLACES, SEARCHED_FRICTION, Count, steepness
from separatrix.verdict.life_table import (
    FREELY,
    LEAST_CRITICAL,
    LEFT_OUT,
    LONG_LOOK,
    Node,
    _accelerated,
    _bearing_wear,
    _drawn,
    _life,
    _node,
    _tests,
    life,
)
from separatrix.verdict.wear_life import (
    THICKEST,
    BearingWear,
    Land,
    Phase,
    TrackWork,
    Worn,
    causes,
    course,
    driven_by,
    film_after,
    lives,
    steady_coverage,
    track_work,
    wear_rates,
    worn_depth,
)

UM = 1e-6
WHEEL = separatrix.read_study("momentum-wheel")
RATES = WearRates(film_wear=5e-18, cage_wear=1e-15, bare_friction=0.35)


def of(*values):
    """Each value as an array of one draw."""
    return tuple(np.array([float(one)]) for one in values)


@pytest.mark.parametrize(
    ("time", "left"), [(5, 0.4205152), (10, 0.3438576), (20, 0.2120761), (60, 0.1043781)]
)
def test_a_film_between_wear_and_deposit(time, left):
    """Closed form, evaluated by another program: h_c 0.1, W 0.046375, D 0.030 um/s, 0.5 um at the start."""
    h, wear, deposit, hold = of(0.5, 0.046375, 0.030, 0.1)
    assert film_after(h, wear, deposit, hold, time)[0] == pytest.approx(left, abs=5e-8)  # its digits


def test_a_film_alone_covers_half_after_its_time():
    """Without deposit exp(h/h_c) = 1 + (exp(h_0/h_c) - 1) exp(-W t/h_c): half coverage at 10.767093 s."""
    h, wear, none, hold = of(0.5, 0.046375, 0.0, 0.1)
    left = film_after(h, wear, none, hold, 10.767093)
    assert 1.0 - math.exp(-left[0] / 0.1) == pytest.approx(0.5, abs=1e-7)


@pytest.mark.parametrize("deposit", [0.0, 0.02, 0.03, 0.030000001, 0.2])
def test_two_steps_of_a_film_are_one(deposit):
    """Wear below, at and above the deposit; a film is neither negative nor thicker than transfer makes it."""
    h, wear, grown, hold = of(0.5 * UM, 0.03 * UM, deposit * UM, 0.1 * UM)
    half = film_after(h, wear, grown, hold, 7.0)
    whole = film_after(h, wear, grown, hold, 14.0)
    assert film_after(half, wear, grown, hold, 7.0) == pytest.approx(whole, rel=1e-9)
    for time in (1e3, 1e9):
        assert 0.0 <= film_after(h, wear, grown, hold, time)[0] <= THICKEST


@pytest.mark.parametrize(
    ("name", "inner", "outer", "passes"),
    [
        ("cryo", 6213.7, 3064.1, (1865.85, 1384.15)),
        ("le7", 13426.0, 6138.0, None),
        ("wheel 6000", 167.26, 54.93, None),
    ],
)
def test_work_of_a_pass_is_that_of_an_independent_program(name, inner, outer, passes, monkeypatch):
    """Its largest value across the track, rigid bodies; and the heat is friction times all of it."""
    monkeypatch.setattr(wear_life, "STRIPS", 512)
    given = study_of(name)
    bearing, operation, friction = given.bearing, given.operation, given.film.race_friction
    state = bearing_state(bearing, operation, KinematicModel.FREE, friction)
    for race, value, at in ((Race.INNER, inner, state.inner), (Race.OUTER, outer, state.outer)):
        found = track_work(bearing, operation, state, race)
        # five digits, of an equilibrium that differs by 3e-4
        assert found.work.max() == pytest.approx(value, rel=1e-3)
        width = 2.0 * at.ellipse.semi_major / found.work.size
        heat = getattr(state.equilibrium, f"heat_{race.value}")[at.ball]
        # slip that is no longer rounded off near zero: 2 % of the little heat of the wheel's outer race
        assert friction * found.work.sum() * width * at.rolling_speed == pytest.approx(heat, rel=2.5e-2)
        assert found.share.sum() == pytest.approx(1.0)
    if passes:
        each = [track_work(bearing, operation, state, race).passes for race in Race]
        assert each == pytest.approx(passes, rel=1e-5)


def test_a_ball_wears_its_own_cap():
    """Pi R w^2, of a shallow cap: 1.5 % of 10 um below the exact pi w^2 (R - w/3)."""
    R, w = 5e-3, 1e-5
    exact = math.pi * w**2 * (R - w / 3.0)
    assert worn_depth(np.array([exact]), 2.0 * R)[0] == pytest.approx(w, rel=1e-3)


TRACK = TrackWork(
    across=np.array([-0.5, 0.5]), share=np.array([0.5, 0.5]), work=np.array([100.0, 100.0]), passes=1.0,
    area=1e-4,
)  # fmt: skip
BEARING = BearingWear(
    tracks=(TRACK, TRACK), loads=(1.0, 1.0), ball_diameter=1e-2, ball_count=10, clearance=3e-4, ball_gap=4e-3
)
FLAT = np.ones((2, 2))
TABLE = LifeTable(
    race_friction=np.array([0.05, 0.5]), pocket_clearance=np.array([3e-4, 3e-3]),
    critical_friction=0.05 / np.array([[0.05, 0.05], [0.5, 0.5]]) * 0.4, steepness=30.0 * FLAT,
    calm_sliding=2.0 * FLAT, whirl_sliding=200.0 * FLAT, calm_land_sliding=1.0 * FLAT,
    whirl_land_sliding=1.0 * FLAT, land_exponent=-1.0, land_widening=1.5,
)  # fmt: skip
"""Critical friction falls as one over race friction: 0.4 at 0.05."""

PHASE = [Phase(share=1.0, bearing=BEARING, table=TABLE)]


def worn(draws=1, **given):
    """Draws that wear by nothing but what is given."""
    values = {
        "film_wear": 0.0, "cage_wear": 0.0, "transferred": 0.0, "thickness": 0.5 * UM, "coverage": 0.1 * UM,
        "film_friction": 0.05, "bare_friction": 0.4, "pocket_friction": 0.1, "worn_friction": 0.1,
        "worn_depth": math.inf, "reservoir": math.inf,
    }  # fmt: skip
    return Worn(**{name: np.broadcast_to(one, draws).astype(float) for name, one in (values | given).items()})


def test_nothing_that_wears_lives_for_ever_and_what_is_unstable_from_the_start_has_no_life():
    """P(unstable) stays where it is; what becomes so within the first step has some life."""
    found = course(PHASE, worn(), 1e9)
    assert np.ptp(found.probability_unstable) == 0.0
    assert np.isinf(lives(found)).all()
    assert lives(course(PHASE, worn(pocket_friction=0.8), 1e6))[0] == 0.0
    assert lives(course(PHASE, worn(film_wear=1e-6, pocket_friction=0.2), 1e6))[0] == 0.5


def test_a_film_that_wears_ends_a_cage_when_its_critical_friction_is_reached():
    """At 0.2 of race friction: coverage (0.4 - 0.2)/(0.4 - 0.05), by the closed form of the film."""
    draws = worn(film_wear=1e-15)
    found = course(PHASE, draws, 1e9)
    left = -0.1 * UM * math.log1p(-0.2 / 0.35)
    rate = 1e-15 * 100.0
    time = 0.1 * UM / rate * math.log(math.expm1(5.0) / math.expm1(left / (0.1 * UM)))
    ends = lives(found)
    assert ends[0] == pytest.approx(time, rel=0.16)  # a step of slow time, 10^(1/16)
    why = causes(found, PHASE, draws, ends)
    assert why.film_worn[0] > 1.0
    assert why.pocket_opened[0] == pytest.approx(0.0, abs=1e-9)
    assert why.friction_risen[0] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(("friction", "sliding"), [(0.1, 2.0), (0.8, 200.0)])
def test_pockets_open_by_what_slides_in_them(friction, sliding):
    """K N v t over both walls of ten pockets, a cap each; of a cage that whirls by the work of a whirl."""
    given = {"cage_wear": 1e-16, "worn_friction": friction}
    found = course(PHASE, worn(pocket_friction=friction, **given), 1e4)
    volume = 1e-16 * sliding * 1e4
    assert found.volume[-1, 0] == pytest.approx(volume, rel=1e-6)  # P(unstable) is 1e-9 from 0 or 1
    depth = math.sqrt(volume / 20.0 / (math.pi * 5e-3))
    assert found.clearance[-1, 0] == pytest.approx(3e-4 + 2.0 * depth, rel=1e-6)


def test_pockets_that_meet_are_the_end_of_a_cage():
    """A gap of 0.4 mm between balls is 50 um on either side: 20 caps of V = pi R w^2, worn by 2 W."""
    phases = [replace(PHASE[0], bearing=replace(BEARING, ball_gap=4e-4))]
    found = course(phases, worn(cage_wear=1e-16), 1e8)
    ends = lives(found)
    assert ends[0] == pytest.approx(20.0 * math.pi * 5e-3 * (5e-5) ** 2 / 2e-16, rel=0.16)  # 10^(1/16)
    assert (found.clearance[-1, 0], causes(found, phases, worn(), ends).pocket_opened[0]) == (4e-4, math.inf)


def test_a_land_opens_all_around_and_takes_the_critical_friction_with_it():
    """2 K N v t over its area; a critical friction of 0.02 over race friction falls with it."""
    bearing = replace(BEARING, land=Land(area=1e-3, clearance=2e-4))
    phases = [replace(PHASE[0], bearing=bearing)]
    draws = worn(cage_wear=1e-12, pocket_friction=0.3, worn_friction=0.3)
    found = course(phases, draws, 1e5)
    worn_off = 2.0 * 1e-12 * 1e5 / 1e-3
    assert found.land_clearance[-1, 0] == pytest.approx(2e-4 + worn_off, rel=1e-6)  # calm but for 1e-9
    ends = lives(found)
    race = 0.05 + 0.35 * math.exp(-5.0)
    time = (0.02 / race / 0.3 - 1.0) * 2e-4 * 1e-3 / 2.0 / 1e-12
    assert ends[0] == pytest.approx(time, rel=0.16)  # a step of slow time
    why = causes(found, phases, draws, ends)
    wide = found.land_clearance[np.searchsorted(found.time, ends[0]), 0] / 2e-4
    assert why.land_opened[0] == pytest.approx(math.log(wide), rel=1e-12)  # critical friction as one over it
    assert why.film_worn[0] == pytest.approx(math.log(race / 0.05), rel=1e-12)  # rounding, as in the next
    assert why.pocket_opened[0] == pytest.approx(0.0, abs=1e-12)


def test_a_cage_that_leaves_its_land_alone_does_not_hide_one_that_rubs():
    """Half of the work between no work and some, half way in the logarithm of the clearance."""
    table = replace(TABLE, calm_land_sliding=np.array([[0.0, 2.0], [0.0, 2.0]]))
    found = table.at(np.array([0.1]), np.array([3e-4 * math.sqrt(10.0)]))
    assert found["calm_land_sliding"][0] == pytest.approx(1.0, rel=1e-12)  # rounding
    assert found["critical_friction"][0] == pytest.approx(0.2, rel=1e-12)


def test_a_worn_pocket_goes_over_to_its_friction():
    """63 % of the way at the stated depth, which 20 caps of that depth have together as volume."""
    volume = 20.0 * math.pi * 5e-3 * 1e-6**2
    given = {"worn_friction": 0.2, "worn_depth": 1e-6, "cage_wear": volume / 2.0 / 1e3}
    found = course(PHASE, worn(**given), 1e3)
    assert found.pocket_friction[-1, 0] == pytest.approx(0.1 + 0.1 * (1.0 - math.exp(-1.0)), rel=1e-4)


def test_debris_grows_a_film_that_does_not_wear_until_the_reservoir_is_empty():
    """A half of K N v over both tracks, 1e-4 m2 each, and half of ten balls; then nothing more."""
    area = 2e-4 + 0.5 * 10 * math.pi * 1e-2**2
    given = {"cage_wear": 1e-14, "transferred": 0.5}
    grown = 0.5 * 1e-14 * 2.0 * 1e4 / area
    free = course(PHASE, worn(**given), 1e4)
    assert free.films[0][-1, 0] == pytest.approx(0.5 * UM + grown, rel=1e-6)
    ended = course(PHASE, worn(**given, reservoir=1e-30), 1e4)
    assert ended.films[0][-1, 0] < 0.5 * UM + 1e-3 * grown
    assert ended.clearance == pytest.approx(free.clearance, rel=1e-15)  # pockets open as before, to rounding


def test_deposit_balances_wear_at_its_fixed_point():
    """D/W of a calm and of a whirling cage; the film of a calm cage ends at that coverage, or grows."""
    area = 2e-4 + 0.5 * 10 * math.pi * 1e-2**2
    given = {"film_wear": 1e-15, "cage_wear": 1e-15 * 100.0 * 0.3 * area / 2.0, "transferred": 1.0}
    calm, whirling = steady_coverage(PHASE, worn(**given))
    assert (calm[0], whirling[0]) == pytest.approx((0.3, 1.0), rel=1e-9)
    found = course(PHASE, worn(**given, bare_friction=0.05), 1e9)
    assert -math.expm1(-found.films[0][-1, 0] / (0.1 * UM)) == pytest.approx(0.3, rel=1e-3)


def test_race_friction_is_the_mean_by_load():
    """The inner track bare, of three times the load of the outer one, which does not wear."""
    idle = replace(TRACK, work=np.zeros(2))
    bearing = replace(BEARING, tracks=(TRACK, idle), loads=(3.0, 1.0))
    found = course([replace(PHASE[0], bearing=bearing)], worn(film_wear=1e-9), 1e6)
    whole = 0.4 - 0.35 * (1.0 - math.exp(-5.0))
    assert found.race_friction[-1, 0] == pytest.approx(0.75 * 0.4 + 0.25 * whole, rel=1e-6)


def test_what_limits_the_answer_is_its_first_note():
    """Pockets that open to the gap, beyond the table's 3 mm; a screen shows three notes."""
    found = _life("cage", PHASE, worn(cage_wear=1e-12), {}, 1.0, 1e9, None, ["another"])
    ends = ("to the gap between the balls", "beyond 3 mm")
    beyond = [f"In 100 % of the draws the pockets open {end} by the end" for end in ends]
    assert [one.partition(":")[0] for one in found.notes] == [*beyond, "another"]


def test_phases_of_a_duty_cycle_share_the_time():
    """Two halves alike are one; one that does not wear doubles the life; the worse one decides."""
    draws, whole = worn(film_wear=1e-15), PHASE[0]
    idle = TrackWork(across=TRACK.across, share=TRACK.share, work=np.zeros(2), passes=0.0, area=1e-4)
    rests = replace(whole, share=0.5, bearing=replace(BEARING, tracks=(idle, idle)))
    half = replace(whole, share=0.5)
    one, same, resting = (course(each, draws, 1e9) for each in (PHASE, [half, half], [half, rests]))
    assert same.films[0] == pytest.approx(one.films[0], rel=1e-12)
    assert lives(resting)[0] / lives(one)[0] == pytest.approx(2.0, rel=0.16)  # a step of slow time
    fragile = replace(rests, table=replace(TABLE, critical_friction=0.01 * FLAT))
    assert lives(course([half, fragile], draws, 1e9))[0] == 0.0


def test_a_test_at_the_speed_of_the_mission_stands_for_itself():
    """An hour is an hour, of films and pockets; half of the passes stand for half of it."""
    solution = solve(separatrix.read_study("cryogenic-turbopump"))
    phase = Phase(share=1.0, bearing=_bearing_wear(solution), table=TABLE)
    found = _accelerated(solution, Tabulated().node, [phase], worn())
    assert (found.film_time, found.pocket_time) == pytest.approx((1.0, 1.0), rel=1e-12)
    assert found.probability_stable == pytest.approx(1.0, abs=1e-6)
    twice = _accelerated(solution, Tabulated().node, [replace(phase, share=2.0)], worn())
    assert twice.film_time == pytest.approx(0.5)


class Tabulated:
    """A runner that has every place of a table already, of one critical friction."""

    def __init__(self, critical=0.2, look=None):
        self.node, self.look = Node(critical, 30.0, (2.0, 200.0), (0.0, 0.0)), look

    def work_out(self, _node, places, *, into, load):  # noqa: ARG002
        """Return the answer of the table."""
        return into(dict.fromkeys(places, self.node) | {LONG_LOOK: self.look})


def test_a_cage_without_candidates_has_a_name_and_notes():
    """The name is that of its material, else of its study; sentences are on the cages of this name."""
    for material, name in ((WHEEL.ranking.candidates[0].material, "Vespel SP-3"), (None, "momentum-wheel")):
        cage = replace(WHEEL.cage, ball_cage_friction=0.1, ball_cage_stiffness=1e6, material=material)
        one = replace(WHEEL, ranking=None, wear=RATES, cage=cage)
        found = life(one, revolutions=1e6, draws=64, runner=Tabulated())
        assert (found.candidate, FREELY in found.notes) == (name, False)
    # what a long look finds is the first note, unless most cages are unstable from the start
    look = SimpleNamespace(worst=SimpleNamespace(runs=16, whirls_by_land=9), reason="9 of 16")
    for critical, is_first in ((0.2, True), (LEAST_CRITICAL, False)):
        notes = life(one, revolutions=1e6, draws=64, runner=Tabulated(critical, look)).notes
        assert (notes[0] == f"9 of 16{LEFT_OUT}", FREELY in notes) == (is_first, not is_first)


def test_a_cage_that_its_land_drives_counts_as_unstable():
    """With any friction in its pockets, as `rank` calls it UNSTABLE; a calm one has no critical friction."""
    solution, settings = solve(WHEEL), StabilitySettings(duration=1e-3, kicks=(0.5,))
    found = run_ensemble(moving_cage(solution, 0.1), settings, kicks=(0.5,), runs=16)
    of_these = SimpleNamespace(ensemble=lambda *_, **__: found)
    found.outcome[0] = RunOutcome.SETTLES
    assert _node(solution, settings, of_these).critical == SEARCHED_FRICTION
    found.outcome[0], found.cause[0] = RunOutcome.WHIRLS, Cause.LAND_FRICTION
    assert _node(solution, settings, of_these).critical == LEAST_CRITICAL


@pytest.mark.parametrize(("holds", "is_thin"), [(1e-7, False), (1e-6, True)])
def test_a_film_that_does_not_cover_its_tracks_from_the_start_is_noted(holds, is_thin):
    """1 um of it: a race friction of 0.03 + (0.35 - 0.03)/e, five times that of a verdict."""
    thin = replace(WHEEL, wear=replace(RATES, coverage_thickness=holds))
    notes = life(thin, revolutions=1e6, draws=64, runner=Tabulated()).notes
    (said,) = [one for one in notes if "life begins" in one] or [""]
    words = "covers 63 % of its tracks by [wear] coverage_thickness: life begins at a race friction of 0.148,"
    assert (words in said, bool(said)) == (is_thin, is_thin)


@pytest.mark.parametrize(("land", "more"), [(3e-4, ()), (4e-4, (4.0,)), (4.5e-4, ()), (8e-4, ())])
def test_the_table_has_the_clearance_at_which_the_land_takes_over(land, more):
    """A cage of 0.25 mm pockets on a 0.3 mm land was up to 1.5 times as stable between places as by runs."""
    one = replace(WHEEL, wear=RATES, cage=replace(WHEEL.cage, land_clearance=land))
    found = life(one, revolutions=1e6, draws=64, runner=Tabulated())
    assert 1e4 * found.table.pocket_clearance == pytest.approx((3.0, *more, 4.5, 7.5))


@pytest.mark.parametrize(
    ("cases", "line"),
    [
        ([{"operation.inner_speed": 1e3}], "needs a column time_share"),
        ([{"cage.mass": 0.02, "time_share": 1.0}], "must vary operation.inner_speed .* alone; got cage.mass"),
        ([{"operation.inner_speed": 0.0, "time_share": 1.0}], "a phase in which the rings turn"),
        ([{"operation.axial_load": 1e3, "time_share": 1.0}] * 13, "must be at most 12 of a duty cycle"),
    ],
)
def test_what_a_duty_cycle_refuses(cases, line):
    """Before anything is computed."""
    study = replace(separatrix.read_study("cryogenic-turbopump"), wear=RATES)
    with pytest.raises(separatrix.InputError, match=line):
        life(study, revolutions=1e6, draws=64, cases=cases)


def test_wear_of_the_library_scatters_over_its_range_else_by_ten():
    """Log-normal with 95 % between the ends: at 2.5, 50 and 97.5 % of 4096 Sobol draws, to 2 %."""
    candidate, given = WHEEL.ranking.candidates[0], WearRates(bare_friction=0.35, cage_wear=2e-15)
    rates, solution = wear_rates(WHEEL, given, candidate), solve(WHEEL, candidate)
    draws, inputs, _ = _drawn(solution, given, rates, candidate, 4096)
    shares = (0.025, 0.5, 0.975)
    ends = [5e-18, math.sqrt(5e-18 * 4e-15), 4e-15]  # MoS2: endurance of a bearing, run-in of a tribometer
    assert np.quantile(draws.film_wear, shares) == pytest.approx(ends, rel=0.02)
    assert np.quantile(draws.cage_wear, shares) == pytest.approx([2e-16, 2e-15, 2e-14], rel=0.02)
    assert {"wear.film_wear", "wear.cage_wear"} <= set(inputs)
    (note,) = _tests(rates, solution)
    assert note.startswith("[wear] film_wear: 1.4e-07 mm3/(N m) of MoS2 sputtered dense in the library")
    assert note.endswith("on the races, vacuum.")


def test_a_reservoir_is_that_of_esa():
    """Limit state g = V - K alpha n with log-normal K: P(empty) = Phi(ln(K_50 alpha n/V)/sigma), to 1 %."""
    draws, sigma, median = 4096, math.sqrt(math.log1p(0.6**2)), 4e-15
    points = (np.arange(draws) + 0.5) / draws
    wear, horizon = median * np.exp(sigma * ndtri(points)), 1e6
    volume = 1.5 * median * 2.0 * horizon
    found = course(PHASE, worn(draws, cage_wear=wear, reservoir=volume), horizon)
    empty = np.mean(found.volume[-1] >= volume)
    assert empty == pytest.approx(float(ndtr(math.log(1.0 / 1.5) / sigma)), abs=0.01)


@pytest.mark.parametrize(
    ("coefficient", "low", "high"), [(5e-9, 0.2, 0.95), (5e-10, 0.99, 1.0), (4e-6, 0.0, 1e-6)]
)
def test_endurance_of_a_published_film(coefficient, low, high):
    """0.6 um of MoS2 outlasted 1.05e8 cycles (NASA): at 5e-9 mm3/(N m) part is left, at 4e-6 nothing."""
    wheel = study_of("wheel 6000")
    state = bearing_state(wheel.bearing, wheel.operation, KinematicModel.FREE, 0.05)
    track = track_work(wheel.bearing, wheel.operation, state, Race.INNER)
    wear = np.array([coefficient * 1e-9 * track.work.max() * track.passes])
    left = film_after(*of(0.6 * UM), wear, *of(0.0, 0.1 * UM), 1.05e8 / 100.0)
    assert low <= -math.expm1(-left[0] / (0.1 * UM)) <= high


def test_the_life_follows_what_it_depends_on():
    """Rank correlation -1 with the wear that alone varies, none with noise; nothing where all are one."""
    wear = np.geomspace(1e-17, 1e-13, 64)
    found = lives(course(PHASE, worn(64, film_wear=wear), 1e9))
    first, *others = driven_by({"noise": np.sin(1e3 * wear / wear[0]), "wear": wear}, found)
    assert first.name == "wear"
    assert first.correlation == pytest.approx(-1.0, abs=0.02)
    assert abs(others[0].correlation) < 0.4
    assert driven_by({"wear": wear}, np.ones(64)) == ()


def test_steepness_of_counts_is_their_slope():
    """Expected counts of a logistic of slope 10: within a third, the step of the slopes that are possible."""
    places = np.log(0.2) + np.linspace(-0.35, 0.35, 8)
    counts = {x: Count(round(4000 / (1.0 + math.exp(-10.0 * (x - math.log(0.2))))), 4000) for x in places}
    assert steepness(counts, math.log(0.2) + PLACES, 0.5) == pytest.approx(10.0, rel=0.34)


def test_a_study_without_wear_names_the_test():
    """One line, and no table is computed; of bare races: test_page_verbs."""
    shipped = separatrix.read_study("cryogenic-turbopump")
    with pytest.raises(separatrix.InputError, match=r"lacks the section \[wear\].*worn volume over load"):
        life(shipped, revolutions=1e6, draws=64)
