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
    speeds = [f"inner ring {entry_words(study['operation']['inner_speed'])}"]
    outer = stated(study, "operation", "outer_speed")
    speeds += [f"outer ring {outer}"] if outer else []
    keys = (("axial_load", "axial"), ("radial_load", "radial"), ("moment", "moment"))
    loads = [f"{load} {way}" for key, way in keys if (load := stated(study, "operation", key))]
    around = [one for key in ("fluid", "temperature") if (one := stated(study, "operation", key))]
    return ", ".join([*speeds, *loads]) + (f"; {' at '.join(around)}" if around else "")


def film_words(study: Json) -> str:
    """Return the film and the friction on the races."""
    film = study["film"]
    name = (film.get("material") or {}).get("name") or "film"
    coat = "none: bare races" if film["is_bare"] else f"{name}, {entry_words(film['thickness'])}"
    return f"{coat}; friction {entry_words(film['race_friction'])}"


def contact_words(study: Json) -> str:
    """Return how the contacts are computed, and what of the film is worn."""
    asked, film = study["traction"], study["film"]
    words = f"{MODELS[asked['model']['value']]}, {PRESSURES[asked['pressure']['value']]}"
    if asked["pressure_slip"]["value"] == "included":
        words += ", slip by the pressure included"
    if "wear.races" not in film:
        return words
    races = film["wear.races"]["value"]
    words += "; film worn" if races == "both" else f"; film of the {races} race worn"
    places = film["wear.across"]["value"]
    if places:
        return f"{words} by a measured profile of {len(places)} places"
    width, share = stated(study, "film", "wear.width"), stated(study, "film", "wear.share")
    left = stated(study, "film", "wear.thickness")
    bare = f"bare, friction {entry_words(film['wear.friction'])}"
    return (
        f"{words} over {width or f'{share} of the width of the contact'}, {f'{left} left' if left else bare}"
    )
