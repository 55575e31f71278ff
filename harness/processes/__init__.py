"""Other processes: work that runs in parallel, and work that may hang or crash."""
