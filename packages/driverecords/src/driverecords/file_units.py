"""Units in the file of a recording; its figures are in these units too."""

from typing import NamedTuple

from toolground.plain_text import printed


class FileUnit(NamedTuple):
    """The unit that a quantity has in a file.

    Attributes:
        unit: in the spelling of the file.
        factor: a value in that unit times the factor is what the recording has, in SI units.
        side: of what the value is, where the recording counts another way, as in "wheel side".
    """

    unit: str
    factor: float = 1.0
    side: str = ""

    @property
    def printed(self) -> str:
        """The unit as it is printed."""
        return printed(self.unit)

    def __str__(self) -> str:
        """What stands behind the name of the quantity."""
        return ", ".join(filter(None, (f"in {self.printed}", self.side)))
