"""Text of the clearances of a cage as it runs, from those at 293 K at rest."""

from __future__ import annotations

from typing import TYPE_CHECKING

from separatrix.present.text.tables import quantity

if TYPE_CHECKING:
    from separatrix.chain.clearances import Clearances


def running_clearances(found: Clearances | None) -> list[tuple[str, str]]:
    """Return each clearance at rest and as it runs, with its strains; nothing where the study states it."""
    if found is None:
        return []
    at = f"at {quantity(found.temperature, 'K')} and a cage speed of {quantity(found.cage_speed, 'rad/s')}"
    rows = []
    for words, rest, runs in (
        ("Running pocket clearance", found.pocket_at_rest, found.pocket),
        ("Along the axis", found.pocket_axial_at_rest, found.pocket_axial),
        ("Running land clearance", found.land_at_rest, found.land),
    ):
        if rest is not None and runs is not None:
            rows.append((words, f"{quantity(runs, 'm')} {at}, {quantity(rest, 'm')} at 293 K at rest"))
    thermal = [("cage", found.cage_strain), ("balls", found.ball_strain), ("rings", found.ring_strain)]
    strains = [f"{part} {100 * strain:.3g} %" for part, strain in thermal if strain is not None]
    rows.append(("Thermal strain", ", ".join(strains)))
    turning = f"cage +{found.hoop_strain * 100:.3g} % at its pitch radius"
    for part, grown in (("its land", found.cage_land_growth), ("the ring's land", found.ring_land_growth)):
        turning += "" if not grown else f", {part} +{quantity(grown, 'm', 3)} in radius"
    rows.append(("Growth by rotation", turning))
    return rows
