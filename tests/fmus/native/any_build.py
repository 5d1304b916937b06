"""Tests of the Python builds that every native build passes too; a module of it calls the folder of FMUs `built`."""

from tests.fmus.description.test_model_description import (  # noqa: F401
    descriptions,
    test_it_tells_that_this_project_made_it,
    test_the_validator_finds_nothing,
)
from tests.fmus.test_state import (  # noqa: F401
    test_a_damaged_state_is_refused_and_changes_nothing,
    test_a_demand_that_is_on_its_way_through_the_dead_time_is_in_the_state,
    test_a_run_goes_on_bit_by_bit_after_set_and_after_deserialise,
    test_a_state_moves_to_another_instance_and_has_one_serialised_form,
    test_a_state_of_another_fmu_is_refused_and_both_are_named,
    test_a_state_saved_before_initialization_restores_that_mode,
)
from tests.fmus.test_time import (  # noqa: F401
    test_a_new_instance_shows_what_it_would_start_with,
    test_a_run_does_not_stop_before_its_start,
    test_a_run_ends_at_its_stop_time,
    test_a_sampled_block_does_not_depend_on_the_communication_step,
    test_a_step_from_another_time_is_refused,
    test_a_step_that_is_not_positive_or_too_long_is_refused,
    test_a_tick_within_a_thousandth_of_a_sample_is_at_the_end_of_the_step,
    test_an_input_that_is_fed_through_shows_before_the_step,
    test_any_finite_time_is_a_start_time,
    test_outputs_are_right_at_the_start_and_parameters_in_effect,
    test_outputs_change_with_time_alone,
    test_the_shortest_and_the_longest_step_are_allowed,
    test_the_stop_time_is_kept_in_a_saved_state_and_forgotten_by_a_reset,
    test_the_time_of_a_host_may_be_a_microsecond_off,
    test_time_counts_from_the_start_time,
)
from tests.fmus.test_values import *  # noqa: F403
