"""Every wrong question of sensitivity, next test or inverse is refused with one line."""

from dataclasses import replace

import numpy as np
import pytest
from asked import Answer, answer, inputs, question

from separatrix.distribution import Normal
from separatrix.errors import InputError
from separatrix.sensitivity import (
    Case,
    Factor,
    FilmAxis,
    Input,
    Measurement,
    Question,
    RestitutionGrid,
    allowed_friction,
    fitted_question,
    next_test,
    sampled_design,
    sampled_values,
    sobol_indices,
    stable_regions,
)
from separatrix.sensitivity.design import evaluated

KNOWN = (Normal(mean=0.5, standard_deviation=0.05), Normal(mean=0.1, standard_deviation=0.01))
CASES = (Case(candidate="A", environment="gas", friction=1),)
ASKED = question(KNOWN, lambda x: 0.6 - x[:, 1] - x[:, 0], cases=CASES)
VALUES = sampled_values(ASKED, 128)
DESIGN = sampled_design(ASKED, 128)
X = FilmAxis(name="film.thickness", words="film thickness", unit="m", values=np.array([0.0, 1e-6]), own=5e-7)
Y = FilmAxis(
    name="film.race_friction", words="race friction", unit="-", values=np.array([0.05, 0.2]), own=0.1
)
GRID = RestitutionGrid(x=X, y=Y, restitution_factor=np.array([[0.1, 0.05], [0.6, 0.5]]))


def answering(margin=None, threshold=None, verdict=None):
    """A model whose answer has one part replaced."""

    def evaluate(values):
        whole = answer(np.ones((len(values), 1)))
        parts = {"margin": margin, "threshold": threshold, "verdict": verdict}
        given = {name: one(len(values)) for name, one in parts.items() if one is not None}
        return Answer(**{name: given.get(name, getattr(whole, name)) for name in parts})

    return Question(inputs=inputs(*KNOWN), cases=CASES, evaluate=evaluate)


def with_one(value):
    """A margin with one number replaced."""

    def margin(count):
        found = np.ones((count, 1))
        found[3] = value
        return found

    return margin


def group(*places):
    """A group of inputs."""
    return Factor(name="group", words="the group", inputs=places)


WRONG = [
    (
        "samples not a power of two",
        lambda: sobol_indices(ASKED, 1000),
        "power of two",
        "got 1000",
        "Write 4096.",
    ),
    ("too few samples", lambda: sobol_indices(ASKED, 64), "from 128 to 1048576", "got 64"),
    ("no samples", lambda: sobol_indices(ASKED, 0), "samples must be a power of two", "got 0"),
    ("negative samples", lambda: sobol_indices(ASKED, -4096), "got -4096"),
    ("too many samples", lambda: sobol_indices(ASKED, 2**30), "got 1073741824"),
    ("samples with a fraction", lambda: sampled_values(ASKED, 4096.0), "got 4096.0"),
    ("samples as text", lambda: sampled_values(ASKED, "4096"), 'got "4096"'),
    ("samples as truth", lambda: sampled_values(ASKED, True), "got true"),
    (
        "a group of an input that is not there",
        lambda: sobol_indices(ASKED, 128, factors=[group(7)]),
        "0 to 1",
        "got 7",
    ),
    ("a group of a negative place", lambda: sobol_indices(ASKED, 128, factors=[group(-1)]), "got -1"),
    (
        "an input in two groups",
        lambda: sobol_indices(ASKED, 128, factors=[group(0), group(0, 1)]),
        "x0 stands twice",
        "Leave it in one.",
    ),
    (
        "an input twice in a group",
        lambda: sobol_indices(ASKED, 128, factors=[group(1, 1)]),
        "x1 stands twice",
    ),
    ("no inputs", lambda: replace(ASKED, inputs=()), "Question.inputs must hold at least one"),
    ("no cases", lambda: replace(ASKED, cases=()), "Question.cases must hold at least one"),
    (
        "a friction that is no input",
        lambda: replace(ASKED, cases=(Case(candidate="A", environment="", friction=5),)),
        "Case A must name inputs by their places, 0 to 1",
        "got 5",
    ),
    (
        "an input of a case that is not there",
        lambda: replace(ASKED, cases=(Case(candidate="A", environment="", inputs=(0, -2)),)),
        "got -2",
    ),
    (
        "a candidate without a name",
        lambda: Case(candidate="", environment="gas"),
        "Case.candidate must be printable",
    ),
    (
        "an input whose name breaks the line",
        lambda: Input(name="a\nb", words="a", unit="-", distribution=KNOWN[0]),
        "Input.name must be printable",
        "a\\x0ab",
    ),
    (
        "an input without words",
        lambda: Input(name="a", words="", unit="-", distribution=KNOWN[0]),
        "Input.words must be printable",
    ),
    (
        "margins of a wrong shape",
        lambda: sampled_design(answering(margin=lambda n: np.ones((n, 3))), 128),
        "The model's margin must have the shape (128, 1)",
        "got (128, 3)",
    ),
    (
        "thresholds of a wrong shape",
        lambda: sampled_design(answering(threshold=lambda n: np.ones(n)), 128),
        "The model's threshold must have the shape",
    ),
    (
        "verdicts of a wrong shape",
        lambda: sampled_design(answering(verdict=lambda n: np.ones((n - 1, 1))), 128),
        "The model's verdict must have the shape",
    ),
    (
        "a margin that is no number",
        lambda: sampled_design(answering(margin=with_one(np.nan)), 128),
        "must be finite in all 128 samples",
        "got 1 that are not",
    ),
    (
        "a margin without end",
        lambda: sampled_design(answering(margin=with_one(np.inf)), 128),
        "must be finite",
    ),
    (
        "a measurement of no input",
        lambda: next_test(ASKED, DESIGN, [Measurement(input=2)]),
        "0 to 1",
        "got 2",
    ),
    ("a measurement of a negative place", lambda: Measurement(input=-1), "Measurement.input", "got -1"),
    ("a measurement of an input by name", lambda: Measurement(input="x0"), "Measurement.input", 'got "x0"'),
    (
        "a measurement without error",
        lambda: Measurement(input=0, error=0.0),
        "Measurement.error must be > 0",
        "A tenth is 0.1",
    ),
    (
        "a negative error",
        lambda: Measurement(input=0, error=-0.1),
        "Measurement.error must be > 0",
        "got -0.1",
    ),
    ("an error in per cent", lambda: Measurement(input=0, error=20.0), "must be <= 10", "A tenth is 0.1"),
    (
        "an error that is no number",
        lambda: Measurement(input=0, error=float("nan")),
        "must be a finite number > 0",
    ),
    ("no repeats", lambda: Measurement(input=0, repeats=0), "whole number from 1 to 1000", "got 0"),
    ("half a repeat", lambda: Measurement(input=0, repeats=1.5), "whole number from 1 to 1000", "got 1.5"),
    ("more than all reducible", lambda: Measurement(input=0, reducible=1.2), "between 0 and 1", "got 1.2"),
    ("less than none reducible", lambda: Measurement(input=0, reducible=-0.1), "between 0 and 1", "got -0.1"),
    (
        "a probability of one",
        lambda: allowed_friction(ASKED, VALUES, probability=1.0),
        "0.5 and 0.9999 [-]",
        "got 1.0",
    ),
    ("a probability in per cent", lambda: allowed_friction(ASKED, VALUES, probability=95), "got 95"),
    ("a probability as text", lambda: allowed_friction(ASKED, VALUES, probability="0.95"), 'got "0.95"'),
    (
        "a probability that is no number",
        lambda: allowed_friction(ASKED, VALUES, probability=float("nan")),
        "between 0.5 and 0.9999",
        "got nan",
    ),
    (
        "a negative scatter",
        lambda: allowed_friction(ASKED, VALUES, scatter=-0.09),
        "scatter must lie",
        "got -0.09",
    ),
    (
        "a scatter in per cent",
        lambda: allowed_friction(ASKED, VALUES, scatter=9),
        "scatter must lie",
        "got 9",
    ),
    (
        "nothing searched",
        lambda: allowed_friction(ASKED, VALUES, searched=0.0),
        "searched must lie",
        "got 0.0",
    ),
    (
        "frictions of 10",
        lambda: allowed_friction(ASKED, VALUES, searched=10.0),
        "searched must lie",
        "got 10.0",
    ),
    (
        "a region of a wrong probability",
        lambda: stable_regions(ASKED, VALUES, GRID, probability=0.2),
        "got 0.2",
    ),
    (
        "a film axis of one value",
        lambda: replace(X, values=np.array([1e-6])),
        "at least two values, finite and rising",
    ),
    ("a film axis that falls", lambda: replace(X, values=np.array([2e-6, 1e-6])), "film.thickness must have"),
    ("a film axis that stands", lambda: replace(X, values=np.array([1e-6, 1e-6])), "finite and rising"),
    ("a film axis with no number", lambda: replace(X, values=np.array([0.0, np.nan])), "finite and rising"),
    ("a film axis without a name", lambda: replace(X, name=""), "FilmAxis.name must be printable"),
    (
        "a grid of a wrong shape",
        lambda: replace(GRID, restitution_factor=np.zeros((2, 3))),
        "must have the shape (2, 2)",
        "got (2, 3)",
    ),
    (
        "a grid that returns everything",
        lambda: replace(GRID, restitution_factor=np.ones((2, 2))),
        "0 <= eta < 1",
    ),
    ("a grid below zero", lambda: replace(GRID, restitution_factor=-np.ones((2, 2))), "0 <= eta < 1"),
    (
        "a grid with no number",
        lambda: replace(GRID, restitution_factor=np.full((2, 2), np.nan)),
        "0 <= eta < 1",
    ),
    (
        "a grid without race friction",
        lambda: replace(GRID, y=replace(Y, values=np.array([0.0, 0.1]))),
        "must have x >= 0 and y > 0",
    ),
    (
        "a grid of a negative thickness",
        lambda: replace(GRID, x=replace(X, values=np.array([-1e-6, 1e-6]))),
        "must have x >= 0 and y > 0",
    ),
    (
        "a fit without a judge",
        lambda: fitted_question(replace(ASKED, judge=None), VALUES, evaluated(ASKED, VALUES)),
        "The model cannot be asked for another friction or film",
        "Give it a judge",
    ),
    (
        "frictions without a judge",
        lambda: allowed_friction(replace(ASKED, judge=None), VALUES),
        "Give it a judge",
    ),
    (
        "films without a judge",
        lambda: stable_regions(replace(ASKED, judge=None), VALUES, GRID),
        "Give it a judge",
    ),
]


@pytest.mark.parametrize(
    ("call", "words"), [(one[1], one[2:]) for one in WRONG], ids=[one[0] for one in WRONG]
)
def test_a_wrong_question_is_refused_with_one_line(call, words):
    """The rule, what was given and the cure, a line a fault, before anything is computed."""
    with pytest.raises(InputError) as caught:
        call()
    text = str(caught.value)
    assert all(len(line) < 400 for line in text.splitlines())
    for word in words:
        assert word in text
