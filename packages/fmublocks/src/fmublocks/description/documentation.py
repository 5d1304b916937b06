"""documentation/index.html of an FMU: what the block is, its equations and its variables."""

import io
import textwrap
from collections.abc import Iterator
from functools import cache
from html import escape
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

from PIL import Image, ImageDraw, ImageFont

from ..block.declaration import Enumeration
from ..block.types import Block, ContinuousBlock
from ..fmu import Fmu
from .build_kind import BuildKind
from .variables import Variable, interface

PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<title>{name}</title>
<style>
body {{ font: 16px/1.5 sans-serif; max-width: 60em; margin: 2em auto; padding: 0 1em; color: #222 }}
pre {{ background: #f4f4f4; padding: 1em; overflow-x: auto; line-height: 1.35 }}
table {{ border-collapse: collapse; margin: 1em 0 }}
th, td {{ text-align: left; padding: .25em 1em .25em 0; border-bottom: 1px solid #ddd; vertical-align: top }}
</style>
</head>
<body>
<h1>{name}</h1>
<p>{description}.</p>
<p><img src="../{picture}" alt="inputs and outputs of {name}"></p>
{equations}
{tables}
<h2>How it runs</h2>
<p>{timing} {inputs} A parameter may be changed until initialization
mode is left, and outputs are right from then on; a tunable one also between steps, for those that follow. A value
that is not allowed is refused with a message to the logger, and everything stays as it was before the
call{tolerance}.</p>
<p>FMI {version} {kinds}, all quantities in SI units. {needs}</p>
</body>
</html>
"""

CONTINUOUS = "The differential equations are integrated with steps of at most {step:g} ms, at any communication step."

SAMPLED = (
    "The block computes every {step:g} ms from the start time on, whatever the communication step, with the "
    "inputs of the step that begins there; the result appears {step:g} ms later."
)


def documentation(fmu: Fmu, kind: BuildKind) -> dict[str, bytes]:
    """Page, picture, licence and what the FMU needs besides itself, by their names in the FMU."""
    files = {"documentation/index.html": page(fmu, kind).encode(), kind.picture: picture(fmu.block)}
    if kind.external:
        files["documentation/externalDependencies.txt"] = kind.external.encode()
    files["documentation/licenses/license.txt"] = licence().encode()
    return files


def licence() -> str:
    """That of this package, whose code every FMU has in it: installed it is among its metadata, in a checkout beside
    the sources."""
    try:
        text = distribution("fmublocks").read_text("licenses/LICENSE")
    except PackageNotFoundError:
        text = None
    return text or (Path(__file__).parents[3] / "LICENSE").read_text(encoding="utf-8")


def page(fmu: Fmu, kind: BuildKind) -> str:
    """The whole page as HTML."""
    block = fmu.block
    return PAGE.format(
        name=escape(block.name),
        description=escape(block.description),
        equations=_prose(fmu.equations),
        tables="\n".join(_table(title, rows) for title, rows in tables(block)),
        timing=timing(block),
        inputs=kind.inputs,
        kinds="Co-Simulation and Model Exchange" if kind.model_exchange else "Co-Simulation",
        needs=kind.needs,
        version=kind.version,
        picture=kind.picture,
        tolerance=" (inputs excepted: this block copes with any)" if block.tolerates_bad_input else "",
    )


def timing(block: Block) -> str:
    """When the block computes, in a sentence."""
    if isinstance(block, ContinuousBlock):
        return CONTINUOUS.format(step=1000.0 * block.step_size)
    return SAMPLED.format(step=1000.0 * block.sample_time)


def tables(block: Block) -> Iterator[tuple[str, list[tuple[str, ...]]]]:
    """Title and rows of the tables of inputs, outputs, parameters, if there are any; the first row is the heading."""
    for causality in ("input", "output", "parameter"):
        heading = ("Name", "Unit", "Meaning", "Start", "Allowed", "In a run")
        rows = [_cells(v) for v in interface(block) if v.causality == causality]
        if rows:
            yield f"{causality.capitalize()}s", [heading[: len(rows[0])], *rows]


def _prose(docstring: str) -> str:
    """Paragraphs of a docstring; an indented one is a formula."""
    first, _, rest = docstring.partition("\n")
    paragraphs = "\n".join((first, textwrap.dedent(rest))).strip("\n").split("\n\n")
    return "\n".join(
        f"<pre>{escape(textwrap.dedent(text))}</pre>" if text.startswith(" ") else f"<p>{escape(text)}</p>"
        for text in paragraphs
    )


def _table(title: str, rows: list[tuple[str, ...]]) -> str:
    """A table under a heading."""
    kinds = ["th"] + ["td"] * (len(rows) - 1)
    lines = ("".join(f"<{kind}>{escape(cell)}</{kind}>" for cell in row) for kind, row in zip(kinds, rows, strict=True))
    body = "\n".join(f"<tr>{line}</tr>" for line in lines)
    return f"<h2>{title}</h2>\n<table>\n{body}\n</table>"


def _cells(variable: Variable) -> tuple[str, ...]:
    meaning = variable.declaration.description
    if isinstance(variable.declaration, Enumeration):
        items = (f"{k}: {what}" for k, (_, what) in enumerate(variable.declaration.items, start=1))
        meaning = f"{meaning} ({'; '.join(items)})"
    cells = (variable.name, variable.unit or "–", meaning)
    if variable.causality == "output":
        return cells
    start = variable.start
    cells = (*cells, f"{start:g}" if isinstance(start, float) else str(start).lower(), variable.allowed())
    return (*cells, variable.variability) if variable.variability else cells


ROW, WIDTH, MARGIN, ARROW = 26, 420, 20, 30
"""Height of one port, width of the picture, and of what stands beside the box, in pixels."""

SCALE = 4
"""Drawn so much larger and then made smaller, lines have smooth edges."""

COLOURS = 32
"""Enough for two colours and their edges; a fifth of the bytes of a full-colour picture."""

BOX, LINE, TEXT = "#eef3f8", "#1f4e79", "black"


@cache  # both builds have it
def picture(block: Block) -> bytes:
    """The picture as PNG; the same block gives the same bytes."""
    inputs, outputs = block.Input._fields, block.Output._fields
    height = round(ROW * (max(len(inputs), len(outputs)) + 1.5)) + 2 * MARGIN
    image = Image.new("RGB", (SCALE * WIDTH, SCALE * height), "white")
    draw = ImageDraw.Draw(image)
    left, right = MARGIN + ARROW, WIDTH - MARGIN - ARROW
    corners = [SCALE * place for place in (left, MARGIN, right, height - MARGIN)]
    draw.rounded_rectangle(corners, 8 * SCALE, BOX, LINE, 2 * SCALE)
    _write(draw, WIDTH / 2, MARGIN + 0.75 * ROW, block.name, "mm", 16)
    for names, edge, inside, anchor in ((inputs, left, 6, "lm"), (outputs, right, -6, "rm")):
        for row, name in enumerate(names):
            y = MARGIN + ROW * (row + 1.75)
            _arrow(draw, edge if edge == right else edge - ARROW, y)
            _write(draw, edge + inside, y, name, anchor, 12)
    stored = io.BytesIO()
    small = image.resize((WIDTH, height), Image.Resampling.LANCZOS)
    small.quantize(COLOURS).save(stored, "PNG", optimize=True)
    return stored.getvalue()


def _write(draw: ImageDraw.ImageDraw, x: float, y: float, text: str, anchor: str, size: int) -> None:
    draw.text((SCALE * x, SCALE * y), text, TEXT, ImageFont.load_default(SCALE * size), anchor)


def _arrow(draw: ImageDraw.ImageDraw, x: float, y: float) -> None:
    """To the right, from a point on."""
    tip = x + ARROW - 2
    draw.line([SCALE * x, SCALE * y, SCALE * (tip - 7), SCALE * y], LINE, 2 * SCALE)
    head = [(tip, y), (tip - 9, y - 5), (tip - 9, y + 5)]
    draw.polygon([(SCALE * a, SCALE * b) for a, b in head], LINE)
