"""What the restitution stage refuses."""

import pytest

from separatrix.chain.restitution import damping_for, damping_ratio, damping_ratio_for
from separatrix.errors import InputError


@pytest.mark.parametrize("eta", [1.0, 1.2, -0.1, float("nan")])
def test_a_restitution_factor_outside_its_range_is_refused(eta):
    """The inverse exists for 0 <= eta < 1 only, and says so."""
    with pytest.raises(InputError, match="restitution_factor must lie in 0 <= eta < 1"):
        damping_ratio_for(eta)
    with pytest.raises(InputError):
        damping_for(eta, 3e6, 0.05)


@pytest.mark.parametrize("damping", [0.0, -1.0, float("nan")])
def test_races_that_do_not_damp_are_refused(damping):
    """A massless ball held by nothing takes no impact: there is no restitution factor."""
    with pytest.raises(InputError, match=r"race_damping must be > 0 \[N s/m\]"):
        damping_ratio(3e6, 0.05, damping)
