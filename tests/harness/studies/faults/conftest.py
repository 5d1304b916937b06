"""What the tests of the fault campaign share."""

import pytest

from driveline.fmus.signal_faults import FMU


@pytest.fixture(scope="session")
def injector(native_builder, tmp_path_factory):
    """The native FMU of SignalFaults."""
    return native_builder(FMU, tmp_path_factory.mktemp("injector"))


@pytest.fixture(scope="session")
def settings(native):
    """Of the loop with each plant, on freshly built FMUs."""
    given = {"parameters": {}, "folder": native.parent, "build": "native", "mapping": {}}
    loop = given | {"controller": None, "motor": None, "can": None}
    return {"TwoMassDriveline": loop, "ValidationVehicle": loop}
