"""The form of the candidates of the user's own: their fields, and the fault beside each."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from separatrix.app.candidates import KEY, SECTION, is_measured
from separatrix.app.draft import Checked, Fault
from separatrix.app.fields import Field, as_typed, field_of

PROPERTIES: dict[str, tuple[Any, str]] = {
    "elastic_modulus": ("5 GPa", "for the stiffness of ball and pocket; needs poisson_ratio"),
    "poisson_ratio": (0.4, "from 0 to below 0.5; needs elastic_modulus"),
    "density": ("1400 kg/m3", "for the mass of the cage and its growth by rotation"),
    "thermal_expansion": ("50e-6 m/m/K", "mean from 293 K to the operating temperature"),
    "compressive_strength": ("100 MPa", "for the warning that a pocket is pressed too hard"),
    "source": ("our data sheet", "where the numbers come from"),
    "confidence": ("measured", "how sure they are"),
}
"""Of a material that is given in place: an example, and the meaning."""

SCATTER: dict[str, tuple[Any, str]] = {
    "standard_deviation": (0.02, "of single tests"),
    "count": (8, "of tests"),
    "source": ("our test 7", ""),
}
"""Beside the mean of a friction."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Measured:
    """An environment with the fields of a candidate's friction in it."""

    environment: str
    fields: tuple[Field, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class CandidateForm:
    """One candidate, `number` from 0; `fields` are its name, and its material unless that is in place."""

    number: int
    name: str
    fields: tuple[Field, ...]
    frictions: tuple[Measured, ...]
    properties: tuple[Field, ...]
    property_faults: tuple[str, ...]
    faults: tuple[str, ...]

    @property
    def has_properties(self) -> bool:
        """Whether its material is given in place."""
        return any(one.value for one in self.properties)


@dataclass(frozen=True, slots=True, kw_only=True)
class CandidateList:
    """The candidates of a study, with what is wrong with them as a whole."""

    items: tuple[CandidateForm, ...]
    inherited: tuple[str, ...]
    """Names of those of the file that the study extends, as long as it has none of its own."""

    environments: tuple[str, ...]
    """To choose from for one that is not in the study yet."""

    faults: tuple[str, ...]


def candidate_list(given: Mapping[str, Any], base: Mapping[str, Any], checked: Checked) -> CandidateList:
    """Return the candidates in the form, from the keys of [ranking] and those that it inherits."""
    items = given.get(KEY, [])
    items = items if isinstance(items, list) else []
    faults = _Faults(one for one in checked.faults if (one.section, one.key) == (SECTION, KEY))
    known = _environments(items, given.get("environment", base.get("environment")))
    found = tuple(_candidate(number, item, known, checked, faults) for number, item in enumerate(items))
    inherited = base.get(KEY, []) if KEY not in given else []
    return CandidateList(
        items=found,
        inherited=tuple(_name(item) for item in inherited) if isinstance(inherited, list) else (),
        environments=tuple(one for one in checked.offered.environments if one not in known),
        faults=faults.rest(),
    )


def _environments(items: Iterable[Any], own: Any) -> dict[str, None]:
    """Return the environments of all candidates, and that of the ranking."""
    frictions = [item.get("friction") for item in items if isinstance(item, dict)]
    found = [env for one in frictions if isinstance(one, dict) for env in one]
    return dict.fromkeys([*found, own] if isinstance(own, str) else found)


def _candidate(
    number: int, item: Any, environments: Iterable[str], checked: Checked, faults: _Faults
) -> CandidateForm:
    given = item if isinstance(item, dict) else {}
    made = _Maker(number, faults)
    frictions, material = given.get("friction"), given.get("material")
    in_place = material if isinstance(material, dict) else {}
    fields = [made.field(("name",), given.get("name"), example="My compound", is_required=True)]
    properties = tuple(
        made.field(("material", key), in_place.get(key), example=example, meaning=meaning)
        for key, (example, meaning) in PROPERTIES.items()
        if material is None or isinstance(material, dict)
    )
    property_faults = faults.taken(f"[{number + 1}].material") if in_place else ()
    if not in_place:
        name, names = material or None, checked.offered.cage_materials
        meaning = "a name of the library; for the stiffness of ball and pocket"
        fields.append(made.field(("material",), name, example="Armalon", meaning=meaning, choices=names))
    return CandidateForm(
        number=number,
        name=_name(item),
        fields=tuple(fields),
        frictions=tuple(
            made.friction(place, env, frictions.get(env) if isinstance(frictions, dict) else None)
            for place, env in enumerate(environments)
        ),
        properties=properties,
        property_faults=property_faults,
        faults=faults.taken(f"[{number + 1}]"),
    )


def _name(item: Any) -> str:
    name = item.get("name", "") if isinstance(item, dict) else item
    return as_typed(name)


class _Faults:
    """Faults of candidates, each of which is shown in one place."""

    def __init__(self, faults: Iterable[Fault]) -> None:
        self._left = list(faults)

    def taken(self, place: str) -> tuple[str, ...]:
        """Return the messages about a place, and what is inside it, that nothing has taken yet."""
        found = [
            one
            for one in self._left
            if one.inside.startswith(place) and one.inside[len(place) : len(place) + 1] in ("", *".,[ ")
        ]
        self._left = [one for one in self._left if one not in found]
        return tuple(one.message for one in found)

    def rest(self) -> tuple[str, ...]:
        """Return the messages that nothing has taken."""
        return tuple(one.message for one in self._left)


class _Maker:
    """What makes the fields of one candidate."""

    def __init__(self, number: int, faults: _Faults) -> None:
        self.number, self.faults = number, faults
        self.sent = {"field": f"{SECTION}.{KEY}", "candidate": str(number)}
        self.id = f"f-{KEY}-{number}"

    def field(self, part: tuple[str, ...], value: Any, **more: Any) -> Field:
        """Return the field of its name, its material or a property of that."""
        return field_of(
            part[-1],
            value,
            id="-".join((self.id, *part)),
            sent={**self.sent, "part": ".".join(part)},
            faults=self.faults.taken(f"[{self.number + 1}].{'.'.join(part)}"),
            **more,
        )

    def friction(self, place: int, environment: str, value: Any) -> Measured:
        """Return the fields of a friction: a mean, or any other form that it has, and its scatter."""
        at = f'[{self.number + 1}].friction."{environment[:60]}"'
        parts = value if is_measured(value) else {"mean": value}
        scatter = tuple(
            self._of_friction(place, environment, key, parts.get(key), f"{at}.{key}", *more)
            for key, more in SCATTER.items()
        )
        mean, meaning = parts.get("mean"), "a number, or like 0.12 +- 20 %"
        own = self._of_friction(place, environment, "mean", mean, at, 0.12, meaning)
        return Measured(environment=environment, fields=(own, *scatter))

    def _of_friction(
        self, place: int, environment: str, key: str, value: Any, at: str, example: Any, meaning: str
    ) -> Field:
        return field_of(
            "friction" if key == "mean" else key,
            value,
            example=example,
            meaning=meaning,
            id=f"{self.id}-friction-{place}-{key}",
            sent={**self.sent, "part": f"friction.{key}", "environment": environment},
            faults=self.faults.taken(at),
        )
