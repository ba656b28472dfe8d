"""What is special in the pages of stability curves, maps and sweeps: cases of sentences, data of figures."""

import csv
import io

import pytest

from separatrix.ground.document import Part, part_of
from separatrix.verbs.map import map_figure, nearest_words, rows
from separatrix.verbs.parts.curve_blocks import band_words, linear_law, pocket_friction
from separatrix.verbs.parts.quantity_text import is_proportional, quantity
from separatrix.verbs.sweep import case_tables, csv_text, envelope_figure, worst_words

POINT = {"critical_friction_low": 0.1, "critical_friction_high": 0.3}


@pytest.mark.parametrize(
    ("lacks", "sentence"),
    [
        ((), "From every disturbance runs settle or roll below 0.1; they whirl from every one above 0.3."),
        (
            ("critical_friction_high",),
            "From every disturbance runs settle or roll below 0.1; up to 1 there is none above which they "
            "whirl from every one.",
        ),
        (
            ("critical_friction_low",),
            "There is no friction at which runs settle or roll from every disturbance; they whirl from every "
            "one above 0.3.",
        ),
    ],
)
def test_a_band_may_lack_an_end(lacks, sentence):
    """An end of the band that was not found is stated, and is not a dash in a sentence."""
    at = part_of({**POINT, **dict.fromkeys(lacks)})
    assert band_words(part_of({"searched_friction": 1.0}), at) == sentence


def test_the_linear_law_is_that_of_the_physics():
    """The line of the picture is twice the damping ratio times sqrt(2/Z), as `linear_critical_friction`."""
    from separatrix.chain.impact_restitution import restitution_factor

    law = linear_law(2.0)
    for eta, friction in zip(law.x[1:-1:20], law.y[1:-1:20], strict=True):
        assert restitution_factor(friction / 2.0) == pytest.approx(eta, rel=1e-12)


@pytest.mark.parametrize(
    ("stated", "friction", "words"),
    [(0.08, 0.08, "0.08"), (None, 0.05, "0.05, that of PEEK in vacuum"), (None, 0.0, "")],
)
def test_the_friction_of_a_cage_says_whose_it_is(stated, friction, words):
    """It is the study's, or its candidate's; a cage of unknown friction has 0 and is not told to have it."""
    cage = {"ball_cage_friction": {"value": stated}, "material": {"name": "PEEK"}}
    study = {"cage": cage, "ranking": {"environments": ["vacuum"], "environment": {"value": None}}}
    assert pocket_friction(part_of({"study": study, "cage": {"ball_cage_friction": friction}})) == words


def test_a_key_of_a_study_is_told_by_its_words():
    """Its section stands before it where the key needs it."""
    names = ("film.thickness", "operation.inner_speed", "film.race_friction", "film.wear.depth")
    labels = ["film thickness", "inner speed", "race friction", "film wear depth"]
    assert [quantity(name).label for name in names] == labels


def test_values_in_proportion_make_a_logarithmic_axis():
    """A steady step does not, nor do values from 0."""
    assert is_proportional([1.0, 2.0, 4.0, 8.0])
    assert not is_proportional([1.0, 2.0, 3.0, 4.0])
    assert not is_proportional([0.0, 1.0, 2.0])


def mapped(**more):
    """A map of two columns: one that changes at 0.2, one without a run, of which a point was refused."""
    run = {"state": "RUN", "runs": 6, "probability_low": 0.0, "probability_high": 0.3, "reason": "calm"}
    run |= {"decision": "STABLE", "probability_whirl": 0.0}
    wild = run | {"decision": "UNSTABLE", "probability_whirl": 1.0, "probability_low": 0.7}
    none = {"state": "REFUSED", "runs": 0, "reason": "too thin", "decision": None, "probability_whirl": None}
    column = [run | {"x": 1e-6, "y": 0.1}, wild | {"x": 1e-6, "y": 0.3, "probability_high": 1.0}]
    points = [*column, none | {"x": 2e-6, "y": 0.1}, none | {"x": 2e-6, "y": 0.3, "state": "NOT_RUN"}]
    change = {"x": 1e-6, "y_low": 0.1, "y_high": 0.3, "whirls_above": True, "margin": -0.1}
    x = {"parameter": "film.thickness", "unit": "m", "values": [1e-6, 2e-6], "here": 1.2e-6}
    y = {"parameter": "film.race_friction", "unit": "-", "values": [0.1, 0.3], "here": 0.4}
    found = {"x": x, "y": y, "points": points, "changes": [change], "kick": 0.5, "title": "A map"}
    return part_of({**found, "study": {}, "units": {"kick": "m/s"}, **more})


def test_a_map_says_where_it_changes_next_to_the_study():
    """The nearest column is told with both ends of its change."""
    words = nearest_words(mapped())
    assert words.startswith(
        "Next to the study, at film thickness 1 \N{MICRO SIGN}m, the cage begins to whirl "
    )
    assert "between race friction 0.1 and 0.3." in words
    assert [row.kind for row in rows(mapped(), [1e-6, 2e-6])] == ["whirls above", "was not finished"]


@pytest.mark.parametrize("count", [10, 40])
def test_the_rows_of_a_map_look_at_each_point_once(count, monkeypatch):
    """However many columns: an interrupted map of ten thousand points has two seconds for its page."""
    made, usual = [], Part.__init__
    monkeypatch.setattr(Part, "__init__", lambda self, *given: made.append(usual(self, *given)))
    places = range(count)
    points = [{"x": x, "y": y, "state": "NOT_RUN", "runs": 0} for x in places for y in places]
    found = rows(part_of({"points": points}), places)
    assert [row.kind for row in found] == ["was not finished"] * count
    assert len(made) == 1 + count**2


def test_every_point_of_a_map_has_its_values_to_point_at():
    """Values and reason stand at each cell, upward in y; what has no share is a gap, a refusal hatched."""
    cells, hatched = map_figure(mapped()).panels[0].marks[:2]
    assert cells.values == [[0.0, None], [1.0, None]]
    assert cells.hover[1][
        0
    ] == "film thickness 1 \N{MICRO SIGN}m, race friction 0.3: UNSTABLE; share that " + (
        "whirls 1 (0.7 to 1), 6 runs"
    )
    assert cells.hover[0][1].endswith("too thin")
    assert hatched.where == [[False, True], [False, False]]


def swept(count=3, **more):
    """Cases of a sweep whose restitution factor rises."""
    cases = [
        {"case": i, "film.thickness": 1e-6 * (i + 1), "restitution_factor": 0.1 * i, "cage_speed": 10.0}
        | {"shaft_frequency": 50.0, "verdict": None, "reason": "", "orbit_frequency": None}
        for i in range(count)
    ]
    worst = {"case": count - 1, "quantity": "restitution_factor", "compared": count, "alike": 1}
    found = {"cases": cases, "worst": worst, "margins": False, "verdicts": False, "title": "A sweep"}
    units = {"cases": {"film.thickness": "m", "restitution_factor": "-", "shaft_frequency": "Hz"}}
    parameters = [{"name": "film.thickness", "unit": "m"}]
    return part_of({**found, "parameters": parameters, "study": {}, "units": units, **more})


def test_a_screen_has_the_worst_cases():
    """A long sweep is cut to the worst ones on a screen; a workbook has all of them."""
    brief, _, sheet = case_tables(swept(50))
    assert [row.case for row in brief.rows[:3]] == [49, 48, 47]
    assert len(sheet.rows) == 50


def test_cases_that_are_alike_have_no_worst():
    """Then the number that they share is stated, and no line is drawn."""
    worst = {"case": 0, "quantity": "restitution_factor", "compared": 3, "alike": 3}
    assert worst_words(swept(worst=worst)).startswith("No case is the worst: all 3 with an answer have the ")
    alike, other = (len(envelope_figure(one).panels[0].marks) for one in (swept(worst=worst), swept()))
    assert other == alike + 1


def test_the_table_of_cases_is_written_with_units():
    """A row for each case in SI units; what is absent is empty."""
    head, first, *_ = csv.reader(io.StringIO(csv_text(swept())))
    assert head[:3] == ["case", "film.thickness [m]", "restitution_factor [-]"]
    assert first == ["0", "1e-06", "0.0", "10.0", "50.0", "", "", ""]
