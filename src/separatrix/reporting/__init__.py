"""The report of a study: one record, made from saved answers, and written as HTML and as PDF."""
