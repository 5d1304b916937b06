"""What several tests share."""

import pytest

from fmus.catalogue import FMUS
from fmus.packaging import build


@pytest.fixture(scope="session")
def built(tmp_path_factory):
    """Folder with all FMUs of the project, freshly built."""
    folder = tmp_path_factory.mktemp("fmus")
    for fmu in FMUS.values():
        build(fmu, folder)
    return folder
