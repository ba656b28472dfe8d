"""Many bearings: cases of a sweep, and what uncertain inputs do to verdicts and choice of material."""
