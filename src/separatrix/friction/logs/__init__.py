"""From raw tribometer logs to friction with its scatter."""
