"""Which cage material: verdict, margin, rank and reason for each candidate."""

from separatrix.ranking.records import Ranking

__all__ = ["Ranking"]
