"""Text of the second verdicts of a ranking, by the other model of a ball."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from separatrix.present.text.tables import interval, paragraph, quantity, section, table
from separatrix.ranking.records import NotMeasured
from separatrix.study import BallModel

if TYPE_CHECKING:
    from separatrix.cage import Judgement
    from separatrix.ranking.records import Ranking, Row

HEADERS = ("material", "damper:\nverdict", "force over\ncapacity")
MORE_HEADERS = ("traction:\nverdict", "P(stable)\n(95 %)", "force over\ncapacity")
WHY = {
    True: "beyond its traction a ball slides along with the cage and takes the energy of the impact, where "
    "the damper returns it",
    False: "a ball with traction yields less to weak impacts than the damper, and goes on moving after them",
}
"""Why the model with traction may find more runs stable, or fewer."""


def by_the_other_ball(found: Ranking, rows: Sequence[Row]) -> list[str]:
    """Return verdicts by both models of a ball, and where they differ; nothing where forces are small."""
    runs = 0
    both: list[tuple[str, Judgement, Judgement]] = []
    for row in rows:
        if isinstance(row, NotMeasured) or row.judgement is None or row.other_ball is None:
            continue
        first, second = row.judgement, row.other_ball
        runs = second.runs
        is_damper = found.ball_model is BallModel.DAMPER
        both.append((row.name, first, second) if is_damper else (row.name, second, first))
    if not both:
        return []
    cells = [[name, *_cells(found, damper), *_cells(found, traction)] for name, damper, traction in both]
    for cell, (_, _, traction) in zip(cells, both, strict=True):
        ends = traction.probability_low, traction.probability_high
        cell.insert(-1, interval(traction.probability_stable, *ends))
    largest = max(damper.largest_contact_force for _, damper, _ in both)
    text = (
        f"The races transmit at most {quantity(found.capacity, 'N', 3)} to a ball before it slides; the "
        f"damper presses pockets with up to {quantity(largest, 'N', 3)}. The other model has {runs} runs "
        f"from each kick. {_differences(both)}"
    )
    title = "Balls as dampers (the paper), and with their inertia and the traction of their races"
    return [section(title, table((*HEADERS, *MORE_HEADERS), cells, left=1), "", paragraph(text))]


def _cells(found: Ranking, one: Judgement) -> list[str]:
    return [one.verdict.name, f"{one.largest_contact_force / found.capacity:.2g}"]


def _differences(both: Sequence[tuple[str, Judgement, Judgement]]) -> str:
    """Where the verdicts differ, and why."""
    said = []
    for more in (True, False):
        names = [
            name
            for name, damper, traction in both
            if damper.verdict is not traction.verdict
            and (traction.probability_stable >= damper.probability_stable) is more
        ]
        if names:
            than = "more" if more else "less"
            said.append(f"With traction {', '.join(names)} come out {than} stable: {WHY[more]}.")
    return " ".join(said) or "Both models give the same verdicts."
