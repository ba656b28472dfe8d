"""Motion of the cage in space: six degrees of freedom, with first-order tilt."""
