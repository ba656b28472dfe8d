"""Friction of cage on ball: logs of tribometers, their reduction, the fit to tests, the friction file."""
