"""Reading tribometer logs through column maps; what a file holds shows in its content, not in its name.

A file is read by the map that is named, by that of a known layout, or by its heads where these leave no
question. Else a draft of a map is made, for the user to look at: nothing is guessed in silence.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

from separatrix.friction.logs.column_map import (
    ColumnMap,
    column_map_of,
    read_column_map,
    shipped_maps,
)
from separatrix.friction.logs.draft import Draft, draft_of
from separatrix.friction.logs.log import RawLog, UnfitError, raw_log
from separatrix.friction.logs.tables import Block, Content, blocks_of, cells_of, content_of, matching
from separatrix.ground.errors import InputError
from separatrix.ground.units import printable, shown

__all__ = ["UnmappedError", "read_column_map", "read_log"]


class UnmappedError(InputError):
    """A log with open questions: it has a draft of its column map."""

    draft: str = ""
    place: Path = Path()
    """Where the draft is to be written."""

    def with_draft_written(self) -> InputError:
        """The refusal, its draft written beside the log and named in its cure; a file there is kept."""
        name = printable(self.place.name, 150)
        others = self.cure.partition("beside the log.")[2]
        cure = f"Look at the draft {name} beside the log, and add: --map {name}."
        try:
            with self.place.open("x", encoding="utf-8") as file:
                file.write(self.draft)
        except FileExistsError:
            look = f"There is a file {name}: look at it, and add: --map {name}."
            cure = f"{look} Without it, a new draft is written."
        except OSError as fault:
            cure = f"A draft of a column map could not be written beside the log: {fault.strerror}."
        return self.at(self.path, cure=f"{cure}{others}")


def read_log(path: str | Path, column_map: ColumnMap | None = None) -> tuple[RawLog, ...]:
    """Logs of one file: one for each table, sheet or step in it.

    Parameters
    ----------
    path : str or Path
        Text of a tribometer, or a table in text or ``.xlsx``.
    column_map : ColumnMap, optional
        What the file does not state itself, from `read_column_map`.

    Raises
    ------
    InputError
        What cannot be read or decided: file, line, and what to write. If the columns are not
        certain, it is an `UnmappedError` with the text of a draft.
    """
    given = column_map or ColumnMap()
    content = content_of(Path(path), given.format)
    if given.is_complete:
        return _logs(content, given)
    fitting = [one for one in shipped_maps() if all(text in content.beginning for text in one.signature)]
    known = given.over(fitting[0]) if fitting else given
    why: UnfitError | None = None
    if known.is_complete:
        try:
            return _logs(content, replace(known, is_shipped=True))
        except UnfitError as error:
            why = error
    draft = draft_of(content, known, why)
    text = draft.text(content.name)
    if draft.questions:
        raise _unmapped(content, draft, text, why)
    columns = column_map_of(text, f"{content.name}, its heads").by("its name")
    stated = {meaning: one for meaning, one in known.columns.items() if meaning in columns.columns}
    name = fitting[0].name if fitting else "plain table"
    columns = replace(columns, columns={**columns.columns, **stated}, name=name)
    try:
        return tuple(replace(log, notes=(*log.notes, *draft.notes)) for log in _logs(content, columns))
    except UnfitError as error:
        draft.form.insert(0, draft.ask("# It does not read the log yet", error.question))
        raise _unmapped(content, draft, draft.text(content.name), why) from None


def _unmapped(content: Content, draft: Draft, text: str, why: UnfitError | None) -> UnmappedError:
    first, count = printable(draft.questions[0], 250).rstrip("?."), len(draft.questions)
    like = "" if why is None else f"is like {draft.given.name}, but not the same, and "
    rule = f"{like}has {count} open questions, the first: {first}"
    rule = rule if count > 1 else f"{like}has an open question: {first}"
    place = content.path.with_name(f"{content.path.name}.map.toml")
    cure = "Write a column map; `separatrix tribometer` writes a draft of it beside the log."
    error = UnmappedError(content.name, rule, cure=cure)
    error.draft, error.place = text, place
    return error


def _logs(content: Content, columns: ColumnMap) -> tuple[RawLog, ...]:
    """The log of each table that the column map names, or of all; the same numbers again are not a test."""
    parts = [part for block in _tests(content, columns) for part in _by_step(block, columns)]
    if not parts:
        needed = [one.names[0] for one in columns.columns.values() if one.names and not one.optional]
        listed = ", ".join(map(shown, needed))
        rule = "has no table with the columns that the column map needs"
        cure = f"They are {listed or 'given by number'}; under them, two rows of numbers."
        raise UnfitError(content.name, rule, cure=cure)
    if len({(part.source, part.name) for part in parts}) < len(parts):
        sheets = {part.source: part.name for part in parts if content.parts and content.parts[0].sheet}
        named = [f"{name}, " if (name := sheets.get(part.source)) else "" for part in parts]
        parts = [replace(part, name=f"{named[i]}table {i + 1}") for i, part in enumerate(parts)]
    found: list[tuple[str, RawLog]] = []
    wrong: InputError | None = None
    stated = columns.conditions(content.path)
    for part in _named(parts, content, columns):
        try:
            log = raw_log(part, content, columns, stated)
            found.append((part.name, replace(log, series=_series(part, content, columns))))
        except InputError as error:
            wrong = wrong or error
    if wrong is not None and found and not isinstance(wrong, UnfitError):
        names = ", ".join(shown(name) for name, _ in found)
        wrong.cure = f"{wrong.cure} Or leave it out, below [format]: tables = [{names}].".strip()
    if wrong is not None:
        raise wrong
    return tuple(_once(found, content, parts))


def _named(parts: Sequence[Block], content: Content, columns: ColumnMap) -> list[Block]:
    """Tables that the map names, by their names or those of their sheets; all where it names none."""
    sheets = {part.sheet for part in content.parts} - {""}
    for name in columns.format.tables:
        if name not in sheets and name not in {part.name for part in parts}:
            there = ", ".join(shown(one) for one in (*sheets, *(part.name for part in parts)) if one)
            cure = f"It has {there}." if there else "It has one table, without a name."
            raise InputError(content.name, f'has no table "{printable(name)}"', cure=cure)
    wanted = set(columns.format.tables) - sheets
    return [part for part in parts if not wanted or part.name in wanted]


def _once(found: Sequence[tuple[str, RawLog]], content: Content, parts: Sequence[Block]) -> Iterator[RawLog]:
    """Logs without those of the same numbers, and with a note on sheets that are not read."""
    kept: dict[bytes, RawLog] = {}
    for _, log in found:
        numbers = b"".join(getattr(log, name).tobytes() for name in ("friction", *log.abscissae))
        if numbers in kept:
            note = f"{log.source} has the same numbers and is left out"
            log = replace(kept[numbers], notes=(*kept[numbers].notes, note))
        kept[numbers] = log
    read_from = {part.source for part in parts}
    others = [printable(part.sheet) for part in content.parts if part.source not in read_from]
    unread = (f"without these columns, and not read: {', '.join(others)}",) if others else ()
    yield from (replace(log, notes=(*log.notes, *unread)) for log in kept.values())


def _tests(content: Content, columns: ColumnMap) -> list[Block]:
    """Tables of two rows or more; one under the names of that before it, with nothing between, goes on."""
    tests: list[Block] = []
    for block in blocks_of(content, columns):
        before = tests[-1] if tests else None
        if before and _table_of(before) == _table_of(block) and not any(map(str.strip, block.above)):
            before.rows += block.rows
            before.lines = [*before.lines, *block.lines]
        elif len(block.lines) > 1:
            tests.append(block)
    return tests


def _table_of(block: Block) -> tuple[object, ...]:
    return block.source, block.name, block.heads, block.below


def _by_step(block: Block, columns: ColumnMap) -> Iterator[Block]:
    """The table, or one for each step in it; a step of a single row is left out, for it is not a log."""
    place = next((i for name in columns.format.tests for i in matching([name], block.heads)), None)
    if place is None:
        yield block
        return
    (texts,) = cells_of(block, [place])
    cells = [re.sub(r"[.,]0*$", "", text) for text in texts]  # 1.000 and 1,0 are one step
    bounds = [0, *(i for i in range(1, len(cells)) if cells[i] != cells[i - 1]), len(cells)]
    names: list[str] = []
    single = [f"{block.heads[place].strip()} {cells[a]}" for a, b in pairwise(bounds) if b - a == 1]
    note = [f"steps of a single row are left out: {printable(', '.join(single), 80)}"] if single else []
    for start, stop in pairwise(bounds):
        if len(bounds) == 2:
            yield block
        elif stop - start >= 2:
            names.append(f"step {printable(cells[start])}")
            again = names.count(names[-1])
            name = names[-1] if again == 1 else f"{names[-1]}, again {again}"
            name = f"{block.name}, {name}" if block.name else name
            rows, lines = block.rows[start:stop], block.lines[start:stop]
            yield replace(block, name=name, rows=rows, lines=lines, notes=note)


def _series(block: Block, content: Content, columns: ColumnMap) -> str:
    """What the lines above a table state about the test of which it is a part; empty for nothing."""
    head = [line for part in content.parts for line in part.lines[:100]] if columns.format.series else []
    found = []
    for pattern in columns.format.series:
        matches = [match for line in (*reversed(block.above), *head) if (match := re.search(pattern, line))]
        found.append(matches[0][1] if matches else "")
    return " ".join(found).strip() if found and found[0] else ""
