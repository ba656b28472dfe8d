"""Saved answers: read, held against the same question answered again, and put side by side."""
