"""Pages that are written by hand but for the parts between their marks: `<!-- NAME, made by COMMAND -->`."""

import re
from collections.abc import Mapping

MARK = re.compile(r"(<!-- (\w+), made by [^>]* -->\n).*?(<!-- end -->)", re.DOTALL)


def filled(page: str, parts: Mapping[str, str]) -> str:
    """The page with these parts, by their names, made again; the others remain.

    Raises:
        KeyError: the page has no such part.
    """
    there = {found[2] for found in MARK.finditer(page)}
    if lacking := parts.keys() - there:
        raise KeyError(f"the page has no part {', '.join(sorted(lacking))}")
    return MARK.sub(lambda found: f"{found[1]}{parts[found[2]]}\n{found[3]}" if found[2] in parts else found[0], page)
