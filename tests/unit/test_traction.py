"""What traction refuses, warns of and returns."""

import math
import pickle
import re

import pytest

from separatrix.chain import strip as strip_module
from separatrix.chain.creep import Creep
from separatrix.chain.film_compliance import film_compliance
from separatrix.chain.hertz import contact_ellipse
from separatrix.chain.strip import solve_strip
from separatrix.chain.traction_curve import shear_field, traction_curve, traction_slope
from separatrix.ground.errors import ConvergenceError, InputError
from separatrix.study.study import Film, Material

ELLIPSE = contact_ellipse(500.0, 200.0, 20.0, 113e9)
CREEP = Creep(spin=5.0, curvature=-2e4)
GOOD = {"race_friction": 0.1, "film_compliance": 1e-15}
PTFE = Material(name="PTFE", elastic_modulus=2e9, poisson_ratio=0.4)


@pytest.mark.parametrize("name", ["race_friction", "film_compliance", "film_thickness"])
@pytest.mark.parametrize("value", [-0.1, math.nan, math.inf])
def test_a_negative_or_endless_number_is_refused(name, value):
    """The message names the quantity, the rule and the value."""
    for ask in (traction_curve, traction_slope) if name != "film_thickness" else (traction_curve,):
        with pytest.raises(InputError, match=rf"{name} must be finite and >= 0 \[.*\]; got {value:g}\."):
            ask(ELLIPSE, CREEP, **{**GOOD, name: value})


def test_film_compliance_is_thickness_over_shear_modulus():
    """h/G = 2 h (1 + nu)/E; bare races have none."""
    film = Film(race_friction=0.1, material=PTFE, thickness=1e-6)
    assert film_compliance(film) == pytest.approx(1e-6 / (2e9 / 2.8), rel=1e-15)
    assert film_compliance(Film(race_friction=0.1)) == 0.0


def test_a_thick_film_in_series_is_noted():
    """Above 0.03 of the semi-minor axis; the number is returned."""
    thick, thin = (
        traction_curve(ELLIPSE, CREEP, film_thickness=share * ELLIPSE.semi_minor, **GOOD)
        for share in (0.031, 0.029)
    )
    (note,) = thick.notes
    assert re.search(r"0\.031 of the semi-minor axis.*is valid up to 0\.03 \(docs", note)
    assert thick.slope > 0.0
    assert thin.notes == ()


def test_traction_without_slip_knows_no_friction():
    """Elastic shear of the same creep; with friction enough it is the traction; rounding."""
    how = {"film_compliance": 1e-15, "creep_increment": 1e-3, "strips": 3, "nodes": 20}
    still = Creep(spin=0.0, curvature=0.0)
    fields = [shear_field(ELLIPSE, still, race_friction=mu, **how) for mu in (0.1, 0.2, 100.0)]
    for field in fields[1:]:
        assert field.shear_without_slip == pytest.approx(fields[0].shear_without_slip, rel=1e-9)
    stuck = fields[2].slip == 0.0
    assert stuck.sum() > 50
    assert fields[2].shear[stuck] == pytest.approx(fields[2].shear_without_slip[stuck], rel=1e-2)


def test_an_unsettled_strip_says_so(monkeypatch):
    """The error carries the sweeps and crosses process borders."""
    monkeypatch.setattr(strip_module, "BLOCK_SWEEPS", 1)
    monkeypatch.setattr(strip_module, "LEAST_INDEX_SWEEPS", 0)
    with pytest.raises(ConvergenceError, match=r"Strip of 20 elements: .* after 1 sweeps") as caught:
        solve_strip(0.5, nodes=20)
    assert pickle.loads(pickle.dumps(caught.value)).iterations == 1  # noqa: S301


def test_least_index_steps_end_too(monkeypatch):
    """One change at a time, the way out of a cycle, finds the same traction."""
    expected = solve_strip(0.4, 0.5, nodes=40).shear
    monkeypatch.setattr(strip_module, "BLOCK_SWEEPS", 0)
    found = solve_strip(0.4, 0.5, nodes=40)
    assert found.sweeps > 4
    assert found.shear == pytest.approx(expected, abs=1e-13)  # rounding
