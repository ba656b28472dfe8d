"""From a log to friction with its standard error."""
