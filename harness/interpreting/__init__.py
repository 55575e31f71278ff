"""Interprets SPIR-V over numpy arrays, in strict IEEE arithmetic, and records every value on the way."""
