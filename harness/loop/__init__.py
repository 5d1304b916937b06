"""Our loop as data: its places and connections, the settings of a run, which builds of the FMUs."""
