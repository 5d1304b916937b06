"""How the Python build refuses a call."""

from typing import Any


class Refused(Exception):
    """A call that changes nothing; the text is what the host logs (the binary takes the repr)."""

    def __init__(self, sentence: str, **fields: Any) -> None:
        """With a sentence of ..protocol and what goes into its fields."""
        super().__init__(sentence.format(**fields))

    def __repr__(self) -> str:
        return str(self)
