"""Equations as MathML, which browsers draw themselves."""

import html
import re

EQUATION = re.compile(r'<(span|div) class="arithmatex">\\[(\[](.*?)\\[)\]]</\1>', re.S)
"""As `pymdownx.arithmatex` leaves it in a page."""

DOT = re.compile(r"<mover>(?=<mi>[^<]*</mi><mo>&#x002D9;)")
"""What latex2mathml makes of a derivative with respect to time: without a word that the dot is an accent."""


def drawn(page: str) -> str:
    """A page of HTML with its equations in MathML."""
    return EQUATION.sub(_mathml, page)


def _mathml(found: re.Match) -> str:
    from latex2mathml.converter import convert  # type: ignore[import-not-found] (of the extra `site`)

    kind, latex = found.groups()
    mathml = convert(html.unescape(latex), display="block" if kind == "div" else "inline")
    accented = DOT.sub('<mover accent="true">', mathml)
    return f"<{kind}>{accented}</{kind}>"
