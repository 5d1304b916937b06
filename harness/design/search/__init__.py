"""Tuning a controller: a cost over many runs, and the search for the parameters that make it least."""
