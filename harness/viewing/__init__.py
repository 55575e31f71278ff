"""Shows a project live in a window."""
