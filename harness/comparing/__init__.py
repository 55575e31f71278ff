"""Compares results with expectations, and says how far off they are, where and why."""
