"""Runs of the builds for FMI 3.0 are those of the builds for FMI 2.0."""

import fmpy
import numpy as np
import pytest
from fmutesting.slow import slow

from driveline.fmus.catalogue import FMUS
from fmublocks.block.types import ContinuousBlock
from fmublocks.description.variables import interface

CASES = [
    *(("CoSimulation", name) for name in FMUS),
    *(("ModelExchange", name) for name, fmu in FMUS.items() if isinstance(fmu.block, ContinuousBlock)),
]


@pytest.mark.parametrize(("kind", "name"), slow(CASES, but=CASES[:1] + CASES[-1:]))
def test_fmpy_gets_the_results_of_fmi_2(native, fmi3, kind, name):
    """Over two seconds with moving inputs, to the last bit; in model exchange by CVode."""
    paths = native / f"{name}.fmu", fmi3 / f"{name}.fmu"
    ours = interface(FMUS[name].block)
    time = np.arange(0.0, 2.0005, 1e-3)
    columns = {"time": time}
    for k, v in enumerate(ours):
        if v.causality == "input":
            wave = {"slope": 0.1}.get(v.name, 10.0) * np.sin(3.0 * time + k) + (v.name == "T_brake") * 10.0
            columns[v.name] = {"Real": wave, "Integer": np.arange(len(time)) % 7, "Boolean": time > 1.0}[v.fmi_type]
    inputs = np.rec.fromarrays([*columns.values()], names=[*columns])  # pyright: ignore[reportArgumentType]
    results = [
        fmpy.simulate_fmu(
            str(path),
            fmi_type=kind,
            stop_time=2.0,
            step_size=1e-3,
            output_interval=1e-3,
            input=inputs,
            record_events=False,
            output=[v.name for v in ours if v.causality == "output"],
        )
        for path in paths
    ]
    assert len(results[0]) == len(time)
    assert (results[0] == results[1]).all()
