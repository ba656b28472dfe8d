"""The report of two designs: what changed between their inputs, and in the answers by more than noise."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from separatrix.comparing.drawing import pictures
from separatrix.comparing.pair import compared, pair_of
from separatrix.comparing.records import Comparison, Noise, Row
from separatrix.comparing.saved import Saved
from separatrix.comparing.text import EXACT, input_words, notes_of, pair_words, result_words, shown_rows
from separatrix.reporting.pictures import picture_of
from separatrix.reporting.record import Block, Facts, Paragraph, Report, Section, Table

MOST_ROWS = 40
"""Results of a table; compare.json has all."""

COUNTED = (Noise.BEYOND, Noise.WITHIN)


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
            Section("What changed", tuple(_first_page(found, one, other))),
            Section("Inputs that differ", tuple(_inputs(found))),
            Section("Results that differ", tuple(_results(found))),
        ),
        documents={},
    )


def _first_page(found: Comparison, one: Saved, other: Saved) -> Iterator[Block]:
    verdicts, counted = found.verdicts, [row for row in found.rows if row.noise in COUNTED]
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
        yield _table(margins, f"Margins in {_own(found)}, with 95 % intervals.", _own(found))
    words = "One run of each." if found.of == "simulate" else "Critical friction and margins of both designs."
    for name, figure in pictures(one, other):
        yield picture_of(figure, name, words, words)


def _own(found: Comparison) -> str:
    """Return the environment of the bearing, as places of results begin with it."""
    return found.environment or "overall"


def _inputs(found: Comparison) -> Iterator[Block]:
    if not found.differences:
        yield Paragraph("None.")
        return
    rows = [
        (at.key, input_words(at.first, at.unit), input_words(at.second, at.unit)) for at in found.differences
    ]
    yield Table(("input", "first", "second"), tuple(rows), "Keys of the study, then options.", left=1)


def _results(found: Comparison) -> Iterator[Block]:
    rows = [row for row in shown_rows(found) if row.name != "margin"]
    if not rows:
        yield Paragraph("None.")
        return
    yield _table(rows[:MOST_ROWS], "The largest changes first; `separatrix compare` has all.", _own(found))
    for note in notes_of(found, len(rows)):
        yield Paragraph(note)


def _table(rows: Sequence[Row], caption: str, own: str) -> Table:
    head = ("where", "what", "first", "second", "change", "noise")
    return Table(head, tuple(tuple(result_words(row, own)) for row in rows), caption, left=2)


def _count(number: int, noun: str) -> str:
    return f"{'No' if number == 0 else number} {noun}{'' if number == 1 else 's'}"
