"""Puts small faults into GLSL files, and says which of them tests do not notice."""
