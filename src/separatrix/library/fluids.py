"""State of a fluid: CoolProp where the extra is installed, the few states of the library otherwise."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from separatrix.errors import InputError
from separatrix.library.records import Datum, Record
from separatrix.units import Kelvin, KilogramPerMetre3, Pascal, format_quantity

ATMOSPHERE: Pascal = 101325.0
SAME_TEMPERATURE: Kelvin = 0.05
"""A state of the record serves this near to its temperature, so that "77.4 K" is the boiling point; the
density changes by less than 0.1 % on the way, that of helium gas by 2 %."""

SAME_PRESSURE = 1e-3
EXTRA = 'Install the extra: pip install "separatrix[fluids]".'


@dataclass(frozen=True, slots=True, kw_only=True)
class FluidState:
    """State of a fluid at a temperature and a pressure; viscosity and heat capacity in SI."""

    name: str
    temperature: Kelvin
    pressure: Pascal
    phase: str
    density: KilogramPerMetre3
    viscosity: float | None
    heat_capacity: float | None
    source: str

    def plain(self) -> dict[str, Any]:
        """Return it as plain data with units."""
        units = {"density": "kg/m3", "viscosity": "Pa s", "heat_capacity": "J/kg/K"}
        return {
            "temperature": {"value": self.temperature, "unit": "K"},
            "pressure": {"value": self.pressure, "unit": "Pa"},
            "phase": self.phase,
            **{key: {"value": getattr(self, key), "unit": unit} for key, unit in units.items()},
            "source": self.source,
        }


def contradictions(record: Mapping[str, Any], temperature: Kelvin) -> Iterator[str]:
    """What a fluid's name says of its phase and its temperature forbids at any pressure.

    A liquid exists between the triple and the critical temperature. A gas exists at any temperature, but
    below the triple point only as thin vapour over the solid. Between, the pressure decides, which a study
    does not state.
    """
    name, phase, at = record["name"], record["phase"], format_quantity(temperature, "K")
    data = record["data"]
    critical, triple = (
        data[key][0]["value"] if data.get(key) else None
        for key in ("critical_temperature", "triple_temperature")
    )
    cure = "Correct the fluid or the temperature."
    if phase == "liquid" and critical is not None and temperature > critical:
        limit = f"the critical temperature is {format_quantity(critical, 'K')}"
        yield f"{name}: at {at} there is no liquid at any pressure, {limit}. {cure}"
    if triple is not None and temperature < triple:
        limit = f"the triple point is {format_quantity(triple, 'K')}"
        yield f"{name}: at {at} it is solid, or a thin vapour; {limit}. {cure}"


def fluid_state(record: Record, temperature: Kelvin, pressure: Pascal = ATMOSPHERE) -> FluidState:
    """State of a fluid at a temperature and a pressure.

    Notes
    -----
    Equations of state and of viscosity are those of CoolProp (I. H. Bell and others, Industrial and
    Engineering Chemistry Research 53, 2498, 2014), which names the source of each. A state of the record
    itself serves with and without that extra: on the saturation line temperature and pressure leave the phase
    open, and the name decides.

    Raises
    ------
    InputError
        The state lies outside the equation of state, or CoolProp is needed and not installed.
    """
    where = f"{record.name} at {format_quantity(temperature, 'K')} and {format_quantity(pressure, 'Pa')}"
    at: dict[str, Any] = {"name": record.name, "temperature": temperature, "pressure": pressure}
    numbers = ("density", "viscosity", "heat_capacity")
    near = [
        next((d for d in record.data.get(key, ()) if _is_at(d, temperature, pressure)), None)
        for key in numbers
    ]
    if near[0] is not None:
        known: dict[str, Any] = {key: d and d.value for key, d in zip(numbers, near, strict=True)}
        return FluidState(**at, phase=str(record.facts["phase"]), **known, source=near[0].source)
    try:
        from CoolProp import CoolProp
    except ImportError:
        raise InputError(where, "is not in the built-in table", cure=EXTRA) from None
    substance = record.facts.get("coolprop")
    if substance is None:
        raise InputError(where, "has no state in its record, and names no fluid of CoolProp")
    state = ("T", temperature, "P", pressure, substance)
    try:
        computed = {key: CoolProp.PropsSI(what, *state) for key, what in zip(numbers, "DVC", strict=True)}
        phase = str(CoolProp.PhaseSI(*state)).replace("_", " ")
    except ValueError as error:
        raise InputError(where, f"has no state: {str(error).partition(':')[0][:100]}") from None
    equations = [CoolProp.get_BibTeXKey(substance, what) for what in ("EOS", "VISCOSITY")]
    return FluidState(**at, phase=phase, **computed, source=f"CoolProp: {', '.join(equations)}")


def other_phase(record: Record, state: FluidState) -> Iterator[str]:
    """Sentence for a fluid of that name which is in another phase."""
    if {str(record.facts["phase"]), state.phase} == {"liquid", "gas"}:
        at = f"{format_quantity(state.temperature, 'K')} and {format_quantity(state.pressure, 'Pa')}"
        yield f"{record.name}: at {at} it is a {state.phase}."


def _is_at(datum: Datum, temperature: Kelvin, pressure: Pascal) -> bool:
    if datum.temperature is None or datum.pressure is None:
        return False
    near = abs(datum.pressure - pressure) <= SAME_PRESSURE * pressure
    low, high = datum.temperature
    return near and low - SAME_TEMPERATURE <= temperature <= high + SAME_TEMPERATURE
