"""What the README and the docstring of the package show runs as it stands there."""

from pathlib import Path

from fmutesting.readme import run_examples

README = Path(__file__).parents[1] / "README.md"


def test_the_examples_run(tmp_path: Path) -> None:
    rows = (f"{0.1 * k:.1f},{5.0 + 0.1 * k:.2f},{20 + k % 7}" for k in range(100))
    (tmp_path / "my_trip.csv").write_text("\n".join(["Time [s],Velocity [km/h],Motor Torque [Nm]", *rows]) + "\n")
    printed = run_examples("driverecords", README, tmp_path)
    assert "9.9 s, up to 4.1 m/s and 26 N.m" in printed
