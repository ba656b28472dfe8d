"""Saved answers: read, compared with the same question answered again, and put side by side."""
