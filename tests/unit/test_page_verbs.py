"""What is special in the pages of verbs: cases of sentences, data of figures, the bearing to scale."""

import pytest

from separatrix.chain.impact_restitution import restitution_factor
from separatrix.ground.document import part_of
from separatrix.present.figure import Trace
from separatrix.present.text import text
from separatrix.study.reading import read_study
from separatrix.verbs import computed, verb_named
from separatrix.verbs.answer_files import document
from separatrix.verbs.map import map_figure, nearest_words, unchanged
from separatrix.verbs.parts.bearing_drawing import CAGE, bearing_picture, section_of
from separatrix.verbs.parts.verdict_blocks import linear_law, pocket_friction
from separatrix.verbs.sweep import SHOWN, case_table, envelope_figure, worst_words

SHIPPED = "cryogenic-turbopump"


def answer(verb, study):
    """Document of an answer, as a part."""
    found = verb_named(verb)
    return part_of(document(found, computed(found, study)))


@pytest.fixture(scope="module")
def restitution():
    """Answer of the shipped study."""
    return answer("restitution", read_study(SHIPPED))


def changed(tmp_path, name, *edits, more=""):
    """A shipped study with other text in it."""
    from importlib.resources import files

    text = files("separatrix.examples").joinpath(f"{name}.toml").read_text(encoding="utf-8")
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    (tmp_path / "changed.toml").write_text(text + more, encoding="utf-8")
    return read_study(tmp_path / "changed.toml")


SOFT = ('thickness = "1 um"', 'thickness = "50 um"\nelastic_modulus = "20 MPa"\npoisson_ratio = 0.3')
SPUTTERED = ('material = "MoS2 sputtered dense"', "")


@pytest.mark.parametrize(
    ("traction", "refusing"),
    [
        ('model = "exact"', ["traction", "restitution", "mobility"]),
        ('pressure = "coated"', []),  # Hertz's pressure, by which it compares, is beyond this film
        ('model = "strips"', []),
    ],
)
def test_check_names_the_verbs_that_refuse_a_soft_film(tmp_path, traction, refusing):
    """Each claim is that of the verb itself, and a verb that is not named answers."""
    study = changed(tmp_path, "momentum-wheel", SOFT, SPUTTERED, more=f"\n[traction]\n{traction}\n")
    found = [one for one in answer("check", study).refusals if one.verb in ("traction", "restitution")]
    assert [one.verb for one in found] == [one for one in refusing if one != "mobility"]
    for verb in ("traction", "restitution", "mobility"):
        said = [*verb_named(verb).refusals(study)]
        assert bool(said) == (verb in refusing)
        if said:
            with pytest.raises(ValueError, match="film strain") as refused:
                computed(verb_named(verb), study)
            assert said == [str(refused.value)]
        else:
            outside = getattr(computed(verb_named(verb), study).record, "outside", ())
            is_noted = any(one.startswith("Under Hertz's pressure") for one in outside)
            assert is_noted == ("coated" in traction and verb == "traction")


STEEP = ('contact_angle = "15 deg"', 'contact_angle = "45 deg"')
TIGHT = ("inner_conformity = 0.57", "inner_conformity = 0.508")
FAST = ('inner_speed = "6000 rpm"', 'inner_speed = "60000 rpm"')
HOT = ('temperature = "20 degC"', 'temperature = "400 degC"')
AT_REST = ("[cage]", '[cage]\nclearances = "at rest, 293 K"')


@pytest.mark.parametrize(
    ("edits", "more", "words"),
    [
        ((STEEP, TIGHT, FAST), "", "out of their grooves"),
        ((SOFT, SPUTTERED), '\n[traction]\nmodel = "exact"\n', "film strain"),
        ((HOT, AT_REST), "", "needs its thermal expansion"),
    ],
    ids=["no equilibrium", "soft film", "no clearances"],
)
def test_check_says_what_a_moving_cage_will_be_refused_for(tmp_path, edits, more, words):
    """In the words of the verb itself, before anything is run."""
    study = changed(tmp_path, "momentum-wheel", *edits, more=more)
    said = {(one.verb, one.sentence) for one in answer("check", study).refusals}
    for verb in ("stability", "map", "simulate", "rank", "sensitivity"):
        with pytest.raises(ValueError, match=words) as refused:
            computed(verb_named(verb), study)
        assert (verb, str(refused.value)) in said


def test_a_verb_that_lacks_a_section_is_refused_for_that():
    """Every verb of a cage, where the study has none, and the first sentence says so."""
    found = answer("check", read_study("le7"))
    assert {one.verb for one in found.refusals} == {
        *("restitution", "stability", "map", "simulate", "rank", "sensitivity", "life")
    }
    lead = verb_named("check").page(found).lead[0]
    assert lead.startswith("The study is valid. It has no [cage] and no [ranking]. `restitution`,")


@pytest.mark.parametrize(
    ("clearance", "first"), [('"1 mm"', "after"), ('"0.6 mm"', "together with"), ('"0.2 mm"', "before")]
)
def test_what_a_cage_reaches_first(tmp_path, clearance, first):
    """The radial gap of the land against half the clearance of a pocket."""
    study = changed(tmp_path, SHIPPED, ('land_clearance = "1 mm"', f"land_clearance = {clearance}"))
    assert f"reached {first} the pockets" in text(verb_named("check").page(answer("check", study)))


def test_films_have_bare_races_apart_and_the_star_at_the_study(restitution):
    """A logarithmic axis has no zero."""
    pictures = [one for one in verb_named("restitution").page(restitution).blocks if hasattr(one, "figure")]
    (panel,) = pictures[0].figure().panels
    traces = [one for one in panel.marks if isinstance(one, Trace)]
    lines, star = [one for one in traces if one.line], traces[-1]
    assert all(min(line.x) > 0.0 for line in lines)
    assert panel.x.ticks[0][1] == "bare"
    assert (star.x, star.y) == ([5e-7], [restitution.restitution_factor])


def test_bare_races_have_no_other_films(restitution):
    """No empty picture, but the reason."""
    none = {"lubrication": None, "lubrication_reason": "The study names no film material."}
    found = part_of({**restitution.values, **none, "units": restitution.units})
    blocks = verb_named("restitution").page(found).blocks
    assert not [one for one in blocks if hasattr(one, "figure")]
    assert any("names no film material" in getattr(one, "text", "") for one in blocks)


def test_the_section_keeps_what_the_study_states(restitution):
    """Clearance of the land, contact angles, ball within its pocket; the cage is dashed."""
    study = restitution.values["study"]
    section = section_of(study)
    assert not section.is_cage_stated
    gap = study["cage"]["land_clearance"]["value"]
    assert section.lands[1] - section.cage[1] == pytest.approx(gap / 2)  # rounding
    assert section.hole > section.ball
    picture = bearing_picture(restitution, restitution)
    assert "contact angle 30.9 deg inner, 25.31 deg outer" in picture.caption
    (panel,) = picture.figure().panels
    assert {one.line for one in panel.marks if one.face == CAGE} == {"--"}


# --- curves, maps, sweeps ------------------------------------------------------------------------
def test_the_linear_law_is_that_of_the_physics():
    """The line of the picture is twice the damping ratio times sqrt(2/Z), as `linear_critical_friction`."""
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
