"""What comes out of an isolated process is read as data, and not without end."""

import io

import pytest

from driveline.harness.cosimulation.process_answers import LENGTH, InvalidAnswer, receive


@pytest.mark.parametrize(("length", "error"), [(10**8, EOFError), (10**8 + 1, InvalidAnswer)])
def test_an_answer_that_is_longer_than_any_is_not_waited_for(length: int, error: type[Exception]) -> None:
    with pytest.raises(error):
        receive(io.BytesIO(LENGTH.pack(length)).read, lambda: 0)
