"""Drag, temperatures, flash and boiling of a bearing in its fluid: numbers of another program, limits."""

import math
from dataclasses import replace

import pytest
from commands import extended

import separatrix
from separatrix.chain.contacts import bearing_state
from separatrix.chain.heat_balance import (
    Fluid,
    Heat,
    ball_drag,
    boiling_limit,
    cylinder_moment,
    heat_balance,
    spin_moment,
    temperatures,
)
from separatrix.ground.errors import InputError
from separatrix.study.study import Guidance

LN2 = Fluid(807.9576, 1.63216e-4)  # 77 K, 2 bar
ORBIT, SPEED, RADIUS = 668.9886, 500.0 * math.pi, 0.0325


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """Return the shipped study with its cage's sizes, its coolant and its steel."""
    return extended(
        tmp_path_factory.mktemp("heat"),
        '[cage]\ninner_diameter = "58 mm"\nouter_diameter = "72 mm"\nwidth = "14 mm"\n'
        '[cooling]\nswirl = 0.5\nflow = "50 g/s"\nrace_conductance = "5 W/K"\ninner_cooling = "20 W/K"\n'
        'outer_cooling = "30 W/K"\nball_cooling = "25 W/K"\ncage_cooling = "10 W/K"\n'
        'steel_conductivity = "12 W/(m K)"\nsteel_heat_capacity = "180 J/kg/K"\n',
    )


@pytest.fixture(scope="module")
def state(study):
    """Return its equilibrium."""
    return bearing_state(study.bearing, study.operation, study.kinematics.model, study.film.race_friction)


@pytest.mark.parametrize(("swirl", "force"), [(0.0, 8.1495), (0.5, -0.24676)])
def test_drag_on_a_ball_in_liquid_nitrogen(swirl, force):
    """Of another program to its digits; where the fluid turns faster than the ball it drives it."""
    found = ball_drag(LN2, 11.1125e-3, RADIUS * (ORBIT - swirl * SPEED))
    assert found == pytest.approx(force, rel=1e-4)


def test_fluid_on_spin_and_faces():
    """Stokes; then of another program, to its digits: a ball, the outside and the inside of the cage."""
    # Stokes: 3 pi mu D v at Reynolds numbers of 1e-4, where the next term, 0.15 Re^0.687, is 3e-4
    assert ball_drag(LN2, 1e-3, 2e-8) == pytest.approx(3.0 * math.pi * LN2.viscosity * 1e-3 * 2e-8, rel=1e-3)
    spin = math.hypot(4083.218, 1942.614)
    assert spin_moment(LN2, 11.1125e-3, spin) == pytest.approx(4.3385e-4, rel=1e-3)  # 0.146 has three digits
    assert 13 * spin * spin_moment(LN2, 11.1125e-3, spin) == pytest.approx(25.5, abs=0.05)
    assert cylinder_moment(LN2, 0.036, 0.014, ORBIT) == pytest.approx(0.05416, rel=1e-3)
    assert cylinder_moment(LN2, 0.029, 0.014, SPEED - ORBIT) == pytest.approx(0.04271, rel=1e-3)


def test_steady_temperatures(study):
    """Of another program, whose heats are known to 0.05 mW a ball: 13/2 of that over 25 W/K."""
    inner, outer = 13 * 17.2370 / 2, 13 * 7.1120 / 2
    heat = Heat(inner, inner + outer, outer, 0.0, 0.0)
    found = temperatures(heat, replace(study.cooling, cage_cooling=0.0), 0.05, 2038.67, 77.0)
    assert found == pytest.approx((84.159569, 84.179123, 80.677252, None, 80.105330), abs=1.3e-5)


def test_heat_leaves_by_the_coolant(study, state):
    """What each part gives the coolant is all heat that is set free outside it, whatever rubs."""
    for pocket, land in ((0.0, 0.0), (30.0, 7.0)):
        found, cooling = heat_balance(study, state, pocket_power=pocket, land_power=land), study.cooling
        middle = 0.5 * (77.0 + found.coolant_out_temperature)
        given = sum(
            hold * (at - middle)
            for hold, at in (
                (cooling.inner_cooling, found.inner_ring_temperature),
                (cooling.outer_cooling, found.outer_ring_temperature),
                (cooling.ball_cooling, found.ball_temperature),
                (cooling.cage_cooling, found.cage_temperature),
            )
        )
        in_fluid = found.ball_drag_power + found.spin_power + found.cage_drag_power
        assert given == pytest.approx(found.shaft_power - in_fluid, rel=1e-9)
        friction = found.shaft_power - in_fluid - pocket - land
        assert friction / SPEED == pytest.approx(state.equilibrium.friction_torque, rel=1e-9)
        assert found.shaft_torque * SPEED == pytest.approx(found.shaft_power, rel=1e-12)


@pytest.mark.parametrize("guidance", [Guidance.OUTER, Guidance.INNER])
def test_the_land_warms_the_ring_that_has_it(study, state, guidance):
    """40 W at a land: half of it into the ring that guides the cage, none into the other."""
    study = replace(study, cage=replace(study.cage, guidance=guidance))
    calm, rubs = (heat_balance(study, state, land_power=power) for power in (0.0, 40.0))
    rings = ("inner_ring_temperature", "outer_ring_temperature")
    inner, outer = (getattr(rubs, name) - getattr(calm, name) for name in rings)
    assert (inner > outer + 0.5) == (guidance is Guidance.INNER)
    assert (outer > inner + 0.4) == (guidance is Guidance.OUTER)


@pytest.mark.parametrize("swirl", [0.0, 0.3, 0.5, 1.0])
def test_drag_warms_whichever_ring_turns_the_fluid(study, state, swirl):
    """A fluid that drives the balls is turned by the inner ring: seen from there it brakes them, as any."""
    orbit = state.cage_speed
    found = heat_balance(replace(study, cooling=replace(study.cooling, swirl=swirl)), state)
    behind = orbit if swirl * SPEED < orbit else SPEED - orbit  # the ring that holds or turns the fluid
    assert found.ball_drag_power == pytest.approx(13 * RADIUS * abs(found.ball_drag) * behind, rel=1e-9)
    made_warm = 13 * RADIUS * abs(found.ball_drag) * abs(orbit - swirl * SPEED)  # between ball and fluid
    assert found.ball_drag_power >= made_warm
    assert found.coolant_out_temperature > 77.0


def added(study, state, **changes):
    """Return the notes that other numbers of the coolant add."""
    changed = replace(study, cooling=replace(study.cooling, **changes))
    return set(heat_balance(changed, state).notes) - set(heat_balance(study, state).notes)


def test_a_coolant_that_leaves_too_warm_is_noted(study, state):
    """At 50 g/s it rises by 5 K beyond its boiling point, at a thousandth of it beyond its properties."""
    (boils,) = (one for one in heat_balance(study, state).notes if "boiling point at 1 atm, 77.36 K" in one)
    assert boils.startswith("The coolant leaves at 82 K, above")
    much = replace(study, cooling=replace(study.cooling, flow=1.0))  # by 0.2 K
    assert not any("boiling point" in one for one in heat_balance(much, state).notes)
    assert any("estimates beyond 15 %" in one for one in added(study, state, flow=50e-6))


def test_what_numbers_of_a_coolant_cannot_be_is_noted(study, state):
    """A coolant warmer than the parts that heat it, drag beyond both races, a flash far above its steel."""
    assert not any("Parts" in one for one in added(study, state, flow=0.03))
    # the parts' 316 W alone make 5 g/s warmer by 31 K; the inner ring is some 6 K above a mean of 21 K
    (note,) = (one for one in added(study, state, flow=0.005) if one.startswith("Parts of at most"))
    assert note.endswith("the parts are warmer than given.")
    (note,) = added(study, state, steel_heat_capacity=7.0)  # a rise of 86 K at 77 K
    assert note.startswith("The flash, a rise of 8")
    slippery = replace(study, film=replace(study.film, race_friction=1e-4))
    (note,) = set(heat_balance(slippery, state).notes) - set(heat_balance(study, state).notes)
    least = min(state.inner.load, state.outer.load)
    assert f"the race with less load, {2e-1 * least:.3g} mN: the balls skid" in note


def test_flash_temperatures(study, state):
    """Of another program: 16.9 and 6.1 K with an effusivity of 4065; of the steel of the rings alone."""
    found = heat_balance(study, state)
    effusivity = math.sqrt(12.0 * study.bearing.ball_material.density * 180.0)
    ratio = 4065.0 / effusivity
    assert (found.flash_inner * ratio, found.flash_outer * ratio) == pytest.approx((16.9, 6.1), abs=0.1)
    # ceramic balls leave the density of the rings, whose conductivity and heat capacity are stated
    light = replace(study.bearing.ball_material, density=3200.0)
    hybrid = replace(study, bearing=replace(study.bearing, ball_material=light))
    assert heat_balance(hybrid, state).flash_inner == found.flash_inner


@pytest.mark.parametrize(
    ("fluid", "temperature", "limit"), [("liquid nitrogen", 77.355, 1.6196e5), ("LOX", 90.188, 2.0524e5)]
)
def test_boiling_limit(tmp_path, fluid, temperature, limit):
    """Of another program at 1 atm; the library's properties have five digits."""
    study = extended(tmp_path, f'[operation]\nfluid = "{fluid}"\ntemperature = "{temperature} K"\n')
    assert boiling_limit(study, temperature) == pytest.approx(limit, rel=1e-4)


@pytest.mark.parametrize(
    ("keys", "line"),
    [
        ({}, r"\[cooling\] lacks: swirl"),
        ({"swirl": 0.5, "flow": "50 g/s"}, r"race_conductance"),
        ({"swirl": 1.5}, r"must lie between 0 and 1"),
        ({"swirl": 0.5, "cage_cooling": "1 W/K"}, r"there are no temperatures"),
        ({"swirl": 0.5, "steel_conductivity": "12 W/(m K)"}, r"steel_heat_capacity"),
    ],
)
def test_what_cooling_refuses(tmp_path, keys, line):
    """Each fault by its key."""
    lines = "".join(f"{name} = {value!r}\n" for name, value in keys.items())
    with pytest.raises(InputError, match=line):
        extended(tmp_path, f"[cooling]\n{lines}")


def test_a_coolant_that_nobody_knows(tmp_path):
    """The library has no such name, or none is stated; one that is unknown there: test_page_verbs."""
    bare = extended(tmp_path, '[operation]\nfluid = "nitrogen"\n[cooling]\nswirl = 0.5\n')
    with pytest.raises(InputError, match=r"fluid is not a fluid of the library, .*; got nitrogen\. Write"):
        separatrix.bearing(bare)
    with pytest.raises(InputError, match=r"\[operation\] fluid is missing beside \[cooling\]"):
        extended(tmp_path, "[cooling]\nswirl = 0.5\n", "ball-218")
