"""Candidates of the user's own in the page: text and form are one, comments stay, each fault has a place."""

import re
import tomllib

import pytest
from fastapi.testclient import TestClient
from test_cli_answers import SMALL

from separatrix.app import candidates, draft
from separatrix.app.editing import edited_by
from separatrix.app.form import PROPERTIES, form
from separatrix.app.server import application
from separatrix.errors import InputError
from separatrix.study_file import read_study
from separatrix.study_file.values import _PROPERTIES

OWN = """extends = "cryogenic-turbopump"

[ranking] # ours
environment = "air"

# the black one
[[ranking.candidates]]
name = "One" # first
friction = { air = 0.1, "lox, 440C" = { mean = 0.2, count = 3 } } # tested

# the film of March
[film]
thickness = "0.5 um"

[[ranking.candidates]]
name = "Two"
material = { elastic_modulus = "5 GPa", poisson_ratio = 0.4 }
[ranking.candidates.friction]
air = { between = [0.1, 0.2] } # guessed

# the end
"""
ONE_LINE = """[ranking]
candidates = [{ name = "One", friction = { air = 0.1, "lox, 440C" = { mean = 0.2, count = 3 } } }, { name = \
"Two", material = { elastic_modulus = "5 GPa", poisson_ratio = 0.4 }, friction = { air = \
{ between = [0.1, 0.2] } } }] # both
"""
INLINE = """extends = "cryogenic-turbopump"
[ranking]
candidates = [{ name = "One", friction = { air = 0.1 } }, { name = "Two" }] # both
"""


def items(text):
    """Candidates of a text."""
    return tomllib.loads(text)["ranking"]["candidates"]


def comments(text):
    """Comments of a text, in order."""
    return re.findall("#.*", text)


@pytest.fixture
def page(tmp_path):
    """The page of a folder with a study of own candidates, without its guard."""
    (tmp_path / "own.toml").write_text(OWN)
    (tmp_path / "small.toml").write_text(SMALL)
    with TestClient(application(tmp_path)) as client:
        yield client


def edit(page, study="own.toml", **fields):
    """Change a study as the form of a fresh page does."""
    version = re.search('name="version" value="([0-9a-f]+)"', page.get(f"/study/{study}").text)[1]
    return page.post(f"/edit/{study}", data={"version": version, **fields}).text


def text_of(page, study="own.toml"):
    """Text of a study, with its unsaved edits."""
    return draft.current_text(page.app.state.root / study)


def more_of(text, field):
    """What is said below a field of the page."""
    return re.search(rf'id="{field}-more">(.*?)</div>', text, re.DOTALL)[1]


@pytest.mark.parametrize(
    ("number", "path", "value", "expected"),
    [
        (0, "name", "[draft] 7", {"name": "[draft] 7"}),
        (0, "material", "Armalon", {"material": "Armalon"}),
        (0, "material.density", "1400 kg/m3", {"material": {"density": "1400 kg/m3"}}),
        (0, "friction|air|mean", "0.3", {"friction": {"air": 0.3, "lox, 440C": {"mean": 0.2, "count": 3}}}),
        (0, "friction|air|mean", "", {"friction": {"lox, 440C": {"mean": 0.2, "count": 3}}}),
        (
            0,
            "friction|air|count",
            "8",
            {"friction": {"air": {"mean": 0.1, "count": 8}, "lox, 440C": {"mean": 0.2, "count": 3}}},
        ),
        (0, "friction|lox, 440C|count", "", {"friction": {"air": 0.1, "lox, 440C": 0.2}}),
        (
            0,
            "friction|friction|mean",
            "0.4",
            {"friction": {"air": 0.1, "lox, 440C": {"mean": 0.2, "count": 3}, "friction": 0.4}},
        ),
        (0, "friction|lox, 440C|source", "7", None),
        (1, "material.density", "2 g/cm3", None),
        (1, "friction|air|mean", "0.2 +- 10 %", {"friction": {"air": "0.2 +- 10 %"}}),
        (1, "friction|water|mean", "1", {"friction": {"air": {"between": [0.1, 0.2]}, "water": 1}}),
    ],
)
@pytest.mark.parametrize("text", [OWN, ONE_LINE])
def test_one_part_is_changed_and_the_rest_stays(text, number, path, value, expected):
    """Comments too, whether the tables have headers or stand in a line."""
    first, *inside = path.split("|") if "|" in path else path.split(".")
    found = candidates.changed(text, number, (first, *inside), value)
    before, after = items(text), items(found)
    assert comments(found) == comments(text)
    assert after[1 - number] == before[1 - number]
    if expected is not None:
        assert after[number] == {**before[number], **expected}
    elif value == "7":
        assert after[0]["friction"]["lox, 440C"] == {"mean": 0.2, "count": 3, "source": "7"}
    else:
        assert after[1]["material"]["density"] == "2 g/cm3"


def test_a_material_without_its_last_property_is_removed():
    """As is a friction without its last environment; each is refused then, or has its default."""
    found = candidates.changed(OWN, 1, ("material", "elastic_modulus"), "")
    assert items(found)[1]["material"] == {"poisson_ratio": 0.4}
    assert "material" not in items(candidates.changed(found, 1, ("material", "poisson_ratio"), ""))[1]
    assert "friction" not in items(candidates.changed(INLINE, 0, ("friction", "air", "mean"), ""))[0]


@pytest.mark.parametrize("text", [OWN, INLINE, SMALL, 'title = "x"'])
def test_a_candidate_is_added_behind_the_others(text):
    """Under its own header, above the comment of what follows; the rest of the text stays."""
    found = candidates.added(text, 'A "new" <one>')
    before = tomllib.loads(text).get("ranking", {}).get("candidates", [])
    assert items(found) == [*before, {"name": 'A "new" <one>'}]
    assert comments(found) == comments(text)
    if text != INLINE:
        new = found.splitlines()
        at = new.index('name = "A \\"new\\" <one>"')
        assert new[: at - 2] + new[at + 1 :] == text.splitlines()
    if text == OWN:
        assert found.index("<one>") < found.index("# the end")


@pytest.mark.parametrize("number", [0, 1])
@pytest.mark.parametrize("text", [OWN, INLINE])
def test_a_candidate_is_removed_with_its_own_lines_only(text, number):
    """The comment above the next section stays, as do the other sections."""
    found = candidates.removed(text, number)
    assert items(found) == [items(text)[1 - number]]
    assert tomllib.loads(found).get("film") == tomllib.loads(text).get("film")
    if text == OWN:
        kept = {"# the black one", "# the film of March", "# the end", "# ours"}
        assert kept <= set(comments(found))


def test_the_last_candidate_leaves_no_empty_list():
    """An empty list would be refused; the section may stay, or go with its only key."""
    assert tomllib.loads(candidates.removed(candidates.removed(OWN, 1), 0))["ranking"] == {
        "environment": "air"
    }
    alone = candidates.added('title = "x"\n', "One")
    assert candidates.removed(alone, 0) == 'title = "x"\n'
    inline = candidates.removed(candidates.removed(INLINE, 0), 0)
    assert tomllib.loads(inline)["ranking"] == {}


@pytest.mark.parametrize(
    "text", ["[ranking]\ncandidates = 3\n", "ranking = 3\n", "[ranking]\ncandidates = [3]\n"]
)
def test_what_is_not_a_table_is_mended_as_text(text):
    """A form cannot change what it does not understand."""
    with pytest.raises(InputError, match="Mend it in the text first"):
        candidates.changed(text, 0, ("name",), "x")


def test_a_form_sent_back_unchanged_changes_no_value():
    """Every field of every candidate makes the same study again."""
    checked = draft.Checked(text=OWN, study=None, faults=())
    ranking = next(one for one in form(checked) if one.name == "ranking")
    fields = [
        field
        for one in ranking.candidates.items
        for field in (*one.fields, *one.properties, *(f for env in one.frictions for f in env.fields))
    ]
    again = OWN
    for field in fields:
        if field.value:
            again = edited_by(again, {**field.sent, "value": field.value, "unit": field.unit})
    assert tomllib.loads(again) == tomllib.loads(OWN)
    assert len({field.id for field in fields}) == len(fields) > 20


def test_the_form_has_every_property_of_a_material():
    """Its name alone is left to the text: it is that of the candidate."""
    assert {*PROPERTIES, "name"} == set(_PROPERTIES)


def test_a_wrong_friction_is_refused_beside_its_field(page):
    """In the row of its environment, of the candidate that has it; mended, the study is sound."""
    sent = {"candidate": "0", "part": "friction.mean", "environment": "air"}
    found = edit(page, **sent, value="7")
    assert "must lie between 0 and 2" in more_of(found, "f-candidates-0-friction-0-mean")
    assert found.count("must lie between 0 and 2") == 1
    assert "1 value is refused" in found
    assert "Every value is accepted" in edit(page, **sent, value="0.15")
    assert "air = 0.15," in text_of(page)


@pytest.mark.parametrize(
    ("sent", "field", "words"),
    [
        ({"part": "name", "value": "x" * 300}, "f-candidates-1-name", "1 to 200 printable"),
        ({"part": "material.density", "value": "3 mm"}, "f-candidates-1-material-density", "unit of density"),
        (
            {"part": "friction.count", "environment": "lox, 440C", "value": "2.5"},
            "f-candidates-1-friction-1-mean",
            "lacks: mean",
        ),
        (
            {"part": "friction.mean", "environment": "air", "value": "0.1 +- x"},
            "f-candidates-1-friction-0-mean",
            "after +-",
        ),
        (  # refused where the distributions of a study are fitted to it
            {"part": "friction.mean", "environment": "air", "value": "{ between = [1, 3] }"},
            "f-candidates-1-friction-0-mean",
            "candidates[2]",
        ),
    ],
)
def test_each_fault_is_beside_its_field(page, sent, field, words):
    """Once, however deep it lies."""
    found = edit(page, candidate="1", **sent)
    assert words in more_of(found, field)
    assert found.count('class="bad">own.toml') == found.count("own.toml, line")


def test_what_has_no_field_is_said_of_the_candidate_or_of_all(page):
    """What it lacks, two of one name, and a key that no candidate has."""
    found = edit(page, added="One")
    third = re.search(r'id="candidate-2">(.*?)</fieldset>', found, re.DOTALL)[1]
    assert "lacks: friction" in third
    again = edit(page, candidate="2", part="friction.mean", environment="air", value="0.2")
    assert re.search(r'Candidates of your own</h3>.*?different names.*?id="candidate-0"', again, re.DOTALL)
    found = edit(page, text=OWN.replace('name = "Two"', 'name = "Two"\nweight = 3'))
    second = re.search(r'id="candidate-1">(.*?)</fieldset>', found, re.DOTALL)[1]
    assert "weight is not a key" in second
    both = edit(page, text=OWN.replace("environment =", 'friction = "pin-on-disk-77K"\nenvironment ='))
    assert re.search(r'Candidates of your own</h3>.*?exclude each other.*?id="candidate-0"', both, re.DOTALL)


def test_candidates_are_added_and_removed_in_the_page(page):
    """The text beside the form follows; a name is needed."""
    found = edit(page, added="My compound")
    assert "Candidate 3: My compound" in found
    assert "[[ranking.candidates]]\nname = &#34;My compound&#34;\n" in found
    assert "needs a name" in edit(page, added=" ")
    edit(page, removed="2")
    assert items(text_of(page)) == items(OWN)
    assert "is not in the text" in edit(page, removed="2")
    assert "is not in the text" in edit(page, removed="x")


def test_a_text_that_the_form_cannot_change_stays(page):
    """One whose end it takes for a comment, and one with a table of a candidate behind another section."""
    with pytest.raises(InputError, match="Mend it in the text first"):
        candidates.added('[[ranking.candidates]]\nname = """One\n# two"""\n', "New")
    text = OWN.replace("[ranking.candidates.friction]", "[cage]\n[ranking.candidates.friction]")
    edit(page, text=text)
    for sent in ({"added": "New"}, {"removed": "0"}, {"candidate": "0", "part": "name", "value": "New"}):
        assert "Mend it in the text first" in edit(page, **sent)
    assert text_of(page) == text


def test_an_older_tab_neither_adds_nor_removes(page):
    """Numbers of candidates may be others meanwhile."""
    old = draft.version_of(OWN)
    edit(page, removed="0")
    before = text_of(page)
    for sent in ({"added": "Three"}, {"removed": "0"}, {"candidate": "0", "part": "name", "value": "Three"}):
        found = page.post("/edit/own.toml", data={"version": old, **sent}).text
        assert "Another tab changed this study" in found
    assert text_of(page) == before


def test_the_materials_of_the_tests_are_ticked(page):
    """Those of the friction table, in its order; a tick goes to the end, and none is the default: all."""
    small = SMALL.replace('["Armalon", "Meldin HTC 100"]', '["vespel sp-211", "Armalon", "Oak"]')
    found = edit(page, "small.toml", text=small)
    boxes = re.findall(r'type="checkbox" name="box-\d+" value="([^"]+)"( checked)?', found)
    assert [name for name, ticked in boxes if ticked] == ["Armalon", "vespel sp-211", "Oak"]
    assert boxes[0] == ("Meldin HTC 100", "")
    assert "names a material that pin-on-disk-77K lacks" in more_of(found, "f-ranking-materials")
    sent = {"field": "ranking.materials"}
    ticked = ["Meldin HTC 100", "Armalon", "vespel sp-211"]
    edit(page, "small.toml", **sent, **{f"box-{i}": name for i, name in enumerate(ticked)})
    assert 'materials = ["vespel sp-211", "Armalon", "Meldin HTC 100"]' in text_of(page, "small.toml")
    edit(page, "small.toml", **sent)
    assert "materials" not in text_of(page, "small.toml")


def test_the_materials_of_a_friction_file_are_ticked(page):
    """A file that cannot be read has none: the list is typed then."""
    test = '[[test]]\nmaterial = "Ours"\ncounterface = "440C"\nmedium = "air"\nfriction = 0.2\n'
    (page.app.state.root / "tests.toml").write_text(test)
    own = SMALL.partition("[ranking]")[0] + '[ranking]\nfriction = "NAME"\n'
    assert 'type="checkbox" name="box-1" value="Ours"' in edit(
        page, "small.toml", text=own.replace("NAME", "tests.toml")
    )
    typed = edit(page, "small.toml", text=own.replace("NAME", "../tests.toml"))
    assert '<input id="f-ranking-materials"' in typed
    assert "Inherited: 11.1125 mm" in typed


def test_a_list_keeps_its_comments():
    """An item goes with the comment behind it; the others stay as they are written."""
    text = '[ranking]\nmaterials = [\n  "A", # a\n  # of May\n  "B", # b\n] # both\n'
    found = draft.edited(text, "ranking", "materials", '["B", "C"]')
    assert tomllib.loads(found)["ranking"]["materials"] == ["B", "C"]
    assert comments(found) == ["# of May", "# b", "# both"]
    assert tomllib.loads(draft.edited(text, "ranking", "materials", '["B", "A"]'))["ranking"][
        "materials"
    ] == [
        "B",
        "A",
    ]


def test_a_new_key_is_above_the_comment_of_the_next_section():
    """The comment is about what follows it."""
    found = draft.edited('[cage]\nmass = "1 g"\n\n# worn\n[film]\n', "cage", "land_friction", "0.2")
    assert found == '[cage]\nmass = "1 g"\nland_friction = 0.2\n\n# worn\n[film]\n'


def test_inherited_candidates_are_named(page):
    """They are replaced as a whole by the first one that the study has of its own."""
    (page.app.state.root / "variant.toml").write_text('extends = "own.toml"\n')
    assert read_study(page.app.state.root / "variant.toml").ranking.candidates[1].name == "Two"
    assert "Inherited: One, Two." in page.get("/study/variant.toml").text
    assert "Inherited: One" not in edit(page, "variant.toml", added="Three")
