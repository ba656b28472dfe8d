"""Text for the moving cage: stability curve and one run, and what they hold for."""

from __future__ import annotations

from collections.abc import Mapping
from math import hypot
from statistics import fmean, pstdev
from typing import Any

from separatrix.report.stability import curve
from separatrix.report.tables import facts, number, paragraph, quantity, section, significant

Document = Mapping[str, Any]


def stability(document: Document) -> list[str]:
    """Critical friction with its band and limits, and the ensemble they hold for."""
    reasons = dict.fromkeys(row["reason"] for row in document["curve"] if row["reason"])
    blocks = [*curve(document), section("What it holds for", facts(_holds_for(document)))]
    return blocks + [paragraph(reason, first="  - : ", indent="      ") for reason in reasons]


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
        *_lead_and_lag(chain),
    ]


def _lead_and_lag(chain: Document) -> list[tuple[str, str]]:
    """Return how far balls run ahead and behind in a bearing whose balls do not run alike."""
    if chain.get("orbital_share") is None:
        return []
    lead, play = (quantity(chain[name], "m") for name in ("lead_amplitude", "half_play"))
    share = f"{100 * chain['orbital_share']:.4g} %"
    words = f"up to {lead} (pockets {play} each way); the harmonics used hold {share} of the speed variance"
    return [("Free balls lead and lag", words)]


def restitution_text(chain: Document) -> str:
    """Return both restitution factors in a few words."""
    printed, free = chain["restitution_factor"], chain["restitution_factor_free_spin"]
    hertz = number(chain["restitution_factor_hertz"])
    spins = f"{number(free)}{' (overdamped)' if free == 0.0 else ''} if the ball may spin"
    return f"{number(printed)} with race dampings summed (Eq. 18); {spins}; {hertz} with a Hertzian pocket"


def ensemble_facts(settings: Document) -> list[tuple[str, str]]:
    """Return the ensemble in a few words."""
    middle = settings.get("middle_kick")
    kicks = ", ".join(f"{kick:g}" for kick in settings["kicks"])
    return [
        ("Kicks", f"{kicks} m/s" + (f"; the curve is that of {middle:g} m/s" if middle else "")),
        ("Runs", f"{settings['runs']} at each point, of {quantity(settings['duration'], 's')}"),
    ]


def simulate(document: Document) -> list[str]:
    """How one run ended, where its centre went, its largest forces, and the work that drove it."""
    return [
        section("The run", facts(_ended(document))),
        section("Centre of the cage", facts([*orbit_facts(document), room_fact(document)])),
        section("Largest forces", facts(_forces(document))),
        section("Work done on the cage; energy at the end", facts(_energies(document))),
        section(
            "What it holds for", facts([*study_facts(document["study"]), *chain_facts(document["chain"])])
        ),
        paragraph(
            "A single run is not evidence: another seed may end differently. See stability and rank.",
            indent="",
        ),
    ]


def _ended(document: Document) -> list[tuple[str, str]]:
    span = " to ".join(quantity(document[f"judged_{end}"], "s") for end in ("from", "until"))
    end = f"{document['outcome']}, judged from {span}."
    return [
        ("Kick, run, seed", f"{document['kick']:g} m/s, {document['run']}, {document['seed']}"),
        ("Pocket friction", friction_text(document)),
        ("Outcome", f"{end} {document['outcome_sentence']}"),
        ("Friction power", power_text(document)),
        *rubbing_facts(document),
    ]


def friction_text(document: Document) -> str:
    """Return the pocket friction, and where it comes from if not from the study's cage."""
    entry = document["study"]["cage"]["ball_cage_friction"]
    whose = f", {entry['candidate']} in {entry['environment']}" if entry["candidate"] else ""
    return number(document["cage"]["ball_cage_friction"]) + whose


def orbit_facts(document: Document) -> list[tuple[str, str]]:
    """Return how far the centre went, and how it moved in the part of the run by which it is judged."""
    start = min(document["judged_from"], document["time"][-1])
    at_end = [hypot(*g) for t, g in zip(document["time"], document["position"], strict=True) if t >= start]
    mean, spread = fmean(at_end), pstdev(at_end)
    evenness = f"{number(spread / mean, 2)} (0: a circle about the axis)" if mean > 0.0 else "none"
    return [
        ("Largest offset", quantity(document["largest_offset"], "m")),
        ("Mean offset at the end", f"{quantity(mean, 'm')}, since {quantity(start, 's')}"),
        ("Relative spread", evenness),
        ("Drift rate", drift_text(document)),
    ]


def room_fact(document: Document) -> tuple[str, str]:
    """Return the clearances that the offset compares with: of the pockets, and of the land."""
    cage = document["cage"]
    pockets = f"pockets {quantity(document['chain']['half_play'], 'm')} each way"
    if cage["guidance"] == "ball":
        return "Clearance", f"{pockets}; no land"
    land = quantity(cage["land_clearance"] / 2.0, "m")
    return "Clearance", f"{cage['guidance']} land {land} radial, {pockets}"


def _forces(document: Document) -> list[tuple[str, str]]:
    """Return the largest force of a pocket, which one, and of the land."""
    peaks = [max(map(abs, column)) for column in zip(*document["contact_force"], strict=True)]
    ball = max(range(len(peaks)), key=peaks.__getitem__)
    return [
        ("Pocket", f"{quantity(document['largest_contact_force'], 'N')}, pocket {ball + 1}"),
        ("Land", quantity(max(document["land_force"]), "N")),
    ]


def _energies(document: Document) -> list[tuple[str, str]]:
    """Return the work of every source that did any, and the energies at the end."""
    work = {name: values[-1] for name, values in document["work"].items() if any(values)}
    held = {key: document[key][-1] for key in document if key in ENERGIES and any(document[key])}
    return [(name.replace("_", " "), f"{1e3 * value:.4g} mJ") for name, value in (work | held).items()]


ENERGIES = ("kinetic_energy", "spring_energy", "land_energy")
DIRECTIONS = {1: "forward", -1: "backward", 0: "none"}


def judgement_facts(found: Document) -> list[tuple[str, str]]:
    """Return a verdict with its evidence on a few lines: nobody should have to take the word alone.

    Parameters
    ----------
    found : mapping
        The fields of a `Judgement`, as plain data.
    """
    return [
        ("Verdict", f"{found['verdict']}. {found['reason']}"),
        ("Motion", motion_text(found["cage_motion"])),
        ("P(stable)", _between(found, "probability_stable", "probability", 2)),
        ("Growth rate", f"{growth_text(found)}, from {found['worst_kick']:g} m/s, the worst kick"),
        ("Offset", offset_text(found)),
        ("Drift rate", drift_text(found)),
        ("Largest forces", forces_text(found)),
        ("Impacts", impacts_text(found)),
        ("Whirl", whirl_text(found)),
        (
            "Energy at the end",
            f"{1e3 * found['end_energy']:.3g} mJ; frame and loads alone can give "
            f"{1e3 * found['drive_energy']:.3g} mJ",
        ),
        ("Friction power", power_text(found)),
        *rubbing_facts(found),
        ("Runs", f"{found['runs']} from each kick, of up to {quantity(found['longest_run'], 's')}"),
    ]


MOTIONS = {
    "CENTRED": "the cage rests among its balls, clear of its land",
    "ON THE LAND": "the cage rests on its land, or moves on it as loads and the land's friction make it",
    "WHIRLING": "friction in the pockets sustains the motion, or makes it grow",
    "DRIFTING": "the cage has no land, and nothing holds its centre",
}


def motion_text(motion: str | None) -> str:
    """Return the class of a motion and what it means."""
    return f"{motion}: {MOTIONS[motion]}" if motion else "unresolved in most runs"


def power_text(found: Document) -> str:
    """Return the power that friction feeds into the cage at the end, or takes from it."""
    powers = {name: found[f"{name}_power"] for name in ("pocket", "land")}
    verbs = {name: "feeds" if watt > 0.0 else "takes" for name, watt in powers.items()}
    return ", ".join(f"{name} {verbs[name]} {quantity(abs(watt), 'W')}" for name, watt in powers.items())


def rubbing_facts(found: Document) -> list[tuple[str, str]]:
    """Return force, speed and power of the rubbing on the land, if the cage rubs there at the end."""
    force, speed = found["rubbing_force"], found["rubbing_speed"]
    if force <= 0.0:
        return []
    power = found.get("rubbing_power")
    heat = "" if power is None else f", {quantity(power, 'W')} of heat"
    return [("Rubbing on the land", f"{quantity(force, 'N')} at {quantity(speed, 'm/s')}{heat}")]


def motion_words(motion: str | None) -> str:
    """Return a class of motion as it is printed."""
    return motion or "unresolved"


def growth_text(found: Document) -> str:
    """Return the growth rate with its interval."""
    rate = f"{significant(found['growth_rate'], 3)} 1/s"
    if found["growth_rate_low"] is None:
        return f"{rate} (one run: no interval)"
    low, high = (significant(found[f"growth_rate_{end}"], 3) for end in ("low", "high"))
    return f"{rate} (95 %: {low} to {high})"


def offset_text(found: Document) -> str:
    """Return how far the centre went at most, where it was at the end, and how evenly."""
    largest, mean = (quantity(found[key], "m") for key in ("largest_offset", "mean_offset"))
    return f"{largest} at most; {mean} at the end, relative spread {number(found['orbit_evenness'], 2)}"


def drift_text(found: Document) -> str:
    """Return the drift rate as measured, and by the linear law for a cage without a land."""
    measured = f"{significant(found['drift_rate'], 3)} 1/s"
    law = found["drift_rate_law"]
    return f"{measured}; by the linear law {significant(law, 3)} 1/s" if law else measured


def forces_text(found: Document) -> str:
    """Return the largest forces."""
    pocket, land = (quantity(found[f"largest_{key}_force"], "N") for key in ("contact", "land"))
    return f"{pocket} at a pocket, {land} at the land"


def impacts_text(found: Document) -> str:
    """Return which pocket is met most, against an even share, and what the land takes."""
    shares = found["pocket_impact_shares"]
    if not any(shares):
        return "none at a pocket" + (
            ", all at the land" if found["land_impact_share"] else ", none at the land"
        )
    most = max(range(len(shares)), key=shares.__getitem__)
    land = f"{_percent(found['land_impact_share'])} of all impacts are at the land"
    even = f"even share {_percent(1.0 / len(shares))}"
    return f"pocket {most + 1} takes {_percent(shares[most])} of the impacts at pockets ({even}); {land}"


def whirl_text(found: Document) -> str:
    """Return frequency and direction in the turning frame, and the whirl ratio in the fixed one."""
    seen = f"{quantity(found['whirl_frequency'], 'Hz')} {DIRECTIONS[found['whirl_direction']]}"
    ratio = found["whirl_ratio"]
    if ratio is None:
        return f"{seen}; the ball set is at rest"
    return f"{seen}, seen from the balls; the centre orbits at {number(ratio, 2)} of the ball set's speed"


def _percent(share: float) -> str:
    return f"{100.0 * share:.0f} %"


def _between(found: Document, key: str, ends: str, digits: int) -> str:
    low, high = (number(found[f"{ends}_{end}"], digits) for end in ("low", "high"))
    return f"{number(found[key], digits)} (95 %: {low} to {high})"
