"""Whether FMUs fit together is known before the run: the two plants do, foreign ones are told why not."""

import math
import re
from dataclasses import replace

import pytest
from fmutesting.foreign import tampered

from driveline.harness.loop.places import PLANTS
from driveline.harness.loop.settings import chosen_build, loop
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.simulate import simulate
from fmuloop import unpacked_fmu
from fmuloop.errors import LONGEST_LINE, WiringError
from fmuloop.experiment import Experiment
from fmuloop.interface import Interface, unit_of
from fmuloop.runs import run
from fmuloop.system import Connection, System
from fmuloop.wiring import fit, out_of_bounds

SHORT = replace(MANOEUVRES["tipin15"], duration=0.2)


@pytest.fixture(autouse=True)
def nothing_is_unpacked(request, monkeypatch):
    """Whatever is wrong is found before any FMU is unpacked."""
    if "runs" not in request.node.name:
        monkeypatch.setattr(unpacked_fmu, "unpack", lambda *_: pytest.fail("an FMU was unpacked"))


def face(path):
    """Everything that a tool sees of the inputs and outputs of an FMU."""
    return [
        (v.name, v.type, unit_of(v), v.causality, v.variability, v.valueReference, v.description)
        for v in Interface(path).variables.values()
        if v.causality in ("input", "output")
    ]


def test_parameters_and_their_bounds_are_those_of_the_fmu_in_the_units_of_the_loop(native):
    fitted = fit(loop("TwoMassDriveline", folder=native.parent, build="native"))
    found = fitted.parameters({"plant.J_1": 0.07})
    assert found["plant"]["J_1"] == 0.07
    assert found["plant"]["C"] == float(Interface(native / "TwoMassDriveline.fmu").variables["C"].start or "nan")
    assert found.keys() == {"plant", "motor", "can", "controller"}
    fitted = fit(loop("TwoMassDriveline", folder=native.parent, build="native"))
    bounds = 0.001, 10.0
    assert list(out_of_bounds(fitted, {"plant.J_1": bounds[0], "plant.C": 1e3, "plant.unknown": 7.0})) == []
    for value in (math.nextafter(bounds[0], 0.0), math.nextafter(bounds[1], 11.0)):
        assert len(list(out_of_bounds(fitted, {"plant.J_1": value}))) == 1
    fitted.interfaces["plant"].factors["J_1"] = 0.1
    assert list(out_of_bounds(fitted, {"plant.J_1": 0.0001})) == []
    assert list(out_of_bounds(fitted, {"plant.J_1": 1.1})) == [
        "plant.J_1 = 1.1: TwoMassDriveline.fmu takes 0.0001 to 1 kg.m2"
    ]


def test_plants_have_one_interface_and_one_from_elsewhere_runs_in_the_loop(built, tmp_path):
    design, validation = (face(built / f"{plant}.fmu") for plant in PLANTS)
    assert design == validation
    assert len(design) > 10
    plant = theirs(built, tmp_path, lambda xml: xml + "\n")
    assert (simulate(SHORT, plant, folder=built) == simulate(SHORT, PLANTS[0], folder=built)).all()


def test_native_builds_run_where_the_whole_loop_has_them(tmp_path):
    folder = tmp_path / "native"
    folder.mkdir()
    for name in ("MotorTorqueLoop", "DampingController", "WheelSpeedCan", PLANTS[0]):
        assert chosen_build(PLANTS[0], folder=tmp_path) == "python"
        (folder / f"{name}.fmu").touch()
    for plant, build, parent in (
        (PLANTS[0], None, folder),
        (PLANTS[1], None, tmp_path),
        (PLANTS[0], "python", tmp_path),
        (PLANTS[1], "native", folder),
    ):
        assert {path.parent for path in loop(plant, folder=tmp_path, build=build).instances.values()} == {parent}
    theirs = folder / f"{PLANTS[0]}.fmu"
    assert loop(theirs, folder=tmp_path).instances["plant"] == theirs
    with pytest.raises(WiringError, match="unknown build nativ; did you mean native"):
        loop(PLANTS[0], folder=tmp_path, build="nativ")


def theirs(built, folder, change, block=PLANTS[0]):
    """One of our FMUs with another description."""
    return tampered(built / f"{block}.fmu", folder / "theirs.fmu", change)


def refused(built, *plant, **options):
    with pytest.raises(WiringError) as error:
        simulate(SHORT, *plant, folder=built, **options)
    return str(error.value)


@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        ('name="omega_1"', 'name="omega1"', "no output omega_1; did you mean omega1"),
        ('name="T_mot"', 'name="T_motor"', "no input T_mot; did you mean T_motor"),
        ('name="T_gear"', 'name="gear"', "no output T_gear"),
        ('name="v_0"', 'name="v0"', "no parameter v_0; did you mean v0"),
        ('name="slope"', 'name="grade"', "no input slope; known are: T_mot, T_brake, grade"),
    ],
)
def test_a_misnamed_variable_is_named(built, tmp_path, old, new, complaint):
    assert complaint in refused(built, theirs(built, tmp_path, lambda xml: xml.replace(old, new, 1)))


def test_a_name_that_two_variables_have_and_a_text_are_refused(built, tmp_path):
    twins = theirs(built, tmp_path, lambda xml: xml.replace('name="J_1"', 'name="J_2"', 1))
    expected = "plant: theirs.fmu has 2 variables of the name J_2"
    assert refused(built, twins, parameters={"plant.J_2": 0.3}) == expected

    def change(xml):
        return re.sub(r'(name="(?:enable|k_d)"[^>]*>\s*)<\w+[^>]*/>', r'\1<String start="x"/>', xml)

    controller = theirs(built, tmp_path, change, "DampingController")
    assert refused(built, controller=controller, parameters={"controller.k_d": 2.0}).splitlines() == [
        f"controller.{name} is a String; only numbers and truth values can be set" for name in ("enable", "k_d")
    ]


def in_unit(name, old, new):
    """Change of a model description: the variable has another unit."""

    def change(xml):
        before, _, after = xml.partition(f'name="{name}"')
        return before + f'name="{name}"' + after.replace(f'unit="{old}"', f'unit="{new}"', 1)

    return change


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [("omega_1", "rad/s", "Hz"), ("T_mot", "N.m", "N.m/rad"), ("slope", "rad", "m"), ("v_0", "m/s", "m")],
)
def test_a_unit_that_does_not_convert_is_named(built, tmp_path, name, old, new):
    complaint = f"plant.{name} is in {new}, which does not convert into {old} (theirs.fmu)"
    assert complaint in refused(built, theirs(built, tmp_path, in_unit(name, old, new)))


@pytest.mark.parametrize("unit", ["Nm", "N m", "N-m", "N*m", "N·m"])
def test_other_spellings_of_a_unit_are_that_unit(built, tmp_path, unit):
    plant = theirs(built, tmp_path, in_unit("T_mot", "N.m", unit))
    assert fit(loop(plant, folder=built)).interfaces["plant"].factors.get("T_mot", 1.0) == 1.0


def test_what_an_fmu_says_at_length_is_repeated_in_short_and_printable(built, tmp_path):
    """And the end of the sentence goes with it: what follows is not the FMU's to say."""

    def change(xml):
        return xml.replace('name="T_mot"', f'name="{"T_mot&#x202e;&#10;" * 2000}"', 1)

    lines = refused(built, theirs(built, tmp_path, change)).split("\n")
    assert all(line.isprintable() and line.startswith(("plant.", "`driveline map ")) for line in lines)
    assert max(map(len, lines)) < LONGEST_LINE + 50


@pytest.mark.parametrize("own", ["N&#10;&#10;m", "m." * 3000 + "m"])
def test_a_problem_is_one_line_whatever_the_unit_of_an_fmu_is(built, tmp_path, own):
    plant = theirs(built, tmp_path, in_unit("T_mot", "N.m", own))
    for mapping in ({}, {"plant.T_mot": "T_mot"}):
        (line,) = [text for text in refused(built, plant, mapping=mapping).split("\n") if "T_gear" not in text]
        assert line.startswith(("plant.T_mot is in ", "plant.T_mot=T_mot: in theirs.fmu T_mot is in "))
        assert "which is not a known unit (known are those such as N.m/rad)" in line


def test_everything_that_is_wrong_is_named_at_once_with_the_nearest(built, tmp_path):
    def change(xml):
        for old, new in (("v_0", "v0"), ("pitch", "omega_3"), ("omega_2", "speed")):
            xml = xml.replace(f'name="{old}"', f'name="{new}"')
        return xml

    *problems, advice = refused(built, theirs(built, tmp_path, change)).splitlines()
    assert (len(problems), advice.split()[:2]) == (2, ["`driveline", "map"])
    for parameters, complaint in (
        ({"plant.J1": 0.06}, "no parameter J1; did you mean J_1"),
        ({"plat.J_1": 0.06}, "no instance plat; did you mean plant"),
        ({"plant.T_mot": 1.0}, "T_mot is of causality input; it must be parameter"),
    ):
        assert complaint in refused(built, parameters=parameters)
    with pytest.raises(WiringError, match="did you mean ValidationVehicle"):
        loop("ValidationVehicel")


def test_types_and_causality_must_suit_and_an_input_is_fed_once(built):
    can, controller = built / "WheelSpeedCan.fmu", built / "DampingController.fmu"
    for source, target, complaint in (
        ("can.counter", "controller.omega_2_can", "can.counter is Integer, but .* is Real"),
        ("can.valid", "controller.counter", "can.valid is Boolean, but .* is Integer"),
        ("can.omega_wheel_L", "controller.omega_2_can", "of causality input; it must be output"),
    ):
        with pytest.raises(WiringError, match=complaint):
            run(System({"can": can, "controller": controller}, (Connection(source, target),)), Experiment(1.0))
    system = System({"motor": built / "MotorTorqueLoop.fmu"}, (Connection("motor.T_mot", "motor.T_ref"),))
    with pytest.raises(WiringError, match=r"motor\.T_ref is fed more than once"):
        run(system, Experiment(1.0, inputs={"motor.T_ref": 5.0}))


def test_what_is_no_fmu_is_refused(built, tmp_path):
    text = tmp_path / "text.fmu"
    text.write_text("no archive")
    for path, complaint in ((tmp_path / "none.fmu", "there is no FMU"), (text, "not an FMU")):
        assert complaint in refused(built, path)
    exchange = theirs(built, tmp_path, lambda xml: xml.replace('fmiVersion="2.0"', 'fmiVersion="3.0"'))
    assert "theirs.fmu" in refused(built, exchange)
