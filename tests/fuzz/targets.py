"""All fuzz targets by name."""

from . import calls, options, parameter_files, recordings

TARGETS = {
    "calls": calls.TARGET,
    "recordings": recordings.TARGET,
    "parameter_files": parameter_files.TARGET,
    "options": options.TARGET,
}
