"""The sentence of reason beside each verdict."""

from __future__ import annotations

from dataclasses import fields
from math import isfinite

from separatrix.cage import Judgement, Verdict
from separatrix.chain.restitution import SOLID_LUBRICATION_LIMIT
from separatrix.limits import RestitutionThreshold
from separatrix.units import Ratio

PAPER_STATEMENT = (
    f"The paper (section 5): a restitution factor below {SOLID_LUBRICATION_LIMIT:g} "
    "is too low to be reached using solid lubrication."
)
NOT_FINISHED = "interrupted before this was computed"


def not_measured(environment: str) -> str:
    """Return the reason of a missing measurement."""
    return f"not measured in {environment}" if environment else "not measured in any environment"


def not_finite(judgement: Judgement) -> str:
    """Return the reason of a verdict that is not given, as a number of its evidence is not finite; or ""."""
    values = ((f.name, getattr(judgement, f.name)) for f in fields(judgement))
    bad = [f"{name} is {value}" for name, value in values if isinstance(value, float) and not isfinite(value)]
    if not bad:
        return ""
    return f"no verdict: {bad[0].replace('_', ' ')}. The inputs are far from those of a bearing"


def reason(threshold: RestitutionThreshold, judgement: Judgement) -> str:
    """Return what decides a verdict in words; friction, threshold and margin stand beside it as numbers."""
    stable = judgement.verdict is Verdict.STABLE
    always = "Stable at any" if stable else "Pocket friction starts no whirl at any"
    ends = {0.0: "Stable at no restitution factor above 0.", 1.0: f"{always} restitution factor."}
    other = disagreement(threshold.value, judgement.verdict)
    return " ".join(part for part in (ends.get(threshold.value), judgement.reason, other) if part)


def disagreement(threshold: Ratio, verdict: Verdict) -> str:
    """Return how the paper's statement differs from the verdict; empty if it does not.

    The paper calls a material inapt if it needs a restitution factor below 0.6, whatever its film gives;
    `PAPER_STATEMENT` says so once for all of them.
    """
    inapt = threshold < SOLID_LUBRICATION_LIMIT
    if inapt and verdict is Verdict.STABLE:
        return f"By the paper's limit (eta < {SOLID_LUBRICATION_LIMIT:g}) it would be rejected."
    if not inapt and verdict is Verdict.UNSTABLE:
        return f"By the paper's limit (eta < {SOLID_LUBRICATION_LIMIT:g}) it would be kept."
    return ""
