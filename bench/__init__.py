"""Measures the harness beside its rivals, and prints one table: ``python -m bench``."""

from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


class AbsentError(Exception):
    """Something that a contender needs is not on this machine; the text says what, and how to get it."""
