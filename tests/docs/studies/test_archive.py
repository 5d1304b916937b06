"""The archive for whoever has no Python: what is in it, and that its results are in the form they must have."""

import zipfile
from io import BytesIO

import fmpy
import numpy as np
import pytest

from docs.studies.archive import LARGEST, NAME, archive
from driveline.fmus.catalogue import FMUS


@pytest.mark.slow
def test_an_fmu_of_the_archive_gives_the_results_beside_it(tmp_path, capsys) -> None:
    with zipfile.ZipFile(archive(tmp_path, "host")) as opened:
        content = {name.removeprefix(f"{NAME}/"): opened.read(name) for name in opened.namelist()}
    assert "missing input" not in capsys.readouterr().out
    assert {"README.md", "LICENSE.txt", "ssp/driveline.ssp"} <= content.keys()
    for name in FMUS:
        tables = [content[f"reference/{name}/{name}_{kind}.csv"] for kind in ("in", "ref")]
        assert all(len(table) <= LARGEST for table in tables)
        given, right = (np.genfromtxt(BytesIO(table), delimiter=",", names=True, deletechars='"') for table in tables)
        assert given["time"][-1] == right["time"][-1] == 2.0
        options = dict(line.split(", ") for line in content[f"reference/{name}/{name}_ref.opt"].decode().splitlines())
        assert (options["StopTime"], options["StepSize"]) == ("2.0", "0.001")
        assert {f"{folder}/{name}.fmu" for folder in ("fmi2", "fmi3")} <= content.keys()
    (tmp_path / "Plant.fmu").write_bytes(content["fmi3/TwoMassDriveline.fmu"])
    given, right = (
        np.genfromtxt(
            BytesIO(content[f"reference/TwoMassDriveline/TwoMassDriveline_{kind}.csv"]), delimiter=",", names=True
        )
        for kind in ("in", "ref")
    )
    found = fmpy.simulate_fmu(
        tmp_path / "Plant.fmu", stop_time=2.0, output_interval=1e-3, input=given, output=["T_gear"]
    )
    assert np.ptp(right["T_gear"]) > 10.0
    np.testing.assert_array_equal(found["T_gear"], right["T_gear"])
