"""What is special in the pages of stability curves, maps and sweeps: cases of sentences, data of figures."""

import pytest

from separatrix.ground.document import part_of
from separatrix.verbs.map import map_figure, nearest_words, unchanged
from separatrix.verbs.parts.quantity_text import is_proportional, quantity
from separatrix.verbs.parts.verdict_blocks import linear_law, pocket_friction
from separatrix.verbs.sweep import SHOWN, case_table, envelope_figure, worst_words


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
    y = {"parameter": "film.race_friction", "unit": "-", "values": [0.1, 0.3], "here": 0.25}
    found = {"x": x, "y": y, "points": points, "changes": [change], "kick": 0.5, "title": "A map"}
    return part_of({**found, "study": {"film": {"is_bare": True}}, "units": {"kick": "m/s"}, **more})


def test_a_map_says_what_is_next_to_the_study_and_where_it_changes():
    """The nearest point with its runs, and both ends of a change in its column."""
    words = nearest_words(mapped())
    assert words.startswith(
        "The point next to the study: film thickness 1 \N{MICRO SIGN}m, race friction 0.3: "
    )
    assert words.endswith("the cage begins to whirl between race friction 0.1 and 0.3.")
    assert nearest_words(mapped(changes=[])).endswith("6 runs.")
    assert [*unchanged(mapped(changes=[]))] == []
    calm = [one.values | {"probability_high": 0.3} for one in mapped().points]
    assert [*unchanged(mapped(changes=[], points=calm))] == [("Whirls nowhere", "at 1 \N{MICRO SIGN}m")]


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
    return part_of(
        {**found, "parameters": parameters, "study": {"film": {"is_bare": True}}, "units": units, **more}
    )


def test_a_long_sweep_is_cut_to_its_worst_cases():
    """A workbook has all of them."""
    assert [row.case for row in case_table(swept(50)).rows] == [49 - i for i in range(SHOWN)]


def test_cases_that_are_alike_have_no_worst():
    """Then the number that they share is stated, and no line is drawn."""
    worst = {"case": 0, "quantity": "restitution_factor", "compared": 3, "alike": 3}
    assert worst_words(swept(worst=worst)).startswith("No case is the worst: all 3 with an answer have the ")
    alike, other = (len(envelope_figure(one).panels[0].marks) for one in (swept(worst=worst), swept()))
    assert other == alike + 1


def test_an_envelope_has_a_curve_for_each_value_of_the_other_inputs():
    """Over the first input where it rises along each curve; else over the numbers of the cases."""
    grid = swept(4)
    for case, (thickness, friction) in zip(
        grid.values["cases"], [(1, 2), (1, 3), (4, 2), (4, 3)], strict=True
    ):
        case |= {"film.thickness": 1e-6 * thickness, "film.race_friction": friction}
    grid.values["parameters"].append({"name": "film.race_friction", "unit": "-"})
    (panel,) = envelope_figure(grid).panels
    assert [one.x for one in panel.marks[:2]] == [[1e-6, 4e-6]] * 2
    assert [one.name for one in panel.marks[:2]] == ["race friction 2", "race friction 3"]
    grid.values["parameters"].pop()
    first, frequencies = envelope_figure(grid).panels
    assert [one.x.label for one in (first, frequencies)] == ["case [-]"] * 2
    assert [one.marker for one in envelope_figure(swept(1)).panels[0].marks[:1]] == ["o"]
