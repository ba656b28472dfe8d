"""Which cage material: verdict, margin, rank and reason for each candidate."""

from separatrix.ranking.lowest import LowestFriction, probability_lowest
from separatrix.ranking.order import ranks
from separatrix.ranking.rank import rank
from separatrix.ranking.reason import PAPER_STATEMENT
from separatrix.ranking.records import (
    NotFinished,
    NotMeasured,
    OwnCurve,
    Ranked,
    RankedEnvironment,
    Ranking,
    Row,
)

__all__ = [
    "PAPER_STATEMENT",
    "LowestFriction",
    "NotFinished",
    "NotMeasured",
    "OwnCurve",
    "Ranked",
    "RankedEnvironment",
    "Ranking",
    "Row",
    "probability_lowest",
    "rank",
    "ranks",
]
