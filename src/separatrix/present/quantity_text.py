"""How each quantity of an answer is written, and its numbers as facts, columns, sentences and axes.

The unit of a quantity stands at the field of its record and in every document; so does the meaning, in the
reference of answers. A name means the same everywhere, so each stands here once.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise
from operator import itemgetter
from typing import Any

from separatrix.ground.plain_data import Part
from separatrix.ground.quantity import Estimate, Number, Quantity, alone, scale
from separatrix.present.blocks import Cell, Column, Level, Table, text_column
from separatrix.present.figure import Axis, Trace

Q = Quantity

QUANTITIES: dict[str, Quantity] = {
    # The ball set and its contacts.
    "azimuth": Q(label="azimuth of the ball", head="azimuth", digits=4),
    "orbital_speed": Q(label="orbital speed of the ball", head="orbit", unit="rad/s", digits=5),
    "pitch_angle": Q(label="pitch angle of the ball's spin", head="pitch", digits=4, rounding=1e-12),
    "axial_displacement": Q(label="axial displacement from first contact", digits=4),
    "radial_displacement": Q(label="radial displacement of the inner ring", digits=4),
    "tilt": Q(label="tilt of the inner ring", digits=4, rounding=1e-12),
    "moment": Q(label="moment of the balls", digits=4, rounding=1e-12),
    "friction_torque": Q(label="torque of friction of balls on races", digits=4),
    "shaft_torque": Q(label="torque of the shaft", digits=4),
    "shaft_power": Q(label="power of the shaft", digits=4),
    "cage_power": Q(label="friction at pockets and lands"),
    "ball_drag": Q(label="drag of the fluid on a ball"),
    "drag_share": Q(label="drag over what the races hold", unit="%", digits=2),
    "ball_drag_power": Q(label="power of the drag of the balls"),
    "spin_power": Q(label="power of the fluid on the spin of the balls"),
    "cage_drag_power": Q(label="power of the fluid on the faces of the cage"),
    "inner_ring_temperature": Q(label="temperature of the inner ring", digits=4),
    "ball_temperature": Q(label="temperature of the balls", digits=4),
    "outer_ring_temperature": Q(label="temperature of the outer ring", digits=4),
    "cage_temperature": Q(label="temperature of the cage", digits=4),
    "coolant_out_temperature": Q(label="temperature of the coolant as it leaves", digits=4),
    "flash_inner": Q(label="flash temperature, a rise, inner race"),
    "flash_outer": Q(label="flash temperature, a rise, outer race"),
    "track_heat": Q(label="heat into the hotter track, over its area", digits=2),
    "boiling_limit": Q(label="heat flux that leaves a surface dry", digits=2),
    "load": Q(label="load", symbol="Q", digits=4),
    "contact_angle": Q(label="contact angle", head="angle", digits=4, rounding=1e-12),
    "semi_major": Q(label="semi-major axis a, across the groove", symbol="a", digits=4),
    "semi_minor": Q(label="semi-minor axis b, along rolling", symbol="b", digits=4),
    "max_pressure": Q(label="maximum Hertz pressure", head="pressure", symbol="p_0", digits=4),
    "approach": Q(label="mutual approach", digits=4),
    "rolling_speed": Q(label="rolling speed", digits=4),
    "spin_roll_ratio": Q(label="spin to roll ratio", head="spin/roll", form=".4f"),
    "pressure": Q(label="pressure", symbol="p"),
    "creep_spin": Q(label="creep by spin, s", digits=4, rounding=1e-9),
    "creep_curvature": Q(label="creep by curvature, q", digits=4),
    "creep_ratio": Q(label="creep ratio", symbol="xi", unit="%"),
    # Clearances of the cage.
    "pocket_at_rest": Q(label="pocket clearance at rest", digits=4),
    "pocket": Q(label="running pocket clearance", digits=4),
    "pocket_axial_at_rest": Q(label="pocket clearance along the axis at rest", digits=4),
    "pocket_axial": Q(label="running pocket clearance along the axis", digits=4),
    "land_at_rest": Q(label="land clearance at rest", digits=4),
    "land": Q(label="running land clearance", digits=4),
    "temperature": Q(label="temperature", digits=4),
    "cage_speed": Q(label="speed of the cage", digits=4),
    "hoop_strain": Q(label="strain of the cage by rotation", unit="%"),
    # Traction, restitution, mobility.
    "slope": Q(label="slope of the traction curve", head="slope", symbol="alpha", digits=4),
    "slope_error": Q(label="error of the slope", digits=2),
    "ball_cage_stiffness": Q(label="stiffness of ball and pocket", symbol="k_BC", digits=4),
    "cage_mass": Q(label="cage mass", symbol="M_C", digits=4),
    "race_damping": Q(label="race damping", symbol="C_mu", digits=4),
    "damping_ratio": Q(label="damping ratio", symbol="zeta", form=".3f"),
    "restitution_factor": Q(label="restitution factor", symbol="eta", form=".3f"),
    "restitution_factor_hertz": Q(label="restitution factor of a Hertzian pocket", form=".3f"),
    "half_play": Q(label="half the pocket clearance along the orbit", head="half clearance", digits=4),
    "orbital_share": Q(label="share of the speed variance in the harmonics used", unit="%", digits=4),
    "free_rolling_offset": Q(label="free-rolling offset of the creep", digits=4),
    "creep_increment": Q(label="creep increment", symbol="dxi", unit="%"),
    "traction_coefficient": Q(label="traction coefficient", symbol="C_T", digits=4),
    "along": Q(label="x along rolling"),
    "across": Q(label="y across the groove", digits=2),
    "film_thickness": Q(label="total thickness of the film"),
    "race_friction": Q(label="race friction", symbol="f_BT"),
    # Life.
    "revolutions": Q(label="revolutions", form=".1e"),
    "first_decile": Q(label="P(stable) of the first tenth", head="first tenth", form=".2f"),
    "last_decile": Q(label="P(stable) of the last tenth", head="last tenth", form=".2f"),
    "correlation": Q(label="rank correlation", form="+.2f"),
    "draws": Q(label="bearings drawn", form=".0f"),
    "never_unstable": Q(label="never unstable", unit="%", digits=3),
    "coverage_calm": Q(label="coverage where deposit of a calm cage balances wear", unit="%", digits=2),
    "coverage_whirling": Q(label="the same of a cage that whirls", unit="%", digits=2),
    "film_time": Q(label="duty that an hour of the test wears the films for, in hours", digits=3),
    "pocket_time": Q(label="duty that an hour of the test wears the pockets for, in hours", digits=3),
    "wear_coefficient": Q(label="wear coefficient", head="wear"),
    "wear_error": Q(label="standard error of the wear coefficient", head="error of wear", digits=2),
    "damping": Q(label="damping, attitude of the spin held", symbol="C_f", digits=4),
    "effective_mass": Q(label="effective mass", symbol="m_e", digits=4),
    "damping_relaxed": Q(label="damping of a slow push", symbol="C_eff", digits=4),
    "damping_locked": Q(label="damping with all spin held", digits=4),
    "groove_damping": Q(label="damping across the orbit", symbol="c_g", digits=4),
    "groove_stiffness": Q(label="stiffness across the orbit", symbol="k_g", digits=4),
    "pocket_friction_effect": Q(
        label="effect $k$ of pocket friction, 1 \N{PLUS-MINUS SIGN} $k$ $f$", digits=4
    ),
    "rates": Q(label="rate of a mode"),
    "oscillations": Q(label="oscillation of a mode"),
    "shares": Q(label="share of 1/$C_eff$"),
    "capacity": Q(label="capacity of the races", symbol="F_max", digits=4),
    "speed": Q(label="speed beyond free orbit", symbol="u", head="speed", digits=4),
    "force_law": Q(label="force by the law", head="law", digits=4),
    "law_error": Q(label="largest error of the law", unit="%", digits=2),
    "asymmetry": Q(label="difference of forward and backward", unit="%", digits=2),
    # Checked studies.
    "mass": Q(label="mass", digits=4),
    "lean": Q(label="lean of a pocket's contact, towards the bearing axis"),
    "land_gap": Q(label="radial gap of the land", digits=4),
    # Stability curves, maps and sweeps.
    "ball_cage_friction": Q(label="ball/cage friction", symbol="f_BC", head="pocket friction"),
    "critical_friction": Q(label="critical friction", ends=("scatter_low", "scatter_high")),
    "critical_friction_low": Q(
        label="lower end of the band", head="band low", ends=("low_scatter_low", "low_scatter_high")
    ),
    "critical_friction_high": Q(
        label="upper end of the band", head="band high", ends=("high_scatter_low", "high_scatter_high")
    ),
    "kicks": Q(label="initial disturbances", unit="m/s", form=".3g"),
    "middle_kick": Q(label="reference disturbance", unit="m/s", form=".3g"),
    "band_few": Q(label="share of runs that whirl at the lower end of the band", unit="%"),
    "runs": Q(label="runs", form=".0f"),
    "most_runs": Q(label="most runs of a point", digits=7),
    "agreeing_runs": Q(label="runs that agree", digits=7),
    "wrong_side_probability": Q(label="risk of the wrong side", unit="%", digits=2),
    "other_decision_probability": Q(label="risk of another decision", unit="%", digits=2),
    "probability_whirl": Q(
        label="share of the runs that whirl", digits=2, ends=("probability_low", "probability_high")
    ),
    "time_share": Q(label="share of the time", head="time", unit="%"),
    "shaft_frequency": Q(label="shaft, 1x", unit="Hz"),
    "cage_frequency": Q(label="cage and ball set, 1x", unit="Hz"),
    "linear_whirl_frequency": Q(label="whirl without clearance", unit="Hz"),
    "orbit_frequency": Q(label="orbit of whirling runs", unit="Hz"),
    "below_margin": Q(label="with a margin below 0", unit="%"),
    "refused": Q(label="without an answer", unit="%"),
    # Runs of the cage.
    "bearing_torque": Q(label="torque of the shaft with its running cage", digits=4),
    "cage_torque": Q(label="torque by friction at pockets and lands"),
    "pocket_heat": Q(label="heat of friction in the pockets"),
    "pocket_share": Q(label="share of the power at the pockets", unit="%", digits=2),
    "housing_frequency": Q(label="loudest third octave of a whirl, in the housing", digits=3),
    "housing_share": Q(label="share of the power of a whirl in it", unit="%", digits=2),
    "slower_torque": Q(label="torque at 0.8 of the speed", digits=4),
    "torque_exponent": Q(label="exponent of torque against speed", form=".2f"),
    "race_exponent": Q(label="the same without the cage", form=".2f"),
    "judged_from": Q(label="start of the judged part", digits=4),
    "followed": Q(label="end of the judged part", digits=4),
    "one_core_time": Q(label="time that one core needs, within a factor of 3", digits=1),
    "run_length": Q(label="length of the run", digits=4),
    "given_restitution_factor": Q(label="restitution factor in place of the study's", symbol="eta", digits=4),
    "tilt_phase": Q(label="phase of the tilt before the offset", form=".0f"),
    "cage_slip": Q(label="slip of the cage", unit="%"),
    "axial_half_play": Q(label="pocket clearance along the axis each way", digits=4),
    "pocket_angle": Q(label="place of the pocket", head="place", digits=4),
    "pocket_impacts": Q(label="impacts", form=".0f"),
    "impacts_per_turn": Q(label="impacts per turn of the cage", form=".2f"),
    "pocket_rubbing_power": Q(label="heat of rubbing", head="heat of rubbing"),
    # Rankings and their verdicts.
    "friction": Q(label="pocket friction", head="friction", symbol="f_BC", form=".3f"),
    "restitution_threshold": Q(
        label="restitution threshold",
        head="threshold",
        form=".2f",
        top=1.0,
        meaning="largest restitution factor eta at which the cage is stable from the reference disturbance",
    ),
    "effective_restitution_factor": Q(label="effective restitution factor", form=".2f"),
    "own_critical_friction": Q(
        label="critical friction",
        head="critical",
        form=".3f",
        meaning="friction at which its pockets whirl half the runs, worst disturbance, on these races",
    ),
    "safety_factor": Q(
        label="safety factor", head="S", symbol="S", form=".2f", meaning="critical friction over friction"
    ),
    "margin": Q(label="margin", form="+.2f", meaning="threshold less the bearing's own eta"),
    "probability_stable": Q(
        label="P(stable)",
        form=".2f",
        ends=("probability_low", "probability_high"),
        meaning="share of runs that settle, or roll in their pockets, from the worst disturbance",
    ),
    "paper_probability_stable": Q(label="P(stable) by the paper's model", head="P(stable)", form=".2f"),
    "uncertain_probability_stable": Q(
        label="P(stable) with the uncertain inputs drawn",
        form=".2f",
        ends=("uncertain_probability_low", "uncertain_probability_high"),
    ),
    "friction_scatter": Q(label="assumed scatter of friction", unit="%"),
    "kick": Q(label="initial disturbance", unit="m/s", form=".3g"),
    "largest_offset": Q(label="largest offset of the cage centre", head="largest offset"),
    "mean_offset": Q(label="mean offset of the cage centre", head="mean offset"),
    "largest_tilt": Q(label="largest tilt of the cage", head="tilt", unit="mrad"),
    "growth_rate": Q(label="growth rate of the amplitude"),
    "drift_rate": Q(label="drift rate", head="drift", digits=2),
    "largest_contact_force": Q(label="largest force at a pocket", head="pocket force"),
    "largest_land_force": Q(label="largest force on the land", head="land force"),
    "rubbing_power": Q(label="power of rubbing on the land", head="rubbing"),
    "whirl_frequency": Q(label="whirl frequency of the cage centre", head="whirl"),
    "energy_imbalance": Q(label="energy imbalance", digits=2),
    "pocket_clearance": Q(label="pocket clearance as it runs", digits=4),
    "land_clearance": Q(label="land clearance as it runs", digits=4),
    "slip_speed": Q(label="sliding speed of ball on pocket"),
    "impact_force": Q(label="force of an impact at that speed"),
    # Uncertain studies.
    "mean": Q(label="mean", digits=4),
    "share": Q(label="share of the variance", head="share", unit="%", form=".0f"),
    "skill": Q(label="part of the deviance explained", head="skill", unit="%", form=".0f"),
    "bearings": Q(label="bearings", form=".0f"),
    "settles": Q(label="whether the cage settles", form=".0f"),
    # Logs, materials and comparisons.
    "standard_error": Q(label="standard error", digits=2),
    "standard_deviation": Q(label="scatter", digits=2),
    "degrees_of_freedom": Q(label="degrees of freedom", form=".0f"),
    "effective_count": Q(label="independent values"),
    "steady_rows": Q(label="rows of the steady part", form=".0f"),
    "rows": Q(label="rows", form=".0f"),
    "cycles": Q(label="whole cycles", form=".0f"),
    "run_in_end": Q(label="end of running-in", head="running-in ends", digits=4),
    "steady_end": Q(label="end of the steady part", head="steady until", digits=4),
    "default_scatter": Q(label="assumed scatter", unit="%"),
}

SHARES = (
    *("unstable_at_start", "film_worn", "pocket_opened", "land_opened"),
    *("friction_risen", "reservoir_empty", "film_sustained"),
)
"""Shares of drawn bearings."""

QUANTITIES |= {name: Q(label=name.replace("_", " "), unit="%", digits=2) for name in SHARES}
QUANTITIES |= {name: Q(label=name.upper(), unit="%") for name in ("stable", "unstable", "undecided")}
QUANTITIES |= {
    f"{one}_strain": Q(label=f"thermal strain, {one}", unit="%") for one in ("cage", "ball", "ring")
}
for _name in ("revolutions_10", "revolutions_50", "revolutions_90", "horizon"):
    QUANTITIES[_name] = QUANTITIES["revolutions"]
for _name in ("forward", "backward"):
    QUANTITIES[f"force_{_name}"] = Q(label=f"force {_name}", head=f"F {_name}", digits=4)
for _race, _end in (("inner", "in"), ("outer", "out")):
    QUANTITIES |= {
        f"heat_{_race}": Q(label=f"heat of friction, {_race} race", digits=4),
        f"{_race}_damping": Q(label=f"damping of the {_race} race", digits=4),
        f"slip_speed_{_race}": Q(label=f"slip speed, {_race} race", digits=4),
        f"film_{_race}": Q(label=f"film on the {_race} track", head=f"film, {_race}", unit="um", form=".3f"),
        f"{_race}_pass_frequency": Q(label=f"balls past the {_race} ring", unit="Hz"),
    }
    for _name in ("load", "contact_angle", "spin_roll_ratio", "max_pressure", "slope"):
        _of = QUANTITIES[_name]
        _label, _head = f"{_of.label} at the {_race} race", f"{_of.head or _of.label} {_end}"
        _symbol = f"Q_{_race[0]}" if _name == "load" else ""
        QUANTITIES[f"{_name}_{_race}"] = replace(_of, symbol=_symbol, label=_label, head=_head)
for _name in ("race_damping", "damping_ratio", "restitution_factor"):
    _label = f"{QUANTITIES[_name].label} if the ball may spin"
    QUANTITIES[f"{_name}_free_spin"] = replace(QUANTITIES[_name], label=_label, symbol="")

Of = Callable[[Any], Part | None]
"""From a row to the part that has a number; None where the row has none."""


def itself(row: Any) -> Any:
    """Return a row: most tables have their numbers there."""
    return row


def quantity(name: str) -> Quantity:
    """Return the label and form of a quantity of this name; one that only full tables have, by its name.

    A key of a study, as ``film.thickness``, has its own words, with its section where these need it.
    """
    if name in QUANTITIES:
        return QUANTITIES[name]
    section, _, key = name.replace("_", " ").rpartition(".")
    is_known = section in ("", "operation", "wear", "cooling") or section in key or key == "race friction"
    return Quantity(label=key if is_known else f"{section.replace('.', ' ')} {key}", head=key)


def ends_of(name: str) -> tuple[str, str]:
    """Return the names of the ends of the interval of a quantity."""
    return quantity(name).ends or (f"{name}_low", f"{name}_high")


def estimate(part: Part, name: str) -> Number:
    """Return a number of a part, with its interval if it has one."""
    value = getattr(part, name)
    low, high = ends_of(name)
    if part.get(low) is None:
        return value  # type: ignore[no-any-return]
    if value is not None and value >= quantity(name).top:
        return Estimate(None, part.get(low))
    return Estimate(value, part.get(low), part.get(high))


def cell(part: Part | None, name: str, mark: str = "") -> Cell:
    """Return a number of a part as a cell; an absent one without a part."""
    if part is None:
        return Cell(None, quantity(name))
    value = estimate(part, name)
    return Cell(value, quantity(name), part.unit(name), mark if value is not None else "")


def named(name: str) -> str:
    """Return the label of a quantity with its symbol, as a line begins with it."""
    known = quantity(name)
    return begun(f"{known.label} ${known.symbol}$" if known.symbol else known.label)


def begun(words: str) -> str:
    """Return words as they stand at the beginning of a line."""
    return words[:1].upper() + words[1:]


def fact(part: Part, name: str, label: str = "") -> tuple[str, Cell]:
    """Return label and value of a quantity."""
    return begun(label or quantity(name).label), cell(part, name)


def head_of(name: str) -> str:
    """Return what stands above a column of a quantity."""
    return quantity(name).head or quantity(name).label


def column(
    name: str,
    *,
    of: Of = itself,
    head: str = "",
    mark: Callable[[Any], str] = lambda _: "",
    is_short: bool = False,
) -> Column:
    """Return the column of a quantity; `of` finds in a row the part that has it; short: without intervals."""

    def one(row: Any) -> Cell:
        found = cell(of(row), name, mark(row))
        if is_short and isinstance(found.value, Estimate) and not found.value.is_beyond:
            return replace(found, value=found.value.value)
        return found

    return Column(head or head_of(name), one, meaning=quantity(name).meaning)


def known_columns(columns: Iterable[Column], rows: Sequence[Any]) -> tuple[Column, ...]:
    """Return the columns in which some of the rows have a value."""
    return tuple(one for one in columns if any(one.cell(row).value not in (None, "") for row in rows))


def place_column(part: Part, name: str, *, head: str = "") -> Column:
    """Return the column of a list of a part, for rows that are places in it."""
    known, unit = quantity(name), part.unit(name)
    return Column(head or head_of(name), lambda place: Cell(getattr(part, name)[place], known, unit))


def places_table(
    name: str, part: Part, *columns: str, level: Level = Level.SHEET, caption: str = ""
) -> Table:
    """Return lists of a part as columns, their places as rows, by default for a workbook."""
    shown = tuple(place_column(part, one) for one in columns if one in part)
    return Table(name, shown, tuple(range(len(part.get(columns[0])))), caption, level)


def all_numbers(name: str, heads: Sequence[str], rows: Iterable[tuple[Any, ...]]) -> Table:
    """Return what some parts have for a workbook; a row is a value for each of `heads`, and then its part."""
    known = tuple(rows)
    kinds: dict[str, bool] = {}
    for key, value in (pair for *_, part in known for pair in part.values.items()):
        is_words = isinstance(value, str | bool)
        if is_words or isinstance(value, int | float):
            kinds[key] = is_words
    ends = {end for key in kinds for end in ends_of(key)}

    def held(key: str) -> Column:
        if kinds[key]:
            return text_column(key.replace("_", " "), lambda row: row[-1].get(key))
        return Column(key.replace("_", " "), lambda row: cell(row[-1] if key in row[-1] else None, key))

    labels = (text_column(head, itemgetter(place)) for place, head in enumerate(heads))
    columns = (*labels, *(held(key) for key in kinds if key not in ends))
    return Table(name, columns, known, level=Level.SHEET)


def by_race(name: str, inner: Part, outer: Part, *names: str) -> Table:
    """Return a table with quantities as rows, for the inner and the outer race."""
    columns = (
        text_column("", lambda row: begun(quantity(row).label)),
        Column("inner race", partial(cell, inner)),
        Column("outer race", partial(cell, outer)),
    )
    return Table(name, columns, names)


def show(part: Part, name: str) -> str:
    """Return a number of a part as it stands in a sentence."""
    return alone(estimate(part, name), quantity(name), part.unit(name))


def number_of(part: Part, name: str, value: float | None) -> str:
    """Return one number of a list of a part, as it stands in a sentence."""
    return alone(value, quantity(name), part.unit(name))


def fill(part: Part, template: str) -> str:
    """Return a sentence in which ``{name}`` stands for a number of a part."""
    return re.sub(r"\{(\w+)\}", lambda name: show(part, name[1]), template)


def axis(
    name: str,
    unit: str,
    values: Iterable[float | None],
    *,
    label: str = "",
    low: float | None = None,
    high: float | None = None,
    is_log: bool = False,
) -> Axis:
    """Return the axis of a quantity in the unit that suits some values: its label, symbol and unit."""
    known = quantity(name)
    size, symbol = scale([one for one in values if one is not None], unit, known.unit)
    sign = f" ${known.symbol}$" if known.symbol else ""
    words = f"{label or known.label}{sign} [{symbol or '-'}]"
    return Axis(label=words, size=size, low=low, high=high, is_log=is_log)


def marks(
    rows: Sequence[Part], x: str, y: str, *, hover: Callable[[Part], str] | None = None, **look: Any
) -> Trace:
    """Return a mark for each row; an estimate brings its interval along, that of y where both have one."""
    found: dict[str, Any] = {"line": ""} | look
    for way, name in (("x", x), ("y", y)):
        values = [estimate(row, name) for row in rows]
        if any(isinstance(one, Estimate) for one in values):
            known = [one if isinstance(one, Estimate) else Estimate(one) for one in values]
            low, high = [one.low for one in known], [one.high for one in known]
            found |= {"ends_along": way, "low": low, "high": high}
            values = [one.value for one in known]
        found[way] = values
    return Trace(hover=tuple(hover(row) for row in rows) if hover else (), **found)


# Parameters of a study that are varied.


SPACE = 1.5
"""Ratio of the last step of an axis to its first beyond which values in proportion are logarithmic."""


def parameter_axis(name: str, unit: str, values: Sequence[float], *, is_tight: bool = False) -> Axis:
    """Return the axis of a parameter; a tight one ends at its first and last value."""
    low, high = min(values), max(values)
    ends = (low, high) if is_tight and low < high else (None, None)
    return axis(name, unit, values, is_log=is_proportional(values), low=ends[0], high=ends[1])


def is_proportional(values: Sequence[float]) -> bool:
    """Whether values rise by a factor rather than by a step: their axis is logarithmic."""
    if len(values) < 3 or not values[0] > 0.0:
        return False
    factors = [b / a for a, b in pairwise(values)]
    is_spread = values[-1] - values[-2] > SPACE * (values[1] - values[0])
    return is_spread and max(factors) < 1.05 * min(factors)


def value_of(parameter: Part, name: str, value: float | None) -> Cell:
    """Return a value of a parameter of this name, in its unit."""
    return Cell(value, quantity(name), parameter.get("unit") or "-")


def at(parameter: Part, name: str, value: float | None) -> str:
    """Return a parameter and its value in words."""
    return f"{quantity(name).label} {value_of(parameter, name, value).text}"
