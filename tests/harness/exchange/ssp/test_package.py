"""The package as a stranger finds it: the standard's schemas, what is in it, and what it says of the loop."""

import tomllib
import zipfile
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import fmpy.ssp
import numpy as np
import pytest
from fmpy.ssp.ssd import read_ssd, read_ssv
from fmutesting.foreign import build_car
from lxml import etree  # pyright: ignore[reportAttributeAccessIssue]

from driveline.harness.commands.cli import main
from driveline.harness.exchange.ssp.layout import Layout
from driveline.harness.exchange.ssp.loop_with_source import SIGNALS, SOURCE, points, with_source
from driveline.harness.loop.places import CONNECTIONS, PLACES, PLANTS, STEP_SIZE
from driveline.harness.loop.settings import loop
from driveline.harness.loop.topology import ONE_UNIT, DriveUnit, Topology
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.manoeuvres.signals import FlatSine, Held
from driveline.models.manoeuvre import BLOCK, Input, State
from fmuloop.wiring import fit
from tests import ROOT
from toolground.errors import UserError

SCHEMAS = {
    ".ssd": "SystemStructureDescription.xsd",
    ".ssv": "SystemStructureParameterValues.xsd",
}

NS = {
    "ssd": "http://ssp-standard.org/SSP1/SystemStructureDescription",
    "ssc": "http://ssp-standard.org/SSP1/SystemStructureCommon",
    "ssv": "http://ssp-standard.org/SSP1/SystemStructureParameterValues",
    "oms": "https://raw.githubusercontent.com/OpenModelica/OMSimulator/master/schema/oms.xsd",
}

SSDS = ("SystemStructure.ssd", "ValidationVehicle.ssd")


def parsed(ssp: Path, name: str) -> etree._Element:
    with zipfile.ZipFile(ssp) as archive:
        return etree.fromstring(archive.read(name))


def values(ssp: Path, name: str) -> dict[str, float]:
    """The numbers of a parameter set."""
    return {parameter.name: float(parameter.value) for parameter in read_ssv(ssp, name).parameters}


def ends(connection: etree._Element) -> list[str]:
    return [f"{connection.get(f'{end}Element')}.{connection.get(f'{end}Connector')}" for end in ("start", "end")]


def test_every_document_is_valid_by_the_standard_and_an_old_unpacker_reads_the_archive(packaged) -> None:
    folder = Path(fmpy.ssp.__file__).parent / "schema"
    with zipfile.ZipFile(packaged()) as archive:
        documents = [name for name in archive.namelist() if Path(name).suffix in SCHEMAS]
        assert len(documents) == 2 + 6 + 2
        for name in documents:
            schema = etree.XMLSchema(file=folder / SCHEMAS[Path(name).suffix])
            schema.assertValid(etree.fromstring(archive.read(name)))
    with zipfile.ZipFile(packaged()) as archive:
        assert archive.testzip() is None
        assert max(entry.extract_version for entry in archive.infolist()) <= 20
        assert all(name.isascii() and not name.startswith("/") for name in archive.namelist())


def test_each_plant_is_a_variant_with_its_own_names_and_the_first_one_the_default(packaged, fmus, tmp_path) -> None:
    names = [parsed(packaged(), name).get("name") for name in SSDS]
    assert names == list(PLANTS)
    turned = packaged(*(option for plant in reversed(PLANTS) for option in ("--plant", plant)))
    assert parsed(turned, "SystemStructure.ssd").get("name") == "ValidationVehicle"
    assert parsed(turned, "TwoMassDriveline.ssd").get("name") == "TwoMassDriveline"
    car = build_car(tmp_path / "car", T_gear=("Shaft.tau", "N.m", 1.0))
    ssp = packaged("--plant", str(car), "--map", "plant.T_gear=Shaft.tau")
    plant = next(c for c in parsed(ssp, SSDS[0]).iterfind(".//ssd:Component", NS) if c.get("name") == "plant")
    assert plant.find(".//ssd:Connector[@name='Shaft.tau']", NS) is not None
    assert plant.get("source") == f"resources/{car.name}"


@pytest.mark.parametrize("name", SSDS)
def test_the_connections_are_those_of_loop_and_source_within_what_the_tools_know_of_the_standard(
    packaged, name
) -> None:
    found = {tuple(ends(connection)) for connection in parsed(packaged(), name).iterfind(".//ssd:Connection", NS)}
    fed = {"T_driver": "controller.T_driver", "T_brake": "plant.T_brake", "slope": "plant.slope"}
    sources = {(f"{SOURCE}.{signal}", fed[signal]) for signal in SIGNALS}
    sources.add((f"{SOURCE}.enable", "controller.enable"))
    assert found == sources | {(connection.source, connection.target) for connection in CONNECTIONS}
    root = parsed(packaged(), name)
    assert root.find("ssd:System/ssd:Connectors", NS) is None, "libcosim: connections are between components"
    assert {child.tag for child in root.find("ssd:System/ssd:Elements", NS)} == {f"{{{NS['ssd']}}}Component"}
    assert root.find(".//ssc:Enumeration", NS) is None, "libcosim stops at one"
    known = {f"{{{NS['ssd']}}}{name}" for name in ("Elements", "Connections", "Annotations")}
    assert {child.tag for child in root.find("ssd:System", NS)} == known, "OMSimulator's command line stops at others"
    step = root.find("ssd:System/ssd:Annotations//oms:SimulationInformation/oms:FixedStepMaster", NS)
    assert (step.get("description"), float(step.get("stepSize"))) == ("oms-ma", STEP_SIZE), "OMSimulator stops without"
    fed = {ends(connection)[1] for connection in root.iterfind(".//ssd:Connection", NS)}
    for component in root.iterfind(".//ssd:Component", NS):
        assert component.get("type"), "OMSimulator has no default"
        for connector in component.iterfind(".//ssd:Connector[@kind='input']", NS):
            assert f"{component.get('name')}.{connector.get('name')}" in fed, "FMPy wants each input connected"


@pytest.mark.parametrize("name", SSDS)
def test_fmpy_reads_its_blocks_and_parameters(packaged, name, tmp_path) -> None:
    copy = tmp_path / "copy.ssp"
    with zipfile.ZipFile(packaged()) as source, zipfile.ZipFile(copy, "w") as target:
        for entry in source.namelist():
            content = source.read(name if entry == "SystemStructure.ssd" else entry)
            target.writestr(entry, content)
    ssd = read_ssd(copy)
    assert ssd.system is not None
    assert {component.name for component in ssd.system.elements} == {SOURCE, *PLACES}
    assert all(component.parameterBindings[0].parameterValues[0].parameters for component in ssd.system.elements)


def test_every_unit_is_defined_in_units_of_the_si(packaged) -> None:
    with zipfile.ZipFile(packaged()) as archive:
        documents = [name for name in archive.namelist() if Path(name).suffix in SCHEMAS]
    for name in documents:
        root = parsed(packaged(), name)
        units = {unit.get("name"): dict(unit[0].attrib) for unit in root.iterfind(".//ssc:Unit", NS)}
        used = {element.get("unit") for element in root.iter() if element.get("unit")}
        assert used == units.keys(), name
    assert units["N.m"] == {"kg": "1", "m": "2", "s": "-2"}
    assert units["rad/s"] == {"s": "-1", "rad": "1"}


def test_a_vehicle_file_its_gains_and_what_is_set_are_the_parameter_sets(packaged, tmp_path) -> None:
    van, gains = ROOT / "examples" / "cars" / "van.toml", tmp_path / "gains.toml"
    gains.write_text("k_d = 1.25\n")
    ssp = packaged("--vehicle", str(van), "--parameters", str(gains), "--set", "motor.seed=7")
    car = tomllib.loads(van.read_text())
    for plant in PLANTS:
        found = values(ssp, f"resources/plant_{plant}.ssv")
        assert {name: found[name] for name in car.keys() & found.keys()} == {
            name: car[name] for name in car.keys() & found.keys()
        }
        assert car.keys() & found.keys()
        every = values(ssp, f"resources/{plant}.ssv")
        assert every["controller.k_d"] == 1.25
        assert every["motor.seed"] == 7
        assert {name: every[f"plant.{name}"] for name in found} == found


@pytest.mark.parametrize("name", [name for name, each in MANOEUVRES.items() if not each.road])
def test_the_source_makes_the_signals_of_every_manoeuvre(packaged, name) -> None:
    manoeuvre = MANOEUVRES[name]
    p: Any = BLOCK.Parameters(**values(packaged("--manoeuvre", name), "resources/manoeuvre_Manoeuvre.ssv"))
    instants = np.arange(0, round(manoeuvre.duration / STEP_SIZE) + 1, 40) * STEP_SIZE  # at jumps, as prbs has them
    made = [BLOCK.output(State(t), Input(), p) for t in instants]
    for signal in SIGNALS:
        expected = getattr(manoeuvre, signal)(instants)
        drawn = [getattr(one, signal) for one in made]
        np.testing.assert_allclose(drawn, expected, atol=1e-10, err_msg=signal)
    assert all(one.enable for one in made)


def test_start_end_and_grip_of_the_road_are_those_of_the_manoeuvre(packaged) -> None:
    plant = values(packaged("--manoeuvre", "tipin50"), "resources/plant_TwoMassDriveline.ssv")
    assert (plant["v_0"], plant["T_0"]) == (MANOEUVRES["tipin50"].v_0, -12.0)
    experiment = parsed(packaged("--manoeuvre", "drive"), SSDS[0]).find("ssd:DefaultExperiment", NS)
    assert float(experiment.get("stopTime")) == MANOEUVRES["drive"].duration
    ssp = packaged("--manoeuvre", "launch_ice", "--plant", "ValidationVehicle")
    assert values(ssp, "resources/ValidationVehicle.ssv")["plant.mu"] == 0.12


TWO_UNITS = Topology((DriveUnit("front"), DriveUnit("rear", (("T_mot", "T_mot_rear"), ("omega_1", "omega_1_rear")))))


def test_in_the_picture_no_block_stands_on_another_and_lines_run_along_the_axes(packaged) -> None:
    for topology in (ONE_UNIT, TWO_UNITS):
        layout = Layout(list(topology.places), topology.connections)
        require_apart(list(layout.boxes.values()))
        for source, target, _ in topology.connections:
            points = [layout.point(source), *layout.corners[source, target], layout.point(target)]
            for (x1, y1), (x2, y2) in pairwise(points):
                assert x1 == x2 or y1 == y2, (source, target)
    system = parsed(packaged(), SSDS[0])
    drawn = system.findall(".//ssd:ConnectionGeometry", NS)
    assert len(drawn) == len(system.findall(".//ssd:Connection", NS)) > len(CONNECTIONS)


def test_no_two_lines_of_the_picture_lie_on_each_other() -> None:
    for topology in (ONE_UNIT, TWO_UNITS):
        layout = Layout(list(topology.places), topology.connections)
        upright = [points[k][0] for points in layout.corners.values() for k in range(0, len(points), 2)]
        assert len({*upright}) == len(upright)


def require_apart(boxes) -> None:
    for k, a in enumerate(boxes):
        assert a.x1 < a.x2
        assert a.y1 < a.y2
        assert all(a.x2 < b.x1 or b.x2 < a.x1 or a.y2 < b.y1 or b.y2 < a.y1 for b in boxes[k + 1 :])


def refused(fmus, folder: Path, capsys, *options: str) -> str:
    assert main(["ssp", "--fmus", str(fmus), "--output", str(folder), *options]) == 2
    assert not list(folder.rglob("*.ssp"))
    return capsys.readouterr().err


def test_other_units_are_converted_on_the_connections_and_in_the_parameters(fmus, tmp_path, caplog) -> None:
    car = build_car(tmp_path / "car", omega_1=("n", "rev/min", 2.0 * np.pi / 60.0), v_0=("start", "km/h", 1 / 3.6))
    (tmp_path / "theirs.toml").write_text('[plant]\nomega_1 = "n"\nv_0 = "start"\n', encoding="utf-8")
    given = ["--plant", str(car), "--map", str(tmp_path / "theirs.toml"), "--output", str(tmp_path)]
    assert main(["ssp", "--fmus", str(fmus), *given]) == 0
    assert "plant.omega_1: converted to another unit by a LinearTransformation" in caplog.text
    ssp = tmp_path / "driveline.ssp"
    root = parsed(ssp, SSDS[0])
    (changed,) = root.iterfind(".//ssc:LinearTransformation/..", NS)
    assert ends(changed) == ["plant.n", "motor.omega_1"]
    assert changed.get("suppressUnitConversion") == "true"
    assert float(changed[0].get("factor")) == pytest.approx(2.0 * np.pi / 60.0)
    assert root.find(".//ssd:Connector[@name='n']/ssc:Real", NS).get("unit") == "rev/min"
    assert values(ssp, "resources/plant_Theirs.ssv")["start"] == pytest.approx(15.0)
    with zipfile.ZipFile(ssp) as archive:
        assert not [name for name in archive.namelist() if name.endswith(".msim")]


def test_an_fmu_of_fmi_3_makes_it_a_package_of_ssp_2_with_the_types_of_that(packaged, fmi3, caplog) -> None:
    """Beyond version and types it is valid by the schema of SSP 1.0."""
    ssp = packaged("--plant", str(fmi3 / "TwoMassDriveline.fmu"))
    (said,) = [each.getMessage() for each in caplog.records]
    assert said.startswith("an FMU is of FMI 3.0, so the package is of SSP 2.0")
    folder = Path(fmpy.ssp.__file__).parent / "schema"
    with zipfile.ZipFile(ssp) as archive:
        assert not [name for name in archive.namelist() if name.endswith(".msim")]
        for name in (name for name in archive.namelist() if Path(name).suffix in SCHEMAS):
            text = archive.read(name)
            assert etree.fromstring(text).get("version") == "2.0"
            old = (
                text.replace(b'version="2.0"', b'version="1.0"')
                .replace(b":Float64", b":Real")
                .replace(b":Int32", b":Integer")
            )
            etree.XMLSchema(file=folder / SCHEMAS[Path(name).suffix]).assertValid(etree.fromstring(old))
    kinds = {component.get("name"): {c[0].tag.rpartition("}")[2] for c in component.iterfind("*/ssd:Connector", NS)}
             for component in parsed(ssp, SSDS[0]).iterfind(".//ssd:Component", NS)}  # fmt: skip
    assert (kinds["plant"], kinds["motor"]) == ({"Float64"}, {"Real"})


def test_a_change_in_a_run_is_refused_before_fmus_are_looked_for(tmp_path, capsys) -> None:
    assert main(["ssp", "--fmus", str(tmp_path), "--set", "controller.k_d@2=1"]) == 2
    message = "driveline ssp: controller.k_d@2: the parameters of an SSP have one value from the start on\n"
    assert capsys.readouterr().err == message


def held(count: int, *levels: float) -> Held:
    return Held(0.01, [levels[k % len(levels)] for k in range(count)])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"T_driver": held(9, 1.0, 2.0, 3.0)}, "T_driver is not made of straight lines, a sine or a binary torque"),
        ({"T_brake": FlatSine(5.0, 5.0, 1.0, 1.0)}, "T_brake is not made of straight lines, and"),
        ({"T_driver": held(401, 1.0, 2.0)}, "its binary torque has 401 bits; other tools are given at most 400"),
    ],
)
def test_what_the_source_cannot_make_is_refused(fmus, change, message) -> None:
    fitted = fit(with_source(loop(folder=fmus, build="native"), fmus / "native" / "Manoeuvre.fmu"))
    manoeuvre = MANOEUVRES["tipin15"]
    points(replace(manoeuvre, T_driver=held(400, 1.0, 2.0)), fitted)
    with pytest.raises(UserError, match=message):
        points(replace(manoeuvre, **change), fitted)


@pytest.mark.parametrize(("count", "fits"), [(64, True), (65, False)])
def test_more_points_than_the_source_has_are_refused(fmus, tmp_path, capsys, count, fits) -> None:
    table = tmp_path / "zigzag.csv"
    rows = [f"{0.1 * k:.1f},{k % 2}" for k in range(count)]
    table.write_text("\n".join(["time [s],T_driver [N.m]", *rows]) + "\n")
    options = ["--manoeuvre", str(table)]
    if fits:
        assert main(["ssp", "--fmus", str(fmus), "--output", str(tmp_path / "out"), *options]) == 0
    else:
        message = refused(fmus, tmp_path / "out", capsys, *options)
        assert "zigzag: its lines have 65 points; other tools are given at most 64" in message


def test_a_package_of_another_loop_stays_without_replace(packaged, fmus, tmp_path, capsys) -> None:
    options = ["ssp", "--fmus", str(fmus), "--output", str(tmp_path), "--quiet"]
    assert main(options) == 0
    before = (tmp_path / "driveline.ssp").read_bytes()
    assert before == packaged().read_bytes(), "the same loop"
    turned = ["--plant", PLANTS[1], "--plant", PLANTS[0]]
    for other, what in ((["--manoeuvre", "launch"], ""), (turned, "plants: ")):
        assert main([*options, *other]) == 2
        assert f"is of another run ({what}" in capsys.readouterr().err
    assert (tmp_path / "driveline.ssp").read_bytes() == before
    assert main([*options, "--manoeuvre", "launch", "--replace"]) == 0
    assert (tmp_path / "driveline.ssp").read_bytes() != before
    assert {path.name for path in tmp_path.iterdir()} == {"driveline.ssp", "driveline.json"}


def test_the_project_of_mastersim_names_what_is_in_the_package(packaged) -> None:
    with zipfile.ZipFile(packaged()) as archive:
        projects = [name for name in archive.namelist() if name.endswith(".msim")]
        assert [Path(name).stem for name in projects] == list(PLANTS)
        for name in projects:
            text = archive.read(name).decode("ascii")
            fmus = [line.split('"')[1] for line in text.splitlines() if line.startswith("simulator")]
            assert {f"../../{entry}" for entry in archive.namelist()} >= set(fmus)
            assert len(fmus) == len(PLACES) + 1
            assert f"parameter plant.v_0 {MANOEUVRES['tipin15'].v_0!r}\n" in text
