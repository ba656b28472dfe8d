"""The film on the races of a study, whole or worn, and how the traction on it is computed."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum
from itertools import pairwise

from separatrix.friction.prediction import FRICTION_LIMIT
from separatrix.ground import bounds as _check
from separatrix.ground.bounds import between, must, not_negative, one_of, positive
from separatrix.ground.errors import InputError
from separatrix.ground.units import Metre, Ratio, format_quantity, shown
from separatrix.study.ball_bearing import Material

MOST_PLACES = 10_000
"""Places of a measured profile."""

_BARE = "For bare races leave material and thickness out."


class Worn(Enum):
    """The races whose film is worn."""

    BOTH = "both"
    INNER = "inner"
    OUTER = "outer"


@dataclass(frozen=True, slots=True, kw_only=True)
class Wear:
    """A film that is thinner, or gone, in the middle of its track.

    Either a band, centred on the contact, of a `width` or of a `share` of the contact's width, in which
    `thickness` is left; or the measured `thicknesses` at the places `across` the groove, linear between
    them, from the centre of the contact. `friction` is that of the ball on a race without film.
    """

    friction: Ratio = field(metadata=must(between, 0.0, FRICTION_LIMIT, open_low=True))
    width: Metre | None = field(default=None, metadata=must(not_negative, 1.0))
    share: Ratio | None = field(default=None, metadata=must(between, 0.0, 1.0))
    thickness: Metre = field(default=0.0, metadata=must(not_negative, 1e-2))
    across: tuple[Metre, ...] = ()
    thicknesses: tuple[Metre, ...] = ()
    races: Worn = field(default=Worn.BOTH, metadata=must(one_of, Worn))

    def __post_init__(self) -> None:
        _check.settle(_check.each_field(self))
        _check.settle(_one_form(self), _profile(self))

    @property
    def is_band(self) -> bool:
        """Whether it is a band; else a measured profile."""
        return not self.across

    def touches(self, race: Enum) -> bool:
        """Whether the film of this race is worn."""
        return self.races is Worn.BOTH or self.races.value == race.value


def _one_form(wear: Wear) -> _check.Problems:
    forms = (wear.width is not None) + (wear.share is not None) + bool(wear.across or wear.thicknesses)
    if forms != 1:
        cure = "Give width, or share, or across with thicknesses (or profile, a CSV file)."
        yield InputError("Wear.width", "must be the only one of the forms of wear", f"{forms} given", cure)
    elif wear.across and wear.thickness != 0.0:
        yield _check.problem(wear, "thickness", "is that of a band; thicknesses gives a profile its own")


def _profile(wear: Wear) -> _check.Problems:
    """A profile has a thickness at each place; two equal places make a step."""
    y, h = wear.across, wear.thicknesses
    if len(y) != len(h) or len(y) > MOST_PLACES or len(y) == 1:
        rule = f"must have as many values as thicknesses, 2 to {MOST_PLACES}"
        yield InputError("Wear.across", rule, f"{len(y)} and {len(h)}")
        return
    for name, values, low in (("across", y, -1.0), ("thicknesses", h, 0.0)):
        wrong = [one for one in values if not _check.is_number(one) or not low <= one <= 1.0]
        if wrong:
            rule = f"must each be a finite number from {low:g} to 1 [m]"
            yield InputError(f"Wear.{name}", rule, shown(wrong[0]))
            return
    for before, after in pairwise(y):
        if after < before:
            got = f"{format_quantity(after, 'm')} after {format_quantity(before, 'm')}"
            yield InputError("Wear.across", "must not fall", got)
            return


@dataclass(frozen=True, slots=True, kw_only=True)
class Film:
    """Solid lubricant on the races; without material and thickness the races are bare."""

    race_friction: Ratio = field(metadata=must(between, 0.0, FRICTION_LIMIT))
    material: Material | None = None
    thickness: Metre | None = field(default=None, metadata=must(positive, 1e-10, 1e-2, hint=_BARE))
    wear: Wear | None = None

    def __post_init__(self) -> None:
        _check.settle(_check.each_field(self))
        if (self.material is None) != (self.thickness is None):
            missing = "material" if self.material is None else "thickness"
            rule = "is missing: a film needs its material and its thickness"
            raise InputError(f"Film.{missing}", rule, cure="Give both, or neither for bare races.")
        if self.wear is None:
            return
        if self.thickness is None:
            cure = "Give material and thickness of the film, or leave the wear out."
            raise InputError("Film.wear", "needs a film that wears", cure=cure)
        left = max((self.wear.thickness, *self.wear.thicknesses))
        if self.wear.is_band and left > self.thickness:
            rule = f"must be at most the thickness of the film, {format_quantity(self.thickness, 'm')}"
            raise InputError("Wear.thickness", rule, format_quantity(left, "m"))
        if self.race_friction == 0.0:
            raise InputError("Film.race_friction", "must be > 0 where a film is worn", "0")


class TractionModel(Enum):
    """Contacts of ball and race: plane strips side by side (the paper's), or the whole contact."""

    STRIPS = "strips"
    EXACT = "exact"


class ContactPressure(Enum):
    """Pressure in these contacts: Hertz's of the bodies without film, or that of the coated bodies."""

    HERTZ = "hertz"
    COATED = "coated"


class PressureSlip(Enum):
    """Whether the slip counts that the pressure causes between unlike or coated bodies."""

    NEGLECTED = "neglected"
    INCLUDED = "included"


@dataclass(frozen=True, slots=True, kw_only=True)
class TractionSettings:
    """How the traction of ball on race is computed."""

    model: TractionModel = field(default=TractionModel.STRIPS, metadata=must(one_of, TractionModel))
    pressure: ContactPressure = field(default=ContactPressure.HERTZ, metadata=must(one_of, ContactPressure))
    pressure_slip: PressureSlip = field(default=PressureSlip.NEGLECTED, metadata=must(one_of, PressureSlip))

    def __post_init__(self) -> None:
        _check.settle(_check.each_field(self))
        if self.pressure_slip is PressureSlip.INCLUDED and self.model is TractionModel.STRIPS:
            cure = 'Write model = "exact", or leave it out.'
            rule = 'must be "neglected" in strips'
            raise InputError("TractionSettings.pressure_slip", rule, '"included"', cure)

    def by(self, model: TractionModel, pressure: ContactPressure | None = None) -> TractionSettings:
        """The same by another model, perhaps under another pressure; strips know no slip by the pressure."""
        slip = self.pressure_slip if model is TractionModel.EXACT else PressureSlip.NEGLECTED
        return TractionSettings(model=model, pressure=pressure or self.pressure, pressure_slip=slip)
