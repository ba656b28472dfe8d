"""What an answer on a cage is based on: the chain before it, and the friction in its pockets."""

from __future__ import annotations

from separatrix.ground.document import Part
from separatrix.present.blocks import Block, Heading, Level, facts
from separatrix.verbs.parts.answer_page import figure_heading
from separatrix.verbs.parts.chain_blocks import clearance_facts
from separatrix.verbs.parts.telling import by_race, fact, said, told

LINKS = ("contact_angle", "load", "slope")


def basis(answer: Part, *more: tuple[str, str]) -> list[Block]:
    """Return the numbers of the chain that an answer on a cage starts from, and `more` facts of its runs."""
    chain, level = answer.chain, Level.LONG
    eta = (
        "{restitution_factor} with race dampings summed (Eq. 18); {restitution_factor_free_spin} if the ball "
        "may spin; {restitution_factor_hertz} with a Hertzian pocket"
    )
    return [
        Heading("Basis of this answer", level),
        by_race("chain", chain.inner, chain.outer, *LINKS, level=level),
        facts(
            *((("Operation", figure_heading(answer)[1]),) if figure_heading(answer)[1:] else ()),
            fact(chain, "race_damping"),
            ("Restitution factor", said(chain, eta)),
            ("Ball/cage stiffness", f"{told(chain, 'ball_cage_stiffness')}, {chain.stiffness_source}"),
            *([] if "clearances" not in chain else clearance_facts(chain.clearances)),
            *_leads(chain),
            *more,
            level=level,
        ),
    ]


def _leads(chain: Part) -> list[tuple[str, str]]:
    """Return by how much free balls lead and lag; empty of a bearing whose balls run alike."""
    if "orbital_share" not in chain:
        return []
    words = (
        "up to {lead_amplitude} (pockets {half_play} each way); the harmonics used contain {orbital_share} "
        "of the speed variance"
    )
    return [("Free balls lead and lag", said(chain, words))]


def pocket_friction(answer: Part) -> str:
    """Return the pocket friction of a cage, and whose it is if not its own; empty if none is known."""
    stated = (answer.values["study"]["cage"].get("ball_cage_friction") or {}).get("value") is not None
    if not stated and not answer.cage.ball_cage_friction:
        return ""
    return told(answer.cage, "ball_cage_friction") + ("" if stated else f", {_material(answer)}")


def _material(answer: Part) -> str:
    """Return the candidate that the cage has, and its environment."""
    study = answer.values["study"]
    ranking = study["ranking"]
    name = (study["cage"].get("material") or {}).get("name") or ranking["candidates"][0]["name"]
    place = (ranking.get("environment") or {}).get("value") or ranking["environments"][0]
    return f"that of {name} in {place}"
