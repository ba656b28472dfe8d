"""Which cage material: verdict, margin, rank and reason for each candidate."""

from separatrix.ranking.lowest import LowestFriction, probability_lowest
from separatrix.ranking.order import ranks
from separatrix.ranking.rank import rank, ranking_question
from separatrix.ranking.reason import PAPER_STATEMENT
from separatrix.ranking.records import OwnCurve, RankedEnvironment, RankedMaterial, Ranking

__all__ = [
    "PAPER_STATEMENT",
    "LowestFriction",
    "OwnCurve",
    "RankedEnvironment",
    "RankedMaterial",
    "Ranking",
    "probability_lowest",
    "rank",
    "ranking_question",
    "ranks",
]
