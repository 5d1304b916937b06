"""Small blocks become FMUs of each kind, whose runs are those of their equations."""

import subprocess
from math import cos
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest
from fmutesting.blocks import FOLDER

from fmublocks.cli import main
from fmublocks.native.compiler import host_compiler
from fmublocks.own_file import fmu_in

BUILDS = ("PiController.fmu", "native/PiController.fmu", "fmi3/PiController.fmu")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory, native_builder: object) -> Path:
    """With both builds of FMI 2.0, and those of FMI 3.0 in fmi3."""
    folder = tmp_path_factory.mktemp("built")
    files = [str(FOLDER / f"{name}.py") for name in ("pi_controller", "lag", "oscillator")]
    for more in (["--build", "both"], ["--fmi", "3"]):
        assert main(["build", *files, "--output", str(folder), *more]) == 0
    return folder


def run_of(path: Path, kind: str, stop_time: float, signals: Any = None) -> np.ndarray:
    """What fmpy, which knows nothing of this package, makes of an FMU."""
    steps: dict[str, Any] = {"stop_time": stop_time, "output_interval": 0.01, "relative_tolerance": 1e-9}
    return fmpy.simulate_fmu(str(path), fmi_type=kind, input=signals, **steps)


def test_each_build_of_a_pi_controller_gives_the_numbers_of_its_equations(folder: Path) -> None:
    names = [("time", float), ("r", float), ("y", float)]
    signals = np.array([(0.01 * k, 1.0, 0.9 * (k > 40)) for k in range(102)], dtype=names)
    block: Any = fmu_in(FOLDER / "pi_controller.py").block
    p, x, expected = block.Parameters(), block.start(block.Input(), block.Parameters()), []
    for _, r, y in signals[:101].tolist():
        expected.append(block.output(x, block.Input(r, y), p).u)
        x = block.update(x, block.Input(r, y), p)
    for build in BUILDS:
        control = run_of(folder / build, "CoSimulation", 1.0, signals)["u"]
        np.testing.assert_array_equal(control[:40], expected[:40], build)


@pytest.mark.parametrize("kind", ["CoSimulation", "ModelExchange"])
@pytest.mark.parametrize("build", ["native", "fmi3"])
def test_an_oscillator_swings_as_its_exact_solution(folder: Path, build: str, kind: str) -> None:
    signals = run_of(folder / build / "Oscillator.fmu", kind, 2.0)
    assert signals["x"][-1] == pytest.approx(cos(12.0), abs=1e-6)  # of the tolerance, over two swings


def test_a_python_build_swings_like_the_native_one_to_the_last_bit(folder: Path) -> None:
    python, native = (
        run_of(folder / name, "CoSimulation", 0.5) for name in ("Oscillator.fmu", "native/Oscillator.fmu")
    )
    np.testing.assert_array_equal(python["x"], native["x"])


def test_the_c_of_a_controller_compiles_without_fmi_and_a_lag_has_none(tmp_path: Path, capsys) -> None:
    assert main(["c", str(FOLDER / "pi_controller.py"), "--output", str(tmp_path)]) == 0
    command = [host_compiler(), "-std=c99", "-Wall", "-Werror", "-c", "pi_controller.c"]
    subprocess.run(command, cwd=tmp_path, check=True)
    assert main(["c", str(FOLDER / "lag.py"), "--output", str(tmp_path)]) == 2
    assert "Lag is a continuous block" in capsys.readouterr().err


RUN = """
const code = new WebAssembly.Module(require("fs").readFileSync(process.argv[1]));
if (WebAssembly.Module.imports(code).length) throw "it imports";
const { memory, malloc, instantiate, last_message, ...fmi } = new WebAssembly.Instance(code, {}).exports;
const text = (words) => {
  const bytes = new TextEncoder().encode(words + "\\0"), at = malloc(bytes.length);
  new Uint8Array(memory.buffer).set(bytes, at);
  return at;
};
fmi._initialize();
const lag = instantiate(text("lag"), text(process.argv[2]), 0);
if (!lag) throw "no instance";
const number = malloc(8), reference = malloc(4), value = () => new DataView(memory.buffer);
const check = (status) => { if (status) throw "refused"; };
check(fmi.fmi2SetupExperiment(lag, 0, 0, 0, 0, 0));
check(fmi.fmi2EnterInitializationMode(lag));
value().setUint32(reference, 0, true), value().setFloat64(number, 1, true);
check(fmi.fmi2SetReal(lag, reference, 1, number));
check(fmi.fmi2ExitInitializationMode(lag));
for (let k = 0; k < 50; k++) check(fmi.fmi2DoStep(lag, 0.01 * k, 0.01, 1));
value().setUint32(reference, Number(process.argv[3]), true);
check(fmi.fmi2GetReal(lag, reference, 1, number));
console.log(value().getFloat64(number, true));
"""


@pytest.mark.slow
def test_a_module_of_webassembly_runs_in_node_and_needs_nothing(folder: Path, tmp_path: Path) -> None:
    pytest.importorskip("ziglang", reason="no Zig here: pip install ziglang")
    if subprocess.run(["sh", "-c", "command -v node"], capture_output=True, check=False).returncode:
        pytest.skip("no Node here: apt-get install nodejs")
    assert main(["wasm", str(FOLDER / "lag.py"), "--output", str(tmp_path)]) == 0
    description: Any = fmpy.read_model_description(str(folder / "native/Lag.fmu"))
    (output,) = (v.valueReference for v in description.modelVariables if v.causality == "output")
    command = ["node", "-e", RUN, str(tmp_path / "Lag.wasm"), description.guid, str(output)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert float(done.stdout) == pytest.approx(1.0 - np.exp(-1.0), abs=1e-6)


@pytest.mark.parametrize(
    ("text", "words", "error"),
    [
        (None, [], "there is no file own_block.py"),
        ("x = 1", [], "has no line `FMU = Fmu(BLOCK, stop_time=10.0)`"),
        ("1/0", [], "own_block.py, line 1: it cannot be run: ZeroDivisionError"),
        ("x = 1", ["--bild", "native"], "unknown option --bild; did you mean --build?"),
        ("x = 1", ["--fmi", "4"], "--fmi: 4 is unknown"),
    ],
)
def test_a_mistake_is_answered_in_one_line(tmp_path: Path, monkeypatch, capsys, text, words, error) -> None:
    monkeypatch.chdir(tmp_path)
    if text:
        Path("own_block.py").write_text(text)
    try:
        code: Any = main(["build", "own_block.py", *words])
    except SystemExit as end:
        code = end.code
    said = capsys.readouterr().err
    assert code == 2
    assert error in said.splitlines()[0]
    assert not Path("build").exists()
