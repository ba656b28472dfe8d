"""What the study of a document states of its bearing, operating point, film and cage, a fact a line."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from separatrix.ground.document import Part
from separatrix.verbs.parts.answer_page import entry_words

Json = Mapping[str, Any]
Facts = list[tuple[str, str]]

MODELS = {"strips": "strips", "exact": "exact contact"}
PRESSURES = {"hertz": "Hertz's pressure", "coated": "pressure of the coated bodies"}


def stated(study: Json, section: str, key: str) -> str:
    """Return an input of a resolved study as text; empty if there is none, or if it is 0."""
    entry = (study.get(section) or {}).get(key) or {}
    return entry_words(entry) if entry.get("value") or entry.get("name") else ""


def bearing_facts(answer: Part) -> Facts:
    """Return bearing, contact, operating point and film of an answer's study."""
    study = answer.values["study"]
    at = study["bearing"]
    balls = f"{at['ball_count']['value']} balls of {entry_words(at['ball_diameter'])}"
    bore = stated(study, "bearing", "bore")
    ball, ring = (at[f"{part}_material"]["name"] for part in ("ball", "ring"))
    steels = f"balls and rings {ball}" if ball == ring else f"balls {ball}, rings {ring}"
    grooves = ", ".join(f"{entry_words(at[f'{race}_conformity'])} {race}" for race in ("inner", "outer"))
    contact = f"{entry_words(at['contact_angle'])} without load; {steels}; groove radius over ball diameter"
    size = f"pitch diameter {entry_words(at['pitch_diameter'])}"
    return [
        ("Bearing", ", ".join(filter(None, [balls, size, bore and f"bore {bore}"]))),
        ("Contact angle", f"{contact} {grooves}"),
        ("Operation", operation_words(study)),
        ("Film on the races", film_words(study)),
        ("Traction", contact_words(study)),
    ]


def operation_words(study: Json) -> str:
    """Return speeds, loads and medium of a study."""
    outer, inner = stated(study, "operation", "outer_speed"), study["operation"]["inner_speed"]
    speeds = [f"inner ring {entry_words(inner)}", outer and f"outer ring {outer}"]
    keys = (("axial_load", "axial"), ("radial_load", "radial"), ("moment", "moment"))
    loads = [f"{load} {way}" for key, way in keys if (load := stated(study, "operation", key))]
    around = " at ".join(filter(None, (stated(study, "operation", key) for key in ("fluid", "temperature"))))
    return ", ".join(filter(None, [*speeds, *loads])) + (f"; {around}" if around else "")


def film_words(study: Json) -> str:
    """Return the film and the friction on the races."""
    film = study["film"]
    name = (film.get("material") or {}).get("name") or "film"
    coat = "none: bare races" if film["is_bare"] else f"{name}, {entry_words(film['thickness'])}"
    worn = stated(study, "film", "wear.races")
    where = f"; worn on {'both races' if worn == 'both' else f'the {worn} race'}" if worn else ""
    return f"{coat}; friction {entry_words(film['race_friction'])}{where}"


def contact_words(study: Json) -> str:
    """Return how the contacts are computed."""
    asked = study["traction"]
    slip = ", slip by the pressure included" if asked["pressure_slip"]["value"] == "included" else ""
    return f"{MODELS[asked['model']['value']]}, {PRESSURES[asked['pressure']['value']]}{slip}"
