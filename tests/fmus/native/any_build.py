"""Tests of the Python builds that every native build passes too; a module of it calls the folder of FMUs `built`."""

from tests.fmus.description.test_model_description import (  # noqa: F401
    descriptions,
    test_it_says_whose_it_is_and_of_which_release,
    test_the_validator_finds_nothing,
)
from tests.fmus.test_state import *  # noqa: F403
from tests.fmus.test_time import *  # noqa: F403
from tests.fmus.test_values import *  # noqa: F403
