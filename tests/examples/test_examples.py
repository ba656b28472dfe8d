"""Every script in examples/ runs, gives its answer and its figure, and uses public names only.

The examples in docstrings run, too.
"""

import doctest
import importlib
import re
import runpy
from pathlib import Path

import matplotlib.pyplot as plt
import nbformat
import pytest
from nbclient import NotebookClient

import separatrix

FOLDER = Path(__file__).parents[2] / "examples"
SCRIPTS = sorted(path.name for path in FOLDER.glob("*.py"))
FALLING = "each below the one before"
ANSWERS = {
    # regressions carry the digits that the answer prints, or the error that it states
    "01_bearing.py": ("heaviest", pytest.approx(533.483, abs=0.0005)),  # N
    "02_traction.py": ("ratio", pytest.approx(0.974, abs=0.003)),
    "03_restitution.py": ("eta", pytest.approx(0.7367, abs=5e-5)),  # four digits computed independently
    "04_stability.py": ("frictions", FALLING),
    "05_ranking.py": ("order", ["Armalon", "My compound", "PEEK 450 GL 30"]),
    "06_sweep.py": ("factors", FALLING),  # a thicker film is more compliant
    "07_one_run.py": ("outcome", "SETTLES"),
    # the closed form of a sphere; both to rounding
    "08_contacts.py": ("ratio", pytest.approx(1.0, rel=1e-12)),
    "09_resume.py": ("same", True),
    "10_uncertain.py": ("probabilities", {"Armalon": 32 / 32, "PEEK 450 GL 30": 19 / 32}),
    # the digits given
    "11_film.py": ("highest", pytest.approx([0.0, 0.0203, 0.2735, 0.5605, 0.7044], abs=5e-5)),
    # values of the axis, to rounding
    "12_map.py": ("lowest", pytest.approx([0.3, 0.3, 0.25])),
    # the friction that the log was made with, to twice its stated half width
    "13_tribometer.py": ("steady", pytest.approx(0.12, abs=0.0006)),
    # the digits printed
    "14_parameter_study.py": ("at_full_speed", pytest.approx([0.183, 0.271, 0.342], abs=5e-4)),
    "15_compare_designs.py": ("best", "Armalon"),
    # Kalker's published 4.12 of a circle at nu 0.25: half a digit, and 0.5 % of 28 columns
    "17_contact.py": ("c11", pytest.approx(4.12, abs=0.005 + 0.005 * 4.12)),
    # strips know neither the coupling across the edges of the band: 0.05 (docs/theory/strips-or-exact.md)
    "18_worn_track.py": ("farthest", pytest.approx(0.025, abs=0.025)),
    # rad/s, the digits printed
    "16_saved_data.py": ("spread", pytest.approx(2.48, abs=0.005)),
}


def test_every_script_has_its_answer():
    """A new script comes with what it must give."""
    assert set(SCRIPTS) == set(ANSWERS)


@pytest.mark.parametrize("script", SCRIPTS)
def test_a_script_runs_and_gives_its_answer_and_figure(script):
    """Run top to bottom, as a reader would."""
    left = runpy.run_path(str(FOLDER / script))
    plt.close("all")
    assert left["figure"].axes
    name, expected = ANSWERS[script]
    if expected is FALLING:
        assert left[name] == sorted(left[name], reverse=True)
    else:
        assert left[name] == expected


@pytest.mark.parametrize("script", SCRIPTS)
def test_a_script_uses_public_names_only(script):
    """What a reader copies is the public interface."""
    text = (FOLDER / script).read_text(encoding="utf-8")
    assert not re.findall(r"from separatrix|import separatrix\.", text)
    assert set(re.findall(r"\bseparatrix\.(\w+)\(", text)) <= set(dir(separatrix))


SOURCE = Path(separatrix.__file__).parent
SHOWN = [
    path for path in SOURCE.rglob("*.py") if re.search(r"^\s*>>>", path.read_text(encoding="utf-8"), re.M)
]


@pytest.mark.parametrize("path", SHOWN, ids=lambda path: str(path.relative_to(SOURCE)))
def test_the_examples_of_a_docstring_print_what_they_say(path):
    """What `help` shows is what a reader gets."""
    name = ".".join(path.relative_to(SOURCE.parent).with_suffix("").parts)
    found = doctest.testmod(importlib.import_module(name))
    assert found.attempted
    assert not found.failed


# The notebooks of the documentation run from start to end, and are stored without what they print.

NOTEBOOKS = sorted((Path(__file__).parents[2] / "docs" / "notebooks").glob("*.ipynb"))


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_and_is_stored_without_outputs(path, monkeypatch):
    """Each ends without an error and shows text and a figure."""
    notebook = nbformat.read(path, as_version=4)
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert not [cell for cell in cells if cell.outputs or cell.execution_count]
    monkeypatch.delenv("MPLBACKEND", raising=False)  # else the kernel does not show figures
    NotebookClient(notebook, timeout=600, kernel_name="python3").execute()
    shown = [output for cell in cells for output in cell.outputs]
    assert any("image/png" in output.get("data", {}) for output in shown)
    assert any(output.output_type == "stream" and output.name == "stdout" for output in shown)
    assert not [output.text for output in shown if output.output_type == "stream" and output.name == "stderr"]
