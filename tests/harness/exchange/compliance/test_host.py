"""What feeds an FMU for the rules of co-simulation."""

from types import SimpleNamespace
from typing import Any

import pytest

from driveline.harness.exchange.compliance.host import Host


def hosted(**experiment: str | None) -> Host:
    """An FMU without inputs, whose description proposes this; nothing if that is empty."""
    default = SimpleNamespace(**({"stepSize": None, "stopTime": None} | experiment)) if experiment else None
    description = SimpleNamespace(defaultExperiment=default)
    instance: Any = SimpleNamespace(
        interface=SimpleNamespace(description=description, rates={}, of_causality=lambda _: [])
    )
    return Host(instance)


@pytest.mark.parametrize(
    ("experiment", "step_size", "stop"),
    [
        ({}, 1e-3, 1.0),
        ({"stopTime": "5"}, 1e-3, 5.0),
        ({"stepSize": "0.02"}, 0.02, 1.0),
        ({"stepSize": "0.02", "stopTime": "5"}, 0.02, 5.0),
    ],
)
def test_the_steps_and_the_end_are_those_that_the_fmu_proposes(
    experiment: dict[str, str | None], step_size: float, stop: float
) -> None:
    host = hosted(**experiment)
    assert (host.step_size, host.stop) == (step_size, stop)
