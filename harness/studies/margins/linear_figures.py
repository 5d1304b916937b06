"""Figures of the linear loop: Bode, Nyquist, poles, describing function. Lines are the loops by their names."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm, Normalize

from ...metrics.spectrum import decibels
from ...views.colours import BLACK, BLUE, GREEN, GREY, VERMILION
from ...views.figure_style import sheet
from ...views.panels import Axis, Curve, Drawing, Level, Panel, Part, Points
from .describing_function import Swing
from .linear_loop import LinearLoop
from .margins import FREQUENCIES, Margins
from .parameter_sweeps import SWEEPS, Swept

COLOURS = (BLUE, VERMILION, GREEN, BLACK)

SHOWN = (0.5, 250.0)
"""In Hz."""

IN_CONTACT = 150.0
"""Amplitude beyond the flanks, over phi_B, at which contact is drawn."""

DAMPING_RATIOS = (0.1, 0.3, 0.5)
"""Lines in the plane of the poles."""


def bode(loops: Mapping[str, tuple[LinearLoop, Margins]], title: str) -> Drawing:
    """Magnitude and phase of the loop gain, with the crossings at which the margins are."""
    f = FREQUENCIES[(FREQUENCIES >= SHOWN[0]) & (FREQUENCIES <= SHOWN[1])]
    named: set[str] = set()
    magnitude: list[Part] = [Level(0.0)]
    phase: list[Part] = [Level(-180.0)]
    for (name, (loop, margin)), color in zip(loops.items(), COLOURS, strict=False):
        L = loop.gain(f)
        degrees = np.degrees(np.unwrap(np.angle(L)))
        degrees -= 360.0 * round(float(np.interp(np.log(8.0), np.log(f), degrees)) / 360.0)
        with np.errstate(divide="ignore"):
            magnitude.append(Curve(f, decibels(L), name, color))
        phase.append(Curve(f, degrees, name, color))
        for at, marker, what in (
            (margin.gain_frequency, "square", "gain margin"),
            (margin.delay_frequency, "circle", "delay margin"),
        ):
            if np.isfinite(at):
                x, label = np.array([at]), "" if what in named else what
                named.add(what)
                magnitude.append(Points(x, decibels(loop.gain(x)), label, color, marker=marker))
                phase.append(Points(x, np.interp(np.log(x), np.log(f), degrees), color=color, marker=marker))
    panels = [
        Panel("loop gain |L| in dB", magnitude, bounds=(-60.0, 30.0)),
        Panel("phase of L in degrees", phase, bounds=(-450.0, 135.0), ticks={k: str(k) for k in range(-450, 136, 90)}),
    ]
    x = Axis("frequency in Hz", SHOWN, "log")
    return Drawing([[panel] for panel in panels], x, title, size=(7.2, 2.3))


def plot_nyquist(loops: Mapping[str, tuple[LinearLoop, Margins]], title: str, stem: Path) -> list[Path]:
    """The loop gain in the complex plane, all of it and near -1, with the circle that M_s keeps free."""
    f = np.geomspace(SHOWN[0], SHOWN[1], 6000)
    turn = np.exp(1j * np.linspace(0.0, 2.0 * np.pi, 361))
    with sheet((7.2, 4.2), title, stem, pads=(0.04, 0.1)) as (figure, files):
        whole, near = figure.subplots(1, 2)
        for (name, (loop, margin)), colour in zip(loops.items(), COLOURS, strict=False):
            L, free = loop.gain(f), -1.0 + turn / margin.M_s
            whole.plot(np.real(L), np.imag(L), color=colour)
            near.plot(np.real(L), np.imag(L), color=colour, label=name)
            near.plot(np.real(free), np.imag(free), color=colour, lw=0.8, ls=":", label=r"$1/M_s$ from -1")
        for axes in (whole, near):
            axes.plot(np.real(turn), np.imag(turn), color=GREY, lw=0.8, label="|L| = 1")
            axes.plot(-1.0, 0.0, "+", color=BLACK, ms=8)
            axes.set(xlabel="real part of L", aspect="equal")
        whole.set(ylabel="imaginary part of L", adjustable="datalim")
        near.set(xlim=(-2.2, 1.4), ylim=(-1.8, 1.8))
        figure.legend(*near.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return files


def plot_poles(found: Mapping[str, Mapping[str, Sequence[Swept]]], title: str, stem: Path) -> list[Path]:
    """The poles of the closed loop by plant and sweep, coloured by the value; returns the files."""
    size = 10.2, 3.3 * len(found) + 0.4
    with sheet(size, title, stem, pads=(0.04, 0.04)) as (figure, files):
        grid = figure.subplots(len(found), len(SWEEPS), sharex=True, sharey=True, squeeze=False)
        for k, (plant, by_sweep) in enumerate(found.items()):
            for axes, sweep in zip(grid[k], SWEEPS, strict=True):
                scale = (LogNorm if sweep.factor else Normalize)(min(sweep.values), max(sweep.values))
                its = by_sweep[sweep.name]
                poles = np.concatenate([each.poles for each in its])
                values = np.repeat([each.value for each in its], [len(each.poles) for each in its])
                y = np.imag(poles) / (2.0 * np.pi)
                shown = axes.scatter(np.real(poles), y, c=values, norm=scale, cmap="viridis", s=10)
                _rays(axes)
                axes.set(xlim=(-150.0, 15.0), ylim=(0.0, 45.0))
                if k == 0:
                    bar = figure.colorbar(shown, ax=axes, location="top", label=f"{sweep.name}, {sweep.unit}")
                    bar.minorticks_off()
                    ticks = [sweep.values[0], sweep.values[len(sweep.values) // 2], sweep.values[-1]]
                    bar.set_ticks(ticks, labels=[f"{tick:.3g}" for tick in ticks])
            grid[k][0].set_ylabel(f"{plant}\nimaginary part in Hz")
        for axes in grid[-1]:
            axes.set_xlabel("real part in 1/s")
    return files


def _rays(axes: Axes) -> None:
    """The limit of stability, and lines of the same damping ratio."""
    axes.axvline(0.0, color=BLACK, lw=0.8)
    for ratio in DAMPING_RATIOS:
        slope = np.sqrt(1.0 - ratio**2) / ratio / (2.0 * np.pi)
        axes.plot([0.0, -400.0], [0.0, 400.0 * slope], color=GREY, lw=0.6, ls="--", zorder=0)
        x, y = min(140.0, 42.0 / slope), min(140.0 * slope, 42.0)
        axes.annotate(f"{ratio:g}", (-x, y), color="0.4", fontsize=7, ha="left", va="bottom")


def backlash(found: Mapping[str, Sequence[Swing]], title: str) -> Drawing:
    """Gain and delay margin while the teeth swing, over the amplitude of the swing."""
    margins: tuple[list[Part], list[Part]] = [], []
    for (name, swings), color in zip(found.items(), COLOURS, strict=False):
        x = np.array([min(swing.amplitude - 1.0, IN_CONTACT) for swing in swings])
        for parts, margin, factor in zip(margins, ("gain_margin", "delay_margin"), (1.0, 1e3), strict=True):
            y = np.array([factor * getattr(swing.margins, margin) if swing.margins else np.nan for swing in swings])
            parts += Curve(x[:-1], y[:-1], name, color), Points(x[-1:], y[-1:], "", color, 6.0, "right")
    label = r"amplitude of the twist beyond the flanks over $\varphi_B$ (half the gap); arrows: in contact"
    labels = ("gain margin", "delay margin in ms")
    rows = [[Panel(label, parts, bounds=(0.0, None))] for label, parts in zip(labels, margins, strict=True)]
    return Drawing(rows, Axis(label, (0.01, IN_CONTACT), "log"), title, size=(7.2, 2.0))
