"""The first page: the verdict in three sentences, the candidates, one figure, and the caveats that matter."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from separatrix.reporting.pictures import own_candidates, picture
from separatrix.reporting.record import Block, Kept, Paragraph, Row, Section, Table, own_rows, quantity
from separatrix.told.sentences import (
    drift,
    drift_sentence,
    margin,
    pocket_force,
    probability,
    rank_texts,
    verdict,
    verdict_sentences,
)
from separatrix.told.tables import ABSENT, number, significant

MOST_CAVEATS = 5
HEAD = (
    *("rank", "candidate", "verdict", "margin", "P(stable) (95 %)", "offset", "drift [1/s]"),
    *("pocket force", "land force", "runs x length"),
)
EXPLAINED = (
    "Margin: largest stable restitution factor less the bearing's own. P(stable): share of the runs that "
    "settle or roll from the worst disturbance, with its 95 % interval. Offset of the centre and forces: "
    "largest of all runs; > what the races hold: there it has no meaning. Drift: median growth rate of the "
    "mean offset. Runs: from each disturbance, up to this length."
)


def first_page(kept: Mapping[str, Kept], about: Sequence[str]) -> Section:
    """Return the answer on one page; `about` are caveats on the answers themselves."""
    if "rank" in kept:
        blocks = _ranking(kept["rank"])
    else:
        blocks = _stability(kept["stability"]) if "stability" in kept else _without_cage(kept)
    main = next(kept[verb] for verb in ("rank", "stability", *kept) if verb in kept).document
    return Section("Answer", (*blocks, *_caveats(main, about)))


def _ranking(kept: Kept) -> Iterator[Block]:
    rank = kept.document
    rows = own_rows(rank)
    for sentence in verdict_sentences(rows, rank["environment"]):
        yield Paragraph(sentence, "lead")
    cells = [
        (place, row["name"], verdict(row), margin(row), probability(row), *_evidence(row))
        for place, row in zip(rank_texts(row["rank"] for row in rows), rows, strict=True)
    ]
    yield Table(HEAD, tuple(cells), f"Candidates in {rank['environment']}. {EXPLAINED}", left=3)
    yield from picture(
        kept,
        own_candidates(kept.data),
        f"The candidates on the stability curve of this bearing: {_below(rank.get('stability') or {})}.",
        "Critical friction against restitution factor, with the friction of each candidate at the "
        "bearing's own restitution factor; the table above has the numbers.",
    )


def _evidence(row: Row) -> tuple[str, ...]:
    if row.get("largest_offset") is None:
        return (ABSENT,) * 5
    return (
        quantity(row["largest_offset"], "m", 3),
        drift(row),
        pocket_force(row["largest_contact_force"], row["force_limit"], short=True),
        quantity(row["largest_land_force"], "N", 3),
        f"{row['runs']} x {quantity(row['longest_run'], 's', 3)}",
    )


def _stability(kept: Kept) -> Iterator[Block]:
    """Yield the answer for the cage of a study without candidates."""
    found, here = kept.document, kept.document["here"] or {}
    friction = (found["study"]["cage"]["ball_cage_friction"] or {}).get("value")
    eta, middle = here.get("restitution_factor"), here.get("critical_friction")
    low, high = here.get("critical_friction_low"), here.get("critical_friction_high")
    curve = f"At this bearing's restitution factor of {number(eta, 2)} "
    if middle is None:
        yield Paragraph(
            f"{curve}no critical friction was found: {here.get('reason') or 'see below'}.", "lead"
        )
    else:
        ends = f"({_friction(here['scatter_low'])} to {_friction(here['scatter_high'])})"
        words = f"half of the runs whirl at a pocket friction of {_friction(middle)} {ends}."
        yield Paragraph(curve + words, "lead")
    if friction is not None and middle is not None:
        side, then = "within", "it is undecided"
        if low is not None and friction < low:
            side, then = "below", "the cage is stable"
            if found.get("drifts"):
                then = "disturbances decay, but the cage drifts and is not stable"
        elif high is not None and friction > high:
            side, then = "above", "the cage is unstable"
        band = f"the band in which the disturbance decides ({_friction(low)} to {_friction(high)})"
        yield Paragraph(
            f"The cage's friction of {significant(friction, 3)} is {side} {band}: {then}.", "lead"
        )
    if sentence := drift_sentence(bool(found.get("drifts")), found.get("drift_rate_law")):
        yield Paragraph(sentence, "lead")
    why = "`rank` was not computed" if found["study"].get("ranking") else "The study has no [ranking]"
    yield Paragraph(f"{why}: no cage materials were compared.", "lead")
    yield from picture(
        kept,
        "stability-curve",
        f"Critical friction against restitution factor: {_below(found)}.",
        "Stability curve with its band and limits, and the bearing's own restitution factor.",
    )


def _below(curve: Row) -> str:
    """Return what a place below the curve means."""
    if curve.get("drifts"):
        return "below the curve disturbances decay, but the cage drifts"
    return "below the curve the cage is stable"


def _friction(value: float | None) -> str:
    """Return a friction to two significant digits, so that a small one differs from 0."""
    return f"{value:#.2g}" if value else number(value, 0)


def _without_cage(kept: Mapping[str, Kept]) -> Iterator[Block]:
    study = next(iter(kept.values())).document["study"]
    if study.get("cage"):
        yield Paragraph("The folder has no verdict: neither `rank` nor `stability` was computed.", "lead")
    else:
        yield Paragraph("The study has no [cage]: there is no verdict on its stability.", "lead")
    if "bearing" in kept:
        at = kept["bearing"].document["contacts"]
        loads = " and ".join(
            f"{quantity(of['load'], 'N', 4)} ({quantity(of['max_pressure'], 'Pa', 3)}) on the {race} race"
            for race, of in at.items()
        )
        yield Paragraph(f"The most loaded ball carries {loads}.", "lead")
    if "traction" in kept:
        at = kept["traction"].document
        slopes = " and ".join(
            f"{significant(at[race]['slope'])} at the {race}" for race in ("inner", "outer")
        )
        yield Paragraph(f"The slopes of its traction curves are {slopes} race.", "lead")


def _caveats(main: Row, about: Sequence[str]) -> Iterator[Block]:
    """Yield what a reader of the first page must know; the rest has a section of its own."""
    found = [*about]
    if main.get("complete") is False:
        found.append("The computation was interrupted: this answer has only what was finished.")
    found += main["warnings"]
    if main["verb"] == "rank":
        rows = [row for row in own_rows(main) if row.get("friction") is not None]
        beyond = [row["name"] for row in rows if row["extrapolation"]]
        if beyond:
            who = "of every candidate" if len(beyond) == len(rows) else f"of {', '.join(beyond)}"
            found.append(
                f"The friction {who} is extrapolated beyond its tests: see Evidence of the verdicts."
            )
        if any(row["friction_scatter_assumed"] for row in rows):
            share = f"{100.0 * main['friction_scatter']:.3g} %"
            found.append(
                f"Tests were not repeated: their friction is assumed to scatter by {share}, a guess."
            )
    for sentence in found[:MOST_CAVEATS]:
        yield Paragraph(sentence, "caveat")
    if found[MOST_CAVEATS:]:
        more = len(found) - MOST_CAVEATS
        yield Paragraph(f"{more} more under Outside its range.", "caveat")
