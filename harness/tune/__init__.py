"""Only what a scene requires: the cheapest shaders of a project that keep its picture within a budget."""
