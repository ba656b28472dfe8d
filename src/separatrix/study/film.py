"""The film on the races of a study, whole or worn, the traction on it, and how film and cage wear."""

from __future__ import annotations

from enum import Enum
from itertools import pairwise
from typing import ClassVar, NamedTuple

from separatrix.friction.friction_file import FRICTION_LIMIT
from separatrix.ground.schema import (
    Fault,
    Faults,
    Only,
    Spelled,
    all_or_none,
    between,
    check,
    is_number,
    key,
    not_negative,
    one_of,
    positive,
    record,
)
from separatrix.ground.units import CubicMetre, Metre, Pascal, Ratio, SpecificWear, format_quantity, shown
from separatrix.study.ball_bearing import MODULI, MODULUS, POISSON, Material

MOST_PLACES = 10_000


class Worn(Spelled):
    """The races whose film is worn."""

    BOTH = "both"
    INNER = "inner"
    OUTER = "outer"


@record
class Wear:
    """A film that is thinner, or gone, in the middle of its track.

    Either a band, centred on the contact, of a `width` or of a `share` of the contact's width, in which
    `thickness` is left; or the measured `thicknesses` at the places `across` the groove, linear between
    them, from the centre of the contact.
    """

    RULES: ClassVar = (
        one_of("width", "share", ("across", "thicknesses"), required=True),
        all_or_none("across", "thicknesses"),
    )

    friction: Ratio = key(between(0.0, FRICTION_LIMIT, open_low=True), example="0.3")
    """Of the ball on a race without film."""

    width: Metre | None = key(not_negative(1.0), default=None)
    """Of the band."""

    share: Ratio | None = key(between(0.0, 1.0), default=None)
    """Width of the band over that of the contact."""

    thickness: Metre = key(not_negative(1e-2), default=0.0)
    """Left in the band."""

    across: tuple[Metre, ...] = key(default=(), certain=True)
    """Places across the groove."""

    thicknesses: tuple[Metre, ...] = key(default=(), certain=True)
    """At these places."""

    races: Worn = key(default=Worn.BOTH)

    @property
    def places(self) -> tuple[tuple[Metre, ...], tuple[Metre, ...]]:
        """Places and thicknesses of a measured profile; empty of a band."""
        return self.across, self.thicknesses

    @property
    def is_band(self) -> bool:
        """Whether it is a band; else a measured profile."""
        return not self.across

    def touches(self, race: Enum) -> bool:
        """Whether the film of this race is worn."""
        return self.races is Worn.BOTH or self.races.value == race.value


@check(Wear)
def _profile_is_one(across: tuple[Metre, ...], thicknesses: tuple[Metre, ...]) -> Faults:
    """A profile has a thickness at each place; two equal places make a step."""
    y, h = across, thicknesses
    if len(y) != len(h) or len(y) > MOST_PLACES or len(y) == 1:
        rule = f"must have as many values as thicknesses, 2 to {MOST_PLACES}"
        yield Fault("across", rule, got=f"{len(y)} and {len(h)}")
        return
    for name, values, low in (("across", y, -1.0), ("thicknesses", h, 0.0)):
        wrong = [one for one in values if not is_number(one) or not low <= one <= 1.0]
        if wrong:
            yield Fault(name, f"must each be a finite number from {low:g} to 1 [m]", got=shown(wrong[0]))
            return
    for before, after in pairwise(y):
        if after < before:
            got = f"{format_quantity(after, 'm')} after {format_quantity(before, 'm')}"
            yield Fault("across", "must not fall", got=got)
            return


@check(Wear)
def _thickness_of_a_band(thickness: Metre, across: tuple[Metre, ...]) -> Faults:
    if across and thickness != 0.0:
        yield Fault("thickness", "is that of a band; thicknesses gives a profile its own")


@record
class Film:
    """Solid lubricant on the races; without material and thickness the races are bare."""

    RULES: ClassVar = (
        one_of("material", ("elastic_modulus", "poisson_ratio")),
        all_or_none("elastic_modulus", "poisson_ratio"),
    )

    race_friction: Ratio = key(between(0.0, FRICTION_LIMIT), example="0.1")
    """Of ball on race."""

    material: Material | None = key(
        default=None, named="film", example='"PTFE transfer film"', without="bare races"
    )
    elastic_modulus: Pascal | None = key(
        MODULUS, default=None, hint=MODULI, without="not given: that of the material"
    )
    """Of a film without a name."""

    poisson_ratio: Ratio | None = key(POISSON, default=None, without="not given: that of the material")
    """Of a film without a name."""

    thickness: Metre | None = key(
        positive(1e-10, 1e-2),
        default=None,
        hint="For bare races leave material and thickness out.",
        example='"0.5 um"',
        without="bare races",
    )
    """Total over ball and race."""

    wear: Wear | None = key(default=None, without="not worn")
    """A band in the middle that is bare, of this friction; or a profile."""

    @property
    def body(self) -> Material | None:
        """Material of the film; None on bare races."""
        if self.elastic_modulus is None or self.poisson_ratio is None:
            return self.material
        return Material(
            name="film given in the study",
            elastic_modulus=self.elastic_modulus,
            poisson_ratio=self.poisson_ratio,
        )


@check(Film)
def _material_and_thickness(
    material: Material | None, elastic_modulus: Pascal | None, thickness: Metre | None
) -> Faults:
    is_known = material is not None or elastic_modulus is not None
    if is_known != (thickness is not None):
        missing, rule = "thickness" if is_known else "material", "is missing: a film needs both"
        yield Fault(missing, f"{rule} material and thickness", "Give both, or neither for bare races.", "")


@check(Film)
def _wear_of_the_film(wear: Wear, thickness: Metre | None, race_friction: Ratio) -> Faults:
    if thickness is None:
        cure = "Give material and thickness of the film, or leave the wear out."
        yield Fault("wear", "needs a film that wears", cure, "")
    elif wear.is_band and wear.thickness > thickness:
        rule = f"must be at most the thickness of the film, {format_quantity(thickness, 'm')}"
        yield Fault(("wear", "thickness"), rule, got=format_quantity(wear.thickness, "m"))
    elif race_friction == 0.0:
        yield Fault("race_friction", "must be > 0 where a film is worn")


class TractionModel(Spelled):
    """Contacts of ball and race: plane strips side by side (the paper's), or the whole contact."""

    STRIPS = "strips"
    EXACT = "exact"


class ContactPressure(Spelled):
    """Pressure in these contacts: Hertz's of the bodies without film, or that of the coated bodies."""

    HERTZ = "hertz"
    COATED = "coated"


class PressureSlip(Spelled):
    """Whether the slip counts that the pressure causes between unlike or coated bodies."""

    NEGLECTED = "neglected"
    INCLUDED = "included"


_EXACT = Only(
    "model",
    (TractionModel.EXACT,),
    'must be "neglected" in strips',
    'Write model = "exact", or leave it out.',
)


@record
class TractionSettings:
    """How the traction of ball on race is computed."""

    model: TractionModel = key(default=TractionModel.STRIPS)
    """The contact as "strips" like the paper's, or as a whole, "exact"."""

    pressure: ContactPressure = key(default=ContactPressure.HERTZ)
    """Of the bodies without film, "hertz", or with it, "coated"."""

    pressure_slip: PressureSlip = key(default=PressureSlip.NEGLECTED, only=(_EXACT,))

    def by(self, model: TractionModel, pressure: ContactPressure | None = None) -> TractionSettings:
        """The same by another model, perhaps under another pressure; strips know no slip by the pressure."""
        slip = self.pressure_slip if model is TractionModel.EXACT else PressureSlip.NEGLECTED
        return TractionSettings(model=model, pressure=pressure or self.pressure, pressure_slip=slip)


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
