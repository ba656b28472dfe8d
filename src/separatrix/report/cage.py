"""Text for the moving cage: stability curve and one run, and what they hold for."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from separatrix.report.tables import facts, number, paragraph, quantity, section, significant, table

Document = Mapping[str, Any]


def stability(document: Document) -> list[str]:
    """Critical friction with its band and the linear limit, and the ensemble they hold for."""
    limits = {row["restitution_factor"]: row["critical_friction"] for row in document["linear_limit"]}
    rows = [
        [
            number(row["restitution_factor"], 2),
            *(number(row[key]) for key in CURVE_KEYS),
            number(limits.get(row["restitution_factor"])),
        ]
        for row in document["curve"]
    ]
    reasons = dict.fromkeys(row["reason"] for row in document["curve"] if row["reason"])
    blocks = [
        section("Stability curve", table(CURVE_HEADERS, rows), CURVE_LEGEND),
        section("What it holds for", facts(_holds_for(document))),
    ]
    return blocks + [paragraph(reason, first="  - : ", indent="      ") for reason in reasons]


CURVE_KEYS = ("critical_friction", "critical_friction_low", "critical_friction_high")
CURVE_LEGEND = "\n" + paragraph(
    "critical friction: half the runs grow from the middle kick; stable below, unstable above. band: from "
    "one run in ten, at whatever kick, to nine in ten at every. linear limit: no clearance, balls at rest."
)
CURVE_HEADERS = ("restitution\nfactor", "critical\nfriction", "band\nlow", "band\nhigh", "linear\nlimit")


def _holds_for(document: Document) -> list[tuple[str, str]]:
    parts = (study_facts(document["study"]), chain_facts(document["chain"]), ensemble_facts(document))
    return [fact for part in parts for fact in part]


def study_facts(study: Document) -> list[tuple[str, str]]:
    """Return the bearing, its operating point and the film on a line each."""
    bearing, operation, film = study["bearing"], study["operation"], study["film"]
    balls = f"{bearing['ball_count']['value']} balls of {_value(bearing['ball_diameter'])}"
    speeds = f"inner ring {_value(operation['inner_speed'])}"
    loads = [
        f"{_value(operation[f'{name}_load'])} {name}"
        for name in ("axial", "radial")
        if operation[f"{name}_load"]["value"]
    ]
    return [
        ("Bearing", f"{balls}, pitch diameter {_value(bearing['pitch_diameter'])}"),
        ("Operation", ", ".join([speeds, *loads])),
        ("Film on the races", f"{_film(film)}; friction {_value(film['race_friction'])}"),
    ]


def _film(film: Document) -> str:
    if film["is_bare"]:
        return "none"
    material = film["material"]
    modulus = quantity(material["elastic_modulus"]["value"], "Pa")
    return f"{material['name']}, {_value(film['thickness'])}, modulus {modulus}"


def _value(entry: Document) -> str:
    return quantity(entry["value"], entry.get("unit", "-"))


def chain_facts(chain: Document) -> list[tuple[str, str]]:
    """Return the chain's numbers on a few lines: angles, loads, slopes, damping, both restitution factors."""
    inner, outer = chain["inner"], chain["outer"]

    def both(key: str, unit: str) -> str:
        return f"{quantity(inner[key], unit)} inner, {quantity(outer[key], unit)} outer"

    return [
        ("Contact angles", both("contact_angle", "rad")),
        ("Loads of the ball", both("load", "N")),
        ("Traction slopes", both("slope", "-")),
        ("Race damping C_mu", quantity(chain["race_damping"], "N s/m")),
        ("Restitution factor", restitution_text(chain)),
        (
            "Ball/cage stiffness",
            f"{quantity(chain['ball_cage_stiffness'], 'N/m')}, {chain['stiffness_source']}",
        ),
    ]


def restitution_text(chain: Document) -> str:
    """Return both restitution factors in a few words."""
    printed, free = chain["restitution_factor"], chain["restitution_factor_free_spin"]
    return f"{number(printed)} as printed (Eq. 18); {number(free)} with the ball free to spin"


def ensemble_facts(settings: Document) -> list[tuple[str, str]]:
    """Return the ensemble in a few words."""
    middle = settings.get("middle_kick")
    kicks = ", ".join(f"{kick:g}" for kick in settings["kicks"])
    return [
        ("Kicks", f"{kicks} m/s" + (f"; the curve is that of {middle:g} m/s" if middle else "")),
        ("Runs", f"{settings['runs']} at each point, of {quantity(settings['duration'], 's')}"),
    ]


FIRST = ", the first candidate's; [cage] ball_cage_friction sets it"


def simulate(document: Document) -> list[str]:
    """How one run ended, its largest offset and force, and the work that drove it."""
    origin = "" if document["study"]["cage"]["ball_cage_friction"]["value"] is not None else FIRST
    end = f"{document['outcome']} after {quantity(document['time'][-1], 's')}."
    ended = [
        ("Kick, run, seed", f"{document['kick']:g} m/s, {document['run']}, {document['seed']}"),
        ("Pocket friction", number(document["cage"]["ball_cage_friction"]) + origin),
        ("Ended", f"{end} {document['outcome_sentence']}"),
        (
            "Energy growth",
            f"{significant(document['energy_growth'])}, mean energy at its end over the kick's",
        ),
        ("Largest offset", quantity(document["largest_offset"], "m")),
        ("Largest pocket force", quantity(document["largest_contact_force"], "N")),
    ]
    work = [
        (name.replace("_", " "), f"{1e3 * values[-1]:.4g} mJ")
        for name, values in document["work"].items()
        if any(values)
    ]
    return [
        section("The run", facts(ended)),
        section("Work on the cage", facts(work or [("none", "0 mJ")])),
        section(
            "What it holds for", facts([*study_facts(document["study"]), *chain_facts(document["chain"])])
        ),
        paragraph(
            "One run proves nothing: two of them may differ in the class. See the verbs stability and rank.",
            indent="",
        ),
    ]
