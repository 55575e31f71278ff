"""Searches domains for the inputs at which a function is at its worst."""
