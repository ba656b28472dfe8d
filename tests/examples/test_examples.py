"""Every script in examples/ runs, and gives its answer."""

import runpy
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[2] / "examples"
SCRIPTS = sorted(path.name for path in FOLDER.glob("*.py"))
ANSWERS = {
    "01_bearing.py": ("heavier", pytest.approx(69.8277, rel=1e-4)),  # N, regression
    "02_traction.py": ("ratio", pytest.approx(0.7185, abs=0.003)),  # regression, to the slopes' own error
    "03_restitution.py": ("eta", pytest.approx(0.7367, abs=5e-5)),  # four digits computed independently
    "04_stability.py": ("frictions", None),
    "05_ranking.py": ("order", ["Armalon", "My compound", "PEEK 450 GL 30"]),
    "06_sweep.py": ("factors", None),  # a thicker film yields more, and takes more of the speed
    "07_simulation.py": ("outcome", "WHIRLS"),
    # the closed form of a sphere; both to rounding
    "08_contact.py": ("ratio", pytest.approx(1.0, rel=1e-12)),
    "09_going_on.py": ("same", True),
    "10_uncertain.py": ("probabilities", {"Vespel SP-3": 26 / 32, "Phenolic, dry": 7 / 32}),  # regression
    # regression, to the digits given
    "11_film.py": ("highest", pytest.approx([0.0, 0.0203, 0.2735, 0.5605, 0.7044], abs=5e-5)),
}


def test_every_script_has_its_answer():
    """A new script comes with what it must give."""
    assert set(SCRIPTS) == set(ANSWERS)


@pytest.mark.parametrize("script", SCRIPTS)
def test_a_script_runs_and_gives_its_answer(script):
    """Run top to bottom, as a reader would."""
    left = runpy.run_path(str(FOLDER / script))
    name, expected = ANSWERS[script]
    if expected is None:
        assert left[name] == sorted(left[name], reverse=True)
    else:
        assert left[name] == expected
