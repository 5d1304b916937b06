"""Pages keep what is written by hand, and the parts that are not made again."""

import pytest

from docs.studies.generated_sections import filled

PAGE = """By hand.
<!-- one, made by a command -->
old
<!-- end -->
Between.
<!-- two, made by a command -->
old too
<!-- end -->
"""


def test_the_parts_that_are_given_are_made_again_and_the_others_remain() -> None:
    assert filled(PAGE, {"one": "new\nlines"}) == PAGE.replace("old\n<", "new\nlines\n<", 1)
    assert filled(PAGE, {}) == PAGE


def test_a_part_that_the_page_does_not_have_is_refused() -> None:
    with pytest.raises(KeyError, match="the page has no part three"):
        filled(PAGE, {"one": "new", "three": "new"})
