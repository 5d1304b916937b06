"""All fuzz targets by name."""

from tests.fuzz import archives, calls, options, parameter_files, plants, recordings, swollen

TARGETS = {
    "calls": calls.TARGET,
    "archives": archives.TARGET,
    "plants": plants.TARGET,
    "recordings": recordings.TARGET,
    "swollen": swollen.TARGET,
    "parameter_files": parameter_files.TARGET,
    "options": options.TARGET,
}
