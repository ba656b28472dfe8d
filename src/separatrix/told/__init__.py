"""Answers as text that an engineer reads in a terminal of 80 to 100 columns: one module a subject."""
