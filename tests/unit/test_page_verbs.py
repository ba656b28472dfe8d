"""What is special in the pages of verbs: cases of sentences, data of figures, the bearing to scale."""

import json
import re
from importlib.resources import files

import pytest
from commands import extended, log, written
from matplotlib.figure import Figure
from test_reference_tables import missing

from separatrix import InputError, read_study, restitution_factor, wilson_interval
from separatrix.ground.compiling import COMPILING
from separatrix.ground.plain_data import Part, part_of
from separatrix.ground.quantity import Estimate, Quantity, alone, in_column
from separatrix.present.blocks import Level, Picture
from separatrix.present.draw import draw_panel
from separatrix.present.figure import Across, Trace
from separatrix.present.text import text
from separatrix.verbs import bearing, compare, computed, life, tribometer, verb_named
from separatrix.verbs.answer_files import document, read_answer, read_answers, read_folder
from separatrix.verbs.compare import RESULTS, difference_interval, differing, results
from separatrix.verbs.compare import compared as compared_answers
from separatrix.verbs.map import map_figure, nearest_words, unchanged, undecided
from separatrix.verbs.parts.answer_page import entry_words
from separatrix.verbs.parts.chain_blocks import CAGE_COLOUR, bearing_picture, section_of
from separatrix.verbs.parts.verdict_blocks import (
    deciding,
    evidence_column,
    linear_law,
    pocket_friction,
    power_facts,
    verdict_sentences,
)
from separatrix.verbs.rank import by_paper, evidence_head
from separatrix.verbs.stability import friction_words, own_words
from separatrix.verbs.sweep import SHOWN, case_table, envelope_figure, worst_words

SHIPPED = "cryogenic-turbopump"
W = {"rubbing_power": "W"}


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
    text = files("separatrix.examples").joinpath(f"{name}.toml").read_text(encoding="utf-8")
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    return read_study(written(tmp_path, text + more))


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
WARM = ('temperature = "77 K"', 'temperature = "100 K"')
BARE = (('material = "PTFE transfer film"', "# material"), ('thickness = "0.5 um"', "# thickness"))
NO_DENSITY = r"toml, line \d+: \[operation\] fluid has no density near 100 K"
CAGES = "restitution stability map simulate rank sensitivity"
ALL = f"traction mobility {CAGES}"


@pytest.mark.parametrize(
    ("shipped", "edits", "more", "verbs", "words"),
    [
        ("momentum-wheel", (STEEP, TIGHT, FAST), "", ALL, "out of their grooves"),
        ("momentum-wheel", (SOFT, SPUTTERED), '\n[traction]\nmodel = "exact"\n', ALL, "film strain"),
        ("momentum-wheel", (HOT, AT_REST), "", CAGES, "needs its thermal expansion"),
        # liquid nitrogen is known at its boiling point, 77.4 K
        (SHIPPED, (WARM,), "\n[cooling]\nswirl = 0.4\n", "bearing simulate", NO_DENSITY),
        (SHIPPED, BARE, "\n[wear]\nbare_friction = 0.3\n", "life", "is missing: bare races have no film"),
    ],
)
def test_check_says_what_will_be_refused(tmp_path, shipped, edits, more, verbs, words):
    """In the words of the verb itself, before anything is run."""
    study = changed(tmp_path, shipped, *edits, more=more)
    said = {(one.verb, one.sentence) for one in answer("check", study).refusals}
    assert {verb for verb, sentence in said if re.search(words, sentence)} == {*verbs.split()}
    for verb in verbs.split():
        with pytest.raises(ValueError, match=words) as refused:
            computed(verb_named(verb), study)
        assert (verb, str(refused.value)) in said


def test_the_push_of_a_ball_levels_off_where_the_page_states():
    """At the force of the law of traction for any speed beyond its knee; the most is friction times loads."""
    found = computed(verb_named("mobility"), read_study("le7"))
    law = found.record.mobility.traction
    known = document(verb_named("mobility"), found)
    (lead,) = verb_named("mobility").page(part_of(known)).lead
    assert f"levels off at {law.force(1e3 * law.speed):.4g} N." in lead
    assert f"carries at most {found.record.mobility.capacity:.4g} N" in lead
    beyond = {**known, "traction": {**known["traction"], "capacity": 1.01 * known["capacity"]}}
    (fitted,) = verb_named("mobility").page(part_of(beyond)).lead  # a fit above it: not for spin
    assert ("spin takes" in lead, "spin takes" in fitted) == (True, False)


@pytest.mark.parametrize(("half", "words"), [(None, "1.0e+05"), (2e5, "1.0e+05"), (5e4, "")])
def test_a_life_of_stable_cages_states_when_the_film_is_gone(half, words):
    """Unless half of the cages are unstable before; the first race counts."""
    films = [(1e3, 4e-7, 4e-7), (1e4, 1e-7, 3e-7), (1e5, 3e-8, 2e-7), (1e6, 0.0, 0.0)]
    names = ("revolutions", "film_inner", "film_outer")
    course = [Part(dict(zip(names, row, strict=True)), {}) for row in films]
    said = " ".join(life.bare(Part({"course": course, "revolutions_50": half}, {})))
    assert said.startswith(f"But the inner race has lost its film by {words} rev") if words else said == ""


@pytest.mark.parametrize(
    ("chances", "clearance", "words"),
    [
        ((0.9, 0.1, 0.2, 0.35, 0.9), 1e-3, "By 1.0e+04 {}: pockets worn so wide"),
        ((0.0, 0.1, 0.5, 0.9, 0.9), 1e-4, "By 1.0e+03 {}."),
        ((0.9, 0.8, 0.5, 0.4, 0.4), 1e-3, ""),
    ],
)
def test_a_life_states_when_cages_are_stable_again(chances, clearance, words):
    """By when more are so, not from when fewest are; the land takes over from wider pockets alone."""
    rows = [
        Part({"revolutions": 10.0 ** (1 + i), "probability_stable": one, "pocket_clearance": clearance}, {})
        for i, one in enumerate(chances)
    ]
    said = " ".join(life.again(Part({"course": rows, "cage": Part({"land_clearance": 5e-4}, {})}, {})))
    assert said.startswith(words.format("revolutions more are stable again")) if words else said == ""


@pytest.mark.parametrize(
    ("ends", "start", "words"),
    [
        ((0.0, 0.0, 0.0), 1.0, "100 % {} are unstable from the start."),
        ((0.0, 0.0, 3e5), 0.7, "70 % {} are unstable from the start. Nine in ten are so by 3.0e+05"),
        ((0.0, 2e3, 3e5), 0.2, "Half {} have become unstable by 2.0e+03 revolutions, nine in ten"),
    ],
)
def test_a_life_that_begins_unstable_has_no_zero_revolutions(ends, start, words):
    """What is so from the start is a share of the cages."""
    known = dict(zip(("revolutions_10", "revolutions_50", "revolutions_90"), ends, strict=True))
    said = " ".join(life.lead(Part({"candidate": "X", "unstable_at_start": start, **known}, {})))
    assert said.startswith(words.format("of the cages of X"))
    assert "0.0e+00" not in said


@pytest.mark.parametrize(("correlation", "words"), [(-0.09, ""), (-0.1, "Measure first: film wear")])
def test_a_life_that_follows_no_input_asks_for_no_measurement(correlation, words):
    """Of 1024 draws without dependence 99.7 % have a rank correlation below 3/32."""
    driver = Part({"name": "wear.film_wear", "correlation": correlation}, {})
    found = Part({**dict.fromkeys(life.WHY, 0.0), "drivers": [driver], "draws": 1024}, {})
    said = " ".join(life.why(found))
    assert said.startswith(words) if words else said == ""


@pytest.mark.parametrize(("test", "use", "differs"), [(0.9, 0.5, True), (0.5, 0.9, True), (0.9, 0.8, False)])
def test_an_accelerated_test_of_another_cage_is_not_scaled(test, use, differs):
    """Less stable or more: it wears otherwise."""
    names = ("inner_speed", "critical_friction", "film_time", "pocket_time")
    run = Part({**dict.fromkeys(names, 1.0), "probability_stable": test}, {"inner_speed": "rad/s"})
    found = Part({"accelerated": run, "course": [Part({"probability_stable": use}, {})]}, {})
    assert ("do not scale" in " ".join(life.faster(found))) is differs


@pytest.mark.parametrize("speed", ["3000 rpm", "10 rpm"])
def test_check_names_the_verbs_that_take_long(tmp_path, speed):
    """Of a dry wheel, and of one as slow as a gimbal; nothing is compiled."""
    study = extended(tmp_path, f'[operation]\ninner_speed = "{speed}"\n', "dry-reaction-wheel")
    compiled = []
    COMPILING.heard.append(lambda: compiled.append(1))
    found = answer("check", study)
    COMPILING.heard.pop()
    times = {one.verb: one.one_core_time for one in found.long_verbs}
    assert list(times) == ["stability", "rank"]
    if speed == "3000 rpm":  # 145 s were measured, and the constants are near the middle of nine bearings
        assert 100.0 < times["rank"] < 210.0
    lead = verb_named("check").page(found).lead[0]
    assert f"and `rank` takes about {round(times['rank'] / 60.0)} min, within a factor of 3." in lead
    assert compiled == []
    assert not any(answer("check", read_study(one)).long_verbs for one in (SHIPPED, "momentum-wheel", "le7"))


def test_a_fluid_that_no_environment_has_is_in_its_refusal(tmp_path):
    """A mistyped one is not of the library either, and is not refused as such."""
    study = changed(tmp_path, "cryogenic-turbopump", ('fluid = "liquid nitrogen"', 'fluid = "LN3"'))
    with pytest.raises(ValueError, match=r"matches \[operation\] fluid LN3 and 440C\. Write"):
        computed(verb_named("rank"), study)


@pytest.mark.parametrize(("load", "is_pressed"), [("0 N", False), ("10 N", True)])
def test_a_pair_without_external_load_is_not_pressed_by_one(tmp_path, load, is_pressed):
    """Both of its bearings have the preload."""
    pair = f'[operation]\naxial_load = "{load}"\npreload = "150 N"\narrangement = "back-to-back"'
    page = verb_named("bearing").page(answer("bearing", extended(tmp_path, pair, "momentum-wheel")))
    (said,) = (one for one in text(page).splitlines() if "This bearing" in one)
    assert said.endswith(": the external load presses it") is is_pressed


def test_notes_do_not_stand_below_uncertain_inputs_that_are_not_there(tmp_path):
    """A guess that is noted is no such input; one with a distribution has the heading."""
    for mass, there in (("25 g", False), ("25 g +- 10 %", True)):
        keys = f'[cage]\nmass = "{mass}"\npocket_clearance = "0.6 mm"\n{LAND}'
        shown = text(verb_named("check").page(answer("check", extended(tmp_path, keys, "le7"))))
        assert "land_stiffness 10 MN/m" in shown
        assert ("Uncertain inputs" in shown) is there


def test_a_verb_that_lacks_a_section_is_refused_for_that():
    """Every verb of a cage, where the study has none, and the first sentence says so."""
    found = answer("check", read_study("le7"))
    assert {one.verb for one in found.refusals} == {
        *("restitution", "stability", "map", "simulate", "rank", "sensitivity", "life")
    }
    lead = verb_named("check").page(found).lead[0]
    assert lead.startswith("The study is valid. It has no [cage] and no [ranking]. `restitution`,")


@pytest.mark.parametrize(("gap", "first"), [(1, "after"), (0.6, "together with"), (0.2, "before")])
def test_what_a_cage_reaches_first(tmp_path, gap, first):
    """The radial gap of the land against half the clearance of a pocket."""
    study = changed(tmp_path, SHIPPED, ('land_clearance = "1 mm"', f'land_clearance = "{gap} mm"'))
    assert f"reached {first} the pockets" in text(verb_named("check").page(answer("check", study)))


def test_films_have_bare_races_apart_and_the_star_at_the_study(restitution):
    """A logarithmic axis has no zero. Bare races have no other films: no empty picture, but the reason."""
    pictures = [one for one in verb_named("restitution").page(restitution).blocks if hasattr(one, "figure")]
    (panel,) = pictures[0].figure().panels
    traces = [one for one in panel.marks if isinstance(one, Trace)]
    lines, star = [one for one in traces if one.line], traces[-1]
    assert all(min(line.x) > 0.0 for line in lines)
    assert panel.x.ticks[0][1] == "bare"
    assert (star.x, star.y) == ([5e-7], [restitution.restitution_factor])
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
    assert {one.line for one in panel.marks if one.face == CAGE_COLOUR} == {"--"}


# --- curves, maps, sweeps ------------------------------------------------------------------------
def test_the_linear_law_is_that_of_the_physics():
    """The line of the picture is twice the damping ratio times sqrt(2/Z), as `linear_critical_friction`."""
    law = linear_law([(0.0, 2.0)])
    for eta, friction in zip(law.x[1:-1:20], law.y[1:-1:20], strict=True):
        assert restitution_factor(friction / 2.0) == pytest.approx(eta, rel=1e-12)
    # of balls of inertia it is not in proportion to the damping ratio: a 6204 has more at 0.25 than at 0
    law = linear_law(limits := [(0.0, 0.132), (0.125, 0.196), (0.25, 0.215), (0.5, 0.185), (0.75, 0.094)])
    drawn = dict(zip(law.x, law.y, strict=True))
    assert [drawn[eta] for eta, _ in limits] == pytest.approx([at for _, at in limits], rel=1e-12)  # rounding


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


LAND = 'guidance = "outer"\nland_clearance = "1 mm"\nball_cage_stiffness = "3e6 N/m"\n'
CRITICAL = "own_critical_friction"
NO_EFFECT = Part({"effects": None, "candidate": None}, {})


def candidate(verdict="STABLE", critical=(0.248, 0.231, 0.269), friction=0.28):
    """A row of a ranking, of a cage whose land is tighter than its pockets."""
    ends = dict(zip((CRITICAL, f"{CRITICAL}_low", f"{CRITICAL}_high"), critical, strict=True))
    factor = {"safety_factor": None, "safety_factor_low": ends[f"{CRITICAL}_low"] / friction}
    sizes = {"land_clearance": 2e-4, "pocket_clearance": 2.5e-4}
    rest = {"name": "Phenolic", "rank": 1, "friction": friction, "verdict": verdict, "extrapolation": []}
    rest |= {"cage_motion": "SETTLED", "driven_by_land": False}
    return Part({**rest, **sizes, **factor, **ends}, dict.fromkeys(sizes, "m"))


@pytest.mark.parametrize(
    ("row", "wide", "words"),
    [
        (candidate(critical=(0.79, 0.7, 0.9)), (0.14, 0.12, 0.2), "keeps it stable"),
        (candidate("UNSTABLE"), (0.143, 0.121, 0.204), "is not enough for Phenolic"),
        (candidate(critical=(None, 1.0, None)), (0.77, 0.72, 0.81), "raises the critical friction"),
        (candidate(), (0.56, 0.53, 0.62), "and lowers the critical friction"),
        (candidate(), (0.22, 0.2, 0.24), "does not decide"),
        (candidate(), (0.28, 0.26, 0.3), "does not decide"),
        (candidate(), (None, 1.0, None), "and lowers the critical friction"),
    ],
)
def test_the_headline_says_whether_a_tight_land_decides(row, wide, words):
    """It does where a wide land would lower the critical friction, beyond the scatter of the runs."""
    ends = dict(zip((CRITICAL, f"{CRITICAL}_low", f"{CRITICAL}_high"), wide, strict=True))
    effect = {"name": "wide_land", "change": "a land of 0.4 mm", **ends}
    (said,) = deciding(Part({"effects": [effect], "candidate": "Phenolic"}, {}), [row])
    start = "The land stops the cage before its pockets do (land clearance 200 µm, pocket clearance 250 µm)"
    assert said.startswith(start)
    value = "> 1.000" if wide[0] is None else "{:.3f} ({:.3f} to {:.3f})".format(*wide)
    value += ", less than the friction of Phenolic" * (words == "keeps it stable")
    assert said.endswith(
        f"{words}. With a land of 0.4 mm the critical friction of Phenolic would be {value}."
    )


@pytest.mark.parametrize(("friction", "count"), [(0.22, 1), (0.115, 0)])
def test_the_headline_says_whether_uneven_orbits_decide(friction, count):
    """A pump cage was STABLE at 0.22, and without its radial load it whirls from 0.108."""
    ends = dict(zip((CRITICAL, f"{CRITICAL}_low", f"{CRITICAL}_high"), (0.108, 0.1, 0.122), strict=True))
    effect = {"name": "even_orbits", "change": "balls that neither lead nor lag", **ends}
    row = Part(candidate(friction=friction).values | {"land_clearance": None}, {})
    said = [*deciding(Part({"effects": [effect], "candidate": "Armalon"}, {}), [row])]
    words = "friction of Armalon would be 0.108 (0.100 to 0.122), less than the friction of Phenolic."
    assert [one.endswith(words) for one in said] == [True] * count


def test_the_headline_names_a_land_that_drives_the_cage():
    """Not that the pockets decide, that a land so tight is not enough, or that it keeps the cage stable."""
    row = Part(candidate("UNSTABLE").values | {"driven_by_land": True, "safety_factor_low": None}, {})
    rest = {"cage": {"land_friction": 0.157}}
    said = "Phenolic: friction on the land, 0.157, and not in the pockets, drives the whirl."
    assert [*deciding(Part(NO_EFFECT.values | rest, {}), [row])] == [said]
    wide = {"name": "wide_land", "change": "a wide land", CRITICAL: 0.01, f"{CRITICAL}_low": 0.01}
    answer = Part({"effects": [wide | {f"{CRITICAL}_high": 0.01}], "candidate": "Phenolic"} | rest, {})
    assert "which raises the critical friction" in [*deciding(answer, [row])][-1]


def test_heat_of_rubbing_has_the_digits_of_the_headline():
    """It was 10 W of heat below a headline of 10.5 W."""
    values = {"rubbing_force": 3.14, "rubbing_speed": 33.4, "rubbing_power": 10.49}
    row = Part(values | {"pocket_power": 0.0, "land_power": 0.0}, {"rubbing_power": "W"})
    assert power_facts(row)[1][1].endswith("10.5 W of heat")


@pytest.mark.parametrize(("eta", "is_said"), [(0.0, True), (0.3, False)])
def test_an_overdamped_bearing_is_not_the_curve_at_its_restitution_factor(eta, is_said):
    """Both have eta = 0: on the curve half of the runs whirl at no friction, in the bearing at 0.487."""
    (said,) = own_words(Part({"here": {"restitution_factor": eta, "critical_friction": 0.487}}, {}))
    assert ("overdamped: its race damping is below that of the curve at 0" in said) is is_said


@pytest.mark.parametrize(("side", "most"), [("BELOW", "fewer"), ("ABOVE", "more")])
def test_a_cage_without_a_critical_friction_has_its_friction_placed(side, most):
    """A cage of 0.08 whirls at no friction up to 1, and the answer on it had no word of 0.08."""
    found = {"here": {"side": side}, "cage": {"ball_cage_friction": 0.08}, "units": {}}
    (said,) = friction_words(part_of(found | {"study": {"cage": {"ball_cage_friction": {"value": 0.08}}}}))
    assert said.endswith(f", 0.08, as at any other, the pockets whirl {most} than half of the runs.")


def test_a_cage_that_is_guided_has_no_drift_rate():
    """It was -0.000003 1/s in a table beside 1925 N on the land."""
    runs = {"by_kick": [Part({"kick": 1.0, "whirls": 0}, {})], "worst_kick": 1.0, "runs": 64}
    values = candidate().values | runs | {"drift_rate_law": 0.0}
    assert evidence_column("drift_rate").cell(Part(values | {"drift_rate": -3e-6}, {})).value is None
    free = Part(values | {"drift_rate": 2.1, "drift_rate_law": 2.0}, {"drift_rate": "1/s"})
    assert evidence_column("drift_rate").cell(free).value == 2.1


def test_the_headline_states_no_force_beyond_what_the_races_hold():
    """It was up to 3140 N where the table below it had > 593."""
    forces = {"largest_contact_force": 3140.0, "force_limit": 593.0, "force_exceeds_races": True}
    values = candidate().values | forces | {"cage_motion": "ROLLING", "pocket_power": 37.1}
    units = {"force_limit": "N", "largest_contact_force": "N", "pocket_power": "W"}
    (said,) = deciding(NO_EFFECT, [Part(values | {"land_clearance": None}, units)])
    assert said.endswith("with pocket forces above 593 N, whose friction is all that the races hold.")


@pytest.mark.parametrize(("others", "whose"), [(0, "Every cage"), (1, "The cage of Phenolic, Phenolic")])
def test_the_headline_states_the_heat_of_cages_that_rub_on_their_land(others, whose):
    """A cage of 18 g was STABLE, and the 336 W with which it rubs at 99 m/s in a table below alone."""
    motions = [("ON THE LAND", 336.0), ("ON THE LAND", 367.0), *[("SETTLED", 0.0)] * others]
    rows = [
        Part(candidate().values | {"land_clearance": None, "cage_motion": motion, "rubbing_power": power}, W)
        for motion, power in motions
    ]
    (said,) = deciding(NO_EFFECT, rows)
    assert said == f"{whose} stays on its land and rubs it with 336 W to 367 W of heat."


def test_no_digits_stand_that_say_nothing():
    """104 (104 to 104) m/s, 14.89452 deg of a clearance of 8 um, 6e-22 deg; a stated angle is as written."""
    noise = Quantity(label="", digits=4, rounding=1e-12)
    assert alone(1e-23, noise, "rad") == "0 deg"
    assert in_column([1e-23, -1e-23, 0.2], noise, "rad")[0] == ["0.00", "0.00", "11.46"]
    for ends, words in (((104.0, 104.2), "104 m/s"), ((103.0, 105.0), "104 (103 to 105) m/s")):
        assert alone(Estimate(104.1, *ends), Quantity(label="", digits=3), "m/s") == words
    entry = {"value": 0.2599584, "unit": "rad", "origin": "derived, from radial_clearance"}
    assert entry_words(entry) == "14.89 deg"
    assert entry_words(entry | {"origin": "case.toml, line 4"}) == "14.89452 deg"


def test_the_headline_names_who_has_another_verdict_with_the_inputs_drawn():
    """A pump was STABLE in the headline and UNDECIDED, with P(stable) 0.78, below the table."""
    rows = [
        Part(candidate().values | {"land_clearance": None, "uncertain_verdict": verdict}, {})
        for verdict in ("UNDECIDED", candidate().verdict, None)
    ]
    (said,) = deciding(NO_EFFECT, rows)
    assert said == "That is at the means of the uncertain inputs; with them drawn: UNDECIDED Phenolic."


def test_the_headline_explains_a_critical_friction_of_zero_and_one_that_was_not_found():
    """A safety factor of 0.00 stood there without a word; the highest that was searched is named as that."""
    said = verdict_sentences([candidate(critical=(None, 1.0, None))], "air")
    assert "Safety factor > 3.57: at no friction up to 1.000 half the runs whirl, the pockets" in said
    row = candidate(critical=(0.0, 0.0, 0.0))
    said = verdict_sentences([row], "air")
    words = "half the runs whirl even without friction in the pockets, which do not drive them"
    assert f"Safety factor 0: {words}; their friction is 0.28" in said
    known = [candidate(), Part(row.values | {"name": "PEEK", "left_pocket": 9}, {})]
    words = words.replace("whirl", "whirl or bring a ball to the edge of its pocket")
    assert f"PEEK: {words}." in [*deciding(NO_EFFECT, known)]
    wide = dict(zip((CRITICAL, f"{CRITICAL}_low", f"{CRITICAL}_high"), (0.254, 0.24, 0.272), strict=True))
    effects = [{"name": "wide_land", "change": "a land of 0.4 mm", **wide}]
    (land,) = deciding(Part({"effects": effects, "candidate": "Phenolic"}, {}), [row])
    assert "and lowers the critical friction" in land  # it read that the land does not decide


@pytest.mark.parametrize(("motion", "ball"), [("plane", "auto"), ("space", "auto"), ("space", "damper")])
def test_the_paper_differs_by_the_motion_too(motion, ball):
    """In space it is the tilt that may decide, and not the damping alone; the plane has none."""
    row = Part(candidate().values | {"paper_verdict": "UNSTABLE", "restitution_threshold": 0.9}, {})
    chain = {"race_damping": 105.7, "race_damping_free_spin": 94.4}
    answer = Part({"chain": chain, "cage": {"motion": motion}, "ball_model": ball}, {})
    told = by_paper(answer, [row], ["Phenolic"])[0].text
    assert ("a ball that may spin in an impact resists it with" in told) is (ball == "auto")
    assert ("the cage also tilts" in told) is (motion == "space")
    row = Part(row.values | {"verdict": "UNSTABLE", "driven_by_land": True, "paper_verdict": "STABLE"}, {})
    look = {"takes_over": True, "duration": 3.0, "count": {"kick": 0.5}}
    of_runs = {"long_look": look, "kicks": [0.1, 0.5], "runs": 64, "duration": 0.3}
    told = by_paper(asked := Part(answer.values | of_runs, {}), [row], ["Phenolic"])[0].text
    assert evidence_head(asked) == "Evidence: 64 runs of 0.3 from each of 0.1, 0.5 (3)"
    assert told.endswith("drives the cage. Runs of 3 show it; those of the paper are shorter.")


def test_a_map_says_what_is_next_to_the_study_where_it_changes_and_what_each_point_has():
    """The nearest point with its runs, and both ends of a change in its column."""
    words = nearest_words(mapped())
    place = "film thickness 1 \N{MICRO SIGN}m, race friction 0.3"
    assert words.startswith(f"The point next to the study: {place}: ")
    assert words.endswith("the cage begins to whirl between race friction 0.1 and 0.3.")
    assert nearest_words(mapped(changes=[])).endswith("6 runs.")
    assert [*unchanged(mapped(changes=[]))] == []
    calm = [one.values | {"probability_high": 0.3} for one in mapped().points]
    assert [*unchanged(mapped(changes=[], points=calm))] == [("Whirls nowhere", "at 1 \N{MICRO SIGN}m")]
    # values and reason stand at each cell, upward in y; what has no share is a gap, a refusal hatched
    cells, hatched = map_figure(mapped()).panels[0].marks[:2]
    assert cells.values == [[0.0, None], [1.0, None]]
    assert cells.hover[1][0] == f"{place}: UNSTABLE; share that whirls 1 (0.7 to 1), 6 runs"
    assert cells.hover[0][1].endswith("too thin")
    assert hatched.where == [[False, True], [False, False]]


def test_a_map_states_why_points_at_which_nothing_whirls_are_undecided():
    """24 of 64 points were UNDECIDED beside "whirls nowhere"; the reason was in the JSON alone."""
    names, off = ("decision", "whirling", "reason"), [("UNDECIDED", 0, f"0.{i} mm off") for i in (3, 4)]
    rows = (*off, ("UNDECIDED", 3, "No clear answer"), ("STABLE", 0, "All settle"))
    points = [Part(dict(zip(names, row, strict=True)), {}) for row in rows]
    assert undecided(Part({"points": points}, {})) == ["0.3 mm off (And 1 more with other numbers.)"]


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


def test_a_long_sweep_is_cut_to_its_worst_cases_and_cases_that_are_alike_have_none():
    """A workbook has all of them. The number that all share is stated, and no line is drawn."""
    assert [row.case for row in case_table(swept(50)).rows] == [49 - i for i in range(SHOWN)]
    worst = {"case": 0, "quantity": "restitution_factor", "compared": 3, "alike": 3}
    assert worst_words(swept(worst=worst)).startswith("No case is the worst: all 3 with an answer have the ")
    alike, other = (len(envelope_figure(one).panels[0].marks) for one in (swept(worst=worst), swept()))
    assert other == alike + 1


def test_an_envelope_has_a_curve_for_each_value_of_the_other_inputs():
    """Over the first input where it rises along each curve; else over the numbers of the cases."""
    grid = swept(4)
    places = [(1, 2), (1, 3), (4, 2), (4, 3)]
    for case, (thickness, friction) in zip(grid.values["cases"], places, strict=True):
        case |= {"film.thickness": 1e-6 * thickness, "film.race_friction": friction}
    grid.values["parameters"].append({"name": "film.race_friction", "unit": "-"})
    (panel,) = envelope_figure(grid).panels
    assert [one.x for one in panel.marks[:2]] == [[1e-6, 4e-6]] * 2
    assert [one.name for one in panel.marks[:2]] == ["race friction 2", "race friction 3"]
    grid.values["parameters"].pop()
    first, frequencies = envelope_figure(grid).panels
    assert [one.x.label for one in (first, frequencies)] == ["case [-]"] * 2
    assert [one.marker for one in envelope_figure(swept(1)).panels[0].marks[:1]] == ["o"]


def test_a_safety_factor_without_an_upper_end_is_an_arrow_to_the_edge():
    """From its lower end, where its value is not known either; a closed interval is a bar alone."""
    grid = swept(3)
    ends = [(1.2, 0.9, 1.6), (3.0, 2.0, None), (None, 2.5, None)]
    for case, found in zip(grid.values["cases"], ends, strict=True):
        case |= dict(zip(("safety_factor", "safety_factor_low", "safety_factor_high"), found, strict=True))
    panel = envelope_figure(grid).panels[1]
    assert panel.title.startswith("Safety factor")
    draw_panel(axes := Figure().add_subplot(), panel)
    assert [(one.xy[1], one.xyann[1]) for one in axes.texts] == [(1.0, 2.0), (1.0, 2.5)]


# Pages of `tribometer` and `compare`, and saved answers that are wrong.

STUDY = read_study("cryogenic-turbopump")
ANSWER = json.loads(json.dumps(document(bearing.VERB, computed(bearing.VERB, STUDY))))


def saved(folder, name="bearing", **changes):
    """Write the answer of a bearing, changed, and return its path."""
    return written(folder, json.dumps(ANSWER | changes), f"{name}.json")


# --- saved answers ------------------------------------------------------------------------------
@pytest.mark.parametrize(
    ("changes", "rule"),
    [
        ({"study": []}, "is not the document of an answer"),
        ({"verb": "none"}, "must be an answer of rank, sensitivity"),
        ({"units": None}, "is damaged: units"),
        ({"title": " "}, "is damaged: title"),
        ({"seed": "1"}, "is damaged: seed"),
        ({"warnings": [1]}, "is damaged: warnings"),
    ],
    ids=str,
)
def test_an_answer_that_was_changed_is_refused(tmp_path, changes, rule):
    """One line that names the file."""
    path = saved(tmp_path, **changes)
    with pytest.raises(InputError, match=rule) as error:
        read_answer(path)
    assert str(error.value).startswith((str(path), path.name))  # short in the folder of the file


def test_folders_and_reports_have_their_answers_by_verb(tmp_path):
    """An interrupted answer is read as any other; one under another name is refused."""
    saved(tmp_path, complete=False)
    assert read_folder(tmp_path)["bearing"]["complete"] is False
    page = tmp_path / "report.html"
    page.write_text(f'<script id="separatrix-answers">{json.dumps({"bearing": ANSWER})}</script>')
    assert list(read_answers(page)) == ["bearing"]
    saved(tmp_path, "rank")
    with pytest.raises(InputError, match="must be an answer of rank; got bearing"):
        read_folder(tmp_path)


# --- two answers --------------------------------------------------------------------------------
def compared(tmp_path, **changes):
    """Compare the answer of a bearing with itself, changed."""
    (tmp_path / "other").mkdir()
    options = compare.Options(first=saved(tmp_path), second=saved(tmp_path / "other", **changes))
    return json.loads(json.dumps(compare.compute(options), allow_nan=False))


def test_the_interval_of_a_difference_of_shares_is_that_of_another_program():
    """Newcombe's method 10 as statsmodels 0.15.0 has it (confint_proportions_2indep, newcomb), 4 decimals."""
    for first, second, low, high in (
        ((48, 80), (56, 70), 0.0524, 0.3339),
        ((2, 7), (6, 7), 0.0582, 0.8062),
        ((0, 20), (0, 10), -0.1611, 0.2775),
        ((0, 20), (10, 10), 0.6791, 1.0),
    ):
        shares = [(n / runs, *wilson_interval(n, runs)) for n, runs in (first, second)]
        assert difference_interval(*shares) == pytest.approx((low, high), abs=6e-5)


def test_noise_is_judged_by_counts_intervals_and_errors():
    """Beyond where the interval of the change excludes 0; what has no interval is not judged."""

    def node(count, eta, threshold, error):
        low, high = wilson_interval(count, 64)
        ends = {"restitution_threshold_low": threshold - 0.1, "restitution_threshold_high": threshold + 0.1}
        shares = {"probability_stable": count / 64, "probability_low": low, "probability_high": high}
        rest = {"restitution_threshold": threshold, "friction": 0.1 + error, "friction_error": 0.01}
        return results(Part({**ends, **shares, **rest, "restitution_factor": eta, "verdict": "A"}, {}))

    rows = {row.name: row for row in differing(node(32, 0.3, 0.5, 0.0), node(48, 0.4, 0.55, 0.05))}
    assert {name: row.beyond_noise for name, row in rows.items()} == {
        "probability_stable": True,
        "restitution_factor": None,
        "restitution_threshold": False,
        "friction": True,
    }
    low, high = 0.1 - 1.959964 * 0.01, 0.1 + 1.959964 * 0.01
    assert (rows["friction"].first.low, rows["friction"].first.high) == pytest.approx((low, high))


def test_a_threshold_at_the_top_is_beyond_its_lower_end_in_a_comparison_too():
    """As in its own answer; the change of it is a number."""
    side = {"value": 1.0, "low": 0.97, "high": 1.0}
    row = {"name": "restitution_threshold", "first": side, "change": side, "beyond_noise": None}
    first, change = (next(one for one in RESULTS if one.head == head) for head in ("first", "change"))
    assert first.cell(Part(row, {})).value == Estimate(None, 0.97)
    assert change.cell(Part(row, {})).value == Estimate(1.0, 0.97, 1.0)


def test_the_most_loaded_ball_is_compared(tmp_path):
    """And an input that differs is told with its unit; two equal answers are told to be equal."""
    study = json.loads(json.dumps(ANSWER["study"]))
    study["film"]["thickness"]["value"] = 3e-7
    balls = [ball | {"load_inner": 2.0 * ball["load_inner"]} for ball in ANSWER["balls"]]
    found = compared(tmp_path, balls=balls, study=study)
    assert missing("compare", found) == set()
    assert [(row["place"], row["name"]) for row in found["rows"]] == [("most loaded ball", "load_inner")]
    (one,) = found["inputs"]
    assert (one["key"], one["first"], one["second"]) == ("film.thickness", 5e-7, 3e-7)
    words = text(compare.page(part_of(found)))
    assert "most loaded ball  load at the inner race" in words
    assert "500 nm  300 nm" in words
    again = compared_answers({"bearing": ANSWER}, {"bearing": ANSWER}, names=("a", "b"))
    assert "The two answers are equal in every result." in text(compare.page(part_of(again)))


def test_what_is_decided_by_comes_first():
    """Verdicts, then safety factors of the own environment, which is not named; then those of others."""

    def ranked(verdict, *factors):
        rows = [[{"name": "A", "verdict": verdict, "safety_factor": one}] for one in factors]
        each = [{"name": place, "materials": row} for place, row in zip("EF", rows, strict=True)]
        return {"rank": ANSWER | {"verb": "rank", "environment": "E", "environments": each}}

    found = compared_answers(ranked("STABLE", 2.0, 3.0), ranked("UNSTABLE", 0.5, 0.1), names=("a", "b"))
    assert [(row["place"], row["name"]) for row in found["rows"]] == [
        *(("A", "verdict"), ("F / A", "verdict"), ("A", "safety_factor"), ("F / A", "safety_factor"))
    ]
    assert "counting noise: verdict (2)." in text(compare.page(part_of(json.loads(json.dumps(found)))))


def test_what_cannot_be_compared_is_refused(tmp_path):
    """Two verbs, and an answer whose parts are not those of one: a line with its file."""
    with pytest.raises(InputError, match="b must be an answer of bearing, as a is; got check"):
        compared_answers({"bearing": ANSWER}, {"check": ANSWER}, names=("a", "b"))
    with pytest.raises(InputError, match=r"bearing\.json is damaged|did not write"):
        compared(tmp_path, study={"ranking": {"candidates": [1]}})


# --- logs ---------------------------------------------------------------------------------------
def test_each_test_is_drawn_with_its_cut_and_its_steady_part(tmp_path):
    """The ends of its steady part, and the mean over it; logs that were read alike are told once."""
    for seed, name in enumerate(("a.csv", "b.csv")):
        log(tmp_path / name, 0.08, seed)
    found = tribometer.compute(tribometer.Options(files=(tmp_path,)))
    found = json.loads(json.dumps(found, allow_nan=False))
    page = tribometer.page(part_of(found))
    pictures = [one for one in page.blocks if isinstance(one, Picture)]
    assert [one.name for one in pictures] == ["a.csv", "b.csv"]
    test = found["tests"][0]
    course, *_ = pictures[0].figure().panels
    ends = [test["run_in_end"], test["steady_end"]]
    assert [one.at for one in course.marks if isinstance(one, Across)] == ends
    (mean,) = [one for one in course.marks if getattr(one, "name", "").startswith("steady mean")]
    assert [*mean.x] == ends
    assert len(test["course"]["along"]) == 600
    # with the columns that were taken, in a page that fits a screen; places along a test in minutes
    words = text(page)
    assert words.count('"friction coefficient"') == 1
    assert "a.csv and 1 more: plain table (" in words
    assert "12.49" in text(page, Level.FULL)  # the last row, at 749.5 s
    assert words.count("\n") < 45
