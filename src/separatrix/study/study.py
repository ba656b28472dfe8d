"""What is asked: one bearing, its operating point, film, cage and candidate cage materials. SI inside.

Every record is frozen and checks itself when built; what computes with it trusts it. A number may be given
as text with its unit, ``CageDesign(mass="25 g", ...)``: the record holds it in SI. The bearing by its
designation and the fluid that cools are here, too; the other sections have a file each.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field, replace
from functools import cache
from pathlib import Path
from typing import Any, ClassVar

from separatrix.friction.friction_law import Friction as Friction
from separatrix.ground.errors import InputError
from separatrix.ground.reader import Reading, Refused
from separatrix.ground.schema import (
    Fault,
    Faults,
    Only,
    Spelled,
    all_or_none,
    between,
    check,
    key,
    keys_of,
    not_negative,
    one_of,
    positive,
    record,
)
from separatrix.ground.toml import KeyPath, Kind, text
from separatrix.ground.units import (
    JoulePerKilogramKelvin,
    Kelvin,
    KilogramPerSecond,
    MetrePerSecond,
    Newton,
    NewtonMetre,
    Radian,
    RadianPerSecond,
    Ratio,
    Second,
    WattPerKelvin,
    WattPerMetreKelvin,
    format_quantity,
)
from separatrix.study import cage_body
from separatrix.study.ball_bearing import GEOMETRY
from separatrix.study.ball_bearing import BallBearing as BallBearing
from separatrix.study.ball_bearing import Material as Material
from separatrix.study.cage_design import SCALED
from separatrix.study.cage_design import BallModel as BallModel
from separatrix.study.cage_design import CageDesign as CageDesign
from separatrix.study.cage_design import CageModel as CageModel
from separatrix.study.cage_design import ClearanceState as ClearanceState
from separatrix.study.cage_design import Guidance as Guidance
from separatrix.study.cage_design import MotionModel as MotionModel
from separatrix.study.cage_design import PocketContact as PocketContact
from separatrix.study.cage_design import PocketShape as PocketShape
from separatrix.study.candidates import Candidate as Candidate
from separatrix.study.candidates import RankingQuestion as RankingQuestion
from separatrix.study.candidates import RankingSection, read_ranking
from separatrix.study.film import ContactPressure as ContactPressure
from separatrix.study.film import Film as Film
from separatrix.study.film import PressureSlip as PressureSlip
from separatrix.study.film import TractionModel as TractionModel
from separatrix.study.film import TractionSettings as TractionSettings
from separatrix.study.film import Wear as Wear
from separatrix.study.film import WearRates as WearRates
from separatrix.study.film import Worn as Worn
from separatrix.study.library import UNITS
from separatrix.study.uncertain import Distribution, helper_of

PLAY = {"contact_angle", "radial_clearance"}
"""Of these either follows from the other: a study that gives one takes neither from the library."""


def read_bearing(raw: Any, path: KeyPath, reading: Reading) -> BallBearing:
    """Bearing of the section; a designation fills the geometry that the section does not give."""
    if not isinstance(raw, dict) or "designation" not in raw:
        return reading.record(BallBearing, raw, path)
    helper = helper_of(reading)
    try:
        name = helper.known(text(raw["designation"], ""), "bearing")
    except InputError as error:
        reading.refuse((*path, "designation"), error)
        raise Refused from None
    found = helper.library.record("bearing", name)
    given = {*raw, *(PLAY if PLAY & set(raw) else ())}
    filled = {entry: found.data[entry][0] for entry in GEOMETRY if entry in found.data and entry not in given}
    values = {entry: _raw(entry, datum.value) for entry, datum in filled.items()}
    bearing = reading.record(BallBearing, {**raw, "designation": name, **values}, path)
    if not filled:
        reading.notes.append(
            f"[bearing] designation {name} has no effect: the study gives all that it fills."
        )
    guesses: dict[str, str] = {}
    for entry, datum in filled.items():
        value = f"{entry} {format_quantity(datum.value, UNITS[entry])}"
        reading.places[(*path, entry)] = f"{found.place}: {name}, {value}; {datum.confidence}: {datum.source}"
        if datum.confidence.startswith("guess"):
            guesses[value] = datum.source
    if guesses:
        be = "are guesses" if len(guesses) > 1 else "is a guess"
        known = "; ".join(dict.fromkeys(guesses.values()))
        reading.notes.append(f"[bearing] {', '.join(guesses)} of {name} {be} of the library: {known}.")
    return replace(bearing, record=found.plain())


def _raw(entry: str, value: float) -> object:
    """A value of the library as a study file has it."""
    if UNITS[entry] != "-":
        return f"{value!r} {UNITS[entry]}"
    return int(value) if entry == "ball_count" else value


_CONDUCTANCE = positive(1e-9, 1e9)
_TEMPERATURES = ("flow", "race_conductance", "inner_cooling", "outer_cooling", "ball_cooling")


@record
class Cooling:
    """The fluid that flows through the bearing, and the conductances between it and the parts.

    Conductances are those of all balls together.
    """

    RULES: ClassVar = (all_or_none(*_TEMPERATURES), all_or_none("steel_conductivity", "steel_heat_capacity"))

    swirl: Ratio = key(between(0.0, 1.0), example="0.4")
    """Speed of the fluid among the balls: 0 with the outer ring, 1 with the inner ring."""

    flow: KilogramPerSecond | None = key(
        positive(1e-9, 1e4), default=None, example='"50 g/s"', without="not given: no temperatures"
    )
    """Of coolant through the bearing, which comes at the temperature of [operation]."""

    race_conductance: WattPerKelvin | None = key(_CONDUCTANCE, default=None, example='"5 W/K"')
    """Between the balls and either ring, through their contacts."""

    inner_cooling: WattPerKelvin | None = key(_CONDUCTANCE, default=None, example='"20 W/K"')
    """Between the inner ring and the coolant."""

    outer_cooling: WattPerKelvin | None = key(_CONDUCTANCE, default=None, example='"30 W/K"')
    """Between the outer ring and the coolant."""

    ball_cooling: WattPerKelvin | None = key(_CONDUCTANCE, default=None, example='"25 W/K"')
    """Between the balls and the coolant."""

    cage_cooling: WattPerKelvin = key(
        not_negative(1e9), default=0.0, example='"10 W/K"', needs=("flow", "there are no temperatures")
    )
    """Between the cage and the coolant; 0 leaves the cage's temperature out."""

    steel_conductivity: WattPerMetreKelvin | None = key(
        positive(1e-3, 1e5), default=None, example='"12 W/(m K)"', without="not given: no flash temperatures"
    )
    """Of balls and rings at their temperature."""

    steel_heat_capacity: JoulePerKilogramKelvin | None = key(
        positive(1e-3, 1e6), default=None, example='"180 J/kg/K"'
    )
    """The same."""


LEAST_KICK: MetrePerSecond = 1e-9
"""Kicks are larger: the energy of a weaker one is lost in rounding."""

MOST_KICK: MetrePerSecond = 1e4
NO_KICK = "A disturbance of zero leaves the cage at rest."
_LIFTS = "A load the other way lifts the inner ring off its balls; turn the bearing round."
_START = "It is the share of the speed at which the ramp begins; at rest the balls would not roll."


class Race(Spelled):
    """One of the two raceways."""

    INNER = "inner"
    OUTER = "outer"


class KinematicModel(Spelled):
    """How the ball's spin axis is found."""

    FREE = "free"
    OUTER_RACE_CONTROL = "outer race control"
    INNER_RACE_CONTROL = "inner race control"


@record
class Kinematics:
    """How the balls turn."""

    model: KinematicModel = key(default=KinematicModel.FREE, example='"free"')
    """Without race control it is "free"."""


class Arrangement(Spelled):
    """What a preload presses: the bearing alone, or it and its twin on the same shaft."""

    SINGLE = "single"
    BACK_TO_BACK = "back-to-back"
    FACE_TO_FACE = "face-to-face"


class PreloadKind(Spelled):
    """What keeps the preload of a pair: the position of its rings, or a spring."""

    RIGID = "rigid"
    SPRING = "spring"


_PAIR = Only(
    "arrangement",
    (Arrangement.BACK_TO_BACK, Arrangement.FACE_TO_FACE),
    "has a meaning only for a pair of bearings",
    'Give a preload and arrangement = "back-to-back" or "face-to-face", or leave it out.',
)


@record
class Operation:
    """Speeds and loads on the inner ring.

    The rings are held parallel, or at the angle `tilt`. With a `moment`, 0 included, the inner ring tilts
    until the balls balance it. With a `preload` the other loads are external: those of the shaft.
    """

    RULES: ClassVar = (one_of("moment", "tilt"), all_or_none("preload", "arrangement"))
    REPLACED: ClassVar = {"preload": ("axial_load",)}

    inner_speed: RadianPerSecond = key(between(-1e6, 1e6), example='"15000 rpm"')
    axial_load: Newton | None = key(
        not_negative(1e9), default=None, hint=_LIFTS, example='"300 daN"', without="0 N with a preload"
    )
    """With a preload the external load of the shaft, which presses this bearing of a pair."""

    preload: Newton | None = key(positive(1e-3, 1e9), default=None, without="not given: axial_load alone")
    """Axial load of each bearing at rest without external load."""

    arrangement: Arrangement | None = key(default=None, without="not given: there is no preload")
    """Of the pair, or "single" for one bearing that the preload presses as axial_load does."""

    preload_kind: PreloadKind | None = key(default=None, only=(_PAIR,), without='not given; default "rigid"')
    """A "rigid" pair keeps the distance of its rings, a "spring" its force on the other bearing."""

    outer_speed: RadianPerSecond = key(between(-1e6, 1e6), default=0.0)
    radial_load: Newton = key(
        not_negative(1e9), default=0.0, hint="Its direction is the x axis: give its size."
    )
    tilt: Radian | None = key(between(-0.1, 0.1), default=None, without="the rings are held parallel")
    """The rings are held at this angle."""

    moment: NewtonMetre | None = key(
        between(-1e9, 1e9), default=None, without="not given: the rings are held and carry any moment"
    )
    """The inner ring tilts until the balls balance it; "0 N m" lets it tilt freely."""

    temperature: Kelvin | None = key(positive(1e-3, 5000.0), default=None, example='"77 K"')
    """The library has data for different temperatures."""

    fluid: str | None = key(default=None, example='"liquid nitrogen"')
    ramp_time: Second = key(not_negative(1e4), default=0.0, hint="Leave it out for a bearing at speed.")
    """Start-up: all speeds rise in this time."""

    ramp_start: Ratio = key(
        between(0.0, 1.0, open_low=True),
        default=0.1,
        hint=_START,
        needs=("ramp_time", "the speeds are steady"),
    )
    """Share of the speeds at which the ramp begins."""

    @property
    def is_tilt_held(self) -> bool:
        """Whether the housing and shaft hold the rings at an angle; else the inner ring tilts freely."""
        return self.moment is None

    @property
    def is_pair(self) -> bool:
        """Whether the bearing is one of two that press each other."""
        return self.arrangement in _PAIR.values


@check(Operation)
def _pair_under_axial_load(
    arrangement: Arrangement, radial_load: Newton, moment: NewtonMetre | None, tilt: Radian | None
) -> Faults:
    for name, value in (("radial_load", radial_load), ("moment", moment), ("tilt", tilt)):
        if value and arrangement is not Arrangement.SINGLE:
            rule = "must be 0 for a pair: how its two bearings share it is not computed"
            cure = "Leave preload and arrangement out, and give the loads of one of the two bearings."
            yield Fault(name, rule, cure)


@check(Operation)
def _something_presses_the_balls(
    axial_load: Newton | None, preload: Newton | None, radial_load: Newton, moment: NewtonMetre | None
) -> Faults:
    """A held tilt takes any moment; without a load, even with a tilt, nothing is pressed together."""
    cure = "Give the axial load, or preload and arrangement."
    if axial_load is None and preload is None:
        yield Fault("axial_load", "is missing", cure)
    elif not (axial_load or preload or radial_load or moment):
        rule = "must be > 0 when there is no radial load or moment: nothing presses the balls"
        yield Fault("axial_load", rule, cure)


@record
class StabilitySettings:
    """The ensemble behind every verdict, and the curve's restitution factors; without any they are chosen.

    Without kicks they scale with the bearing; `cage.settings_for` puts numbers in their place.
    """

    reference_kick: MetrePerSecond | None = key(
        positive(1e-6, 1e3), default=None, certain=True, hint=NO_KICK, without=SCALED
    )
    """The initial disturbance of critical friction and threshold, with which default `kicks` scale."""

    kicks: tuple[MetrePerSecond, ...] = key(
        between(LEAST_KICK, MOST_KICK, open_low=True, open_high=True),
        default=(),
        certain=True,
        hint=NO_KICK,
        length=(0, 20),
        rising=True,
        without="0.2, 1 and 4 times the reference disturbance",
    )
    """Speeds of the cage's centre at the start."""

    runs: int = key(between(1, 1e6), default=64, certain=True, example="64")
    """Per point."""

    duration: Second = key(
        positive(1e-9, 1e4), default=0.3, hint="Some tenths of a second show the motion.", example='"0.3 s"'
    )
    axial_kick: Ratio = key(between(0.0, 10.0), default=0.0)
    """Only in space: speed along the axis at the start, over the disturbance."""

    tilt_kick: Ratio = key(between(0.0, 10.0), default=0.0)
    """Only in space: speed of the rim by tilting at the start, over the disturbance."""

    ball_scatter: Ratio = key(between(0.0, 1.0), default=0.3)
    """Lead or lag of each ball at the start, over half the pocket clearance."""

    restitution_factors: tuple[Ratio, ...] = key(
        between(0.0, 1.0, open_low=True, open_high=True),
        default=(),
        certain=True,
        length=(0, 1000),
        rising=True,
        without="the eighths, 1/16 and 15/16",
    )
    """Where the curve is computed."""

    seed: int = key(between(0, 2**63 - 1), default=1, certain=True, example="1")

    @property
    def middle_kick(self) -> MetrePerSecond:
        """The reference kick of settings whose defaults have numbers (`cage.settings_for`)."""
        if self.reference_kick is None:
            raise InputError("StabilitySettings.reference_kick", "is not known before the cage's speed is")
        return self.reference_kick


@cache
def shipped_studies() -> dict[str, Path]:
    """Path of each shipped example by its name."""
    folder = Path(__file__).parents[1] / "examples"
    return {path.stem: path for path in sorted(folder.iterdir()) if path.suffix == ".toml"}


@record
class Study:
    """Everything that was asked, resolved: library names are replaced by their records."""

    FILE: ClassVar = Kind(shipped=shipped_studies)

    name: str = ""
    title: str = key(default="", example='"My bearing"', without="the name of the file")
    extends: str | None = key(default=None, compare=False)
    """Start from another file, or from a shipped example; this one overrides."""

    library: tuple[str, ...] = key(
        default=(),
        compare=False,
        length=(1, 20),
        single=True,
        hint="Give the path of a file, in quotes, or a list of them.",
        without="materials.toml beside the study",
    )
    """Files with your own materials."""

    operation: Operation = key()
    bearing: BallBearing = key(read=read_bearing)
    kinematics: Kinematics = key(default=Kinematics())
    film: Film = key()
    traction: TractionSettings = key(default=TractionSettings())
    ranking: RankingQuestion | None = key(default=None, read=read_ranking, form=RankingSection)
    cage: CageDesign | None = key(default=None)
    stability: StabilitySettings = key(default=StabilitySettings())
    wear: WearRates | None = key(default=None)
    cooling: Cooling | None = key(default=None)
    origins: Mapping[str, str] = field(default_factory=dict, compare=False, repr=False)
    """Where each value was given: "bearing.ball_diameter" to "case.toml, line 4"; the absent are defaults."""

    distributions: Mapping[str, Distribution] = field(default_factory=dict)
    """Distributions of uncertain inputs by name (`study.keys`); the records hold the means."""

    fluid: Mapping[str, Any] | None = field(default=None, compare=False, repr=False)
    """The library's whole record of the fluid."""

    friction_table: Mapping[str, Any] | None = field(default=None, compare=False, repr=False)
    """The library's whole record of the table that [ranking] names."""

    notes: tuple[str, ...] = field(default=(), compare=False, repr=False)
    """Where it leaves the range of the models, and what of its file has no effect or is left out."""

    content: Mapping[str, Any] | None = field(default=None, compare=False, repr=False)
    """What the study was read from: its name, its merged keys, and the texts of the files that they name."""

    def place(self, *keys: str) -> str:
        """File and line of the first of these keys that is given; the name of the study if none is."""
        given = (self.origins[one].partition(": ")[0] for one in keys if one in self.origins)
        return next(given, self.name)


@check(Study)
def _balls_that_turn(operation: Operation, bearing: BallBearing) -> Faults:
    if (operation.inner_speed or operation.outer_speed) and bearing.ball_material.density is None:
        rule = "needs a density, for the centrifugal force of the balls"
        yield Fault(("bearing", "ball_material"), rule, 'Add density = "7650 kg/m3" or the like.', "")


@check(Study)
def _coolant_that_is_known(cooling: Cooling, operation: Operation) -> Faults:
    for name in ("temperature", "fluid") if cooling else ():
        if getattr(operation, name) is None:
            rule = "is missing beside [cooling]"
            yield Fault(("operation", name), rule, "Give it, or leave [cooling] out.", "")


LEAST_TURNING = 1e-4
"""Least race friction that turns balls: of less, rounding of the loads is 1e-10 (momentum-wheel at 3e-5)."""


@check(Study)
def _friction_turns_free_balls(kinematics: Kinematics, film: Film) -> Faults:
    if kinematics.model is KinematicModel.FREE and film.race_friction < LEAST_TURNING:
        rule = f'must be >= {LEAST_TURNING:g} for the "free" kinematics'
        cure = "Without friction nothing turns the balls; choose a race control model."
        yield Fault(("film", "race_friction"), rule, cure)


@check(Study)
def _pressure_of_a_whole_film(traction: TractionSettings, film: Film) -> Faults:
    """The pressure of coated contacts is that of a whole film."""
    if traction.pressure is ContactPressure.COATED and film.wear is not None:
        rule = 'must be "hertz" where the film is worn: a film whose thickness varies is in series'
        yield Fault(("traction", "pressure"), rule)


@check(Study)
def _stiffness_is_known(cage: CageDesign, ranking: RankingQuestion | None) -> Faults:
    """Without a stiffness, the cage or every candidate needs a material, for the modulus of the pocket."""
    if cage.ball_cage_stiffness is not None or cage.material is not None:
        return
    candidates = ranking.candidates if ranking else ()
    bare = [candidate.name for candidate in candidates if candidate.material is None]
    if bare or not candidates:
        who = f'the candidate "{bare[0]}"' if bare else "the cage"
        rule = f"is missing, and {who} has no material to compute it from"
        yield Fault(("cage", "ball_cage_stiffness"), rule, "Give the stiffness or the material.", "")


@check(Study)
def _mass_is_known(cage: CageDesign, ranking: RankingQuestion | None) -> Faults:  # noqa: ARG001 - has the density
    """A mass is given, or that of a ring of known shape and density, perhaps of a candidate."""
    if cage.has_shape and cage.mass is None and (cage.material is None or cage.material.density is None):
        cure = "Give it, or a cage material with its density."
        yield Fault(("cage", "mass"), "is missing, and the density of the cage is not known", cure, "")


check(Study)(cage_body.bars_are_left)
check(Study)(cage_body.lands_between_rings)
check(Study)(cage_body.ring_between_rings)
_SIZES = (cage_body.bars_are_left, cage_body.ring_between_rings)
check(Study, after=_SIZES)(cage_body.body_that_can_be)
check(Study)(cage_body.pockets_for_balls)


ORDER = (
    *("bearing", "operation", "kinematics", "film", "traction", "cage", "stability", "ranking", "wear"),
    "cooling",
)
"""Sections as a reader likes them."""

SECTIONS: dict[str, type] = {name: keys_of(Study)[name].hint for name in ORDER if name != "ranking"}
"""Sections of a study file whose keys are the fields of a record."""


def key_of(path: str) -> str:
    """Name in a study file of a field: ``CageDesign.mass`` and ``Study.cage.mass`` are ``[cage] mass``."""
    record, _, key = path.partition(".")
    if record == "Study" and "." in key:
        section, _, key = key.partition(".")
        return f"[{section}] {key}"
    return f"{_HEAD_OF[record]}{key}" if record in _HEAD_OF else path


_HEAD_OF = {record.__name__: f"[{section}] " for section, record in SECTIONS.items()} | {
    "RankingQuestion": "[ranking] ",
    "Friction": "[ranking] ",
    "Wear": "[film] wear.",
}
