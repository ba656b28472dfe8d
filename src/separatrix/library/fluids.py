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
        return {
            "temperature": {"value": self.temperature, "unit": "K"},
            "pressure": {"value": self.pressure, "unit": "Pa"},
            "phase": self.phase,
            "density": {"value": self.density, "unit": "kg/m3"},
            "viscosity": {"value": self.viscosity, "unit": "Pa s"},
            "heat_capacity": {"value": self.heat_capacity, "unit": "J/kg/K"},
            "source": self.source,
        }


def contradictions(record: Mapping[str, Any], temperature: Kelvin) -> Iterator[str]:
    """What a fluid's name says of its phase and its temperature forbids at any pressure.

    A liquid exists between the triple and the critical temperature. A gas exists at any temperature, but
    below the triple point only as thin vapour over the solid. Between, the pressure decides, which a study
    does not state.
    """
    name, phase, at = record["name"], record["phase"], format_quantity(temperature, "K")
    critical, triple = (_known(record, f"{key}_temperature") for key in ("critical", "triple"))
    if phase == "liquid" and critical is not None and temperature > critical:
        limit = format_quantity(critical, "K")
        yield (
            f"{name}: at {at} there is no liquid at any pressure, the critical temperature "
            f"is {limit}. Correct the fluid or the temperature."
        )
    if triple is not None and temperature < triple:
        limit = format_quantity(triple, "K")
        yield (
            f"{name}: at {at} it is solid, or a thin vapour; the triple point is {limit}. "
            "Correct the fluid or the temperature."
        )


def _known(record: Mapping[str, Any], key: str) -> float | None:
    data = record["data"].get(key)
    return None if not data else float(data[0]["value"])


def fluid_state(record: Record, temperature: Kelvin, pressure: Pascal = ATMOSPHERE) -> FluidState:
    """State of a fluid at a temperature and a pressure.

    Notes
    -----
    Equations of state and of viscosity are those of CoolProp (I. H. Bell and others, Industrial and
    Engineering Chemistry Research 53, 2498, 2014), which names the source of each. A state of the record
    itself serves with and without that extra: on the saturation line temperature and pressure leave the phase
    open, and the name tells it.

    Raises
    ------
    InputError
        The state lies outside the equation of state, or CoolProp is needed and not installed.
    """
    tabulated = _tabulated(record, temperature, pressure)
    if tabulated is not None:
        return tabulated
    try:
        from CoolProp import CoolProp
    except ImportError:
        raise _without_coolprop(record, temperature, pressure) from None
    return _computed(CoolProp, record, temperature, pressure)


def other_phase(record: Record, state: FluidState) -> Iterator[str]:
    """What is to be said where a fluid of that name is in another phase."""
    phase = str(record.facts["phase"])
    if {phase, state.phase} == {"liquid", "gas"}:
        at = f"{format_quantity(state.temperature, 'K')} and {format_quantity(state.pressure, 'Pa')}"
        yield f"{record.name}: at {at} it is a {state.phase}."


def _tabulated(record: Record, temperature: Kelvin, pressure: Pascal) -> FluidState | None:
    found = {
        key: next((d for d in record.data.get(key, ()) if _is_at(d, temperature, pressure)), None)
        for key in ("density", "viscosity", "heat_capacity")
    }
    density = found["density"]
    if density is None:
        return None
    return FluidState(
        name=record.name,
        temperature=temperature,
        pressure=pressure,
        phase=str(record.facts["phase"]),
        density=density.value,
        viscosity=found["viscosity"].value if found["viscosity"] else None,
        heat_capacity=found["heat_capacity"].value if found["heat_capacity"] else None,
        source=density.source,
    )


def _is_at(datum: Datum, temperature: Kelvin, pressure: Pascal) -> bool:
    if datum.temperature is None or datum.pressure is None:
        return False
    near = abs(datum.pressure - pressure) <= SAME_PRESSURE * pressure
    low, high = datum.temperature
    return near and low - SAME_TEMPERATURE <= temperature <= high + SAME_TEMPERATURE


def _without_coolprop(record: Record, temperature: Kelvin, pressure: Pascal) -> InputError:
    at = f"{format_quantity(temperature, 'K')} and {format_quantity(pressure, 'Pa')}"
    return InputError(f"{record.name} at {at}", "is not in the built-in table", cure=EXTRA)


def _computed(coolprop: Any, record: Record, temperature: Kelvin, pressure: Pascal) -> FluidState:
    substance = record.facts.get("coolprop")
    where = f"{record.name} at {format_quantity(temperature, 'K')} and {format_quantity(pressure, 'Pa')}"
    if substance is None:
        raise InputError(where, "has no state in its record, and names no fluid of CoolProp")
    state = ("T", temperature, "P", pressure, substance)
    try:
        density, viscosity, heat_capacity = (coolprop.PropsSI(key, *state) for key in "DVC")
        phase = str(coolprop.PhaseSI(*state)).replace("_", " ")
    except ValueError as error:
        raise InputError(where, f"has no state: {str(error).partition(':')[0][:100]}") from None
    source = (
        f"CoolProp: {_reference(coolprop, substance, 'EOS')}, {_reference(coolprop, substance, 'VISCOSITY')}"
    )
    return FluidState(
        name=record.name,
        temperature=temperature,
        pressure=pressure,
        phase=phase,
        density=density,
        viscosity=viscosity,
        heat_capacity=heat_capacity,
        source=source,
    )


def _reference(coolprop: Any, substance: str, what: str) -> str:
    return str(coolprop.get_BibTeXKey(substance, what))
