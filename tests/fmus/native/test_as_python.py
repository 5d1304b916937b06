"""The native builds pass the tests of the Python builds: a user cannot tell the two apart."""

import pytest

from tests.fmus.description.test_model_description import (  # noqa: F401
    test_every_quantity_has_unit_and_meaning_and_every_parameter_bounds,
    test_the_documentation_page_tells_of_every_variable,
    test_the_plants_have_the_same_inputs_and_outputs,
    test_value_references_count_inputs_outputs_and_parameters,
)
from tests.fmus.native.any_build import *  # noqa: F403
from tests.fmus.test_numbers import *  # noqa: F403


@pytest.fixture(scope="module")
def built(native):
    """What those tests call the folder of the FMUs."""
    return native
