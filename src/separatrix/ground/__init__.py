"""What every room stands on: units, refusals, files, compiled kernels. It knows no bearing."""
