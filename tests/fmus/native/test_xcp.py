"""FMI-LS-XCP: by the A2L file of a native FMU a tool reads and writes the memory of the first instance as it runs."""

import ctypes
import math
import re
from collections.abc import Iterator, Mapping
from contextlib import ExitStack
from itertools import count
from pathlib import Path
from typing import Any
from xml.etree import ElementTree
from zipfile import ZipFile

import fmpy
import pytest
from fmutesting.host import Host, opened
from fmutesting.together import together

from driveline.fmus.catalogue import FMUS
from fmublocks.description.variables import interface
from fmublocks.native.xcp import FOLDER, address_in

pytestmark = pytest.mark.skipif(fmpy.platform != "linux64", reason="addresses are those of Linux")

PLATFORMS = {"native": "linux64", "fmi3": "x86_64-linux"}

BUILDS = together("build", PLATFORMS)

STEP = 0.002


def a2l_of(path: Path, platform: str = "") -> str:
    with ZipFile(path) as archive:
        return archive.read("/".join(filter(None, (FOLDER, platform, f"{path.stem}.a2l")))).decode()


def addresses(text: str) -> dict[str, int]:
    found = re.findall(r"/begin (?:CHARACTERISTIC|MEASUREMENT) (\S+).*?(?:VALUE|ECU_ADDRESS) 0x(\w+)", text, re.DOTALL)
    return {name: int(address, 16) for name, address in found}


class Tool:
    """What measures and calibrates: it knows the A2L file, and where the binary was loaded."""

    def __init__(self, path: Path, platform: str, host: Host) -> None:
        (binary,) = Path(host.fmu.unzipDirectory).glob(f"binaries/{platform}/*.so")
        maps = [line.split() for line in Path("/proc/self/maps").read_text().splitlines()]
        base = min(int(row[0].split("-")[0], 16) for row in maps if row[-1] == str(binary))
        self._at = {name: base + address for name, address in addresses(a2l_of(path, platform)).items()}

    @property
    def names(self) -> list[str]:
        return list(self._at)

    def read(self, name: str) -> float:
        return ctypes.c_double.from_address(self._at[name]).value

    def write(self, **values: float) -> None:
        for name, value in values.items():
            ctypes.c_double.from_address(self._at[name]).value = value


@pytest.fixture
def bench(request: Any, tmp_path: Path) -> Iterator[Any]:
    """Opens an FMU of a build, with a tool."""
    numbers = count()
    with ExitStack() as stack:

        def begin(name: str, build: str) -> tuple[Host, Tool]:
            path = request.getfixturevalue(build) / f"{name}.fmu"
            host = stack.enter_context(opened(path, tmp_path / f"{name}_{next(numbers)}"))
            return host, Tool(path, PLATFORMS[build], host)

        yield begin


def inputs(k: int) -> Mapping[str, float]:
    omega = 150.0 + 3.0 * math.sin(50.0 * k * STEP)
    return {"T_driver": 50.0, "omega_1_meas": omega, "T_mot_est": 50.0}


def stepped(host: Host, numbers: range) -> list[dict[str, Any]]:
    found = []
    for k in numbers:
        host.set(**(inputs(k) if "T_driver" in host.variables else {"T_mot": 30.0 + k}))
        host.step(k * STEP, STEP)
        found.append(host.outputs())
    return found


@BUILDS
@together("name", FMUS)
def test_a_public_parser_reads_what_is_declared(request: Any, name: str, build: str) -> None:
    pya2l = pytest.importorskip("pya2l.parser", reason="pya2l is not installed")
    path, listed = request.getfixturevalue(build) / f"{name}.fmu", interface(FMUS[name].block)
    for platform in ("", PLATFORMS[build]):
        text = a2l_of(path, platform)
        with pya2l.A2lParser() as parser:
            (module,) = parser.tree_from_a2l(text.encode()).PROJECT.MODULE
        described = {item.Name.Value: item for item in (*module.CHARACTERISTIC, *module.MEASUREMENT)}
        assert described.keys() >= {v.name for v in listed}
        assert {item.Name.Value for item in module.CHARACTERISTIC} == {
            v.name for v in listed if v.causality == "parameter" and v.fmi_type == "Real"
        }
        assert all(item.SYMBOL_LINK.SymbolName.Value == f"{name}_instance" for item in described.values())
        assert "/include" not in text


@together("name", FMUS)
def test_the_manifest_says_what_the_standard_asks(native: Path, name: str) -> None:
    with ZipFile(native / f"{name}.fmu") as archive:
        manifest = ElementTree.fromstring(archive.read(f"{FOLDER}/fmi-ls-manifest.xml"))
        assert {f"{FOLDER}/{name}.a2l", f"{FOLDER}/linux64/{name}.a2l"} <= set(archive.namelist())
        assert "documentation/fmi-ls-xcp.txt" in archive.namelist()
    prefix = "{http://fmi-standard.org/fmi-ls-manifest}fmi-ls-"
    assert manifest.tag == "fmiLayeredStandardManifest"
    assert manifest.get(f"{prefix}name") == "org.fmi-standard.fmi-ls-xcp"
    assert manifest.get(f"{prefix}version") == "1.0.0"
    (offered,) = manifest
    assert offered.attrib == {
        "definition": f"{name}.a2l",
        "description": f"memory of the first instance of {name}",
        "types": "CoSimulation",
        "supportsDirectMemoryAccess": "true",
    }


@BUILDS
@together("name", FMUS)
def test_at_the_addresses_are_the_values_while_it_steps(bench: Any, name: str, build: str) -> None:
    host, tool = bench(name, build)
    host.initialize(**({"v_0": 10.0, "T_0": 20.0} if "v_0" in host.variables else {}))
    known = [n for n in host.variables if n in tool.names]
    assert {v.name for v in interface(FMUS[name].block)} <= set(known)
    for k in range(5):
        host.step(k * STEP, STEP)
        assert [tool.read(n) for n in known] == [float(host.get(n)) for n in known]
    assert len(tool.names) > len(interface(FMUS[name].block))


@BUILDS
@together(
    "name, values", [("DampingController", {"k_d": 0.75, "demand_lead": 0.0}), ("TwoMassDriveline", {"m": 2500.0})]
)
def test_what_is_written_acts_as_what_is_set(bench: Any, name: str, values: dict[str, float], build: str) -> None:
    results = []
    for write in (False, True, None):
        host, tool = bench(name, build)
        host.initialize(**({"v_0": 10.0} if name == "TwoMassDriveline" else inputs(0)))
        before = stepped(host, range(40))
        if write:
            tool.write(**values)
        elif write is False:
            host.set(**values)
        results.append((before, stepped(host, range(40, 80))))
        assert {n: host.get(n) for n in values} == {n: tool.read(n) for n in values}
    was_set, was_written, usual = results
    assert was_written == was_set
    assert was_written != usual


@BUILDS
@together(
    "name, value, message",
    [
        ("C", 100.0, "C = 100.0 is refused; a fixed parameter can be set until initialization mode is left"),
        ("k_d", 200.00000000000003, "k_d = 200.00000000000003 N.m.s/rad is refused; allowed is 0 to 200 N.m.s/rad"),
        ("k_d", math.nan, "k_d = nan N.m.s/rad is refused; allowed is 0 to 200 N.m.s/rad"),
    ],
)
def test_what_cannot_be_is_put_back_and_said_and_the_run_goes_on(
    bench: Any, name: str, value: float, message: str, build: str
) -> None:
    host, tool = bench("DampingController", build)
    host.initialize(**inputs(0))
    usual, again = [], bench("DampingController", build)[0]
    again.initialize(**inputs(0))
    stepped(host, range(10))
    before = tool.read(name)
    tool.write(**{name: value})
    written = stepped(host, range(10, 30))
    assert message in host.message
    assert tool.read(name) == before == host.get(name)
    stepped(again, range(10))
    usual = stepped(again, range(10, 30))
    assert written == usual


@BUILDS
def test_before_the_start_a_fixed_one_is_written_too(bench: Any, build: str) -> None:
    host, tool = bench("DampingController", build)
    other, _ = bench("DampingController", build)
    tool.write(C=90.0, phi_B=0.1)
    host.initialize(**inputs(0))
    other.initialize(C=90.0, phi_B=0.1, **inputs(0))
    assert stepped(host, range(30)) == stepped(other, range(30))
    assert host.message == ""


@BUILDS
def test_a_value_that_was_written_stays_beside_one_that_is_set_and_goes_with_the_state(bench: Any, build: str) -> None:
    host, tool = bench("DampingController", build)
    host.initialize(**inputs(0))
    state = host.fmu.getFMUstate()
    tool.write(k_d=1.0)
    host.set(omega_w=5.0)
    stepped(host, range(3))
    assert (host.get("k_d"), host.get("omega_w")) == (1.0, 5.0)
    host.fmu.setFMUstate(state)
    host.fmu.freeFMUstate(state)
    assert tool.read("k_d") == host.get("k_d") == FMUS["DampingController"].block.Parameters().k_d
    tool.write(k_d=1.0)
    host.fmu.reset()
    assert tool.read("k_d") == FMUS["DampingController"].block.Parameters().k_d


@BUILDS
def test_the_place_is_that_of_the_first_instance_and_free_after_it(request: Any, tmp_path: Path, build: str) -> None:
    path = request.getfixturevalue(build) / "MotorTorqueLoop.fmu"
    with opened(path, tmp_path, "first") as first:
        tool = Tool(path, PLATFORMS[build], first)
        with opened(path, tmp_path, "second") as second:
            first.set(g_T=1.5)
            second.set(g_T=1.25)
            assert tool.read("g_T") == 1.5
        first.fmu.freeInstance()
        with opened(path, tmp_path, "third") as third:
            third.set(g_T=0.75)
            assert tool.read("g_T") == 0.75
        first.fmu.freeInstance = lambda: None


@BUILDS
def test_a_saved_state_has_no_parameter_that_cannot_be_written(request: Any, tmp_path: Path, build: str) -> None:
    """J_1 of a run is fixed; a state that is saved before the next step does not keep it."""
    path = request.getfixturevalue(build) / "TwoMassDriveline.fmu"
    with opened(path, tmp_path, "first") as host:
        tool = Tool(path, PLATFORMS[build], host)
        host.initialize()
        J_1 = host.get("J_1")
        tool.write(J_1=2.0 * J_1)
        state = host.fmu.getFMUState() if build == "fmi3" else host.fmu.getFMUstate()
        host.step(0.0, 0.01)
        (host.fmu.setFMUState if build == "fmi3" else host.fmu.setFMUstate)(state)
        assert tool.read("J_1") == J_1


def test_an_instance_with_a_long_name_is_where_the_host_allocates_it(native: Path, tmp_path: Path) -> None:
    path = native / "MotorTorqueLoop.fmu"
    with opened(path, tmp_path, "n" * 2000) as host:
        tool = Tool(path, PLATFORMS["native"], host)
        host.set(g_T=1.5)
        assert host.get("g_T") == 1.5
        assert tool.read("g_T") == 0.0


def test_a_symbol_that_is_not_there_is_named(native: Path) -> None:
    with ZipFile(native / "MotorTorqueLoop.fmu") as archive:
        binary = archive.read("binaries/linux64/MotorTorqueLoop.so")
    address = address_in(binary, "MotorTorqueLoop_instance")
    assert address
    assert address % 8 == 0
    with pytest.raises(KeyError, match="Other_instance"):
        address_in(binary, "Other_instance")
    assert address_in(b"\xca\xfe\xba\xbe", "MotorTorqueLoop_instance") is None
