"""What is declared of the quantities is complete and holds together."""

import math
from itertools import combinations
from typing import Annotated, Any, NamedTuple

import pytest

from driveline.models import two_mass_driveline, validation_vehicle
from fmublocks.block.declaration import Enumeration, Real, merged, variables
from fmublocks.block.types import Block
from tests.models.block.test_operators import BLOCKS, every_block


class Sample(NamedTuple):
    J_1: Annotated[float, Real("kg.m2", "inertia", 1e-4, 10.0)] = 0.055
    omega_1: Annotated[float, Real("rad/s", "speed")] = 0.0


class Other(NamedTuple):
    C: Annotated[float, Real("N.m/rad", "stiffness", 1.0, 1e5)] = 117.4
    J_1: Annotated[float, Real("kg.m2", "inertia", 1e-4, 10.0)] = 0.055


class OtherStart(NamedTuple):
    J_1: Annotated[float, Real("kg.m2", "inertia", 1e-4, 10.0)] = 0.06


class OtherBound(NamedTuple):
    J_1: Annotated[float, Real("kg.m2", "inertia", 1e-4, 20.0)] = 0.055


class Bare(NamedTuple):
    J_1: float = 0.055


def test_a_declaration_is_read_in_the_order_of_the_fields() -> None:
    first, second = variables(Sample)
    assert (first.name, first.start, first.declaration) == ("J_1", 0.055, Real("kg.m2", "inertia", 1e-4, 10.0))
    assert (second.name, second.start) == ("omega_1", 0.0)


def test_a_field_without_declaration_is_named() -> None:
    with pytest.raises(TypeError, match=r"Bare\.J_1"):
        variables(Bare)


def test_records_merge_into_one_with_each_name_once_in_their_order() -> None:
    made = merged("Both", Sample, Other)
    assert made.__name__ == "Both"
    assert made() == (0.055, 0.0, 117.4)
    assert made(C=2.0) == made(0.055, 0.0, 2.0)
    assert variables(made) == (*variables(Sample), variables(Other)[0])


@pytest.mark.parametrize("other", [OtherStart, OtherBound])
def test_records_that_mean_different_things_by_one_name_do_not_merge(other: Any) -> None:
    with pytest.raises(TypeError, match=rf"{other.__name__}\.J_1 is declared otherwise elsewhere"):
        merged("Both", Sample, other)


@every_block
def test_parameters_and_inputs_start_within_their_bounds(block: Block) -> None:
    for record in (block.Parameters, block.Input):
        for name, declaration, start in variables(record):
            assert start is not None, name
            if isinstance(declaration, Real):
                assert declaration.minimum <= start <= declaration.maximum, name
                assert math.isfinite(start), name


@pytest.mark.parametrize(("one", "other"), list(combinations(BLOCKS, 2)), ids=lambda block: block.name)
def test_blocks_agree_on_the_quantities_they_share(one: Block, other: Block) -> None:
    """Unit and start value of a parameter are the same wherever the same symbol stands."""
    theirs = {v.name: v for v in variables(other.Parameters)}
    for name, declaration, start in variables(one.Parameters):
        if name in theirs and isinstance(declaration, Real):
            same = theirs[name].declaration
            assert isinstance(same, Real), name
            assert (same.unit, theirs[name].start) == (declaration.unit, start), name


def test_both_plants_declare_their_shared_parameters_alike() -> None:
    """Start values and bounds, so that a parameter set for one plant is allowed for the other."""
    theirs = {v.name: v for v in variables(validation_vehicle.Parameters)}
    shared = [v for v in variables(two_mass_driveline.Parameters) if v.name in theirs]
    assert len(shared) > 15
    assert shared == [theirs[v.name] for v in shared]


@every_block
def test_an_enumeration_names_each_of_its_values(block: Block) -> None:
    started = block.output(block.start(block.Input(), block.Parameters()), block.Input(), block.Parameters())
    for name, declaration, _ in variables(block.Output):
        if isinstance(declaration, Enumeration):
            names = [item for item, _ in declaration.items]
            assert len(names) == len(set(names)) > 1
            assert 1 <= getattr(started, name) <= len(names)
