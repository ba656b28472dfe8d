"""`traction`: traction curves, and by strips at other pivoting-to-rolling ratios."""

from __future__ import annotations

from separatrix.chain.contacts import race_tracks
from separatrix.chain.race_curve import beyond_strips
from separatrix.chain.shown_traction import curves_by_ratio, shear, shown_curve
from separatrix.chain.solution import solve
from separatrix.study.study import Study
from separatrix.verbs import answer_records as answers


def compute(study: Study) -> answers.TractionAnswer:
    """Traction curves, and by strips at other pivoting-to-rolling ratios."""
    solution = solve(study)
    _ = solution.slopes  # refused, and noted, as everything after them
    tracks = race_tracks(study.bearing, study.film, solution.bearing)
    inner, outer = (shown_curve(track, study.traction) for track in tracks)
    return answers.TractionAnswer(
        race_friction=study.film.race_friction,
        bearing=solution.bearing,
        inner=inner,
        outer=outer,
        inner_others=curves_by_ratio(tracks[0], inner),
        outer_others=curves_by_ratio(tracks[1], outer),
        inner_shear=shear(tracks[0]),
        outer_shear=shear(tracks[1]),
        outside=tuple(beyond_strips(tracks, study.traction)),
        notes=solution.notes,
    )
