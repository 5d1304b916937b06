"""Files with the parameters of a car and of its controller: what may stand in them, and where it goes."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import pytest
from fmutesting.together import together

from driveline.fmus.building.parameter_files import (
    MOST_PROBLEMS,
    OF_A_RUN,
    for_instances,
    read_files,
    read_parameters,
    read_vehicle,
    units,
)
from driveline.fmus.catalogue import FMUS
from driveline.fmus.errors import ParameterFileError
from driveline.fmus.names import COMPARATORS, RENAMED
from fmublocks.block.declaration import Integer, Real, variables
from fmublocks.fmu import Fmu
from tests import ROOT

EXAMPLES = sorted((ROOT / "examples" / "cars").glob("*.toml"))
PARAMETERS = {name: {v.name: v for v in variables(fmu.block.Parameters)} for name, fmu in FMUS.items()}


@pytest.fixture
def written(tmp_path: Path) -> Callable[[str], Path]:
    def write(text: str) -> Path:
        path = tmp_path / "car.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return write


def refusal(read: Callable[[Path], Any], path: Path) -> str:
    with pytest.raises(ParameterFileError) as found:
        read(path)
    return str(found.value)


def test_a_vehicle_file_names_what_belongs_to_the_car(written: Callable[[str], Path]) -> None:
    values = read_vehicle(written("\ufeff# mine\nJ_1 = 0.09  # kg.m2\nm = 2200\nT_cyc = 1e-2\nk_s = 3.0e4\n"))
    assert values == {"J_1": 0.09, "m": 2200.0, "T_cyc": 0.01, "k_s": 3e4}
    bounds = {"m": 300.0, "phi_B": 0.0, "J_1": 10.0}
    assert read_vehicle(written("m = 300\nphi_B = 0\nJ_1 = 10\n")) == bounds, "are allowed themselves"
    assert all(type(value) is float for value in values.values())


@pytest.mark.parametrize("text", ["d_min = 0.026", "d_min = 0.03\nd_max = 0.029"])
def test_the_shortest_delay_is_not_longer_than_the_longest(written: Callable[[str], Path], text: str) -> None:
    assert " s is longer than d_max = " in refusal(read_vehicle, written(text))
    assert read_vehicle(written("d_min = 0.025")) == {"d_min": 0.025}


def test_a_file_of_gains_names_what_is_set_in_the_controller(written: Callable[[str], Path]) -> None:
    assert read_parameters(written("k_d = 2.5\nT_take_max = 40\n")) == {"k_d": 2.5, "T_take_max": 40.0}
    stored = read_parameters(ROOT / "models" / "controller" / "gains.toml")
    assert {name: PARAMETERS["DampingController"][name].start for name in stored} == stored


@pytest.mark.slow
def test_every_parameter_belongs_into_one_of_the_files_or_to_a_run(written: Callable[[str], Path]) -> None:
    for name in {name for owned in PARAMETERS.values() for name in owned}:
        start = next(owned[name].start for owned in PARAMETERS.values() if name in owned)
        path = written(f"{name} = {str(start).lower()}\n")
        read = []
        for reader in (read_vehicle, read_parameters):
            try:
                read.append(reader(path))
            except ParameterFileError as error:
                assert f"{name} does not belong here" in str(error)  # noqa: PT017 (either may refuse)
        assert read == ([] if name in OF_A_RUN else [{name: start}]), name


@together(
    "entry, message",
    [
        ("J1 = 0.09", "J1 is not known; did you mean J_1"),
        ("hat = 3", "hat is not known"),
        ("mass = 1200.0", "mass is not known; did you mean m?"),
        ("wheel_radius = 0.3", "wheel_radius is not known; did you mean r?"),
        ("rad = 0.3", "rad is not known; did you mean r?"),
        ("th = 0.3", "th is not known; did you mean k_th or h or d_th?"),
        ("torque = 300.0", "torque is not known; did you mean T_max?"),
        ("max_torque = 300.0", "max_torque is not known; did you mean T_max?"),
        ("tyre_radius = 0.3", "tyre_radius is not known; did you mean r?"),
        ("gear_ratio = 9.0", "gear_ratio is not known; did you mean i?"),
        ("curb_weight = 1887", "curb_weight is not known; did you mean m?"),
        ("rotor_inertia = 0.05", "rotor_inertia is not known; did you mean J_1"),
        ("rotor = 0.05", "rotor is not known; did you mean J_1"),
        ("m = '1887 1/min'", "m = '1887 1/min': it is in 1/min, which does not convert into kg"),
        ("inertia = 0.3", "inertia is not known; did you mean J_1 or J_2 or J_w?"),
        ("J_1 = '0.09'", 'J_1 = "0.09": a number in kg.m2 stands without quotes'),
        ("J_1 = true", "J_1 = True: it must be a finite number"),
        ("J_1 = [0.09]", "J_1 = [0.09]: it must be a finite number"),
        ("J_1 = nan", "J_1 = nan: it must be a finite number"),
        ("J_1 = -inf", "J_1 = -inf: it must be a finite number"),
        ("m = 299.9", "m = 299.9: TwoMassDriveline takes 300 to 40000 kg"),
        ("m = 40001", "m = 40001: TwoMassDriveline takes 300 to 40000 kg"),
        ("T_max = 0.5", "T_max = 0.5: MotorTorqueLoop takes 1 to 2000 N.m"),
        ("i = 0.99", "i = 0.99: TwoMassDriveline takes 1 to 30"),
        ("v_0 = 3.0", "v_0 does not belong here: the manoeuvre sets it"),
        ("seed = 3", "seed does not belong here: --seed sets it for a run"),
        ("k_d = 2.0", "k_d does not belong here: it is one of the controller, for the file of --parameters"),
        ("[plant]\nJ_1 = 0.09", "plant is a table; an entry stands alone, for all that have it: J_1 = 0.09"),
        ("plant.J_1 = 0.09", "plant is a table"),
        ("gap = 2.5", 'gap = 2.5: a vehicle file takes 0 to 0.2 rad; "2.5 deg" is in degrees'),
        ("frequency = 30.0", "frequency = 30 Hz, C = 117.4 N.m/rad: leave one out"),
    ],
)
def test_what_does_not_belong_in_a_vehicle_file_is_named_with_its_line(
    written: Callable[[str], Path], entry: str, message: str
) -> None:
    path = written(f"# a car\nC = 117.4\n\n{entry}\n")
    assert refusal(read_vehicle, path).startswith(f"{path}, line 4: {message}")


def test_what_belongs_to_the_car_is_no_parameter_of_the_controller(written: Callable[[str], Path]) -> None:
    path = written("k_d = 2.5\nJ_1 = 0.09\n")
    expected = f"{path}, line 2: J_1 does not belong here: it is one of the car, for the file of --vehicle"
    assert refusal(read_parameters, path) == expected


def test_all_that_is_wrong_is_said_at_once(written: Callable[[str], Path]) -> None:
    lines = refusal(read_vehicle, written("J1 = 1\nJ_2 = 0.3\n  'C' = 0\n")).splitlines()
    assert [line.partition(", ")[2].partition(":")[0] for line in lines] == ["line 1", "line 3"]


@together("text", ["J_1 = 0.09\nJ_1 = 0.1\n", "J_1 0.09\n", "J_1 =\n"])
def test_what_is_no_toml_is_said_with_its_line(written: Callable[[str], Path], text: str) -> None:
    message = refusal(read_vehicle, written(text))
    assert "not TOML: " in message
    assert "line" in message


def test_a_file_that_is_absent_or_no_text_is_named(tmp_path: Path) -> None:
    assert refusal(read_vehicle, tmp_path / "car.toml") == f"{tmp_path / 'car.toml'}: there is no such file"
    (tmp_path / "car.toml").write_bytes(b"\xff\xfe")
    assert "not TOML: " in refusal(read_vehicle, tmp_path / "car.toml")


def test_a_file_is_no_more_than_anybody_writes(written: Callable[[str], Path]) -> None:
    path = written(f"J_1 = {'[' * 990}\n")
    assert refusal(read_vehicle, path) == f"{path}: line 1 has brackets in brackets, more than 10 deep"
    assert refusal(read_vehicle, written(f"m = 1{400 * '0'}")).endswith("... has more than 300 digits")
    assert refusal(read_vehicle, Path("/dev/null")) == "/dev/null: it is no regular file"


def test_a_refusal_has_no_more_lines_than_somebody_reads(written: Callable[[str], Path]) -> None:
    lines = refusal(read_vehicle, written("".join(f"a{k} = 1\n" for k in range(1000)))).splitlines()
    assert len(lines) == MOST_PROBLEMS + 1
    assert lines[-1].endswith("there may be more")


def test_a_name_is_shown_in_one_line(written: Callable[[str], Path]) -> None:
    assert refusal(read_vehicle, written('"a\\u001bb\\n" = 1')).endswith(r"line 1: 'a\x1bb\n' is not known")
    assert len(refusal(read_vehicle, written(f"{'a' * 900} = 1"))) < 300


def test_all_blocks_that_have_a_parameter_must_allow_it(written: Callable[[str], Path]) -> None:
    class Narrow(NamedTuple):
        J_1: Annotated[float, Real("kg.m2", "inertia", 0.05, 0.06)] = 0.055
        gears: Annotated[int, Integer("number of gears", 1, 6)] = 1

    own = Fmu(replace(FMUS["TwoMassDriveline"].block, name="Mine", Parameters=Narrow), stop_time=1.0)
    path = written("J_1 = 0.07\n")
    assert read_vehicle(path) == {"J_1": 0.07}
    with pytest.raises(ParameterFileError, match=r"J_1 = 0\.07: Mine takes 0\.05 to 0\.06 kg\.m2"):
        read_vehicle(path, [own])
    assert read_vehicle(written("gears = 2\n"), [own]) == {"gears": 2}
    with pytest.raises(ParameterFileError, match=r"gears = 2\.0: it must be a whole number"):
        read_vehicle(written("gears = 2.0\n"), [own])


def test_parameters_of_somebody_elses_fmu_are_taken_as_they_are(written: Callable[[str], Path]) -> None:
    path = written("shaft = 3\nJ_1 = 0.09\n")
    assert read_vehicle(path, others={"shaft"}) == {"shaft": 3.0, "J_1": 0.09}
    assert "shaft is not known" in refusal(read_vehicle, path)


def test_an_entry_goes_to_every_instance_that_has_the_name() -> None:
    instances = {"plant": {"i", "m", "r"}, "can": {"i", "r"}, "controller": {"k_d"}}
    placed = for_instances({"i": 10.5, "m": 2200.0, "k_d": 4.0, "k_s": 3e4}, instances)
    assert placed == {"plant.i": 10.5, "plant.m": 2200.0, "can.i": 10.5, "controller.k_d": 4.0}


def test_either_file_may_be_absent(written: Callable[[str], Path]) -> None:
    assert read_files(None, None) == {}
    assert read_files(written("J_1 = 0.09"), None) == {"J_1": 0.09}
    assert read_files(None, written("k_d = 3")) == {"k_d": 3.0}


def test_the_unit_of_an_entry_is_the_declared_one() -> None:
    assert {name: units()[name] for name in ("J_1", "i", "T_cyc")} == {"J_1": "kg.m2", "i": "1", "T_cyc": "s"}
    assert "seed" not in units()


@together("path", EXAMPLES)
def test_an_example_names_the_whole_car_or_is_the_data_sheet_of_one(path: Path) -> None:
    """With the source of each entry."""
    values, text = read_vehicle(path), path.read_text(encoding="utf-8")
    if "is not public" in text:
        assert {"m", "r", "i", "T_max", "L_w", "c_wa"} <= values.keys()
        assert text.count("#") > 2 * len(values)
        return
    assert {"J_1", "J_2", "C", "phi_B", "i", "r", "m", "tau", "T_max", "T_cyc", "d_min", "d_max"} <= values.keys()
    assert {"J_w", "J_g", "J_p", "F_z0", "J_y", "m_h", "c_slip"} <= values.keys()


@pytest.mark.parametrize(("old", "new"), [pair for pair in RENAMED.items() if pair[1] not in COMPARATORS])
def test_a_parameter_that_was_renamed_is_refused_with_its_new_name(old: str, new: str, tmp_path: Path) -> None:
    (tmp_path / "gains.toml").write_text(f"{old} = 0.5\n", encoding="utf-8")
    with pytest.raises(ParameterFileError, match=f"{old} is not known; it is called {new} now"):
        read_parameters(tmp_path / "gains.toml")
