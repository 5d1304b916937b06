"""The build with PythonFMU: the block's own Python runs inside the FMU."""
