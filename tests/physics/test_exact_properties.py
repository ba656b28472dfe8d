"""Exact rolling contacts nobody thought of: Coulomb's law, symmetries, scaling, films; rough interfaces."""

import math
from dataclasses import replace

import numpy as np
import pytest
from exact_cases import MU, P0, body, contact, ellipse, kalker, saturation
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from separatrix import ContactProblem, Creep, creep_of_force, rigid_slip, rolling_contact, solve_each
from separatrix.chain.exact.grid import cell_counts
from separatrix.chain.exact.influence import Body, Layer, Solid, pair_images, solid
from separatrix.chain.exact.pressure import press
from separatrix.chain.exact.rolling import solve
from separatrix.chain.exact.slip import FrictionLaw, rough_compliance
from separatrix.chain.exact.slope import traction_slope
from separatrix.chain.film_compliance import Profile, worn_band
from separatrix.chain.hertz import contact_ellipse, ellipse_of_axes
from separatrix.ground.errors import InputError

quick = settings(max_examples=12)
shape = st.floats(-1.0, 0.5).map(lambda x: 10.0**x)
poisson = st.floats(0.0, 0.5)
cells = st.integers(6, 18)
size = st.floats(-2.0, 1.2).map(lambda x: 10.0**x)
signed = st.tuples(size, st.sampled_from([-1.0, 1.0])).map(lambda t: t[0] * t[1])
creeps = st.tuples(signed, signed, signed, signed)
CLOSE = 2e-4  # of mu N: two solutions to 1e-5 of the tractions each, where slip changes sides


def slips(made, parts, nu):
    """Longitudinal, lateral, spin and Heathcote creep as multiples of the saturation creep."""
    xi, eta, spin, curve = (part * saturation(nu) for part in parts)
    return rigid_slip(made.grid, longitudinal=xi, lateral=eta, spin=spin, curvature=curve)


def resultants(one):
    """Force, lateral force and moment over mu N."""
    return np.array([one.force, one.lateral_force, one.spin_moment]) / (MU * one.load)


@quick
@given(shape, poisson, cells, cells, creeps)
def test_coulombs_law(b, nu, columns, rows, parts):
    """|tau| <= g everywhere, slip against traction, none in stick, and power lost, not won."""
    made = contact(b, nu, columns=columns, rows=rows)
    one = solve(made, slips(made, parts, nu))
    size = np.hypot(*one.traction)
    g, inside = made.bound, made.bound > 0.0
    assert (size <= g * (1.0 + 1e-9)).all()
    sliding = inside & ~one.stick
    assert size[sliding] == pytest.approx(g[sliding], rel=1e-3)
    along = (one.traction * one.slip).sum(axis=0)[sliding]
    # 1e-5 of the tractions over c g, c the cell's stiffness: slips smaller than that have no direction
    large = np.hypot(*one.slip)[sliding] > 1e-2 * saturation(nu)
    assert along[large] == pytest.approx(-(g * np.hypot(*one.slip))[sliding][large], rel=1e-2)
    assert one.dissipation >= 0.0
    assert (one.dissipation > 0.0) == (one.stick_share < 1.0)
    assert math.hypot(one.force, one.lateral_force) <= MU * one.load * (1.0 + 1e-9)


@quick
@given(shape, poisson, cells, cells, creeps)
def test_mirror_across_the_groove_and_all_creeps_reversed(b, nu, columns, rows, parts):
    """At y -> -y lateral creep and spin, and with them lateral force and moment, change sign; T is odd."""
    made = contact(b, nu, columns=columns, rows=rows)
    xi, eta, spin, curve = parts
    W, mirrored = slips(made, parts, nu), slips(made, (xi, -eta, -spin, curve), nu)
    one, mirror, back = (resultants(solve(made, each)) for each in (W, mirrored, -W))
    assert mirror == pytest.approx(one * [1.0, -1.0, -1.0], abs=CLOSE)
    assert back == pytest.approx(-one, abs=CLOSE)


@quick
@given(shape, poisson, cells, creeps, st.floats(-3.0, 3.0), st.floats(-9.0, 9.0), st.floats(-9.0, 9.0))
def test_scaling(b, nu, count, parts, length, stiffness, load):
    """Lengths, moduli and pressure in any units: the same tractions over the pressure."""
    made = contact(b, nu, columns=count, rows=count)
    base = resultants(solve(made, slips(made, parts, nu)))
    s, G, p0 = 10.0**length, 10.0**stiffness, P0 * 10.0 ** (stiffness + 0.2 * load)
    solid = body(nu, G=G)
    problem = ContactProblem(
        ellipse=ellipse(b * s, a=s, p0=p0, modulus=G),
        bodies=(solid, solid),
        friction=FrictionLaw(coefficient=MU),
    )
    scaled = rolling_contact(problem, columns=count, rows=count)
    xi, eta, spin, curve = (part * 2.0 * MU * p0 / G * (1.0 - nu) for part in parts)
    W = rigid_slip(scaled.grid, longitudinal=xi, lateral=eta, spin=spin / s, curvature=curve / s**2)
    assert resultants(solve(scaled, W)) * [1.0, 1.0, 1.0 / s] == pytest.approx(base, abs=CLOSE)


@quick
@given(shape, poisson, cells, st.floats(-4.0, 0.5))
def test_a_layer_of_the_base_changes_nothing(b, nu, count, thickness):
    """To 1e-6 of the force, whatever its thickness."""
    nu = min(nu, 0.49)
    same = body(nu, (1.0, nu, b * 10.0**thickness))
    made = (contact(b, nu, columns=count, rows=count, race=race) for race in (None, same))
    one, other = (kalker(each, 0.5 * saturation(nu), tolerance=1e-8).force for each in made)
    assert other == pytest.approx(one, rel=1e-6)


@quick
@given(shape, poisson, st.floats(-2.3, -0.5), st.floats(1.1, 3.0))
def test_a_stiffer_or_thinner_film_sticks_harder(b, nu, thickness, factor):
    """Sticking slope up with E_f and with 1/h; below that of the bare contact."""
    h, G = b * 10.0**thickness, 0.05

    def slope(*layer):
        made = contact(b, nu, columns=14, rows=10, friction=1e6, race=body(nu, *layer))
        return -kalker(made, 1e-6).force

    film = slope((G, 0.4, h))
    assert film < slope((G * factor, 0.4, h)) < slope()
    assert film < slope((G, 0.4, h / factor)) < slope()


@quick
@given(shape, poisson, st.floats(0.02, 0.2))
def test_a_film_in_series_is_the_limit_of_a_layer(b, nu, G):
    """Layer of thickness h/b = 1e-4: the sticking force of L = h/G - h/G_base; 0.5 % at 14 columns."""
    h = 1e-4 * b
    layer = contact(b, nu, columns=14, rows=10, friction=1e6, race=body(nu, (G, 0.2, h)))
    series = contact(b, nu, columns=14, rows=10, friction=1e6, film_compliance=h * (1.0 / G - G))
    # Compressible film: the Poisson effect of a layer is of order h.
    assert kalker(layer, 1e-6).force == pytest.approx(kalker(series, 1e-6).force, rel=5e-3)


# A rough interface in series, whose compliance rises where the pressure falls.

B = 0.2


def alone(columns, *, friction):
    """Rough interface between rigid bodies."""
    stiff, law = (body(0.25, G=1e9),) * 2, FrictionLaw(coefficient=friction)
    problem = ContactProblem(ellipse=ellipse(B), bodies=stiff, friction=law, roughness=1.0)
    return rolling_contact(problem, columns=columns, rows=columns)


def test_rough_interface_alone_in_stick():
    """Traction p xi d/l, d the distance from the leading edge: force 9 pi/32 N b xi/l to 0.3/n^1.5."""
    for columns in (20, 40):
        force = -kalker(alone(columns, friction=1e9), xi=1.0).force
        exact = 9.0 * math.pi / 32.0 * ellipse(B).load * B
        assert force == pytest.approx(exact, rel=0.3 / columns**1.5)


@pytest.mark.parametrize("creep", [0.5, 1.0, 3.0])
def test_rough_interface_alone_slips_at_one_distance(creep):
    """Traction mu p min(1, xi d/(mu l)) in every row, whatever the pressure; 0.1 % at 40 x 40 cells."""

    def row(y):
        end = B * math.sqrt(1.0 - y * y)

        def traction(x):
            p = P0 * math.sqrt(max(1.0 - (x / B) ** 2 - y * y, 0.0))
            return MU * p * min(1.0, creep * (end - x) / B)

        return quad(traction, -end, end, limit=100)[0]

    exact = 2.0 * quad(row, 0.0, 1.0, limit=100)[0]
    found = kalker(alone(40, friction=MU), xi=creep * MU / B)
    assert -found.force == pytest.approx(exact, rel=1e-3)
    assert found.stick_share == pytest.approx(1.0 if creep < 0.6 else 2.0 / math.pi / creep, abs=0.04)


@quick
@given(shape, st.floats(0.0, 0.5), st.integers(6, 18), st.floats(-9.0, 0.0), size, size)
def test_roughness_softens(b, nu, cells, logarithm, xi, spin):
    """Whatever the contact: finite, within the bound, and sticking less the rougher it is."""
    made = contact(b, nu, columns=cells, rows=cells, roughness=10.0**logarithm)
    one = kalker(made, xi * saturation(nu), phi=spin * saturation(nu))
    assert np.isfinite(one.traction).all()
    assert (np.hypot(*one.traction) <= made.bound * (1.0 + 1e-9)).all()
    sticking = [
        -kalker(contact(b, nu, columns=cells, rows=cells, friction=1e6, roughness=r), 1e-6).force
        for r in (0.0, made.problem.roughness, 2.0 * made.problem.roughness)
    ]
    assert sticking[0] > sticking[1] > sticking[2] > 0.0


def test_edges_without_pressure():
    """Cells that the pressure leaves out are neither nan nor infinitely soft, with cohesion too."""
    made = contact(B, columns=12, rows=12, roughness=1e-4)
    pressure = made.pressure.copy()
    pressure[:, :6] = 0.0
    L = rough_compliance(made.grid, pressure, 1e-4)
    assert np.isfinite(L).all()
    assert L.max() == pytest.approx(1e-4 / (1e-6 * pressure[made.grid.fraction == 1.0].max()), rel=0.2)
    sticky = replace(made.problem, friction=FrictionLaw(coefficient=MU, cohesion=0.1 * P0))
    assert math.isfinite(kalker(rolling_contact(sticky, columns=12, rows=12), xi=1e-3).force)


# What the exact contact refuses, each in one line with its place, rule and value; what may be left out.

STEEL = Body(base=solid(200e9, 0.3))
ELLIPSE = contact_ellipse(100.0, 180.0, 15.0, 110e9)
LAW = FrictionLaw(coefficient=0.1)
NAN, INF = math.nan, math.inf


def problem(*layers, **changed):
    """Steel on a race with these layers."""
    race = Body(base=STEEL.base, layers=layers)
    return ContactProblem(**{"ellipse": ELLIPSE, "bodies": (STEEL, race), "friction": LAW} | changed)


def made(*layers, **changed):
    """The same on 8 x 8 cells."""
    return rolling_contact(problem(*layers, **changed), columns=8, rows=8)


def film(E=4e9, nu=0.38, h=1e-6):
    """One layer."""
    return Layer(thickness=h, solid=solid(E, nu))


def slope(columns=(6, 8), **creep):
    """Slope under a creep."""
    creep = Creep(**{"spin": 0.0, "curvature": 0.0} | creep)
    return traction_slope(problem(), creep, columns=columns, rows=8)


def slipping(**creeps):
    """Solution under creeps."""
    contact = made()
    return solve(contact, rigid_slip(contact.grid, **creeps))


FIELD = np.zeros((2, 8, 8))
SPOILT = np.full((2, 8, 8), NAN)


def field(**given):
    """Solution without a slip."""
    return solve(made(), FIELD, **given)


def pressed(name, **given):
    """What builds a contact with another value of this field of its ellipse."""
    return lambda value: made(ellipse=replace(ELLIPSE, **{name: value}), **given)


PLACES = "Profile.across must be finite, in increasing order, one place for each value [m]; got "
ONE = "must be one number, finite and > 0; got "
FILM = "ContactProblem.film_compliance"
SLIP = "solve: slip must be finite and at most 1000 [-]; got"
CELLS = "must be a whole number and lie from 4 to 256"
RULES = [  # what is called with each of the values, and what is said before "; got VALUE."
    (lambda E: solid(E, 0.3), "solid: elastic_modulus must be finite and > 0 [Pa]", (NAN, INF)),
    (lambda nu: solid(1e9, nu), "solid: poisson_ratio must lie from 0 to 0.5 [-]", (-1.0, NAN)),
    (lambda G: Solid(shear_modulus=G, poisson_ratio=0.3),
     "Solid.shear_modulus must be finite and > 0 [Pa]", (INF, 0.0)),
    (lambda nu: Solid(shear_modulus=1.0, poisson_ratio=nu),
     "Solid.poisson_ratio must lie from 0 to 0.5 [-]", (0.6,)),
    (lambda h: film(h=h), "Layer.thickness must be finite and > 0 [m]", (NAN, INF, 0.0)),
    (lambda nu: film(nu=nu), "Layer.solid.poisson_ratio must not exceed 0.49 in a film [-]", (0.495,)),
    (lambda mu: FrictionLaw(coefficient=mu),
     "FrictionLaw.coefficient must be finite and >= 0 [-]", (NAN, INF, -0.1)),
    (lambda c: FrictionLaw(coefficient=0.1, cohesion=c),
     "FrictionLaw.cohesion must be finite and >= 0 [Pa]", (NAN, -1.0)),
    (lambda s: FrictionLaw(coefficient=0.1, shear_strength=s),
     "FrictionLaw.shear_strength must be > 0 [Pa]", (NAN,)),
    (lambda v: Profile(across=(0.0,), values=(v,)), "Profile.values must be finite and >= 0", (INF, -0.1)),
    (lambda L: made(film_compliance=L), f"{FILM} must be finite and >= 0 [m/Pa]", (INF, -1.0)),
    (lambda r: made(roughness=r), "ContactProblem.roughness must be finite and >= 0 [m]", (-1e-7, NAN)),
    (lambda n: rolling_contact(problem(), columns=n), f"rolling_contact: columns {CELLS}", (3,)),
    (lambda n: rolling_contact(problem(), rows=n), f"rolling_contact: rows {CELLS}", (10.5, NAN)),
    (lambda s: slope(spin=s), "traction_slope: creep.spin must be finite", (NAN,)),
    (lambda q: slope(curvature=q), "traction_slope: creep.curvature must be finite", (INF,)),
    (lambda t: field(tolerance=t), "solve: tolerance must be > 0 and at most 0.1 [-]", (NAN, 0.0)),
]  # fmt: skip
REFUSED = [
    *((lambda ask=ask, x=x: ask(x), f"{says}; got {x:g}.") for ask, says, values in RULES for x in values),
    *(
        (lambda name=name, x=x: pressed(name)(x), f"ContactProblem.ellipse.{name} {ONE}{x}.")
        for name in ("load", "semi_minor", "semi_major", "max_pressure")
        for x in (NAN, INF, 0.0)
    ),
    (lambda: made(film(h=1.0)), "Body.layers must be at most"),
    (lambda: made(film(9e12, h=1e-8), film(h=1e-5)), "Body.layers must fit 24 images to 0.001 of their span"),
    (lambda: made(film(E=0.2e9)), "rolling_contact: film strain p0/M_c must not exceed 1 [-]; got 2."),
    (lambda: Profile(across=(0.0, NAN), values=(0.1, 0.1)), f"{PLACES}(0.0, nan)."),
    (lambda: Profile(across=(0.0,), values=(0.1, 0.2)), f"{PLACES}(0.0,)."),
    (lambda: worn_band(NAN, worn=0.3, film=0.1), f"{PLACES}(nan, nan,"),
    (lambda: worn_band(-1e-4, worn=0.3, film=0.1), f"{PLACES}(0.0001, 0"),
    (lambda: pressed("load")(np.array([1.0, 2.0])), f"ContactProblem.ellipse.load {ONE}[1. 2.]."),
    (lambda: pressed("curvature_transverse", own_pressure=True)(0.0),
     f"ContactProblem.ellipse.curvature_transverse {ONE}0.0."),
    (lambda: pressed("curvature_transverse", own_pressure=True)(1e-12),
     "ContactProblem: contact under its own pressure must not reach beyond 100 half"),
    (lambda: slipping(longitudinal=1e9), SLIP),
    (lambda: slipping(lateral=NAN), SLIP),
    (lambda: slipping(spin=INF), SLIP),
    (lambda: slipping(curvature=1e20), SLIP),
    (lambda: slope(spin=1e9), SLIP),
    (lambda: slope(columns=(20, 20)), "traction_slope: columns must be strictly increasing; got (20, 20)."),
    (lambda: press(SPOILT[0], (0.1, 0.1), pair_images(STEEL, STEEL), 1.0), "press: gap must be finite"),
    (lambda: solve(made(), np.zeros((2, 3, 3))), "solve: slip must have the shape (2, 8, 8); got (2, 3, 3)."),
    (lambda: field(start=FIELD[:1]), "solve: start must have the shape (2, 8, 8); got (1, 8, 8)."),
    (lambda: field(start=SPOILT), "solve: start must be finite [Pa]; got nan."),
    (lambda: solve_each(made(), [SPOILT]), f"{SLIP} nan."),
    (lambda: creep_of_force(made(), 1.0), "creep_of_force: force must be below that of sliding, 1 [-]; got"),
    (lambda: creep_of_force(made(friction=FrictionLaw(coefficient=0.0)), 0.5),
     "creep_of_force: contact must have"),
    (lambda: made(ellipse=ellipse_of_axes(300.0, 0.15e-6, 0.45e-3, 110e9)),
     "ContactProblem.ellipse.max_pressure must be below the modulus of the pair, 1.1e+11 Pa; got"),
]  # fmt: skip


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # 0 x inf where a spin of inf meets y = 0
@pytest.mark.parametrize(("wrong", "says"), REFUSED, ids=map(str, range(len(REFUSED))))
def test_refused(wrong, says):
    """One line; nothing is computed."""
    with pytest.raises(InputError) as raised:
        wrong()
    message = str(raised.value)
    assert message.startswith(says)
    assert "\n" not in message


def test_the_valid_ones_are_solved():
    """The contact from which the others depart."""
    assert math.isfinite(slipping(longitudinal=1e-4).force)
    assert math.isfinite(slope().slope)


def test_cells_that_are_left_out():
    """40 x 40, more columns in contacts longer than wide, up to 8:1; given numbers stay."""
    counts = [cell_counts(None, None, semi_minor=b, semi_major=1.0) for b in (0.1, 1.0, 5.0, 8.0, 100.0)]
    assert counts == [(40, 40), (40, 40), (68, 24), (80, 20), (80, 20)]
    assert cell_counts(12, 16, semi_minor=5.0, semi_major=1.0) == (12, 16)
    long = problem(ellipse=ellipse_of_axes(300.0, 0.5e-3, 0.1e-3, 110e9))
    assert rolling_contact(long).grid.shape == (24, 68)
