"""What the exact contact refuses, each in one line with its place, rule and value; what may be left out."""

import math
from dataclasses import replace

import numpy as np
import pytest

from separatrix.chain.creep import Creep
from separatrix.chain.hertz import contact_ellipse, ellipse_of_axes
from separatrix.chain.traction.exact import (
    Body,
    ContactProblem,
    FrictionLaw,
    Layer,
    Profile,
    Solid,
    rigid_slip,
    rolling_contact,
    shift,
    solid,
    solve,
    solve_each,
    traction_slope,
    transient,
    worn_band,
)
from separatrix.chain.traction.exact.cases import rolling_cases
from separatrix.chain.traction.exact.grid import cell_counts
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


def slope(**creep):
    """Slope under a creep."""
    return traction_slope(problem(), Creep(**{"spin": 0.0, "curvature": 0.0} | creep), columns=(6, 8), rows=8)


def slipping(**creeps):
    """Solution under creeps."""
    contact = made()
    return solve(contact, rigid_slip(contact.grid, **creeps))


def flat(**changed):
    """Ellipse with a field changed, its own pressure solved."""
    return made(ellipse=replace(ELLIPSE, **changed), own_pressure=True)


FIELD = np.zeros((2, 8, 8))
SPOILT = np.full((2, 8, 8), NAN)

REFUSED = [
    # solids and films
    (lambda: solid(NAN, 0.3), "solid: elastic_modulus must be finite and > 0 [Pa]; got nan."),
    (lambda: solid(INF, 0.3), "solid: elastic_modulus must be finite and > 0 [Pa]; got inf."),
    (lambda: solid(1e9, -1.0), "solid: poisson_ratio must lie from 0 to 0.5 [-]; got -1."),
    (lambda: solid(1e9, NAN), "solid: poisson_ratio must lie from 0 to 0.5 [-]; got nan."),
    (
        lambda: Solid(shear_modulus=INF, poisson_ratio=0.3),
        "Solid.shear_modulus must be finite and > 0 [Pa]; got inf.",
    ),
    (lambda: film(h=NAN), "Layer.thickness must be finite and > 0 [m]; got nan."),
    (lambda: film(h=INF), "Layer.thickness must be finite and > 0 [m]; got inf."),
    (lambda: film(h=0.0), "Layer.thickness must be finite and > 0 [m]; got 0."),
    (lambda: film(nu=0.495), "Layer.solid.poisson_ratio must not exceed 0.49 in a film [-]; got 0.495."),
    (lambda: made(film(h=1.0)), "Body.layers must be at most"),
    (
        lambda: made(film(E=9e12, h=1e-8), film(h=1e-5)),
        "Body.layers must fit 24 images to 0.001 of their span [-]; got",
    ),
    (lambda: made(film(E=0.2e9)), "rolling_contact: film strain p0/M_c must not exceed 1 [-]; got 2."),
    # friction and profiles
    (
        lambda: FrictionLaw(coefficient=NAN),
        "FrictionLaw.coefficient must be finite and >= 0 [-]; got nan.",
    ),
    (
        lambda: FrictionLaw(coefficient=INF),
        "FrictionLaw.coefficient must be finite and >= 0 [-]; got inf.",
    ),
    (
        lambda: FrictionLaw(coefficient=0.1, cohesion=NAN),
        "FrictionLaw.cohesion must be finite and >= 0 [Pa]; got nan.",
    ),
    (
        lambda: FrictionLaw(coefficient=0.1, shear_strength=NAN),
        "FrictionLaw.shear_strength must be > 0 [Pa]; got nan.",
    ),
    (
        lambda: Profile(across=(0.0, NAN), values=(0.1, 0.1)),
        "Profile.across must be finite, in increasing order, one place for each value [m]; got (0.0, nan).",
    ),
    (
        lambda: Profile(across=(0.0,), values=(0.1, 0.2)),
        "Profile.across must be finite, in increasing order, one place for each value [m]; got (0.0,).",
    ),
    (
        lambda: Profile(across=(0.0,), values=(NAN,)),
        "Profile.values must be finite and >= 0; got nan.",
    ),
    (lambda: Profile(across=(0.0,), values=(INF,)), "Profile.values must be finite and >= 0; got inf."),
    (lambda: Profile(across=(0.0,), values=(-0.1,)), "Profile.values must be finite and >= 0; got -0.1."),
    (
        lambda: worn_band(NAN, worn=0.3, film=0.1),
        "Profile.across must be finite, in increasing order, one place for each value [m]; got (nan, nan,",
    ),
    (
        lambda: worn_band(-1e-4, worn=0.3, film=0.1),
        "Profile.across must be finite, in increasing order, one place for each value [m]; got (0.0001, 0",
    ),
    # problem and grid
    *(
        (
            lambda name=name, value=value: made(ellipse=replace(ELLIPSE, **{name: value})),
            f"ContactProblem.ellipse.{name} must be one number, finite and > 0; got {value}.",
        )
        for name in ("load", "semi_minor", "semi_major", "max_pressure")
        for value in (NAN, INF, 0.0)
    ),
    (
        lambda: made(ellipse=contact_ellipse(np.array([1.0, 2.0]), 180.0, 15.0, 110e9)),
        "ContactProblem.ellipse.load must be one number, finite and > 0; got [1. 2.].",
    ),
    (
        lambda: flat(curvature_transverse=0.0),
        "ContactProblem.ellipse.curvature_transverse must be one number, finite and > 0; got 0.0.",
    ),
    (
        lambda: flat(curvature_transverse=1e-12),
        "ContactProblem: contact under its own pressure must not reach beyond 100 half lengths",
    ),
    (
        lambda: made(film_compliance=NAN),
        "ContactProblem.film_compliance must be finite and >= 0 [m/Pa]; got nan.",
    ),
    (
        lambda: made(film_compliance=INF),
        "ContactProblem.film_compliance must be finite and >= 0 [m/Pa]; got inf.",
    ),
    (lambda: made(roughness=-1e-7), "ContactProblem.roughness must be finite and >= 0 [m]; got -1e-07."),
    (lambda: made(roughness=NAN), "ContactProblem.roughness must be finite and >= 0 [m]; got nan."),
    (
        lambda: rolling_contact(problem(), columns=3),
        "rolling_contact: columns must be a whole number and lie from 4 to 256; got 3.",
    ),
    (
        lambda: rolling_contact(problem(), rows=10.5),
        "rolling_contact: rows must be a whole number and lie from 4 to 256; got 10.5.",
    ),
    (
        lambda: rolling_contact(problem(), rows=NAN),
        "rolling_contact: rows must be a whole number and lie from 4 to 256; got nan.",
    ),
    # creeps
    (lambda: slipping(longitudinal=1e9), "solve: slip must be finite and at most 1000 [-]; got 1e+09."),
    (lambda: slipping(lateral=NAN), "solve: slip must be finite and at most 1000 [-]; got nan."),
    (lambda: slipping(spin=INF), "solve: slip must be finite and at most 1000 [-]; got"),
    (lambda: slipping(curvature=1e20), "solve: slip must be finite and at most 1000 [-]; got"),
    (lambda: slope(spin=NAN), "traction_slope: creep.spin must be finite; got nan."),
    (lambda: slope(spin=1e9), "solve: slip must be finite and at most 1000 [-]; got"),
    (lambda: slope(curvature=INF), "traction_slope: creep.curvature must be finite; got inf."),
    (
        lambda: traction_slope(problem(), Creep(spin=0.0, curvature=0.0), columns=(20, 20)),
        "traction_slope: columns must be strictly increasing; got (20, 20).",
    ),
    # fields
    (lambda: solve(made(), np.zeros((2, 3, 3))), "solve: slip must have the shape (2, 8, 8); got (2, 3, 3)."),
    (lambda: solve_each(made(), [SPOILT]), "solve: slip must be finite and at most 1000 [-]; got nan."),
    (lambda: solve(made(), FIELD, start=SPOILT), "solve: start must be finite [Pa]; got nan."),
    (
        lambda: solve(made(), FIELD, start=FIELD[:1]),
        "solve: start must have the shape (2, 8, 8); got (1, 8, 8).",
    ),
    (
        lambda: solve(made(), FIELD, tolerance=NAN),
        "solve: tolerance must be > 0 and at most 0.1 [-]; got nan.",
    ),
    (lambda: solve(made(), FIELD, tolerance=0.0), "solve: tolerance must be > 0 and at most 0.1 [-]; got 0."),
    (lambda: shift(made(), SPOILT), "solve: slip must be finite and at most 1000 [-]; got nan."),
    (lambda: transient(made(), [SPOILT]), "solve: slip must be finite and at most 1000 [-]; got nan."),
]


@pytest.mark.filterwarnings("ignore::separatrix.ground.errors.ValidityWarning")
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
    setup = rolling_cases(long).cases[0].setup
    assert (setup.columns, setup.rows) == (68, 24)
    assert setup.contact().grid.shape == rolling_contact(long).grid.shape == (24, 68)
    assert rolling_cases(long, columns=40).cases[0].setup.columns == 40
