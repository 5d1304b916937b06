"""One run, many runs, and what made a result."""
