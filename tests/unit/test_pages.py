"""The contract of every verb: Python = JSON = command line, its keys, files, and a page of its numbers."""

import contextlib
import json
import re
from dataclasses import replace

import pytest
import xarray as xr
from matplotlib import image
from test_reference_tables import missing

import separatrix
from separatrix import InputError, Interrupted, read_study
from separatrix.front import api, main
from separatrix.ground.plain_data import part_of
from separatrix.ground.quantity import Estimate
from separatrix.present import html, quantity_text
from separatrix.present.blocks import Facts, Heading, Level, Note, Page, Picture, Table, View, spans
from separatrix.present.draw import save
from separatrix.present.figure import Axis, Figure, Panel, Trace
from separatrix.present.pdf import pdf
from separatrix.present.spreadsheet import spreadsheet
from separatrix.present.text import lead, text
from separatrix.verbs import VERBS, verb_named
from separatrix.verbs.answer_files import page_of_document, refusing_damage
from separatrix.verdict.long_jobs import NAME

SMALL = """
extends = "momentum-wheel"
[stability]
kicks = ["0.4 m/s"]
runs = 4
duration = "2 ms"
restitution_factors = [0.4, 0.6]
[cage]
model = "full"
[bearing]
contact_angle = "20 deg +- 1 deg"
[wear]
film_wear = "5e-9 mm3/(N m)"
cage_wear = "1e-6 mm3/(N m)"
bare_friction = 0.35
[operation]
fluid = "gaseous nitrogen"
[cooling]
swirl = 0.4
flow = "1 g/s"
race_conductance = "0.1 W/K"
inner_cooling = "0.2 W/K"
outer_cooling = "0.2 W/K"
ball_cooling = "0.1 W/K"
steel_conductivity = "25 W/(m K)"
steel_heat_capacity = "460 J/kg/K"
"""
CALLS = {
    "life": {"revolutions": "1e6", "samples": 64},
    "simulate": {"kick": "0.4 m/s"},
    "map": {"x": "restitution_factor=0.2..0.8:2", "y": "ball_cage_friction=0..0.4:3", "runs": 2},
    "sensitivity": {"samples": 64},
    "sweep": {"vary": ("cage.mass=3..4g:2",), "verdicts": True},
}
ELLIPSE = "semi_major semi_minor max_pressure approach rolling_speed"
CURVE = "slope slope_error creep_increment traction_coefficient"
DAMPING = "race_damping damping_ratio restitution_factor"
CRITICAL = "restitution_factor critical_friction critical_friction_low critical_friction_high"
MATERIAL = "name friction restitution_threshold margin probability_stable verdict rank reason"
KEYS = {
    ("bearing", "balls"): "contact_angle_inner contact_angle_outer load_inner load_outer orbital_speed "
    "pitch_angle spin_roll_ratio_inner spin_roll_ratio_outer",
    ("bearing", ""): "axial_displacement radial_displacement",
    **{("bearing", f"contacts.{race}"): ELLIPSE for race in ("inner", "outer")},
    **{("traction", race): CURVE for race in ("inner", "outer")},
    ("restitution", ""): " ".join(f"{name} {name}_free_spin" for name in DAMPING.split()),
    ("mobility", ""): "rates damping damping_relaxed effective_mass capacity speed force_forward force_law",
    ("simulate", ""): "outcome largest_offset whirl_frequency whirl_speed pocket_power",
    ("stability", "curve"): CRITICAL,
    ("stability", "linear_limit"): "restitution_factor critical_friction",
    ("rank", ""): "restitution_factor",
    ("life", ""): "candidate revolutions_10 revolutions_50 revolutions_90 unstable_at_start never_unstable",
    ("life", "course"): "time revolutions probability_stable race_friction pocket_friction pocket_clearance",
    ("rank", "overall"): MATERIAL,
    ("rank", "environments.materials"): MATERIAL,
}
"""Verb and place in its document -> the keys that scripts rely on."""

KEPT = {verb: {NAME} for verb in VERBS if verb_named(verb).keeps_runs}
KEPT |= {"simulate": {"moving-cage.html"}, "sweep": {NAME}}  # its verdicts are kept
"""Files beside the answer."""

COUNTS = (
    *("most_loaded", "iterations", "whirling", "ball", "run", "runs", "nodes", "sweeps", "slip", "rank"),
    *("whirl_direction", "friction_scatter_assumed", "settles", "rolls", "whirls"),
    *("drifts", "unresolved", "whirls_by_land", "left_pocket", "force_exceeds_races", "driven_by_land"),
    *("input_mean", "input_standard_deviation"),  # each in the unit beside it, in input_unit
)
"""Ends of the names of plain numbers without a unit."""

LEVELS = (Level.BRIEF, Level.FULL, Level.REPORT, Level.SHEET)


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    """The shipped wheel, full model, with an ensemble of no weight and an uncertain input."""
    path = tmp_path_factory.mktemp("small") / "small.toml"
    path.write_text(SMALL, encoding="utf-8")
    return path


def options(verb):
    """Return the options of a call as those of the command."""
    words = []
    for name, value in CALLS.get(verb, {}).items():
        for one in value if isinstance(value, tuple) else (value,):
            words += [f"--{name}"] if one is True else [f"--{name}", str(one)]
    return words


@pytest.fixture(scope="module")
def folder(small, tmp_path_factory):
    """The files of the answers of every verb, as the command line writes them."""
    place = tmp_path_factory.mktemp("answers")
    for verb in VERBS:
        assert main([verb, str(small), *options(verb), "--out", str(place / verb), "--quiet"]) == 0
    return place


@pytest.fixture(scope="module")
def answers(small, folder):
    """The answer of every verb in Python, computed once; runs that the command line kept are taken."""
    found = {}

    def answer(verb):
        if verb not in found:
            kept = {"folder": folder / verb} if verb_named(verb).keeps_runs else {}
            found[verb] = getattr(api, verb)(small, **CALLS.get(verb, {}), **kept)
        return found[verb]

    return answer


def saved(folder, verb):
    """Return the document of a verb, as it was written beside the figures."""
    return json.loads((folder / verb / f"{verb}.json").read_text(), parse_constant=pytest.fail)


@pytest.mark.parametrize("verb", VERBS)
def test_python_and_command_line_answer_alike(verb, folder, answers):
    """The same document to the last digit, and the same page of it."""
    answer, found = answers(verb), saved(folder, verb)
    assert json.loads(json.dumps(answer.document())) == found
    assert answer.summary() == text(page_of_document(verb_named(verb), found))
    assert answer.summary().startswith(found["title"])
    assert has(found, "separatrix_version verb name title study seed warnings provenance")


def test_json_alone_is_printed_and_no_file_is_written(small, answers, capsys, elsewhere, tmp_path):
    """One document on standard output, nothing else anywhere."""
    assert main(["bearing", str(small), "--json", "--quiet"]) == 0
    out, err = capsys.readouterr()
    assert (err, list(tmp_path.iterdir())) == ("", [])
    printed = json.loads(out, parse_constant=pytest.fail)
    assert printed == json.loads(json.dumps(answers("bearing").document()))


def has(record, names):
    """Whether all names are keys, each present or null."""
    return set(names.split()) <= set(record)


def records(found, path):
    """Return the records at a place of a document."""
    places = [found]
    for key in filter(None, path.split(".")):
        inside = [one[key] for one in places]
        places = [one for item in inside for one in (item if isinstance(item, list) else [item])]
    return places


@pytest.mark.parametrize(("verb", "path"), KEYS)
def test_documents_have_the_keys_that_scripts_rely_on(verb, path, folder):
    """Each record at that place."""
    found = records(saved(folder, verb), path)
    assert found
    assert all(has(one, KEYS[verb, path]) for one in found)


@pytest.mark.parametrize("verb", VERBS)
def test_every_name_of_a_document_has_a_line(verb, folder):
    """In the generated reference."""
    assert missing(verb, saved(folder, verb)) == set()


@pytest.mark.parametrize("verb", [verb for verb in VERBS if verb_named(verb).needs])
def test_a_verb_says_which_sections_it_needs(verb):
    """Of a study that has neither a cage nor candidates."""
    needs = verb_named(verb).needs
    said = " and ".join(rf"\[{one}\]" for one in needs)
    said += rf" are missing; `{verb}` needs them" if len(needs) > 1 else rf" is missing; `{verb}` needs it"
    with pytest.raises(InputError, match=rf"^le7: {said}\. See `separatrix new`"):
        getattr(api, verb)("le7", **CALLS.get(verb, {}))


def test_what_is_null_has_a_reason(folder):
    """A stability point without a critical friction or without an end of its band says why."""
    for row in saved(folder, "stability")["curve"]:
        assert row["reason"] or None not in [row[name] for name in CRITICAL.split()]


WRITING = [verb for verb in VERBS if verb_named(verb).writes_data]


@pytest.mark.parametrize("verb", WRITING)
def test_files_are_whole_and_nothing_else_is_left(verb, folder):
    """Document, text for a terminal, dataset, each figure as PNG and SVG; no temporary file stays."""
    names = {path.name for path in (folder / verb).iterdir()}
    pictures = {name for name in names if name.endswith(".png")}
    assert pictures or verb in ("bearing", "sensitivity")
    own = {f"{verb}{suffix}" for suffix in (".json", ".txt", ".nc", ".xlsx", ".html")}
    assert names == pictures | KEPT.get(verb, set()) | {f"{p[:-4]}.svg" for p in pictures} | own
    lines = (folder / verb / f"{verb}.txt").read_text(encoding="ascii").splitlines()
    assert max(map(len, lines)) <= 100


@pytest.mark.parametrize("verb", WRITING)
def test_an_answer_read_back_has_the_arrays_of_the_fresh_one(verb, folder):
    """Values, units and places on the axes of the netCDF file; whatever has a dimension has a unit."""
    with xr.open_dataset(folder / verb / f"{verb}.nc", engine="h5netcdf", decode_times=False) as fresh:
        data = separatrix.load(folder / verb / f"{verb}.json")
        xr.testing.assert_identical(data, fresh.load())
    for name, variable in data.variables.items():
        if variable.dtype.kind == "f":
            assert "units" in variable.attrs or str(name).endswith(COUNTS), name


def test_the_dataset_names_dimensions_and_units(folder):
    """Ball and race, environment and material, are dimensions; quantities carry their unit."""
    bearing = separatrix.load(folder / "bearing" / "bearing.json")
    assert bearing["load_inner"].dims == ("ball",)
    assert bearing["load_inner"].attrs["units"] == "N"
    assert bearing["contact_max_pressure"].sel(race="inner").attrs["units"] == "Pa"
    rank = separatrix.load(folder / "rank" / "rank.json")
    there = {"environment": "vacuum", "material": "Vespel SP-3"}
    assert float(rank["material_friction"].sel(there)) == 0.08
    assert json.loads(rank.attrs["study"])["bearing"]["ball_count"]["value"] == 12


def test_no_figure_is_clipped(folder):
    """The outermost pixels of every picture are white: no label runs over the edge."""
    for path in folder.rglob("*.png"):
        pixels = image.imread(path)[..., :3]
        edges = [pixels[:2], pixels[-2:], pixels[:, :2], pixels[:, -2:]]
        least = min(edge.min() for edge in edges)
        assert least > 0.98, path.name  # white is 1; a grey hint of antialiasing passes


def numbers(value):
    """Yield every number of a document."""
    if isinstance(value, dict):
        for one in value.values():
            yield from numbers(one)
    elif isinstance(value, list):
        for one in value:
            yield from numbers(one)
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield float(value)


@pytest.mark.parametrize("verb", VERBS)
def test_every_number_of_a_page_is_the_documents(verb, answers, monkeypatch):
    """Those of tables and facts, and those told in sentences, too."""
    document = json.loads(json.dumps(answers(verb).document()))
    known, told = set(numbers(document)), []
    alone = quantity_text.alone

    def noted(value, *rest):
        told.append(value)
        return alone(value, *rest)

    monkeypatch.setattr(quantity_text, "alone", noted)
    page = verb_named(verb).page(part_of(document))
    for block in page.blocks:
        if isinstance(block, Table):
            told += [cell.value for one in block.shown for cell in one.cells if cell.is_number]
        elif isinstance(block, Facts):
            told += [cell.value for _, cell in block.pairs if cell.is_number]
    found = {one for value in told for one in (value if isinstance(value, Estimate) else (value,))}
    assert len(found) >= 5
    assert {one for one in found if one is not None} <= known


def test_a_ranking_that_was_interrupted_early_has_no_heading_without_a_table(folder):
    """The heading of the evidence came before the first note."""
    document = saved(folder, "rank")
    for row in [row for one in document["environments"] for row in one["materials"]]:
        row["verdict"] = None
    assert "Evidence:" not in text(verb_named("rank").page(part_of(document)))


def test_a_life_names_the_state_of_the_clearances_that_open(folder):
    """They are those that the study states: of a cage at rest they were headed "as it runs"; the hours."""
    document = saved(folder, "life")
    document["study"]["cage"]["clearances"]["value"] = "at rest, 293 K"
    heads = [
        one.head
        for block in verb_named("life").page(part_of(document)).blocks
        if isinstance(block, Table)
        for one in block.shown
    ]
    assert {"pocket clearance, at rest, 293 K", "time"} <= {*heads}


@pytest.mark.parametrize("verb", VERBS)
def test_every_medium_shows_every_page(verb, answers):
    """Text, HTML, PDF, workbook; each picture on paper and to hover over; no block is empty."""
    page = answers(verb).page()
    names = [one.name for one in page.blocks if isinstance(one, Picture | View)]
    assert len(names) == len(set(names))
    for level in LEVELS:
        shown = text(page, level)
        assert shown.isascii() or verb == "check"
        assert not re.search(r"\bnan\b|\binf\b|None|\$", shown), shown
    assert len(text(page).splitlines()) < 75
    drawn = html.html(page, {verb: answers(verb).document()})
    assert 'aria-label="' in drawn
    assert pdf(page).startswith(b"%PDF")
    assert spreadsheet(page).startswith(b"PK")
    for one in page.blocks:
        if isinstance(one, Picture):
            spec = one.figure()
            assert save(spec).svg.startswith("<svg")
            assert one.caption
            axes = [axis for panel in spec.panels for axis in (panel.x, panel.y)]
            assert all("[" in axis.label or axis.names for axis in axes)


@pytest.mark.parametrize("verb", [verb for verb in VERBS if verb_named(verb).keeps_runs])
def test_an_interrupted_answer_has_a_page(verb, small):
    """Interrupted at any of its first steps: marked as incomplete, with a page in every medium."""
    for after in (1, 2):
        calls = iter(range(after))

        def stop(done, total, calls=calls):
            if next(calls, None) is None:
                raise KeyboardInterrupt

        with pytest.raises(Interrupted) as caught:
            getattr(api, verb)(small, **CALLS.get(verb, {}), progress=stop, jobs=1)
        answer = caught.value.finished
        if answer is None or answer.document()["complete"]:  # nothing or all was finished
            continue
        assert answer.document()["complete"] is False
        page = answer.page()
        assert "Interrupted" in text(page)
        html.html(page, level=Level.REPORT | Level.FULL)
        spreadsheet(page)


@pytest.mark.parametrize("verb", VERBS)
def test_a_damaged_answer_is_refused_in_a_line(verb, answers):
    """Each key taken away or made a text: the page is whole, or the answer is refused; no other error."""
    document = answers(verb).document()
    own = [key for key in document if key not in ("separatrix_version", "verb", "name", "title", "seed")]
    for key in own:
        for broken in ({k: v for k, v in document.items() if k != key}, {**document, key: "?"}):
            with contextlib.suppress(InputError), refusing_damage("old.json"):
                text(page_of_document(verb_named(verb), broken, "old.json"), Level.FULL)


def test_blocks_are_where_their_level_says(answers):
    """The screen has no picture, the report no hint on options; a heading has something below it."""
    page = answers("rank").page()
    brief = page.at(Level.BRIEF).blocks
    assert not any(isinstance(one, Picture) for one in brief)
    assert sum(isinstance(one, Note) and one.kind == "lead" for one in brief) == 1
    for level in LEVELS:
        blocks = page.at(level).blocks
        pairs = zip(blocks, [*blocks[1:], Heading("end")], strict=True)
        heads = [(a.depth, b.depth) for a, b in pairs if isinstance(a, Heading) and isinstance(b, Heading)]
        assert all(inner > outer for outer, inner in heads)
    assert "--full" not in text(page, Level.REPORT)


def test_dollar_signs_of_a_user_are_no_formula():
    """A name between two of them is written as it is, on the screen and in a figure; a symbol is one."""
    said = "air $^$ at $5: $eta$ of `$x`"
    kinds = [("text", "air $^$ at $5: "), ("symbol", "eta"), ("text", " of "), ("code", "$x")]
    assert list(spans(said)) == kinds
    panel = Panel(title=said, x=Axis(label="a [-]"), y=Axis(label="b [-]"), marks=())
    assert save(Figure(rows=((panel,),))).svg.startswith("<svg")


def test_sentences_have_the_micro_sign_of_tables():
    """But not what a study file states, nor code; plain text has a u everywhere."""
    said = 'a gap of 120 um takes 3 uW; given: "0.5 um +- 20 %"; write `--y 5 um`.'
    (_, words), code, _ = spans(said)
    assert words.startswith('a gap of 120 \N{MICRO SIGN}m takes 3 \N{MICRO SIGN}W; given: "0.5 um +- 20 %"')
    assert code == ("code", "--y 5 um")
    assert "gap of 120 um takes 3 uW" in text(Page("t", "", (Note(said),)))
    stated = Note("eta of 3 um, 3 \N{MICRO SIGN}m", "lead")  # what `report` prints
    assert lead(Page("t", "", (stated,))) == "eta of 3 um, 3 um"


def test_a_click_in_a_figure_is_at_the_values_of_its_axes():
    """The place of a point with a text, by the ends of both axes, has the values of the point."""
    x = Axis(label="a [um]", size=1e-6, low=1e-6, high=1e-4, is_log=True)
    # a 0 has no place on a logarithmic axis; it left the figure without room and warned
    point = Trace(x=(1e-5, 2e-5, 0.0), y=(0.25, 0.5, 0.1), line="", marker="o", hover=("here", "there", "0"))
    panel = Panel(title="", x=x, y=Axis(label="b [-]", low=0.0, high=1.0), marks=(point,))
    drawing = save(Figure(rows=((panel,),), heading=("above", "it")))
    (across, down, _), _ = drawing.targets
    along, up = drawing.ways
    share = (across / drawing.width - along.start) / (along.end - along.start)
    # places of points are to a hundredth of a point
    assert along.low * (along.high / along.low) ** share == pytest.approx(1e-5, rel=1e-3)
    share = (down / drawing.height - up.start) / (up.end - up.start)
    assert up.low + (up.high - up.low) * share == pytest.approx(0.25, rel=1e-3)


def test_uncertain_inputs_are_said_to_be_at_their_means(answers):
    """By verbs that do not draw them; in a notebook an answer is its page."""
    assert "<h1>" in answers("bearing")._repr_html_()
    assert "at their means: bearing.contact_angle" in answers("bearing").summary()
    assert "at their means" not in answers("sensitivity").summary()


def test_an_old_document_names_what_it_lacks():
    """What an answer of an earlier version lacks is said with its place."""
    study = replace(read_study("momentum-wheel"), cage=None, ranking=None)
    document = separatrix.bearing(study).document()
    del document["contacts"]["outer"]["approach"]
    with pytest.raises(InputError, match=r"old\.json: contacts: outer lacks approach"):
        text(page_of_document(verb_named("bearing"), document, "old.json"))
