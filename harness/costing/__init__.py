"""Counts what GLSL functions cost on GPUs."""
