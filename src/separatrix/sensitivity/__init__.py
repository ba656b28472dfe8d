"""Sources of uncertainty, which test to run next, and what a cage or a new material may be at most.

Every question is asked of a model, `records.Question`; it does not matter what computes it.
"""

from separatrix.sensitivity.design import Design, sampled_design, sampled_values
from separatrix.sensitivity.evidence import Evidence, evidence_of
from separatrix.sensitivity.fit import FitError, fitted_question, with_fit_error
from separatrix.sensitivity.inverse import allowed_friction
from separatrix.sensitivity.next_test import default_measurements, next_test
from separatrix.sensitivity.of_model import fitted_to, question_of, reducible_shares
from separatrix.sensitivity.question import Case, Input, Question
from separatrix.sensitivity.records import (
    AllowedFriction,
    CaseSobol,
    Estimate,
    Factor,
    FilmAxis,
    Measurement,
    NextTest,
    RestitutionGrid,
    SobolAnswer,
    SobolIndex,
    StableRegion,
    TestGain,
)
from separatrix.sensitivity.region import friction_grid, stable_regions
from separatrix.sensitivity.sobol import indices_of, sobol_indices
from separatrix.sensitivity.words import (
    allowed_sentence,
    input_words,
    next_test_sentences,
    region_sentences,
    sobol_sentence,
)

__all__ = [
    "AllowedFriction",
    "Case",
    "CaseSobol",
    "Design",
    "Estimate",
    "Evidence",
    "Factor",
    "FilmAxis",
    "FitError",
    "Input",
    "Measurement",
    "NextTest",
    "Question",
    "RestitutionGrid",
    "SobolAnswer",
    "SobolIndex",
    "StableRegion",
    "TestGain",
    "allowed_friction",
    "allowed_sentence",
    "default_measurements",
    "evidence_of",
    "fitted_question",
    "fitted_to",
    "friction_grid",
    "indices_of",
    "input_words",
    "next_test",
    "next_test_sentences",
    "question_of",
    "reducible_shares",
    "region_sentences",
    "sampled_design",
    "sampled_values",
    "sobol_indices",
    "sobol_sentence",
    "stable_regions",
    "with_fit_error",
]
