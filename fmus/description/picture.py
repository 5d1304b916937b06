"""model.png of an FMU: the block with its inputs on the left and its outputs on the right."""

import io

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import FancyBboxPatch
from PIL import Image

from ...models.block.types import Block

ROW = 0.26
"""Height of one port in inches."""

COLOURS = 32
"""Enough for two colours and their edges; a fifth of the bytes of a full-colour picture."""

WIDTH, MARGIN, ARROW = 4.2, 0.2, 0.3


def picture(block: Block) -> bytes:
    """The picture as PNG; the same block gives the same bytes."""
    inputs, outputs = block.Input._fields, block.Output._fields
    height = ROW * (max(len(inputs), len(outputs)) + 1.5)
    figure = Figure(figsize=(WIDTH, height + 2 * MARGIN), dpi=100)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set(xlim=(0.0, WIDTH), ylim=(-MARGIN, height + MARGIN))
    axes.set_axis_off()
    left, right = MARGIN + ARROW, WIDTH - MARGIN - ARROW
    box = FancyBboxPatch((left, 0.0), right - left, height, boxstyle="round,pad=0,rounding_size=0.08")
    box.set(facecolor="#eef3f8", edgecolor="#1f4e79", linewidth=1.5)
    axes.add_patch(box)
    axes.text(WIDTH / 2, height - 0.7 * ROW, block.name, ha="center", va="center", fontsize=11, weight="bold")
    for names, x, side in ((inputs, left, "left"), (outputs, right, "right")):
        for row, name in enumerate(names):
            y = height - ROW * (row + 2.0)
            tail = x - ARROW if side == "left" else x
            axes.annotate("", (tail + ARROW, y), (tail, y), arrowprops={"arrowstyle": "->", "color": "#1f4e79"})
            axes.text(x + (0.06 if side == "left" else -0.06), y, name, ha=side, va="center", fontsize=8)
    FigureCanvasAgg(figure)
    drawn, stored = io.BytesIO(), io.BytesIO()
    figure.savefig(drawn, format="png", metadata={"Software": None})
    Image.open(drawn).convert("RGB").quantize(COLOURS).save(stored, "PNG", optimize=True)
    return stored.getvalue()
