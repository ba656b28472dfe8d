"""Which cage material: verdict, margin, rank and reason for each candidate."""

from separatrix.ranking.order import ranks
from separatrix.ranking.rank import rank, ranking_question
from separatrix.ranking.reason import PAPER_STATEMENT
from separatrix.ranking.records import RankedEnvironment, RankedMaterial, Ranking

__all__ = [
    "PAPER_STATEMENT",
    "RankedEnvironment",
    "RankedMaterial",
    "Ranking",
    "rank",
    "ranking_question",
    "ranks",
]
