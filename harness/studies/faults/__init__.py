"""The fault campaign: bad signals and ice, and whether the controller copes."""
