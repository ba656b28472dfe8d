"""Which input drives the doubt, which test to run next, and what a cage or a new material may be at most."""
