"""documentation/index.html of an FMU: what the block is, its equations and its variables."""

import textwrap
from collections.abc import Iterable
from html import escape

from models.declaration import Enumeration

from .fmu import Fmu
from .interface import Variable, interface

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
<p><img src="../model.png" alt="inputs and outputs of {name}"></p>
{equations}
{tables}
<h2>How it runs</h2>
<p>{timing} Inputs are held over a communication step. A parameter may be changed until initialization
mode is left, and outputs are right from then on. A value that is not allowed is refused with a
message to the logger, and everything stays as it was before the call{tolerance}.</p>
<p>FMI 2.0 Co-Simulation, all quantities in SI units. The model is Python code inside this file, on the
standard library alone. The host process must be a Python of version 3.11 or later, or have loaded
libpython with its symbols visible (on Linux: LD_PRELOAD).</p>
</body>
</html>
"""

CONTINUOUS = (
    "The differential equations are integrated with steps of at most {step:g} ms, at any communication step."
)

SAMPLED = (
    "The block computes every {step:g} ms from the start time on, whatever the communication step, with the "
    "inputs of the step that begins there; the result appears {step:g} ms later."
)


def page(fmu: Fmu) -> str:
    """The whole page as HTML."""
    block = fmu.block
    timing = SAMPLED if block.update else CONTINUOUS
    tables = (
        _table(title, [v for v in interface(block) if v.causality == causality])
        for title, causality in (("Inputs", "input"), ("Outputs", "output"), ("Parameters", "parameter"))
    )
    return PAGE.format(
        name=escape(block.name),
        description=escape(block.description),
        equations=_prose(fmu.equations),
        tables="\n".join(tables),
        timing=timing.format(step=1000.0 * (block.sample_time or block.step_size)),
        tolerance=" (inputs excepted: this block copes with any)" if block.tolerates_bad_input else "",
    )


def _prose(docstring: str) -> str:
    """Paragraphs of a docstring; an indented one is a formula."""
    first, _, rest = docstring.partition("\n")
    paragraphs = "\n".join((first, textwrap.dedent(rest))).strip("\n").split("\n\n")
    return "\n".join(
        f"<pre>{escape(textwrap.dedent(text))}</pre>" if text.startswith(" ") else f"<p>{escape(text)}</p>"
        for text in paragraphs
    )


def _table(title: str, of_kind: Iterable[Variable]) -> str:
    """A table of variables under a heading."""
    head = (
        ("Name", "Unit", "Meaning") if title == "Outputs" else ("Name", "Unit", "Meaning", "Start", "Allowed")
    )
    rows = ["".join(f"<th>{name}</th>" for name in head)]
    for variable in of_kind:
        rows.append("".join(f"<td>{escape(cell)}</td>" for cell in _cells(variable)))
    body = "\n".join(f"<tr>{row}</tr>" for row in rows)
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
    return (*cells, f"{start:g}" if isinstance(start, float) else str(start).lower(), variable.allowed())
