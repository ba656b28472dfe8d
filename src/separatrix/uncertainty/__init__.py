"""Uncertain inputs through the chain: sampling, samples of the chain, probabilities."""
