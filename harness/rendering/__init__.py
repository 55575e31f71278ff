"""Renders SHADERed projects as SHADERed does."""
