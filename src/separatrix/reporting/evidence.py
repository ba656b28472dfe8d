"""Evidence and uncertainty of the verdicts, where models leave their range, inputs and their sources."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping

from separatrix.reporting.pictures import picture
from separatrix.reporting.record import (
    Block,
    Kept,
    Paragraph,
    Row,
    Section,
    Table,
    entry,
    facts,
    own_rows,
    quantity,
)
from separatrix.study.sources import inputs_of
from separatrix.told.sentences import (
    margin,
    next_test,
    probability,
    rank_texts,
    threshold,
    verdict,
    with_interval,
)
from separatrix.told.tables import ABSENT, grouped, number, rate

MOST_DRIVERS, MOST_TESTS = 5, 6
PROPERTIES = {
    "elastic_modulus": "elastic modulus",
    "poisson_ratio": "Poisson's ratio",
    "density": "density",
    "compressive_strength": "compressive strength",
}


def evidence(rank: Kept) -> Section:
    """Return what the verdicts of a ranking rest on."""
    return Section("Evidence of the verdicts", tuple(_evidence(rank.document)))


def _evidence(rank: Row) -> Iterator[Block]:
    rows = own_rows(rank)
    words = (
        "A verdict counts the runs in which the cage settles, or rolls in its pockets with less energy than "
        "its loads can give it, from each disturbance; the worst one decides."
    )
    yield Paragraph(words)
    yield Table(
        (
            "candidate",
            "friction",
            "threshold (95 %)",
            "runs that settle or roll, from each disturbance",
            "verdict",
        ),
        tuple(
            (
                str(row["name"]),
                _friction(row),
                threshold(row),
                ", ".join(map(_calm, row.get("by_kick") or ())) or ABSENT,
                verdict(row),
            )
            for row in rows
        ),
        f"Counts in {rank['environment']}. Friction: mean and standard error.",
    )
    yield Table(
        ("candidate", "motion", "growth rate [1/s] (95 %)", "whirl", "whirl ratio", "end energy", "rubbing"),
        tuple((str(row["name"]), *_motion(row)) for row in rows),
        "Motion from the worst disturbance. Growth rate: of the amplitude, from the middle of the runs to "
        "their last fifth; about 0 once the cage has settled. Whirl: frequency seen from the balls; ratio: "
        "speed of the cage centre about the axis over that of the ball set; rubbing: friction power on the "
        "land.",
        left=2,
    )
    if any(row.get("largest_tilt") is not None for row in rows):
        yield _in_space(rows)
    yield facts(
        *((", ".join(who), reason) for reason, who in grouped((r["reason"], r["name"]) for r in rows).items())
    )
    balls = grouped((_ball(row), row["name"]) for row in rows if row.get("ball"))
    yield facts(*((", ".join(who), words) for words, who in balls.items()))
    beyond = grouped((one, row["name"]) for row in rows for one in row.get("extrapolation") or ())
    for sentence, who in beyond.items():
        whose = "every candidate" if len(who) == len(rows) else ", ".join(who)
        yield Paragraph(f"Extrapolated: {sentence} ({whose}).")
    others = [one for one in rank["environments"] if one["name"] != rank["environment"]]
    for name, each in [*((one["name"], one["materials"]) for one in others), ("overall", rank["overall"])]:
        if others:
            yield _short(name, each)


def _ball(row: Row) -> str:
    """Return the model of the ball that decided, and why."""
    return f"Ball: {row['ball']}. {row['ball_reason'] or 'The study asks for it.'}"


def _calm(count: Row) -> str:
    """Return how many runs from a disturbance settle or roll, and how many of them roll."""
    rolls = f" ({count['rolls']} roll)" if count["rolls"] else ""
    return f"{count['settles'] + count['rolls']} at {count['kick']:g} m/s{rolls}"


def _in_space(rows: list[Row]) -> Table:
    return Table(
        ("candidate", "largest tilt", "axial travel", "cone ratio", "impacts at pockets [1/s]"),
        tuple(
            (
                str(row["name"]),
                quantity(row["largest_tilt"], "rad", 3),
                quantity(row["axial_travel"], "m", 3),
                number(row["cone_ratio"], 2),
                number(row["impact_rate"], 0),
            )
            for row in rows
        ),
        "Motion out of the plane. Travel: along the axis from end to end; cone ratio: speed at which the "
        "lean of the cage's axis goes round over the speed of the ball set.",
    )


def _short(name: str, rows: list[Row]) -> Table:
    caption = f"Candidates in {name}."
    if name == "overall":
        caption = "Candidates overall: mean friction over the environments in which each was measured."
    cells = (
        (place, str(row["name"]), verdict(row), _friction(row), threshold(row), margin(row), probability(row))
        for place, row in zip(rank_texts(row["rank"] for row in rows), rows, strict=True)
    )
    head = ("rank", "candidate", "verdict", "friction", "threshold (95 %)", "margin", "P(stable) (95 %)")
    return Table(head, tuple(cells), caption, left=3)


def _friction(row: Row) -> str:
    if row.get("friction") is None:
        return ABSENT
    error = row.get("friction_error")
    return number(row["friction"]) + (f" \u00b1 {error:.2g}" if error else "")


def _motion(row: Row) -> tuple[str, ...]:
    if row.get("growth_rate") is None:
        return (ABSENT,) * 6
    return (
        str(row["cage_motion"] or "unresolved").lower().replace("_", " "),
        rate(row["growth_rate"], row["growth_rate_low"], row["growth_rate_high"]),
        quantity(row["whirl_frequency"], "Hz", 3),
        number(row["whirl_ratio"], 2),
        quantity(row["end_energy"], "J", 3),
        quantity(row["rubbing_power"], "W", 2),
    )


def uncertainty(kept: Mapping[str, Kept]) -> Section:
    """Return the verdicts over the uncertain inputs, and the next test; or how to get them."""
    found = kept.get("sensitivity")
    blocks = _without_sensitivity(kept) if found is None else _sensitivity(found)
    return Section("Uncertainty and the next test", tuple(blocks))


def _without_sensitivity(kept: Mapping[str, Kept]) -> Iterator[Block]:
    document = next(iter(kept.values())).document
    uncertain = document["study"]["uncertain_inputs"]
    if uncertain:
        yield facts(*((one["name"], str(one["words"])) for one in uncertain))
        yield Paragraph("These inputs are at their means in this report.")
    else:
        yield Paragraph("The study states no input with a distribution.")
    if "rank" in kept:
        rows = [row for row in own_rows(kept["rank"].document) if row.get("uncertain_verdict")]
        for row in rows:
            found = f"{row['uncertain_verdict']}, {probability(row, 'uncertain_')}"
            yield Paragraph(f"{row['name']} with the uncertain inputs drawn: P(stable) {found}.")
    if document["study"].get("ranking"):
        yield Paragraph(
            "To see which input decides and what to measure next, run "
            f"`separatrix sensitivity {document['name']}` into this folder, then the report again."
        )


def _sensitivity(kept: Kept) -> Iterator[Block]:
    found = kept.document
    rows = own_rows(found)
    yield Table(
        ("candidate", "verdict", "P(stable) (95 %)", "restitution factor, median (nine in ten)", "runs"),
        tuple(
            (
                str(row["name"]),
                verdict(row),
                probability(row),
                with_interval(row, "restitution_factor"),
                ABSENT if row.get("runs") is None else str(row["runs"]),
            )
            for row in rows
        ),
        f"{found['bearings']} bearings drawn from the uncertain inputs, in {found['environment']}.",
        left=2,
    )
    yield from picture(
        kept,
        "sensitivity-probabilities",
        "P(stable) of every candidate with the uncertain inputs drawn.",
        "Probability of a stable cage for each candidate and environment; the table has the numbers.",
    )
    for one in found["drivers"]:
        if not one["shares"] or one["environment"] != found["environment"]:
            continue
        largest = sorted(one["shares"], key=lambda share: -share["share"])[:MOST_DRIVERS]
        words = ", ".join(f"{share['name']} {100.0 * share['share']:.0f} %" for share in largest)
        yield Paragraph(f"{one['name']}: the variance of its verdict comes from {words}.")
    yield from map(Paragraph, next_test(found, MOST_TESTS))


def outside(kept: Mapping[str, Kept]) -> Section:
    """Return every warning of every answer, each once with the verbs that gave it."""
    pairs = [(one, verb) for verb, kept_one in kept.items() for one in kept_one.document["warnings"]]
    if "traction" in kept:
        pairs += [(one, "traction") for one in kept["traction"].document["outside"]]
    each = grouped(pairs)
    blocks: list[Block] = [
        Paragraph(f"{text} ({', '.join(dict.fromkeys(verbs))})", "caveat") for text, verbs in each.items()
    ]
    return Section("Outside its range", tuple(blocks or [Paragraph("No model left its range.")]))


def inputs(kept: Mapping[str, Kept]) -> Section:
    """Return every input of the study with where it was given, and materials and frictions with sources."""
    study = next(iter(kept.values())).document["study"]
    rows = [
        (
            f"{section}: {key.replace('_', ' ')}",
            (str(item["name"]) if "name" in item else entry(item))
            + (f" ({item['distribution']['words']})" if "distribution" in item else ""),
            str(item["origin"]),
        )
        for section, key, item in inputs_of(study)
    ]
    blocks: list[Block] = [Table(("input", "value", "given in"), tuple(rows), "Inputs of the study.", left=3)]
    materials = tuple(dict.fromkeys(_materials(study)))
    if materials:
        head = ("material", "property", "value", "confidence", "source")
        blocks.append(Table(head, materials, "Materials, at the temperature of the study.", left=5))
    if study.get("ranking"):
        blocks += _frictions(study["ranking"])
    return Section("Inputs and their sources", tuple(blocks))


def _materials(study: Row) -> Iterator[tuple[str, ...]]:
    sections = [study.get(name) or {} for name in ("bearing", "film", "cage")]
    found = [one.get(key) for one in sections for key in ("ball_material", "ring_material", "material")]
    found += [one.get("material") for one in (study.get("ranking") or {}).get("candidates", [])]
    for one in found:
        if not isinstance(one, dict) or not one.get("name"):
            continue
        record = one.get("record") or {}
        for key, words in PROPERTIES.items():
            value = one.get(key) or {}
            if value.get("value") is None:
                continue
            place = (record.get("taken") or {}).get(key)
            taken = record["data"][key][place] if place is not None else {}
            source, confidence = taken.get("source"), taken.get("confidence")
            known = (confidence or one.get("confidence"), source or one.get("source"))
            yield str(one["name"]), words, entry(value), *(str(text or ABSENT) for text in known)


def _frictions(ranking: Row) -> Iterator[Block]:
    names = ranking["environments"]
    rows = []
    for one in ranking["candidates"]:
        cells = []
        for name in names:
            friction = one["friction"].get(name)
            spread = (friction or {}).get("standard_deviation")
            known = "not measured" if friction is None else number(friction["mean"])
            cells.append(known + (f" \u00b1 {spread:.2g}" if spread else ""))
        rows.append((str(one["name"]), *cells))
    caption = (
        f"Friction of the candidates as measured: mean, and standard deviation. From {ranking['origin']}."
    )
    yield Table(("candidate", *map(str, names)), tuple(rows), caption)
    sources = dict.fromkeys(
        f"{one['source']} ({one['confidence']})"
        for candidate in ranking["candidates"]
        for one in candidate["friction"].values()
        if one is not None
    )
    for source in sources:
        yield Paragraph(f"Source of the frictions: {source}.")


def provenance(kept: Mapping[str, Kept]) -> Section:
    """Return version, seed, command and checksums: what one needs to compute the answers again."""
    first = next(iter(kept.values())).document
    blocks: list[Block] = [
        facts(
            ("Study", f"{first['name']}: {first['title']}"),
            ("Version of separatrix", _each(kept, "separatrix_version")),
            ("Seed", _each(kept, "seed")),
        )
    ]
    commands = [(verb, _command(verb, one.document)) for verb, one in kept.items()]
    blocks.append(Table(("answer", "command"), tuple(commands), "Answers in this report.", left=2))
    known = first.get("provenance") or {}
    if known.get("versions"):
        blocks.append(facts(*((str(key), str(value)) for key, value in known["versions"].items())))
    files = {str(name): str(one.get("sha256") or "") for name, one in (known.get("files") or {}).items()}
    files = files or dict(_libraries(first["study"]))
    if files:
        head = ("file", "SHA-256")
        blocks.append(Table(head, tuple(files.items()), "Files that the study was read from.", left=2))
    return Section("Provenance", tuple(blocks))


def _each(kept: Mapping[str, Kept], key: str) -> str:
    return ", ".join(sorted({str(one.document[key]) for one in kept.values()}))


def _command(verb: str, document: Row) -> str:
    kept = document.get("provenance") or {}
    asked, entry = kept.get("command") or {}, str(kept.get("entry") or "")
    study = document["name"] if entry.startswith("shipped:") or not entry else entry
    given = {**(asked.get("question") or {}), **(asked.get("models") or {})}
    options: list[str] = []
    for key, value in given.items():
        flag = f"--{key.replace('_', '-')}"
        for one in value if isinstance(value, list) else [value]:
            if one not in (None, False):
                options += [flag] if one is True else [flag, shlex.quote(str(one))]
    return " ".join(["separatrix", verb, shlex.quote(str(study)), *options])


def _libraries(entry_of: object) -> Iterator[tuple[str, str]]:
    """Yield name and checksum of each library file behind a study."""
    if isinstance(entry_of, list):
        for one in entry_of:
            yield from _libraries(one)
    if isinstance(entry_of, dict):
        library = entry_of.get("library")
        if isinstance(library, dict) and library.get("sha256"):
            shipped = " (shipped with this version)" if library.get("shipped") else ""
            yield f"{library['file']}{shipped}", str(library["sha256"])
        for one in entry_of.values():
            yield from _libraries(one)
