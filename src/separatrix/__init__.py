"""Predicts whether the cage of a dry-lubricated ball bearing runs stably, and ranks candidate materials."""
