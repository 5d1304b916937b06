"""The C is a core, and an adapter of the standard around it: another version of the standard is another adapter."""

import re

from driveline.fmus.catalogue import FMUS
from driveline.fmus.native.packaging import c_sources
from tests.together import together

OF_FMI = {
    2: {
        *("fmi2.c", "fmi2_adapter.h", "fmi2_model_exchange.c"),
        *("fmi2Functions.h", "fmi2FunctionTypes.h", "fmi2TypesPlatform.h"),
    },
    3: {
        *("fmi3.c", "fmi3_instance.c", "fmi3_model_exchange.c", "fmi3_refused.c"),
        *("fmi3Functions.h", "fmi3FunctionTypes.h", "fmi3PlatformTypes.h"),
    },
}


@together("fmi", OF_FMI)
@together("name", FMUS)
def test_the_adapter_alone_knows_fmi(name, fmi):
    sources = c_sources(FMUS[name], fmi)
    assert {"run.c", "shared.h", "variables.h", "operators.h"} <= set(sources)
    assert sources.pop("all.c")
    knowing = {file for file, text in sources.items() if re.search(rb"fmi(?!n\()", text.lower())}  # fmin( is C's own
    assert knowing == (OF_FMI[fmi] & set(sources))
    assert OF_FMI[fmi] - knowing <= {f"fmi{fmi}_model_exchange.c"}
