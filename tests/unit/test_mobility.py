"""The verb `mobility` and its record: what is refused, and what a study without a cage gets."""

import json
from dataclasses import replace

import numpy as np
import pytest

import separatrix
from separatrix import api, figures
from separatrix.cli import main
from separatrix.ground.errors import InputError, ValidityWarning
from separatrix.study.study import Wear, Worn


def test_a_study_without_a_cage_has_no_impacts():
    """The ball's mobility all the same, and the reason."""
    answer = api.mobility("le7")
    assert answer.impacts is None
    assert "lacks the section [cage]" in answer.impacts_reason
    document = answer.document()
    assert document["impacts"] is None
    assert document["rates"] == sorted(document["rates"])
    assert "Not computed: le7 lacks the section [cage]" in answer.summary()
    assert [name for name, _ in figures.draw("mobility", answer.to_xarray())] == ["mobility"]


def test_document_and_table_of_a_wheel():
    """Units and places of the keys; the main table is the push."""
    answer = api.mobility("momentum-wheel")
    document = json.loads(json.dumps(answer.document()))
    assert document["slip_law"] == "elastic creep"
    assert document["rigid"]["slip_law"] == "rigid"
    assert document["traction"]["capacity"] == pytest.approx(document["capacity"], rel=0.15)
    assert sum(document["shares"]) == pytest.approx(1.0, rel=1e-9)
    assert document["impacts"]["felt_mass"] == pytest.approx(0.5 * 3.5e-3)
    table, data = answer.to_dataframe(), answer.to_xarray()
    assert {"force_forward", "force_backward", "force_law"} <= set(table)
    assert len(table) == len(document["speed"])
    assert data["mobility"].dims == ("frequency",)
    assert data["step_damping"].attrs["units"] == "N s/m"
    assert data["impacts_restitution_forward"].dims == ("impact",)


def test_figures_show_the_answer():
    """Three panels of the ball, two of the impacts; each axis has its unit."""
    answer = api.mobility("momentum-wheel")
    for name, panels in (("mobility", 3), ("mobility-impacts", 2)):
        axes = answer.plot(name).axes
        assert len(axes) == panels
        assert all("[" in one.get_xlabel() and "[" in one.get_ylabel() for one in axes)
    force = answer.plot("mobility").axes[2]
    drawn = {line.get_label(): line.get_ydata() for line in force.lines}
    assert drawn["forward"][1:] == pytest.approx(answer.mobility.force_forward)
    capacity = answer.mobility.capacity
    assert drawn[f"capacity {capacity:.3g} N"][0] == pytest.approx(capacity)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"inner_speed": 0.0}, "must differ from outer_speed"),
        ({"race_friction": 0.0}, "must be > 0 for traction"),
    ],
)
def test_what_does_not_roll_is_refused(changes, words, tmp_path, capsys):
    """As traction is: one line, status 2."""
    (key, value), path = next(iter(changes.items())), tmp_path / "case.toml"
    section, text = ("film", "0") if key == "race_friction" else ("operation", f'"{value} rpm"')
    control = '[kinematics]\nmodel = "outer race control"\n' if key == "race_friction" else ""
    path.write_text(
        f'extends = "cryogenic-turbopump"\n[{section}]\n{key} = {text}\n{control}', encoding="utf-8"
    )
    assert main(["mobility", str(path), "--json"]) == 2
    assert words in capsys.readouterr().err


def test_a_worn_film_is_warned_of():
    """Its friction is not in the slip fields."""
    study = separatrix.read_study("cryogenic-turbopump")
    wear = Wear(width=0.2e-3, friction=0.3, races=Worn.INNER)
    with pytest.warns(ValidityWarning, match="The film is worn: the mobility"):
        found = separatrix.solve(replace(study, film=replace(study.film, wear=wear))).mobility
    assert np.isfinite(found.force_law).all()


def test_mass_that_an_impact_feels():
    """Half of a thin ring's; of a given moment of inertia 1/(1/M + R^2/J)."""
    study = separatrix.read_study("cryogenic-turbopump")
    assert separatrix.solve(study).impact_mass == pytest.approx(12.5e-3)
    outward = replace(study, cage=replace(study.cage, moment_of_inertia=3.6e-5))
    by_hand = 1.0 / (1.0 / 25e-3 + 32.5e-3**2 / 3.6e-5)
    found = separatrix.solve(outward).impact_mass
    assert found == pytest.approx(by_hand, rel=1e-12)  # rounding of the same formula
    with pytest.raises(InputError, match=r"\[cage\]"):
        _ = separatrix.solve(replace(study, cage=None)).impact_mass
