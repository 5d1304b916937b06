"""Tables in Markdown."""

from collections.abc import Iterable, Sequence


def markdown_table(headings: Sequence[str], rows: Iterable[Sequence[str]], labels: int) -> str:
    """A table whose first `labels` columns are words, the others numbers, which stand to the right."""
    ruler = ["---"] * labels + ["---:"] * (len(headings) - labels)
    return "\n".join(f"| {' | '.join(row)} |" for row in (headings, ruler, *rows))
