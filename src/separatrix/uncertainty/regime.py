"""Samples that the law of the boundary knows nothing of."""

from __future__ import annotations

import numpy as np

from separatrix.uncertainty.sampling import Draws


def other_regime(draws: Draws) -> tuple[str, ...]:
    """Say of how many samples the law of the boundary does not hold: they meet first what the cage does not.

    With a land tighter than the pockets the cage never meets a ball; a law fitted where it does knows nothing
    of that, nor the other way round.
    """
    cage = draws.study.cage
    if cage is None or cage.land_clearance is None:
        return ()
    names = ("cage.land_clearance", "cage.pocket_clearance")
    central = (cage.land_clearance, cage.pocket_clearance)
    land, pocket = (draws.column(n) if n in draws.names else c for n, c in zip(names, central, strict=True))
    tight, is_tight = np.broadcast_to(land < pocket, len(draws.values)), central[0] < central[1]
    count = int(np.count_nonzero(tight != is_tight))
    if not count:
        return ()
    first = "pockets before its land" if is_tight else "land before its pockets"
    return (
        f"In {count} of {len(tight)} samples the cage meets its {first}, unlike the cage as given: the "
        "boundary is not known there. Narrow the clearances, or rank such a cage by itself.",
    )
