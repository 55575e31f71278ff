"""Calls GLSL functions on numpy arrays."""
