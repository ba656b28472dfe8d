"""Blocks and figures, and their renderers."""
