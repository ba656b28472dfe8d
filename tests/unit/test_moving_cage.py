"""What a moving cage refuses, by the words of the message; rules of a `CageDesign` too: test_study_cage."""

import math
import re
from dataclasses import replace

import pytest
from cages import AT_REST

from separatrix.ground.errors import InputError
from separatrix.study.study import Guidance, PocketShape

CAGE = replace(AT_REST, cage_speed=670.0, guidance=Guidance.OUTER, land_clearance=1e-3)
SLOT = {"pocket_shape": PocketShape.ELONGATED}

POSITIVE = (
    *("mass", "moment_of_inertia", "pitch_radius", "ball_cage_stiffness", "land_stiffness"),
    *("race_damping", "groove_damping", "transverse_inertia", "hertz_coefficient", "land_clearance"),
    *("land_radius", "inner_radius", "outer_radius"),
)
NOT_NEGATIVE = (
    *("ball_cage_friction", "land_friction", "unbalance", "gravity", "ball_diameter", "land_width"),
    *("added_mass", "groove_stiffness", "pivot_speed", "axial_kick", "tilt_kick"),
)


ONE_VALUE = [
    *((field, 0.0, "must be > 0") for field in POSITIVE),
    *((field, -1e-3, "must lie between 0 and ") for field in NOT_NEGATIVE),
    *((field, math.inf, "must be a finite number") for field in ("cage_speed", "inner_speed", "outer_speed")),
    ("ball_count", 11.0, "must be a whole number from 1 to 1000"),
    ("ramp_time", -1.0, "must be >= 0"),
    ("ramp_start", 0.0, "must be > 0 and <= 1"),
    ("axial_gravity", 2e6, "must lie between"),
    ("dynamic_unbalance", 0.2, "must lie between 0 and"),
    ("land_restitution", 1.1, "must lie between 0 and 1"),
    ("land_clearance", None, "is missing"),
    ("guidance", "outer", "must be one of"),
    ("pocket_shape", "square", "must be one of"),
    ("pocket_clearance", -1e-6, "must be >= 0"),
    ("pocket_axial_clearance", 1e-4, "has no meaning for a square pocket"),
    ("pocket_axial_offset", 1e-5, "changes nothing in a square pocket"),
    ("pocket_position_scatter", 2e-4, "leaves no clearance"),
    ("pocket_angles", (0.0, 1.0), "must hold one angle for each of the 11 balls"),
    ("orbital_cosines", (math.nan,), "must be a finite number; got nan"),
    ("orbital_sines", (0.1,), "must be as many as orbital_cosines, 0"),
    ("ball_spin", (1.0, math.inf, 0.0), "must be a finite number; got inf"),
    ("ball_spin", (1.0, 2.0), "must have 3 items; got 2 of them"),
    ("transverse_inertia", 0.02 * 0.0325**2, "must be at least half that about the axis"),
    ("inner_radius", 0.033, "The walls of its pockets do not reach the balls."),
    ("outer_radius", 0.032, "The walls of its pockets do not reach the balls."),
]
"""A field, its value, and the rule that it breaks."""

TOGETHER = [
    ("pocket_axial_clearance", "must be > 0", SLOT | {"pocket_axial_clearance": 0.0}),
    ("outer_radius", "must be larger than inner_radius", {"inner_radius": 0.03, "outer_radius": 0.029}),
    ("pocket_axial_clearance", "is missing: an elongated pocket needs it", SLOT),
    ("pocket_clearance", "must be > 0 with Hertz contact",
     {"pocket_clearance": 0.0, "hertz_coefficient": 3e8}),
    ("pocket_spacing_scatter", "and pocket_angles exclude each other",
     {"pocket_spacing_scatter": 0.1, "pocket_angles": tuple(0.5 * j for j in range(11))}),
    ("orbital_cosines", "must be empty for a ball set at rest",
     {"cage_speed": 0.0, "orbital_cosines": (0.1,), "orbital_sines": (0.1,)}),
]  # fmt: skip
"""The field that is refused, the rule, and values of which each is right by itself."""

REFUSED = [*((field, rule, {field: value}) for field, value, rule in ONE_VALUE), *TOGETHER]


@pytest.mark.parametrize(("field", "rule", "changes"), REFUSED)
def test_a_field_is_refused_in_words(field, rule, changes):
    """Each rule of one field or of several."""
    with pytest.raises(InputError, match=rf"MovingCage.{field}(\[\d\])? .*{re.escape(rule)}"):
        replace(CAGE, **changes)
