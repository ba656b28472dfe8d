"""The report of answers, section by section, and that of two designs; the answers that a report needs."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING

from separatrix.comparing.pair import compared, differences, of_study, pair_of
from separatrix.comparing.records import Comparison, Noise
from separatrix.comparing.records import Row as Differing
from separatrix.comparing.saved import Saved, read_file
from separatrix.comparing.shown import (
    EXACT,
    input_words,
    notes_of,
    pair_words,
    pictures,
    result_words,
    shown_rows,
)
from separatrix.ground.errors import InputError
from separatrix.reporting.evidence import evidence, inputs, outside, provenance, uncertainty
from separatrix.reporting.first_page import first_page
from separatrix.reporting.pictures import picture, picture_of
from separatrix.reporting.record import Block, Facts, Kept, Paragraph, Report, Row, Section, Table, quantity
from separatrix.reporting.stages import bearing_and_cage, stages
from separatrix.told.sentences import deciding, margin, probability, time_shares, verdict
from separatrix.verbs import Computed, Verb, verb_named

if TYPE_CHECKING:
    from separatrix.study.study import Study

MOST_CASES = 40
MOST_ROWS = 40
"""Results of a table of two designs; compare.json has all."""

NEEDED = {
    "bearing": ("balls", "contacts"),
    "traction": ("inner", "outer", "outside"),
    "restitution": ("restitution_factor", "race_damping", "inner", "outer"),
    "stability": ("curve", "here", "chain", "cage"),
    "rank": ("environment", "environments", "stability", "chain", "pocket"),
    "sensitivity": ("environment", "environments", "drivers", "next_tests", "undecided"),
    "map": (),
    "sweep": ("parameters", "cases", "worst", "duty"),
}
"""Verbs that a report shows, in the order of the chain, and the keys that each document must have."""

ALWAYS = ("separatrix_version", "title", "name", "study", "seed", "warnings")


def report_of(kept: Mapping[str, Kept], missing: Sequence[str] = ()) -> Report:
    """Return the report of answers to one study.

    Parameters
    ----------
    kept : mapping
        The answers by verb, in the order of the chain.
    missing : sequence of str
        What could not be computed, a sentence each: caveats of the first page.
    """
    main = next(kept[verb] for verb in ("rank", "stability", *kept) if verb in kept).document
    return Report(
        title=str(main["title"]),
        subtitle=f"Study {main['name']}, computed by separatrix {main['separatrix_version']}",
        sections=(first_page(kept, [*_about(kept), *missing]), *_sections(kept)),
        documents={verb: one.document for verb, one in kept.items()},
    )


def _sections(kept: Mapping[str, Kept]) -> Iterator[Section]:
    yield bearing_and_cage(kept)
    yield from stages(kept)
    if "rank" in kept:
        yield evidence(kept["rank"])
    if "map" in kept:
        words = "The verdict in the plane of two inputs; the star is the study itself."
        alt = "Map of the share of runs that whirl over two inputs of the study."
        shown = picture(kept["map"], "stability-map", "Share of the runs that whirl.", alt)
        yield Section("Stability map", (Paragraph(words), *shown))
    if "sweep" in kept:
        yield Section("Operating envelope", tuple(_envelope(kept["sweep"])))
    yield uncertainty(kept)
    yield outside(kept)
    yield inputs(kept)
    yield provenance(kept)


def _envelope(kept: Kept) -> Iterator[Block]:
    found = kept.document
    worst, cases = found["worst"], found["cases"]
    names = {str(one["name"]).rpartition(".")[2].replace("_", " "): one for one in found["parameters"]}
    if worst is not None:
        case = next(row for row in cases if row["case"] == worst["case"])
        at = ", ".join(f"{name} {_value(case, one)}" for name, one in names.items())
        words = f"Of {worst['compared']} cases the worst is number {worst['case']}: {at}. "
        yield Paragraph(f"{words}It has the {deciding(worst['quantity'], worst['value'])}.")
    if (duty := found["duty"]) is not None:
        yield Facts(tuple((f"Time {words}", share) for words, share in time_shares(duty)))
    words = "Stability and frequencies over the cases; orders are those of shaft, cage and balls."
    shown = (one for name in ("envelope", "sweep") for one in picture(kept, name, words, words))
    yield from islice(shown, 1)
    yield _cases(cases, names)


def _value(case: Row, parameter: Row) -> str:
    return quantity(case[parameter["name"]], parameter["unit"] or "-")


def _cases(cases: list[Row], names: Mapping[str, Row]) -> Table:
    head = ("case", *names, "eta", "margin", "P(stable)", "verdict or reason")
    rows = tuple(
        (
            str(case["case"]),
            *(_value(case, one) for one in names.values()),
            quantity(case["restitution_factor"], "-", 3),
            margin(case),
            probability(case),
            verdict(case) if case["verdict"] else case["reason"] or "-",
        )
        for case in cases[:MOST_CASES]
    )
    more = len(cases) - MOST_CASES
    return Table(head, rows, f"The cases{f'; {more} more are in the answer' if more > 0 else ''}.")


def report_of_two(first: Mapping[str, Saved], second: Mapping[str, Saved]) -> Report:
    """Return the report of two designs, each with its answers by verb: on the first verb that both have."""
    one, other, also = pair_of(first, second)
    found = compared(one, other, also)
    titles = [answer.title for answer in found.answers]
    return Report(
        title=titles[0] if titles[0] == titles[1] else f"{titles[0]} and {titles[1]}",
        subtitle=f"Two answers of {found.of} compared",
        sections=(
            Section("What changed", tuple(_changes(found, one, other))),
            Section("Inputs that differ", tuple(_changed_inputs(found))),
            Section("Results that differ", tuple(_changed_results(found))),
        ),
        documents={},
    )


def _changes(found: Comparison, one: Saved, other: Saved) -> Iterator[Block]:
    verdicts = found.verdicts
    counted = [row for row in found.rows if row.noise in (Noise.BEYOND, Noise.WITHIN)]
    beyond = sum(row.noise is Noise.BEYOND for row in counted)
    inputs = len(found.differences)
    yield Paragraph(f"{_count(inputs, 'input')} differ{'s' if inputs == 1 else ''}.", "lead")
    shared = f"{_count(len(verdicts), 'verdict')} changed, of {found.shared_verdicts} that both have."
    yield Paragraph(shared if found.shared_verdicts else "They have no verdict in common.", "lead")
    words = f"{_count(beyond, 'result')} changed by more than counting noise"
    yield Paragraph(f"{words}, of {len(counted)} that are counted in runs." if counted else EXACT, "lead")
    names = zip(("First", "Second"), found.answers, strict=True)
    yield Facts(tuple((name, f"{one.title} ({one.path}, seed {one.seed})") for name, one in names))
    if verdicts:
        head = ("where", "what", "first", "second")
        rows = tuple((row.place, row.name, *pair_words(row)) for row in verdicts[:MOST_ROWS])
        yield Table(head, rows, "Verdicts that changed.", left=4)
    margins = [row for row in found.rows if row.name == "margin" and row.place.startswith(_own(found))]
    if margins:
        yield _changed_table(margins, f"Margins in {_own(found)}, with 95 % intervals.", _own(found))
    words = "One run of each." if found.of == "simulate" else "Critical friction and margins of both designs."
    for name, figure in pictures(one, other):
        yield picture_of(figure, name, words, words)


def _own(found: Comparison) -> str:
    """Return the environment of the bearing, as places of results begin with it."""
    return found.environment or "overall"


def _changed_inputs(found: Comparison) -> Iterator[Block]:
    rows = tuple(
        (at.key, input_words(at.first, at.unit), input_words(at.second, at.unit)) for at in found.differences
    )
    head = ("input", "first", "second")
    yield Table(head, rows, "Keys of the study, then options.") if rows else Paragraph("None.")


def _changed_results(found: Comparison) -> Iterator[Block]:
    rows = [row for row in shown_rows(found) if row.name != "margin"]
    if not rows:
        yield Paragraph("None.")
        return
    caption = "The largest changes first; `separatrix compare` has all."
    yield _changed_table(rows[:MOST_ROWS], caption, _own(found))
    for note in notes_of(found, len(rows)):
        yield Paragraph(note)


def _changed_table(rows: Sequence[Differing], caption: str, own: str) -> Table:
    head = ("where", "what", "first", "second", "change", "noise")
    return Table(head, tuple(tuple(result_words(row, own)) for row in rows), caption, left=2)


def _count(number: int, noun: str) -> str:
    return f"{'No' if number == 0 else number} {noun}{'' if number == 1 else 's'}"


def _about(kept: Mapping[str, Kept]) -> list[str]:
    """Return how the answers of a folder differ in their inputs from the main one, a sentence for each."""
    main = next(verb for verb in ("rank", "stability", *kept) if verb in kept)
    sentences = []
    for verb, one in kept.items():
        names = _differing(kept[main].document, one.document)
        if names:
            more = f" and {len(names) - 4} more" if len(names) > 4 else ""
            sentences.append(
                f"`{verb}` was computed from other inputs than `{main}`: {', '.join(names[:4])}{more} differ."
            )
    return sentences


def read_folder(folder: Path, *, needed: bool = True) -> dict[str, Kept]:
    """Return the answers of a folder that a report can show, by verb.

    Parameters
    ----------
    folder : Path
        It exists.
    needed : bool
        Whether a folder without any is refused.

    Raises
    ------
    InputError
        There is none, or a file is not an answer of separatrix.
    """
    found = {}
    for verb in NEEDED:
        path = folder / f"{verb}.json"
        if path.exists():
            found[verb] = Kept(read_document(path, verb))
    if needed and not found:
        names = ", ".join(f"{verb}.json" for verb in NEEDED)
        cure = "Name the folder of an answer, or a study: separatrix report cryogenic-turbopump."
        raise InputError(str(folder), f"contains no answer of separatrix ({names})", cure=cure)
    return found


def read_document(path: Path, verb: str) -> Row:
    """Return a saved document; one that is not of this verb, or lacks what a report needs, is refused."""
    where, cure = str(path), "Compute this answer again, or remove the file."
    saved = read_file(path)
    if saved.verb != verb:
        raise InputError(where, f"is not a document of `{verb}`", cure=cure)
    found = saved.document
    missing = [key for key in (*ALWAYS, *NEEDED[verb]) if key not in found]
    if missing or not isinstance(found["study"].get("bearing"), dict):
        raise InputError(where, f"lacks {', '.join(missing) or 'its study'}", cure=cure)
    return found


def _differing(first: Row, second: Row) -> list[str]:
    """Return the names of the inputs that differ between two documents, and the version if that does."""
    ours, theirs = (dict(of_study(one["study"])) for one in (first, second))
    names = [at.key for at in differences(ours, theirs)]
    beside = {"version of separatrix": "separatrix_version", "seed": "seed"}
    return names + [words for words, key in beside.items() if first[key] != second[key]]


def verbs_of(study: Study) -> Iterator[str]:
    """Yield the verbs that a report of a study needs, in the order of the chain."""
    yield from ("bearing", "traction")
    if study.cage is not None:
        yield "restitution"
        yield "stability" if study.ranking is None else "rank"


def answers(kept: Kept, study: Study) -> bool:
    """Whether an answer is complete, from this version, and to this study."""
    from separatrix import __version__
    from separatrix.ground.plain_data import plain
    from separatrix.study.sources import resolved

    found = kept.document
    asked = {"study": plain(resolved(study), "study"), "seed": study.stability.seed}
    asked["separatrix_version"] = __version__
    return all(found[key] == value for key, value in asked.items()) and found.get("complete", True) is True


def keeping(compute: Callable[[Verb], Computed], folder: Path | None) -> Callable[[str], Kept]:
    """Return what computes an answer; its files are written if there is a folder, without figures."""
    from separatrix.verbs.answer_files import document, save_answer

    def kept(verb: str) -> Kept:
        made = compute(verb_named(verb))
        found = document(verb, made.record, made.study, made.question)
        if folder is not None:
            save_answer(folder, made.record, made.study, found, pictures=False)
        return Kept(found)

    return kept


def answers_of(
    study: Study, folder: Path | None, compute: Callable[[str], Kept]
) -> tuple[dict[str, Kept], list[str], bool]:
    """Return the answers to a study, what was refused, and whether no answer was interrupted.

    Those in the folder are taken; the others that a report needs are computed.
    """
    known = read_folder(folder, needed=False) if folder is not None else {}
    found = {verb: one for verb, one in known.items() if answers(one, study)}
    missing = add_missing(found, verbs_of(study), compute)
    complete = all(one.document.get("complete", True) for one in found.values())
    return {verb: found[verb] for verb in NEEDED if verb in found}, missing, complete


def add_missing(found: dict[str, Kept], wanted: Iterable[str], compute: Callable[[str], Kept]) -> list[str]:
    """Compute the wanted answers that are not there; return what was refused, a sentence each."""
    missing = []
    for verb in wanted:
        if verb in found:
            continue
        try:
            found[verb] = compute(verb)
        except InputError as error:
            if not found:
                raise
            missing.append(f"`{verb}` was not computed: {error}")
            continue
        if found[verb].document.get("complete") is False:
            break
    return missing
