"""How texts and bytes are damaged."""

from random import Random

ODD = (
    *("", " ", "a" * 300, "\0", "\u202e", "é", "../../x", "/etc/passwd", "true", "x", "None", "--", "-", "=", "1,5"),
    *("nan", "inf", "-inf", "1e300", "1e-320", "1e999", "-1", "0", "0.5", "2147483648", "9" * 20, "0x10"),
)
"""What stands where a number, a name or a path is expected."""


def spoiled_text(text: str, random: Random) -> str:
    """The text with one piece left out, doubled, moved or replaced."""
    first, last = sorted(random.randrange(len(text) + 1) for _ in range(2))
    last = min(last, first + random.choice((1, 3, 30, 300)))
    piece = text[first:last]
    new = random.choice(("", 2 * piece, piece[::-1], random.choice(ODD), random.choice(',;"\n\r\t<>&[]')))
    return text[:first] + new + text[last:]


def spoiled_bytes(content: bytes, random: Random) -> bytes:
    """The bytes with some changed, left out or added."""
    place = random.randrange(len(content) + 1)
    size = random.choice((1, 4, 100))
    new = random.choice((b"", random.randbytes(size), bytes(size), content[place : place + size] * 2))
    return content[:place] + new + content[place + random.choice((0, size)) :]
