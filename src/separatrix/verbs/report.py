"""`report`: the pages of the answers to a study joined under one title, as a document to hand over.

It ends with how far they can be trusted, by the factors of NASA-STD-7009B (docs/credibility.md). The levels
of the program are data, `parts/credibility.toml`; what a study adds is counted in its answers.
"""

from __future__ import annotations

import re
import tomllib
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache, partial
from importlib.resources import files
from operator import itemgetter
from pathlib import Path
from typing import TYPE_CHECKING, Any

from separatrix import __version__
from separatrix.ground.errors import InputError, json_text
from separatrix.ground.files import staged
from separatrix.ground.plain_data import Document, part_of
from separatrix.present.blocks import Block, Heading, Level, Note, Page, Table, facts, joined, text_column
from separatrix.verbs import VERBS, verb_named
from separatrix.verbs import answer_files as saved
from separatrix.verbs.parts.chain_blocks import bearing_picture

if TYPE_CHECKING:
    from separatrix.study.study import Study
    from separatrix.verbs.verb import Verb

FACTORS = {
    "data_pedigree": "data pedigree",
    "verification": "verification",
    "validation": "validation",
    "development_review": "technical review",
    "development_process": "process",
}
"""Factors of a program's development, as the standard names them."""

CREDIBILITY_CAPTION = (
    "Levels 0 to 4 of NASA-STD-7009B that the developers claim, assessed by nobody else; 0 is "
    "insufficient evidence. What each rests on, and what is missing: the documentation, page Credibility."
)


@cache
def claims() -> tuple[Document, ...]:
    """Return the claims of each part of the program: by factor its level, evidence, and what is missing."""
    found = tomllib.loads((files(__package__) / "parts" / "credibility.toml").read_text(encoding="utf-8"))
    return tuple(found["whole"] | part for part in found["part"])


def credibility(documents: Mapping[str, Document]) -> list[Block]:
    """Return the levels of the program, and what the answers to one study add to them."""
    study = next(iter(documents.values()))["study"]
    levels = (text_column(words, partial(_level, key)) for key, words in FACTORS.items())
    columns = (text_column("part", itemgetter("name")), *levels)
    notes = {text for one in documents.values() for text in one["warnings"]}
    uncertain = ", ".join(one["name"] for one in study["uncertain_inputs"])
    varied = ", ".join(f"`{verb}`" for verb in ("sensitivity", "sweep", "map") if verb in documents)
    outside = f"{len(notes) or 'no'} notes on what is outside its range"
    return [
        Heading("Credibility", Level.REPORT),
        Table("credibility", columns, claims(), CREDIBILITY_CAPTION, Level.REPORT),
        facts(
            ("Input pedigree", _pedigree(study)),
            ("Use assessment", outside + _extrapolated(documents.get("rank", {}))),
            ("Uncertain inputs", uncertain or "none is stated: intervals are counting noise"),
            ("Results robustness", f"varied by {varied}" if varied else "no input was varied"),
            ("Technical review", "of this use: to be stated by whoever uses the answer"),
            level=Level.REPORT,
        ),
    ]


def _level(factor: str, row: Document) -> int:
    return int(row[factor]["level"])


def _pedigree(study: Document) -> str:
    """How many inputs are stated or assumed, and how sure the numbers of materials and frictions are."""
    from separatrix.study.sources import inputs_of

    origins = [str(entry["origin"]) for *_, entry in inputs_of(study) if entry.get("value") not in (None, [])]
    assumed = sum(one.startswith("default") for one in origins)
    known = ", ".join(f"{count} {word}" for word, count in Counter(_confidences(study)).most_common())
    return f"{len(origins) - assumed} inputs stated, {assumed} by default; materials and frictions: {known}"


def _confidences(part: Any) -> Iterator[str]:
    """Yield how sure each number of the study's materials and frictions is; not the rest of their records."""
    from separatrix.study.library import CONFIDENCES

    if isinstance(part, Mapping):
        words = re.findall(r"\w+", str(part.get("confidence") or ""))
        yield from (word for word in words if word in CONFIDENCES)
        part = [one for key, one in part.items() if key not in ("record", "table", "other_tests")]
    for one in part if isinstance(part, list) else ():
        yield from _confidences(one)


def _extrapolated(ranked: Document) -> str:
    """In how many rows of a ranking the friction is extrapolated."""
    places = (one for one in ranked.get("environments", ()) if one["name"] == ranked["environment"])
    found = [row["extrapolation"] for one in places for row in one["materials"] if "extrapolation" in row]
    beyond = sum(map(bool, found))
    return f"; the friction of {beyond} of {len(found)} candidates is extrapolated" if found else ""


ORDER = (
    *("rank", "stability", "bearing", "traction", "restitution", "mobility", "map", "sweep"),
    *("sensitivity", "life", "simulate"),
)
"""Verbs in the order of a report: the answer first, then the chain behind it, then what varies it."""

LARGEST = 4_000_000
"""Characters of an answer that goes into the HTML file as JSON; that of a run in space has more."""


@dataclass(frozen=True, slots=True)
class Report:
    """A page made of the pages of answers, and their documents by verb."""

    page: Page
    documents: Mapping[str, Document] = field(repr=False)

    def summary(self) -> str:
        """The answer in a few sentences, a paragraph each."""
        from separatrix.present.text import lead

        return lead(self.page)

    def html(self) -> str:
        """One HTML file, as text, that needs no other file and no network."""
        from separatrix.present.html import html

        light = {verb: one for verb, one in self.documents.items() if len(json_text(one)) < LARGEST}
        return html(self.page, light)

    def _repr_html_(self) -> str:
        return self.html()

    def pdf(self) -> bytes:
        """The same as PDF; needs the extra ``pdf``."""
        from separatrix.present.pdf import pdf

        return pdf(self.page)

    def write(self, folder: Path, *, with_pdf: bool) -> list[Path]:
        """Write report.html, and report.pdf too, into a folder, both or none; return their paths."""
        contents = {"report.html": self.html().encode()} | ({"report.pdf": self.pdf()} if with_pdf else {})
        with staged(folder) as stage:
            for name, content in contents.items():
                (stage / name).write_bytes(content)
        return [folder / name for name in contents]

    def document(self, files: Sequence[Path] = ()) -> Document:
        """Plain data: what was answered in short, and where the report is."""
        return {
            "separatrix_version": __version__,
            "verb": "report",
            "name": next(iter(self.documents.values()))["name"],
            "title": self.page.title,
            "answers": [*self.documents],
            "summary": list(self.page.lead),
            "files": [str(path) for path in files],
        }


def report_of(
    found: Mapping[str, Document], missing: Sequence[str] = (), where: str = "The answer"
) -> Report:
    """Return the report of answers to one study, by verb.

    Parameters
    ----------
    found : mapping
        The documents.
    missing : sequence of str
        What could not be computed, a sentence each: caveats of the first page.
    where : str
        What a refusal of a damaged answer names.
    """
    kept = {verb: found[verb] for verb in ORDER if verb in found}
    if not kept:
        raise InputError(where, "has no answer that a report shows", cure="Name the study instead.")
    pages = {one: saved.page_of_document(verb_named(one), kept[one], f"{where}: {one}.json") for one in kept}
    main, first = next(iter(pages.items()))
    caveats = [Note(text, "caveat") for text in missing]
    for verb, one in kept.items():
        with saved.refusing_damage(where):
            names = differing(kept[main], one)
        text = f"`{verb}` was computed from other inputs than `{main}`: {names} differ."
        caveats += [Note(text, "caveat")] if names else []
    bearing = kept.get("bearing")
    drawn = bearing_picture(part_of(kept[main]), part_of(bearing).contacts if bearing else None)
    pages[main] = replace(first, blocks=(*first.blocks[:1], *caveats, *first.blocks[1:], drawn))
    parts = [(VERBS[verb].rstrip("."), page) for verb, page in pages.items()]
    whole = joined(first.title, first.subtitle, parts)
    return Report(replace(whole, blocks=(*whole.blocks, *credibility(kept))), kept)


def differing(one: Document, other: Document) -> str:
    """Return the inputs in which two answers differ, the first four by name; empty if there are none."""
    ours, theirs = (
        dict(saved.inputs_of_study(found["study"]))
        | {"version of separatrix": (found["separatrix_version"], None)}
        for found in (one, other)
    )
    names = [key for key in {**ours, **theirs} if ours.get(key) != theirs.get(key)]
    return ", ".join(names[:4]) + (f" and {len(names) - 4} more" if names[4:] else "")


def report_of_study(
    study: Study, compute: Callable[[Verb], Document], folder: Path | None = None, *, pictures: bool = False
) -> Report | None:
    """Return the report of a study; None if an answer that it needs was interrupted.

    Complete answers of `folder` to this study, from this version, are taken; those that lack are computed
    and written there, their `pictures` if that is asked for.
    """
    from separatrix.study.reading import require

    asked, found, missing = saved.asked_by(study), dict[str, Document](), list[str]()
    for path in [folder / f"{verb}.json" for verb in ORDER] if folder is not None else []:
        one = saved.read_answer(path) if path.exists() else {}
        if one.get("complete", True) is True and asked.items() <= one.items():
            found[path.stem] = one
    last = "stability" if study.ranking is None else "rank"
    of_cage = ("restitution", "simulate", last) if study.cage else ()
    for verb in map(verb_named, ("bearing", "traction", *of_cage)):
        if verb.name in found:
            continue
        try:
            require(study, verb.name, *verb.needs)
            made = compute(verb)
        except InputError as error:
            if not found:
                raise
            missing.append(f"`{verb.name}` was not computed: {error}")
            continue
        if folder is not None:
            saved.save_answer(folder, verb, made, pictures=pictures)
        if made.get("complete") is False:
            return None
        found[verb.name] = made
    return report_of(found, missing, str(folder or study.name))
