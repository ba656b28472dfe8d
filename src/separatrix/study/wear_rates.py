"""How film and cage wear in slow time: what `life` needs besides the study of a verdict."""

from __future__ import annotations

from typing import ClassVar, NamedTuple

from separatrix.friction.friction_file import FRICTION_LIMIT
from separatrix.ground.schema import all_or_none, between, key, positive, record
from separatrix.ground.units import CubicMetre, Metre, Ratio, SpecificWear, format_quantity
from separatrix.study.ball_bearing import Material

_WEAR = positive(1e-24, 1e-6)


@record
class WearRates:
    """Archard's coefficients of film and cage, and what is known of film and pockets as they wear.

    A coefficient is worn volume over load and sliding distance, from a test at the pressure, the speed and in
    the medium of the bearing: run-in wear of a tribometer is up to a thousand times that of endurance.
    """

    RULES: ClassVar = (all_or_none("worn_pocket_friction", "worn_pocket_depth"),)

    film_wear: SpecificWear | None = key(
        _WEAR, default=None, example='"5e-9 mm3/(N m)"', without="not given: that of the film in the library"
    )
    """Of the film between ball and race."""

    cage_wear: SpecificWear | None = key(
        _WEAR, default=None, example='"1e-6 mm3/(N m)"', without="not given: that of the cage in the library"
    )
    """Of the cage's pockets on the balls."""

    bare_friction: Ratio = key(between(0.0, FRICTION_LIMIT, open_low=True), example="0.35")
    """Of ball on race where the film is gone."""

    coverage_thickness: Metre = key(positive(1e-10, 1e-4), default=1e-7)
    """Thickness at which a film covers 63 % of its track."""

    transferred: Ratio = key(between(0.0, 1.0), default=0.0)
    """Share of what is worn off the pockets that stays on tracks and balls."""

    worn_pocket_friction: Ratio | None = key(
        between(0.0, FRICTION_LIMIT), default=None, example="0.3", without="not given: as new"
    )
    """Friction of a pocket whose surface is worn off: fibres come out."""

    worn_pocket_depth: Metre | None = key(
        positive(1e-9, 1e-2), default=None, example='"10 um"', without="not given: as new"
    )
    """Depth of wear by which friction has gone 63 % of that way."""

    reservoir: CubicMetre | None = key(
        positive(1e-15, 1e-3), default=None, example='"1 mm3"', without="not given: it never ends"
    )
    """Volume of the cage that may wear off before it gives no more film."""


class WearRate(NamedTuple):
    """A wear coefficient, and of one of the library where it is expected and how it was tested."""

    value: SpecificWear
    range: tuple[SpecificWear, SpecificWear] | None = None
    test: str = ""
    """Empty of one that the study gives."""


def library_rate(material: Material | None) -> WearRate | None:
    """Wear coefficient of a material's record in the library; None without one."""
    record = material.record if material is not None else None
    if material is None or record is None or "wear_coefficient" not in record["taken"]:
        return None
    datum = record["data"]["wear_coefficient"][record["taken"]["wear_coefficient"]]
    span = dict.fromkeys(format_quantity(one, "K") for one in datum["temperature"] or ())
    pressure = datum["pressure"] and format_quantity(datum["pressure"], "Pa")
    tested = filter(None, [" to ".join(span), pressure, datum["medium"], datum["form"]])
    value = f"{format_quantity(datum['value'], 'm3/(N m)')} of {material.name} in the library"
    words = f"{value} ({datum['confidence']}: {datum['source']}), tested: {', '.join(tested) or 'not stated'}"
    return WearRate(datum["value"], datum["range"] and tuple(datum["range"]), words)
