"""Text of the mobility of a ball: its small motion, its law of traction, impacts of the cage on it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from separatrix.present.text.tables import (
    facts,
    number,
    paragraph,
    quantity,
    section,
    significant,
    stated,
    table,
)
from separatrix.present.walk import field_units

if TYPE_CHECKING:
    from separatrix.answers import MobilityAnswer
    from separatrix.chain.mobility import Impacts, LinearMobility, Mobility
    from separatrix.study import Study

SMALL = {
    "damping": "Damping C_f, attitude of the spin held",
    "effective_mass": "Effective mass m_e",
    "damping_relaxed": "Damping C_eff of a slow push",
    "damping_locked": "Damping with all spin held",
    "groove_damping": "Damping across the orbit, c_g",
    "groove_stiffness": "Stiffness across the orbit, k_g",
    "pitch_angle": "Pitch of the spin axis",
    "pocket_friction_effect": "Effect k of pocket friction, 1 +- k f",
    "slip_speed_inner": "Slip speed, inner race",
    "slip_speed_outer": "Slip speed, outer race",
}
SHOWN_PUSHES = 8


def mobility(answer: MobilityAnswer, study: Study) -> list[str]:  # noqa: ARG001
    """Small motion by both slip laws, the law of traction, and the restitution of impacts."""
    found, rigid = answer.mobility, answer.rigid
    units = field_units(type(found.linear))
    cells = [
        [words, *(quantity(getattr(one, name), units[name], 5) for one in (found.linear, rigid))]
        for name, words in SMALL.items()
    ]
    small = table(("", "elastic creep", "rigid"), cells)
    blocks = [
        section("Small motion of the most loaded ball", small),
        section("Modes", _modes(found.linear, rigid)),
        section("Push along the orbit", facts(_law(found)), _pushes(found)),
    ]
    if answer.impacts is None:
        return [*blocks, section("Impacts of the cage", paragraph(f"Not computed: {answer.impacts_reason}"))]
    return [*blocks, section("Impacts of the cage on the ball", *_impacts(answer.impacts))]


def _modes(found: LinearMobility, rigid: LinearMobility) -> str:
    """Return a table of the rates, the time of each, and what it adds to the speed of a slow push."""
    rows = [
        [
            str(i + 1),
            significant(float(found.rates[i]), 5),
            quantity(1.0 / float(found.rates[i]), "s", 3),
            f"{100.0 * float(found.shares[i]):.2f}",
            significant(float(rigid.rates[i]), 5),
        ]
        for i in range(found.rates.size)
    ]
    headers = ("mode", "rate\n1/s", "time", "share of 1/C_eff\n%", "rate, rigid\n1/s")
    return table(headers, rows)


def _law(found: Mobility) -> Sequence[tuple[str, str]]:
    """Return what the races carry at most, the law, and how near it is to the slip fields."""
    law = found.traction
    elements = ", ".join(
        f"{quantity(c, 'N s/m', 4)} to {quantity(v, 'm/s', 3)}"
        for c, v in zip(law.slopes, law.speeds, strict=True)
    )
    largest = max(found.force_forward.max(), found.force_backward.max())
    return [
        ("Capacity f_BT (N_I + N_E)", stated(found, "capacity")),
        ("Largest force of the slip fields", quantity(float(largest), "N", 4)),
        ("Law of traction, C_i to v_i", elements),
        ("Largest error of the law", f"{100 * found.law_error:.2g} % of the capacity"),
        ("Forward and backward differ by", f"+-{100 * found.asymmetry:.2g} % of the capacity at most"),
    ]


def _pushes(found: Mobility) -> str:
    """Return a table of F(u) forward and backward beside the law."""
    chosen = range(found.speed.size - 1, -1, -max(1, found.speed.size // SHOWN_PUSHES))
    rows = [
        [
            significant(float(found.speed[i]), 3),
            *(
                significant(float(force[i]))
                for force in (found.force_forward, found.force_backward, found.force_law)
            ),
        ]
        for i in reversed(chosen)
    ]
    return table(("speed\nm/s", "F forward\nN", "F backward\nN", "law\nN"), rows, left=0)


def _impacts(found: Impacts) -> list[str]:
    """Return a table of restitution against the speed of the impact, and what it is to be compared with."""
    rows = [
        [
            significant(float(found.speed[i]), 3),
            *(
                number(float(one[i]))
                for one in (found.restitution_forward, found.restitution_backward, found.restitution_law)
            ),
            significant(float(found.peak_force[i])),
            significant(1e6 * float(found.duration[i])),
        ]
        for i in range(found.speed.size)
    ]
    headers = ("speed\nm/s", "from behind\n-", "from front\n-", "by the law\n-", "peak force\nN", "time\nus")
    beside = [
        ("Mass that the impact feels", stated(found, "felt_mass")),
        ("Limit of gentle impacts", number(found.restitution_linear)),
        ("Eq. 18 with this mass", number(found.restitution_summed)),
        ("eta of the paper, all of the mass", number(found.nominal_restitution_factor)),
    ]
    return [
        table(headers, rows, left=0),
        facts(beside),
        paragraph("Share of its speed with which the cage returns; below 0 it goes on behind the ball."),
    ]
