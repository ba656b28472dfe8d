"""Text of a ranking: what it holds for, then each environment with verdicts and reasons."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from separatrix.report.cage import chain_facts, ensemble_facts
from separatrix.report.tables import ABSENT, facts, number, paragraph, quantity, section, table

Document = Mapping[str, Any]

HEADERS = ("rank", "material", "friction", "threshold", "margin", "P(stable)", "95 % interval", "verdict")


def rank(document: Document) -> list[str]:
    """Verdict, margin, rank and reason of each candidate, overall and in each environment."""
    environments = document["environments"]
    head = [
        *chain_facts(document["chain"]),
        *ensemble_facts(document),
        *_evidence([row for environment in environments for row in environment["materials"]]),
        ("The paper's bound", document["paper_statement"]),
        *_disagreement(document),
    ]
    return [
        section("What the verdicts hold for", facts(head)),
        section("Overall: mean friction over the measured environments", _table(document["overall"])),
        *(
            section(_title(environment["name"]), _table(environment["materials"]))
            for environment in environments
        ),
        section("Reasons, overall", *_reasons(document["overall"])),
        *(section(f"Reasons, {e['name']}", *_reasons(e["materials"])) for e in environments),
        paragraph(LEGEND, indent=""),
    ]


LEGEND = (
    "rank: by threshold, ties within the scatter share a rank. threshold: largest restitution factor at "
    "which the cage is stable. margin: threshold less this bearing's restitution factor. P(stable): share of "
    "the runs in which the motion dies, all kicks."
)


def _title(name: str) -> str:
    return name[:1].upper() + name[1:]


def _table(rows: Sequence[Document]) -> str:
    return table(HEADERS, [_row(row) for row in rows], left=2)


def _row(row: Document) -> list[str]:
    interval = f"{number(row['probability_low'], 2)} to {number(row['probability_high'], 2)}"
    return [
        ABSENT if row["rank"] is None else str(row["rank"]),
        row["name"],
        number(row["friction"]),
        number(row["restitution_threshold"], 2),
        ABSENT if row["margin"] is None else f"{row['margin']:+.2f}",
        number(row["probability_stable"], 2),
        ABSENT if row["probability_low"] is None else interval,
        row["verdict"] or ("not measured" if row["friction"] is None else "not finished"),
    ]


def _reasons(rows: Iterable[Document]) -> list[str]:
    return [paragraph(f"{row['name']}: {row['reason']}", first="  ", indent="      ") for row in rows]


def _evidence(rows: Sequence[Document]) -> list[tuple[str, str]]:
    """Return the extremes of the evidence, among the stable candidates and among all."""
    stable = [row for row in rows if row["verdict"] == "STABLE"]
    return [
        (label, f"{_most(stable, key, unit)} among the stable, {_most(rows, key, unit)} among all candidates")
        for label, key, unit in (
            ("Largest offset", "largest_offset", "m"),
            ("Largest drift rate", "drift_rate", "1/s"),
            ("Largest pocket force", "largest_contact_force", "N"),
        )
    ]


def _most(rows: Sequence[Document], key: str, unit: str) -> str:
    """Return the largest magnitude of a quantity; a growing run has no limit but the end of its time."""
    return quantity(max((abs(row[key]) for row in rows if row[key] is not None), default=None), unit)


def _disagreement(document: Document) -> list[tuple[str, str]]:
    """Return what to say where the chain's own eta is below the paper's least."""
    eta, limit = document["restitution_factor"], document["solid_lubrication_limit"]
    if eta >= limit:
        return []
    text = f"The contact model gives {number(eta, 2)} for this film, below that {limit:g}. Both are shown."
    return [("This film", text)]
