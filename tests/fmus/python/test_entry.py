"""Resource URIs in every legal form, and what is none: read or refused with a message, by no crash."""

import ctypes
import sys
from typing import Any
from urllib.parse import quote

import fmpy
import pytest
from fmpy.fmi2 import (
    FMU2Slave,
    fmi2CallbackAllocateMemoryTYPE,
    fmi2CallbackFreeMemoryTYPE,
    fmi2CallbackFunctions,
    fmi2CallbackLoggerTYPE,
)
from fmpy.logging import addLoggerProxy

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="the entry is for Linux alone")


@pytest.fixture(scope="module")
def instantiate(built, tmp_path_factory):
    """Instantiates the motor from a folder with a space and an umlaut; gives what it logged, or that it was made."""
    folder = tmp_path_factory.mktemp("a folder") / "ü"
    fmpy.extract(str(built / "MotorTorqueLoop.fmu"), str(folder))
    description = fmpy.read_model_description(str(folder))
    fmu: Any = FMU2Slave(guid=description.guid, unzipDirectory=str(folder), modelIdentifier="MotorTorqueLoop")
    said: list[str] = []
    callbacks = fmi2CallbackFunctions()
    callbacks.logger = fmi2CallbackLoggerTYPE(lambda *message: said.append(message[4].decode()))
    addLoggerProxy(ctypes.byref(callbacks))
    callbacks.allocateMemory = fmi2CallbackAllocateMemoryTYPE(fmpy.calloc)
    callbacks.freeMemory = fmi2CallbackFreeMemoryTYPE(fmpy.free)

    def make(uri: str | None, guid: str = str(description.guid), kind: int = 1) -> str:
        said.clear()
        location = (
            None
            if uri is None
            else uri.format(path=f"{folder}/resources", quoted=quote(f"{folder}/resources")).encode()
        )
        made = fmu.fmi2Instantiate(b"motor", kind, guid.encode(), location, ctypes.byref(callbacks), 0, 0)
        if made:
            fmu.fmi2FreeInstance(made)
        return "made" if made else said[0]

    return make


@pytest.mark.parametrize(
    "uri",
    ["file://{quoted}", "file:{quoted}", "file://localhost{quoted}", "FILE://{path}/", "file:{path}", "{path}"],
)
def test_every_legal_form_of_a_resource_uri_is_read(instantiate, uri):
    assert instantiate(uri) == "made"


@pytest.mark.parametrize(
    "uri", [None, "", "file:", "file://server{quoted}", "http:{quoted}", "file:///%zz", "file:///%00"]
)
def test_what_is_no_uri_of_a_file_here_is_refused_with_a_message(instantiate, uri):
    assert instantiate(uri).endswith("is no URI of a file on this machine")


def test_another_folder_kind_or_guid_is_refused_with_a_message(instantiate):
    assert instantiate("file:///nowhere") == (
        "fmuResourceLocation = 'file:///nowhere' is not the folder of the resources of this FMU"
    )
    assert "is for co-simulation alone" in instantiate("{path}", kind=0)
    for guid in ("another", "", "2.0", "-"):  # the last two are in the description, within a version and the guid
        assert instantiate("{path}", guid=guid) == f"fmuGUID = '{guid}' is not the guid of this FMU"
