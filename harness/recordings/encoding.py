"""Which characters the bytes of a text file are."""

import codecs

MARKS = ((codecs.BOM_UTF8, "utf-8-sig"), (codecs.BOM_UTF16_LE, "utf-16"), (codecs.BOM_UTF16_BE, "utf-16"))

LOOKED_AT = 1000
"""Bytes at the beginning that tell UTF-16 without a mark from the others: every other one of them is zero."""


def encoding_of(content: bytes) -> str:
    """UTF-8 or UTF-16, with or without the mark of either; Latin-1, in which every byte is a character, if neither."""
    for mark, name in MARKS:
        if content.startswith(mark):
            return name
    head = content[:LOOKED_AT]
    if len(head) > 1 and head.count(0) > len(head) // 3:
        return "utf-16-le" if head[1::2].count(0) > head[::2].count(0) else "utf-16-be"
    try:
        content.decode("utf-8")
    except UnicodeDecodeError:
        return "latin-1"
    return "utf-8"


def decoded(content: bytes) -> str:
    """The text, its lines ended by one line feed each.

    Raises:
        UnicodeDecodeError: it is damaged UTF-16.
    """
    return content.decode(encoding_of(content)).replace("\r\n", "\n").replace("\r", "\n")
