"""The report of a folder's answers, section by section."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from separatrix.reporting.envelope import envelope
from separatrix.reporting.evidence import about, evidence, outside, uncertainty
from separatrix.reporting.first_page import first_page
from separatrix.reporting.inputs import inputs, provenance
from separatrix.reporting.kept import Kept
from separatrix.reporting.pictures import picture
from separatrix.reporting.record import Paragraph, Report, Section
from separatrix.reporting.stages import bearing_and_cage, stages


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
    first = first_page(kept, [*about(kept), *missing])
    return Report(
        title=str(main["title"]),
        subtitle=f"Study {main['name']}, computed by separatrix {main['separatrix_version']}",
        sections=(first, *_sections(kept)),
        documents={verb: one.document for verb, one in kept.items()},
    )


def _sections(kept: Mapping[str, Kept]) -> Iterator[Section]:
    yield bearing_and_cage(kept)
    yield from stages(kept)
    if "rank" in kept:
        yield evidence(kept["rank"])
    if "map" in kept:
        yield _map(kept["map"])
    if "sweep" in kept:
        yield envelope(kept["sweep"])
    yield uncertainty(kept)
    yield outside(kept)
    yield inputs(kept)
    yield provenance(kept)


def _map(kept: Kept) -> Section:
    words = "The verdict in the plane of two inputs; the star is the study itself."
    shown = picture(
        "map",
        kept.data,
        "stability-map",
        "Share of the runs that whirl.",
        "Map of the share of runs that whirl over two inputs of the study.",
    )
    return Section("Stability map", (Paragraph(words), *shown))
