"""The sentence of reason beside each verdict."""

from __future__ import annotations

from separatrix.cage import Judgement, Verdict
from separatrix.restitution import SOLID_LUBRICATION_LIMIT
from separatrix.stability import RestitutionThreshold
from separatrix.units import Ratio

PAPER_STATEMENT = (
    f"The paper (section 5): a restitution factor below {SOLID_LUBRICATION_LIMIT:g} "
    "is too low to be reached using solid lubrication."
)
NOT_FINISHED = "interrupted before this was computed"


def not_measured(environment: str) -> str:
    """Return the reason of a missing measurement."""
    return f"not measured in {environment}" if environment else "not measured in any environment"


def reason(friction: Ratio, threshold: RestitutionThreshold, eta: Ratio, judgement: Judgement) -> str:
    """Return friction, threshold, margin and verdict in words, and the paper's word where it differs."""
    need = {0.0: "is stable at no restitution factor above 0", 1.0: "is stable at any restitution factor"}
    between = f"{threshold.value:.2f} ({threshold.low:.2f} to {threshold.high:.2f})"
    allowed = need.get(threshold.value, f"needs a restitution factor below {between}")
    margin = threshold.value - eta
    side = f", {abs(margin):.2f} {'below' if margin >= 0 else 'above'} that"
    film = f"this bearing has eta = {eta:.2f}{'' if threshold.value in need else side}"
    first = f"With a friction of {friction:.3g} it {allowed}; {film}."
    return " ".join((first, judgement.reason, disagreement(threshold.value, judgement.verdict))).rstrip()


def disagreement(threshold: Ratio, verdict: Verdict) -> str:
    """Return how the paper's statement differs from the verdict; empty if it does not.

    The paper calls a material inapt if it needs a restitution factor below 0.6, whatever its film gives;
    `PAPER_STATEMENT` says so once for all of them.
    """
    inapt = threshold < SOLID_LUBRICATION_LIMIT
    if inapt and verdict is Verdict.STABLE:
        return "The paper would call it inapt."
    if not inapt and verdict is Verdict.UNSTABLE:
        return "The paper would keep it."
    return ""
