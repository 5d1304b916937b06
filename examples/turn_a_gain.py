"""Turns the damping of a running controller, as a calibration engineer does at the bench, and compares three runs:

    driveline build
    python examples/turn_a_gain.py

The same on the command line: driveline simulate --manoeuvre drive --set controller.k_d@2.0=1.5 --set controller.k_d@5=4
"""

from typing import Any

import driveline

DRIVE = driveline.MANOEUVRES["drive"]

RUNS = {
    "as designed": {},
    "turned once": {"controller.k_d@2.0": 1.5},
    "and back up": {"controller.k_d@2.0": 1.5, "controller.k_d@5.0": 4.0},
}
"""Parameters of each run: `instance.parameter@t` has its value from t s on; without a time from the start."""


def compared(**settings: Any) -> dict[str, tuple[float, float]]:
    """Of each run the largest gear torque in N.m, and how far T_ref comes away from that of the first."""
    found = {}
    reference = driveline.simulate(DRIVE, **settings)
    for name, parameters in RUNS.items():
        results = driveline.simulate(DRIVE, parameters=parameters, **settings)
        away = abs(results["controller.T_ref"] - reference["controller.T_ref"]).max()
        found[name] = float(abs(results["plant.T_gear"]).max()), float(away)
    return found


if __name__ == "__main__":
    for run, (torque, distance) in compared().items():
        print(f"{run:12} gear torque up to {torque:6.1f} N.m, T_ref up to {distance:5.1f} N.m away")
