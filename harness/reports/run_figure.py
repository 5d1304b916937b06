"""Figure of one run: speeds, torques and the motion of the body, one above the other."""

from pathlib import Path

import numpy as np
from matplotlib import style
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from .figures import BLACK, BLUE, GREEN, GREY, STYLE, VERMILION, Line, Panel, draw, legend, save, titled

DEMAND = Line("controller.T_driver", r"$T_{driver}$, demand", BLACK, "--", 0.8)

PANELS = (
    Panel(
        "speed\nin rad/s",
        (
            Line("can.omega_2_can", r"$\omega_2$ over CAN", GREEN, "-", 0.8),
            Line("plant.omega_2", r"$\omega_2$, wheels", GREY, "-", 1.4),
            Line("plant.omega_1", r"$\omega_1$, motor", BLACK),
        ),
    ),
    Panel(
        "gear torque\nin N·m",
        (
            Line("plant.T_gear", r"$T_{gear}$", VERMILION, "-", 1.4),
            Line("controller.T_gear_hat", r"$\hat T_{gear}$, estimate", BLUE, "-", 0.8),
            DEMAND,
        ),
    ),
    Panel(
        "motor torque\nin N·m",
        (
            Line("motor.T_mot", r"$T_{mot}$, motor", GREY, "-", 1.4),
            Line("controller.T_ref", r"$T_{ref}$, to the motor", BLUE, "-", 0.8),
            DEMAND,
        ),
    ),
    Panel("acceleration\nin m/s²", (Line("plant.a_body", "$a$, body", BLACK),)),
    Panel("speed of the\nvehicle in m/s", (Line("plant.v", "$v$, vehicle", BLACK),)),
)


def plot_run(results: np.ndarray, title: str, stem: Path, caption: str = "") -> list[Path]:
    """Draws one run of the loop.

    Args:
        results: of `harness.simulate.simulate`.
        stem: path of the files without their ending.
        caption: what was set, in small below.

    Returns:
        The files written.
    """
    with style.context(STYLE):
        figure = Figure(figsize=(7.2, 8.4), layout=ConstrainedLayoutEngine(h_pad=0.12))
        rows = figure.subplots(len(PANELS), 1, sharex=True)
        titled(figure, title, caption)
        for axes, panel in zip(rows, PANELS, strict=True):
            draw(axes, panel, results, np.full(len(results), True))
            axes.set_ylabel(panel.label)
            if len(panel.lines) > 1:
                legend(axes)
        rows[-1].set(xlabel="time in s", xlim=(results["time"][0], results["time"][-1]))
        figure.align_ylabels()
        return save(figure, stem)
