"""What several tests share."""

import pytest
from hypothesis import settings

from fmus.catalogue import FMUS
from fmus.packaging import build

# the same examples in every run, and nothing timed
settings.register_profile("driveline", deadline=None, derandomize=True)
settings.load_profile("driveline")


@pytest.fixture(scope="session")
def built(tmp_path_factory):
    """Folder with all FMUs of the project, freshly built."""
    folder = tmp_path_factory.mktemp("fmus")
    for fmu in FMUS.values():
        build(fmu, folder)
    return folder
