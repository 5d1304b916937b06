"""The C is a core, and an adapter of the standard around it: another version of the standard is another adapter."""

import re

import pytest

pytest.importorskip("casadi", reason="the extra `native` is not installed")

from driveline.fmus.catalogue import FMUS
from driveline.fmus.native.packaging import c_sources


@pytest.mark.parametrize("name", FMUS)
def test_the_adapter_alone_knows_fmi(name):
    sources = c_sources(FMUS[name])
    assert {"run.c", "shared.h", "variables.h", "operators.h"} <= set(sources)
    assert sources.pop("all.c")
    knowing = {file for file, text in sources.items() if re.search(rb"fmi(?!n\()", text.lower())}  # fmin( is C's own
    adapter = {file for file in sources if file.startswith("fmi2")}
    assert knowing == adapter >= {"fmi2.c", "fmi2_adapter.h", "fmi2Functions.h"}
