"""Reads SHADERed projects into plain data."""
