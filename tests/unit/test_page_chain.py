"""What is special in the pages of check, traction, restitution and mobility, and in the bearing to scale."""

from __future__ import annotations

import pytest

from separatrix.ground.document import part_of
from separatrix.present.figure import Trace
from separatrix.present.text import text
from separatrix.study.reading import read_study
from separatrix.verbs import computed, verb_named
from separatrix.verbs.answer_files import document
from separatrix.verbs.parts.bearing_drawing import CAGE, bearing_picture, section_of

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
