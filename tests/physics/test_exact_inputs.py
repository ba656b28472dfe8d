"""What the exact contact refuses, each in one line with its place, rule and value; what may be left out."""

import math
from dataclasses import replace

import numpy as np
import pytest

from separatrix import ContactProblem, Creep, creep_of_force, rigid_slip, rolling_contact, solve_each
from separatrix.chain.exact.grid import cell_counts
from separatrix.chain.exact.influence import Body, Layer, Solid, pair_images, solid
from separatrix.chain.exact.pressure import press
from separatrix.chain.exact.rolling import solve
from separatrix.chain.exact.slip import FrictionLaw
from separatrix.chain.exact.slope import traction_slope
from separatrix.chain.film_compliance import Profile, worn_band
from separatrix.chain.hertz import contact_ellipse, ellipse_of_axes
from separatrix.ground.errors import InputError

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
