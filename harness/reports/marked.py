"""Pages that are written by hand but for the parts between their marks: `<!-- NAME, made by COMMAND -->`."""

import re
from collections.abc import Mapping

MARK = re.compile(r"(<!-- (\w+), made by [^>]* -->\n).*?(<!-- end -->)", re.DOTALL)


def filled(page: str, parts: Mapping[str, str]) -> str:
    """The page with its parts, by their names, made again.

    Raises:
        KeyError: the page has a part that is not among them.
    """
    return MARK.sub(lambda found: f"{found[1]}{parts[found[2]]}\n{found[3]}", page)
