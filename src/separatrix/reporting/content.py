"""The report of a folder's answers, section by section, and that of two designs: what differs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import islice

from separatrix.comparing.pair import compared, pair_of
from separatrix.comparing.records import Comparison, Noise
from separatrix.comparing.records import Row as Differing
from separatrix.comparing.save import pictures
from separatrix.comparing.saved import Saved
from separatrix.comparing.text import EXACT, input_words, notes_of, pair_words, result_words, shown_rows
from separatrix.present.text.stability import DECIDES
from separatrix.reporting.evidence import about, evidence, outside, uncertainty
from separatrix.reporting.first_page import first_page
from separatrix.reporting.inputs import inputs, provenance
from separatrix.reporting.kept import Kept
from separatrix.reporting.pictures import picture, picture_of
from separatrix.reporting.record import (
    Block,
    Facts,
    Paragraph,
    Report,
    Row,
    Section,
    Table,
    margin,
    probability,
    quantity,
    verdict,
)
from separatrix.reporting.stages import bearing_and_cage, stages

MOST_CASES = 40
TIMES = {
    "below_margin": "with a margin below 0",
    "stable": "STABLE",
    "unstable": "UNSTABLE",
    "undecided": "UNDECIDED",
    "refused": "without an answer",
}
MOST_ROWS = 40
"""Results of a table of two designs; compare.json has all."""


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
        sections=(first_page(kept, [*about(kept), *missing]), *_sections(kept)),
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
        shown = picture("map", kept["map"].data, "stability-map", "Share of the runs that whirl.", alt)
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
        yield Paragraph(f"{words}It has the {DECIDES[worst['quantity']]}: {worst['value']:.3g}.")
    if (duty := found["duty"]) is not None:
        known = {words: duty[key] for key, words in TIMES.items() if duty[key] is not None}
        yield Facts(tuple((f"Time {words}", f"{100 * share:.3g} %") for words, share in known.items()))
    words = "Stability and frequencies over the cases; orders are those of shaft, cage and balls."
    shown = (one for name in ("envelope", "sweep") for one in picture("sweep", kept.data, name, words, words))
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
    """Return the report of two designs, each with its answers by verb: on the first verb that both have.

    Raises
    ------
    InputError
        They share no verb.
    """
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
    yield Paragraph(f"{_count(len(verdicts), 'verdict')} changed.", "lead")
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
