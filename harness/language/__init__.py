"""GLSL as text: includes and macros, tokens, syntax, signatures, rewriting."""
