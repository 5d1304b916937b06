"""What the isolated process answers to a question."""

from driveline.harness.cosimulation.process_host import _answer


def test_texts_are_answered_in_their_order_and_nothing_as_none() -> None:
    assert list(_answer(sorted, (["b", "a"],)).texts) == ["a", "b"]
    nothing = _answer(dict.clear, ({},))
    assert (list(nothing.texts), nothing.error) == ([], None)


def test_bytes_are_answered_as_they_are() -> None:
    answer = _answer(bytes, ([0, 97],))
    assert (bytes(answer.content), list(answer.texts)) == (b"\x00a", [])


def test_an_error_is_the_answer() -> None:
    assert isinstance(_answer(int, ("x",)).error, ValueError)
