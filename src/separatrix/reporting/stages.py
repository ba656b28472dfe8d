"""Bearing and operating point, and the chain stage by stage, each with its equation, numbers and figure."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import degrees

from separatrix.reporting.pictures import drawing, equation, picture
from separatrix.reporting.record import Block, Kept, Paragraph, Row, Section, Table, entry, facts, quantity
from separatrix.told.sentences import strain_facts
from separatrix.told.tables import ABSENT, interval, kick_list, number

CONTACT = {
    "load": ("Load Q", "N"),
    "semi_major": ("Semi-major axis a, across the groove", "m"),
    "semi_minor": ("Semi-minor axis b, along rolling", "m"),
    "max_pressure": ("Maximum pressure p\u2080", "Pa"),
    "approach": ("Mutual approach", "m"),
}
CREEP = {
    "rolling_speed": ("Rolling speed V", "m/s"),
    "spin_roll_ratio": ("Pivoting to rolling ratio", "-"),
    "creep_spin": ("Creep by spin s", "1/m"),
    "creep_curvature": ("Creep by curvature q", "1/m2"),
}
SLOPES = {"slope": ("Slope \u03b1", "-"), "slope_error": ("Error of the slope", "-")}
MISSING = "Not in this folder: run `separatrix {verb} {name}` into it, then the report again."


def bearing_and_cage(kept: Mapping[str, Kept]) -> Section:
    """Return bearing, cage and operating point, with the drawing to scale."""
    document = next(iter(kept.values())).document
    study = document["study"]
    at, on, film, cage = (study.get(name) or {} for name in ("bearing", "operation", "film", "cage"))
    balls = f"{entry(at['ball_count'])} of {entry(at['ball_diameter'])}, {_name(at['ball_material'])}"
    conformity = f"{entry(at['inner_conformity'])} inner, {entry(at['outer_conformity'])} outer"
    loads = ", ".join(
        f"{entry(on[f'{way}_load'])} {way}" for way in ("axial", "radial") if on[f"{way}_load"]["value"]
    )
    coat = (
        "none: bare races"
        if film.get("is_bare")
        else f"{_name(film['material'])}, {entry(film['thickness'])}"
    )
    pairs = [
        ("Balls", balls),
        ("Pitch diameter", entry(at["pitch_diameter"])),
        ("Bore", entry(at["bore"])),
        ("Rings", _name(at["ring_material"])),
        ("Contact angle without load", entry(at["contact_angle"])),
        ("Groove radius over ball diameter", conformity),
        ("Speed", f"{entry(on['inner_speed'])} inner ring, {entry(on['outer_speed'])} outer ring"),
        ("Load", loads or "none"),
        ("Medium", ", ".join(entry(on[key]) for key in ("fluid", "temperature") if on[key]["value"])),
        ("Film on the races", f"{coat}; friction on the races {entry(film['race_friction'])}"),
    ]
    if cage:
        material = (cage.get("material") or {}).get("name")
        pairs += [
            ("Cage", ", ".join(filter(None, [material, entry(cage["mass"])])).strip(f", {ABSENT}")),
            ("Pockets", f"{entry(cage['pocket_shape'])}, clearance {entry(cage['pocket_clearance'])}"),
            ("Guidance", _guidance(cage)),
        ]
    contacts = _with_contacts(kept)
    shown = drawing(study, None if contacts is None else contacts.document)
    return Section("Bearing, cage and operating point", (facts(*pairs), *_clearances(kept), shown))


def _clearances(kept: Mapping[str, Kept]) -> Iterator[Block]:
    """Yield the clearances at rest and as the cage runs, and what changes them; nothing if not computed."""
    parts = (part for one in kept.values() for part in (one.document, one.document.get("chain") or {}))
    found = next((part["clearances"] for part in parts if part.get("clearances")), None)
    if found is None:
        return
    names = (("pocket", "pocket"), ("pocket_axial", "pocket, along the axis"), ("land", "land"))
    rows = tuple(
        (words, quantity(found[f"{name}_at_rest"], "m"), quantity(found[name], "m"))
        for name, words in names
        if found[name] is not None
    )
    at = f"{quantity(found['temperature'], 'K')} and a cage speed of {quantity(found['cage_speed'], 'rad/s')}"
    yield Table(
        ("clearance", "at 293 K at rest", "as it runs"),
        rows,
        f"Clearances of the cage, which runs at {at}. In a ranking: of the reference cage.",
    )
    yield facts(*strain_facts(found, quantity))


def _guidance(cage: Row) -> str:
    kind = cage["guidance"]["value"]
    if kind == "ball" or cage["land_clearance"]["value"] is None:
        return "by the balls: no land"
    return f"{kind} land, clearance {entry(cage['land_clearance'])}, friction {entry(cage['land_friction'])}"


def _name(material: Row | None) -> str:
    return str((material or {}).get("name") or ABSENT)


def stages(kept: Mapping[str, Kept]) -> Iterator[Section]:
    """Yield the chain: a title, then a section for each stage, from any answer that has its numbers."""
    words = "Each stage takes what the one before it gives. Equation numbers in brackets are the paper's."
    yield Section("The chain, stage by stage", (Paragraph(words),))
    first = next(iter(kept.values())).document
    parts = (
        ("bearing", "Ball equilibrium", _equilibrium, kept.get("bearing")),
        ("bearing", "Contacts", _contacts, _with_contacts(kept)),
        ("bearing", "Creep", _creep, _with_contacts(kept)),
        ("traction", "Traction", _traction, kept.get("traction")),
        ("restitution", "Restitution", _restitution, kept.get("restitution") or _chain(kept)),
        ("rank", "Ball on pocket", _pocket, kept.get("rank")),
    )
    needs = {"restitution": "cage", "rank": "ranking"}
    for verb, title, part, found in parts:
        if verb in needs and not first["study"].get(needs[verb]):
            continue
        missing = Paragraph(MISSING.format(verb=verb, name=first["name"]))
        yield Section(title, (missing,) if found is None else tuple(part(found)), 3)
    curve = next((kept[verb] for verb in ("rank", "stability") if verb in kept), None)
    if curve is not None:
        yield Section("Stability", tuple(_stability(curve)), 3)


def _chain(kept: Mapping[str, Kept]) -> Kept | None:
    """Return the numbers of the chain that the answer on a cage has; None without one."""
    verb = next((verb for verb in ("rank", "stability", "sensitivity") if verb in kept), None)
    return None if verb is None else Kept(kept[verb].document["chain"])


def _with_contacts(kept: Mapping[str, Kept]) -> Kept | None:
    """Return an answer that has the contacts of the most loaded ball; None if there is none."""
    chain = _chain(kept)
    return kept.get("bearing") or (None if chain is None else Kept({"contacts": chain.document}))


def _equilibrium(kept: Kept) -> Iterator[Block]:
    found = kept.document
    yield equation(
        r"F_a = \sum_j \left(Q_{i,j}\,\sin\,\alpha_{i,j} + T_{i,j}\,\cos\,\alpha_{i,j}\right)",
        "Balance of the inner ring along the axis: ball loads Q at the contact angles, tractions T.",
    )
    yield equation(
        r"Q_o\,\cos\,\alpha_o - T_o\,\sin\,\alpha_o = Q_i\,\cos\,\alpha_i - T_i\,\sin\,\alpha_i + F_c, "
        r"\qquad T_i + T_o = \dfrac{2 M_g}{D}",
        "Balance of a ball: centrifugal force F_c and gyroscopic moment M_g.",
    )
    yield facts(
        ("Axial displacement of the inner ring", quantity(found["axial_displacement"], "m", 4)),
        ("Radial displacement", quantity(found["radial_displacement"], "m", 4)),
        ("Kinematics", str(found["model"])),
    )
    head = ("ball", "angle inner", "angle outer", "load inner", "load outer", "orbit", "centrifugal force")
    rows = [
        (
            str(one["ball"] + 1),
            *(
                f"{degrees(one[f'contact_angle_{race}']):.2f} deg" if one[f"{race}_contact"] else ABSENT
                for race in ("inner", "outer")
            ),
            *(quantity(one[f"load_{race}"], "N", 4) for race in ("inner", "outer")),
            quantity(one["orbital_speed"], "rad/s", 4),
            quantity(one["centrifugal_force"], "N", 4),
        )
        for one in found["balls"]
    ]
    alike = all(row[1:] == rows[0][1:] for row in rows)
    if alike:
        rows = [(f"all {len(rows)}", *rows[0][1:])]
    yield Table(head, tuple(rows), "Ball loads and contact angles under load and speed.")
    if not alike:
        yield from picture(
            kept,
            "bearing-balls",
            "Ball loads and contact angles around the bearing.",
            "Two panels against the azimuth of the ball: load and contact angle; the table has the numbers.",
        )


def _contacts(kept: Kept) -> Iterator[Block]:
    at = kept.document["contacts"]
    yield equation(
        r"p_0 = \dfrac{3\,Q}{2\,\pi\,a\,b}",
        "Hertz: maximum pressure p\u2080 of the ellipse with semi-axes a and b.",
    )
    yield _both_races(at, CONTACT, "Contacts of the most loaded ball.")
    yield from picture(
        kept,
        "bearing-contacts",
        "The contacts of the most loaded ball.",
        "Three panels: both contact ellipses to scale, pressure across the groove, creep across the groove.",
    )


def _creep(kept: Kept) -> Iterator[Block]:
    at = kept.document["contacts"]
    yield equation(
        r"\xi(y) = \delta + s\,y + q\,y^2 + \delta\xi",
        "Creep across the groove [14, 16]: free-rolling offset, spin, curvature (Heathcote), and the "
        "increment that an impact of the cage adds.",
    )
    yield _both_races(at, CREEP, "Creep in the contacts of the most loaded ball.")


def _both_races(contacts: Row, names: Mapping[str, tuple[str, str]], caption: str) -> Table:
    """Return a table of both races; `names` has words and unit of each key."""
    rows = tuple(
        (words, *(quantity(contacts[race].get(key), unit, 4) for race in ("inner", "outer")))
        for key, (words, unit) in names.items()
    )
    return Table(("quantity", "inner race", "outer race"), rows, caption)


def _traction(kept: Kept) -> Iterator[Block]:
    found = kept.document
    yield equation(
        r"\alpha = \left.\dfrac{\partial C_T}{\partial\,\delta\xi}\right|_{\delta\xi = 0}",
        "Slope of the traction coefficient against the creep increment.",
    )
    yield _both_races(found, SLOPES, "Slopes of the traction curves in free rolling.")
    yield from picture(
        kept,
        "traction-curves",
        "Traction curves of the most loaded ball (the paper's Fig. 7), and at other pivoting to rolling "
        "ratios.",
        "Traction coefficient against creep increment for both races; the table has their slopes.",
    )


def _restitution(kept: Kept) -> Iterator[Block]:
    found = kept.document
    yield equation(
        r"C_\mu = \dfrac{\alpha_i\,Q_i}{V_i} + \dfrac{\alpha_o\,Q_o}{V_o}",
        "Race damping [18]: slopes, loads and rolling speeds of both contacts.",
    )
    yield equation(
        r"\zeta = \dfrac{\sqrt{k_{BC}\,M_C}}{2\,C_\mu}, \qquad "
        r"\eta = \exp\left(-\dfrac{\pi\,\zeta}{\sqrt{1-\zeta^2}}\right)",
        "Restitution factor of an impact [17, derived anew]: pocket stiffness k_BC, cage mass M_C.",
    )
    rows = tuple(
        (words, *(form(found[key + end]) for end in ("", "_free_spin")))
        for key, words, form in (
            ("race_damping", "Race damping C_\u03bc", lambda x: quantity(x, "N s/m", 4)),
            ("damping_ratio", "Damping ratio \u03b6", number),
            ("restitution_factor", "Restitution factor \u03b7", number),
        )
    )
    yield Table(
        ("quantity", "dampings summed [18]", "ball free to spin"), rows, "Restitution factor of this film."
    )
    yield facts(
        ("Cage mass", quantity(found["cage_mass"], "kg", 4)),
        (
            "Stiffness of ball and pocket",
            f"{quantity(found['ball_cage_stiffness'], 'N/m', 4)}, {found['stiffness_source']}",
        ),
        ("Restitution factor of a Hertzian pocket", number(found["restitution_factor_hertz"])),
    )
    what = "film thickness and race friction"
    yield from picture(
        kept,
        "restitution-film",
        f"Restitution factor against {what} (the paper's Fig. 8); the star is this bearing.",
        f"Two panels: restitution factor against {what}, dampings summed and with the ball free to spin.",
    )


def _pocket(kept: Kept) -> Iterator[Block]:
    at = kept.document["pocket"]
    yield equation(
        r"\bar p = \dfrac{F}{\pi\,r^2}",
        "Mean pressure of ball on pocket in an impact of force F, contact radius r.",
    )
    slip = quantity(at["slip_speed"], "m/s", 4)
    if at["slip_speed_high"] > 1.001 * at["slip_speed_low"]:
        ends = (quantity(at[f"slip_speed_{end}"], "m/s", 4) for end in ("low", "high"))
        slip += f" ({' to '.join(ends)} around the bearing)"
    yield facts(
        ("Sliding speed", slip),
        ("Force of an impact at the impact speed", quantity(at["impact_force"], "N", 3)),
        ("Mean pressure", quantity(at["pressure"], "Pa", 3)),
        ("Maximum pressure", quantity(at["max_pressure"], "Pa", 3)),
    )


def _stability(kept: Kept) -> Iterator[Block]:
    found = kept.document
    curve = found["stability"] if found["verb"] == "rank" else found
    yield equation(
        r"f_{lin} = 2\,\zeta\,\sqrt{2/Z}, \qquad m = \eta_{max}(f_{BC}) - \eta",
        "Linear limit of the friction (Z balls, no clearance), and the margin m of a candidate: its "
        "threshold, read from the curve at its friction, less the bearing's factor.",
    )
    rows = tuple(
        (
            number(one["restitution_factor"], 3),
            number(one["critical_friction"]),
            f"{number(one['scatter_low'])} to {number(one['scatter_high'])}",
        )
        for one in [*curve["curve"]]
    )
    count, length = curve["runs"], quantity(curve["duration"], "s", 3)
    caption = (
        f"Critical friction, at which half of {count} runs of {length} whirl from a disturbance of "
        f"{curve['middle_kick']:g} m/s, with its 95 % interval. Disturbances: {kick_list(curve['kicks'])}."
    )
    yield Table(("restitution factor", "critical friction", "95 % interval"), rows, caption, left=0)
    here = curve["here"] or {}
    if here.get("critical_friction") is not None:
        yield facts(
            (
                "Critical friction of this bearing",
                interval(here["critical_friction"], here["scatter_low"], here["scatter_high"], 3)
                + f" at a restitution factor of {number(here['restitution_factor'])}",
            ),
        )
        if here["restitution_factor"] == 0.0:
            yield Paragraph(
                "Impacts of this bearing are overdamped: its critical friction is found with its own race "
                "damping, the table's row at 0 with the largest damping that leaves no rebound."
            )
    if found["verb"] == "rank":
        yield from picture(
            kept,
            "rank-overview",
            "Restitution threshold of every candidate in every environment, and overall.",
            "One row for each candidate, the best at the top: thresholds of the restitution factor.",
        )
