"""Tables of the reference, written from the records: keys of a study, names of the documents, quantities."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import is_dataclass
from typing import Any, NamedTuple, get_args, get_origin, get_type_hints

from reference_meanings import Line, lines_of

from separatrix.chain.clearances import Clearances
from separatrix.chain.contacts import BearingState, RaceContact
from separatrix.chain.impact_restitution import Restitution
from separatrix.chain.solution import Solution
from separatrix.friction.logs.log import ColumnRead, RawLog
from separatrix.friction.reduction import TestCourse, TestFriction
from separatrix.ground.schema import Described, is_record, keys_of
from separatrix.ground.units import UNITS, format_quantity
from separatrix.present.quantity_text import QUANTITIES
from separatrix.study import study
from separatrix.study.ball_bearing import Material
from separatrix.study.template import keys_in, remark_of, sections, study_keys
from separatrix.verbs import cage_answers, chain_answers
from separatrix.verbs.compare import Row
from separatrix.verbs.report import FACTORS, claims
from separatrix.verdict.swept_cases import Duty, Sweep, WorstCase

KEYS = """# Keys of a study

After this page you can look up each key of a study file: its unit, the values that it takes, its meaning and
its default. The page is written from the program. Rules that connect several keys:
[study file](../reference/study-file.md). The unit is that of the results; the file may state
[another of the same kind](../reference/study-file.md#how-values-are-written).
"""
NAMES = """# Names in the JSON documents

After this page you can look up each name in the document that `--json` prints: its unit, its shape and its
meaning. The page is written from the records of the program. All numbers are in SI units. What the parts
of a document are for, and the files beside it: [results](../reference/results.md). Symbols of the paper:
[nomenclature](nomenclature.md).

Every document of a study has `separatrix_version`, `verb`, `name` and `title` (of the study), `seed`,
`warnings` (sentences), `provenance` (what `reproduce` needs), `study` (every resolved input with
`value`, `unit` and `origin`) and `units` (of each result, under the same names).
"""
QUANTITIES_HEAD = """# Nomenclature

After this page you can go from a symbol of the paper to its name in the program, and back. A quantity has
the same name in the study file, in Python, in JSON and in the datasets, and SI units everywhere (angles in
rad). Text, tables and figures show handier units and the label. The page is written from the program; every
name of an answer, whether it is told or not: [names in the documents](json-names.md).

Axes of arrays have fixed names: `ball`, `race`, `strip`, `node`, `time`, `kick`, `run`, `case`. A singular
name is one value, a plural an array. `inner` and `outer` are the rings, never I and E or one letter.
"""
PAPER = dict(
    one.split(maxsplit=1)
    for one in """
ball_diameter D; pitch_diameter d_m; ball_count Z; radial_clearance P_d; inner_conformity f_i;
outer_conformity f_o; inner_speed omega_I; outer_speed omega_E; load_inner N_I; load_outer N_E; load N;
spin_roll_ratio Delta omega_piv / Delta omega_roul; ball_spin omega_S; rolling_speed_inner V_I^roul;
rolling_speed_outer V_E^roul; across y; contact_modulus E*; curvature_rolling 1/R_x;
curvature_transverse 1/R_y; elastic_modulus E_film; thickness h; creep_ratio xi; creep_increment delta xi;
shear tau; creep_spin s; creep_curvature q; orbital_cosines A_h; orbital_sines B_h; half_play c_p; lean tau;
rates lambda_i; kick v_0; damping_relaxed C_eff; hertz_coefficient K_H; moment_of_inertia J; pitch_radius R;
cage_speed Omega; drive_energy E_drive; largest_offset r; pocket_clearance 2 c_p; land_clearance 2 c_g;
pocket_axial_clearance 2 c_a; slip_speed_inner v_e; slip_speed_outer v_e; pocket_friction_effect k;
transverse_inertia J_t; cage_frequency f_c; shaft_frequency f_i
""".replace("\n", " ").split(";")
)
"""Symbols that the paper or the theory has for a name, where the table of quantities does not show one."""
UNSTATED = {"run_in_end": "s", "steady_end": "s", "effective_count": "-"}
"""Units that no field states: places along a test are in the SI unit of `run_in_axis`, here of a time."""
LEFT_OUT = frozenset({study.Study, Solution})
"""Records that a document does not repeat: the study has its own place, the chain is in `chain`."""


class Verb(NamedTuple):
    """What a document is made of: records, and names that no record has."""

    records: tuple[type, ...]
    own: tuple[Line, ...] = ()


CHAIN_RECORDS = (Restitution, RaceContact, Clearances)
RACES = (
    Line("inner", meaning="the contact of the most loaded ball with the inner race"),
    Line("outer", meaning="the same with the outer race"),
)
CONTACTS = (
    *RACES,
    Line("clearances", meaning="clearances as the cage runs; null for a study that states them"),
    Line("creep_spin", "1/m", meaning="creep across the contact by spin"),
    Line("creep_curvature", "1/m2", meaning="creep across the contact by its curvature"),
)
OF_BEARING = (
    *CONTACTS,
    Line("balls", meaning="a row for each ball; quantities with the dimension `ball` are in it"),
    Line("ball", meaning="number of the ball, from 0"),
    Line("contacts", meaning="contacts of the most loaded ball, `inner` and `outer`"),
    Line("most_loaded", meaning="number of the most loaded ball"),
)
SLOPE = (
    Line("slope", "-", meaning="alpha, increase of the traction coefficient with the creep increment at 0"),
    Line("slope_error", "-", meaning="estimated error of the slope"),
    Line("free_rolling_offset", "-", meaning="creep increment at which the traction is zero"),
)
CHAIN = (
    *CONTACTS,
    *SLOPE,
    Line("stiffness_source", meaning="where the stiffness of ball and pocket comes from"),
    Line("restitution_factor_hertz", "-", meaning="restitution factor of a Hertzian pocket, impact speed"),
)
OF_CAGE = (
    *CHAIN,
    Line("chain", meaning="the chain before the cage: restitution, contacts and slopes"),
    Line("half_play", "m", meaning="half the clearance of a ball in its pocket"),
    Line("axial_half_play", "m", meaning="half that along the axis; null in the plane"),
    Line("lead_amplitude", "m", meaning="largest lead of a ball by uneven orbital speed"),
    Line("orbital_share", "-", meaning="share of the balls' uneven speed that the cage model uses"),
)
RUN = (
    *OF_CAGE,
    Line(
        "race_damping", "N s/m", meaning="in `cage`: null where it is infinite, at a restitution factor of 1"
    ),
    *(
        Line(name, "J", "time", f"in `work`: done on the cage by {what}")
        for name, what in (
            ("pocket_friction", "the friction of the pockets"),
            ("land_friction", "the friction of the land"),
            ("land_normal", "the spring and the damper of the land"),
            ("balls", "the balls: what the races take from them, less what drives them"),
            ("frame_and_loads", "the turning frame, gravity and unbalance"),
        )
    ),
)
COUNTS = tuple(
    Line(name, meaning=f"in `counts`: points {what}")
    for name, what in (
        ("STABLE", "with this decision"),
        ("UNSTABLE", "with this decision"),
        ("UNDECIDED", "with this decision"),
        ("refused", "that are not a bearing"),
        ("not_run", "that an interrupt left out"),
    )
)
ROWS = (
    *OF_CAGE,
    *(
        Line(
            f"uncertain_{name}",
            "" if name == "verdict" else "-",
            meaning=f"`{name}` where every run draws its own bearing; null without uncertain inputs",
        )
        for name in ("verdict", "probability_stable", "probability_low", "probability_high", "runs")
    ),
)
ANSWERS = (("path", "where it is"), ("title", "that of its study"), ("complete", "whether it is finished"))
TRIBOMETER = (
    Line("files", meaning="a row for each log"),
    Line("rows", meaning="rows that were read"),
    Line("tests", meaning="a row for each test; in `fits` the number of tests"),
    Line("course", meaning="friction along the test, and what the log has beside it"),
    Line("friction_low", "-", meaning="lower end of the 95 % interval of the friction"),
    Line("friction_high", "-", meaning="upper end of it"),
    Line("fits", meaning="a row for each material in each environment; empty where a test lacks conditions"),
    Line("environment", meaning="medium and counterface"),
    Line("scatter_source", meaning="where the scatter comes from"),
    Line("slopes", meaning="change of the logarithm of friction with that of a condition, by its name"),
    Line("tested", meaning="range of each condition in the tests, by its name"),
    Line("default_scatter", "-", meaning="assumed for an unrepeated test, as a share of the mean"),
    Line("friction_file", meaning="path of the friction file, null if none was written"),
)
COMPARISON = (
    Line("of", meaning="verb of the two answers"),
    Line("answers", meaning="the two in the order given: `path`, `title`, `seed`, `complete`"),
    *(Line(name, meaning=f"of an answer: {what}") for name, what in ANSWERS),
    Line("environment", meaning="the bearing's own, where both agree; else null"),
    Line("inputs", meaning="inputs that differ, `first` and `second`"),
    Line("key", meaning="of an input: key of the study, or option"),
    Line("rows", meaning="results that differ, at most 500; those that a reader decides by come first"),
    Line("left_out", meaning="number of rows beyond these"),
    Line("also", meaning="other verbs of both folders"),
)
REPRODUCED = (
    Line("same", meaning="whether all answers are the same, to rounding"),
    Line("answers", meaning="each answer that was computed again"),
    Line("agreement", meaning="bit for bit, to rounding, or different"),
    Line("count", "-", meaning="number of keys that differ beyond rounding"),
    Line(
        "differences",
        meaning="the first of them, or the largest to rounding: `key`, `stored`, `computed`, `relative`",
    ),
    Line("versions", meaning="versions that differ here: `name`, `stored`, `here`"),
    Line("stored", meaning="value of the saved answer"),
    Line("here", meaning="of a version: the one here"),
)
REPORTED = (
    Line("answers", meaning="verbs whose answers the report shows"),
    Line("summary", meaning="sentences of its first page"),
    Line("files", meaning="paths that were written"),
)
TRACTION = (
    Line("area", meaning="fields of the exact contact in free rolling"),
    *CONTACTS,
    Line("by_spin_roll_ratio", meaning="curves by strips at other spin-to-roll ratios"),
    Line("shear", meaning="shear of a few strips in free rolling"),
)
FILMS = (
    *CHAIN,
    Line("lubrication_reason", meaning="why there is no `lubrication`"),
)
VERBS = {
    "check": Verb((chain_answers.CheckAnswer,), CONTACTS),
    "bearing": Verb((BearingState, Clearances), OF_BEARING),
    "traction": Verb((chain_answers.TractionAnswer,), TRACTION),
    "restitution": Verb((*CHAIN_RECORDS, chain_answers.RestitutionAnswer), FILMS),
    "mobility": Verb((chain_answers.MobilityAnswer,)),
    "stability": Verb((cage_answers.StabilityAnswer, *CHAIN_RECORDS), OF_CAGE),
    "map": Verb((cage_answers.MapAnswer, *CHAIN_RECORDS), (*OF_CAGE, *COUNTS)),
    "simulate": Verb((cage_answers.SimulationAnswer, *CHAIN_RECORDS), RUN),
    "rank": Verb((cage_answers.RankingAnswer, *CHAIN_RECORDS), ROWS),
    "sensitivity": Verb((cage_answers.SensitivityAnswer, *CHAIN_RECORDS), OF_CAGE),
    "life": Verb((cage_answers.LifeAnswer, *CHAIN_RECORDS), OF_CAGE),
    "sweep": Verb(
        (Sweep, WorstCase, Duty),
        (
            Line("worst", meaning="the worst case"),
            Line("duty", meaning="shares of the time"),
            Line("case", meaning="number of the case"),
        ),
    ),
    "compare": Verb((Row,), COMPARISON),
    "reproduce": Verb((), REPRODUCED),
    "report": Verb((), REPORTED),
    "tribometer": Verb((RawLog, ColumnRead, TestFriction, TestCourse), TRIBOMETER),
}


def records_of(*roots: type) -> tuple[type, ...]:
    """Return record classes and those that their fields hold, each once and after what holds it."""
    found: dict[type, None] = {}
    for root in roots:
        _collect(root, found)
    return tuple(found)


def _collect(record: type, found: dict[type, None]) -> None:
    if record in found or record in LEFT_OUT:
        return
    found[record] = None
    for hint in get_type_hints(record).values():
        for inside in _records_in(hint):
            _collect(inside, found)


def _records_in(hint: Any) -> Iterator[type]:
    if isinstance(hint, type) and is_dataclass(hint):
        yield hint
    for argument in get_args(hint):
        yield from _records_in(argument)


def names_of(verb: str) -> set[str]:
    """Return every name that the tables of a verb have a line for."""
    made_of = VERBS[verb]
    return {line.name for record in records_of(*made_of.records) for line in lines_of(record)} | {
        line.name for line in made_of.own
    }


def json_page() -> str:
    """Return the page of the names in the documents: what a verb is made of, then each record once."""
    page, shown = [NAMES], dict[type, None]()
    for verb, made_of in VERBS.items():
        records = records_of(*made_of.records)
        shown |= dict.fromkeys(records)
        links = ", ".join(f"[{one.__name__}](#{_anchor(one)})" for one in records)
        page += [f"## {verb}\n", *([f"Records: {links}.\n"] if records else []), *_table(made_of.own)]
    page += ["## Records\n"]
    for record in shown:
        text, _, _ = inspect.cleandoc(record.__doc__ or "").partition("\nAttributes\n")
        text, _, _ = text.partition("\nParameters\n")
        name = record.__name__
        page += [f"({_anchor(record)})=\n### {name}\n", _markdown(text).strip() + "\n"]
        page += _table(lines_of(record))
    return "\n".join(page)


def _anchor(record: type) -> str:
    return f"{record.__module__}-{record.__name__}".removeprefix("separatrix.").replace(".", "-").lower()


def _table(lines: Iterable[Line]) -> list[str]:
    rows = [f"| `{one.name}` | {one.unit} | {one.shape} | {_cell(one.meaning)} |" for one in lines]
    return ["| name | unit | dimensions | meaning |\n|---|---|---|---|", *rows, ""] if rows else []


def _markdown(text: str) -> str:
    text = re.sub(r":(?:\w+):`(\\?[^`]*)`", r"$\1$", text)
    return re.sub(r"(?<!`)``?([^`]+)``?(?!`)", r"`\1`", text)


def _cell(text: str) -> str:
    return _markdown(text).replace("|", "\\|").replace("*", "\\*")


def lines_by_name() -> dict[str, list[Line]]:
    """Return every line of the documents and of the studies under its name."""
    found: dict[str, list[Line]] = {}
    for made_of in VERBS.values():
        for record in records_of(*made_of.records):
            for line in lines_of(record):
                found.setdefault(line.name, []).append(line)
        for line in made_of.own:
            found.setdefault(line.name, []).append(line)
    for path in sections():
        for key in study_keys(path):
            unit = key.one.unit if key.one.unit in UNITS else "-"
            found.setdefault(key.name, []).append(Line(key.name, unit, "", key.meaning))
    return found


def quantities_page() -> str:
    """Return the page of the quantities: symbol, label, name, unit and meaning, by name."""
    page = [QUANTITIES_HEAD, "| symbol | name | unit | label | meaning |\n|---|---|---|---|---|"]
    known = lines_by_name()
    for name in sorted({*QUANTITIES, *PAPER}):
        one = QUANTITIES.get(name)
        label, symbol = (one.label, one.symbol) if one else ("", "")
        meaning = (one.meaning if one else "") or next((x.meaning for x in known[name] if x.meaning), "")
        meaning = "" if meaning == label else meaning
        symbols = " or ".join(dict.fromkeys(sign for sign in (PAPER.get(name), symbol) if sign))
        cells = (_cell(symbols), f"`{name}`", units_of_name(name, known), _cell(label), _cell(meaning))
        page.append(f"| {' | '.join(cells)} |")
    return "\n".join([*page, ""])


def credibility_claims() -> str:
    """Return the claimed levels of each part of the program, with what they rest on and what is missing."""
    page: list[str] = []
    for part in claims():
        page += [
            f"### {part['name']}\n",
            f"{part['covers']}\n",
            "| factor | level | rests on | for the next level |",
        ]
        page += ["|---|---|---|---|"]
        page += [
            f"| {words} | {one['level']} | {one['evidence']} | {one['missing']} |"
            for words, one in ((words, part[key]) for key, words in FACTORS.items())
        ]
        page.append("")
    return "\n".join(page)


def units_of_name(name: str, known: Mapping[str, list[Line]]) -> str:
    """Return the SI units that a name has in the records; empty if none states one."""
    units = dict.fromkeys(line.unit for line in known.get(name, ()) if line.unit)
    return UNSTATED.get(name) or " or ".join(units)


def study_page() -> str:
    """Return the page of the keys of a study, section by section, with those of records inside."""
    film = sections()["film"]
    found = {path: study_keys(path) for path in sections()}
    found["film.wear"] = tuple(keys_in("film.wear", keys_of(film)["wear"].hint))
    found["ball_material"] = tuple(keys_in("material", Material))
    heads = {"": "Above the first section", "ball_material": "A material in place"}
    page = [KEYS]
    for path, keys in found.items():
        page.append(f"## {heads.get(path, f'[{path}]')}\n")
        if path in sections() and (remark := remark_of(path)):
            page.append(f"{remark}\n")
        page.append("| key | unit | takes | meaning |\n|---|---|---|---|")
        for key in keys:
            unit = key.one.unit if key.one.unit in UNITS else ""
            page.append(f"| `{key.name}` | {unit} | {_takes(key.one)} | {_cell(key.meaning)} |")
        page.append("")
    return "\n".join(page)


def _takes(one: Described) -> str:
    """Return the values of a key in words."""
    hint, bound, unit = one.hint, one.key.bound, one.unit or "-"
    kinds = {int: "whole number", bool: "true or false", str: "text"}
    table = "name or table" if one.key.named else "table"
    kind = "list" if get_origin(hint) is tuple else table if is_record(hint) else kinds.get(hint, "")
    if bound is None or bound.low == -bound.high < -1e3:  # nothing real is outside
        return kind
    low, high = (f"{end:.0f}" if hint is int else format_quantity(end, unit) for end in bound[:2])
    ends = f"{'above ' * bound.open_low}{low} to {'below ' * bound.open_high}{high}"
    return ", ".join(part for part in (kind, bound.sign or ends) if part)
