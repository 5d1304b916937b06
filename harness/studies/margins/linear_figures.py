"""Figures of the linear loop: Bode, Nyquist, poles, describing function. Lines are the loops by their names."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from matplotlib import style
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from ...views.colours import BLACK, BLUE, GREEN, GREY, VERMILION
from ...views.figure_style import STYLE, legend, save, titled
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


def plot_bode(loops: Mapping[str, tuple[LinearLoop, Margins]], title: str, stem: Path, caption: str = "") -> list[Path]:
    """Magnitude and phase of the loop gain, with the crossings at which the margins are; returns the files."""
    f = FREQUENCIES[(FREQUENCIES >= SHOWN[0]) & (FREQUENCIES <= SHOWN[1])]
    with style.context(STYLE):
        figure = Figure(figsize=(7.2, 5.4), layout=ConstrainedLayoutEngine(h_pad=0.11))
        magnitude, phase = figure.subplots(2, 1, sharex=True)
        for (name, (loop, margin)), colour in zip(loops.items(), COLOURS, strict=False):
            L = loop.gain(f)
            degrees = np.degrees(np.unwrap(np.angle(L)))
            degrees -= 360.0 * round(float(np.interp(np.log(8.0), np.log(f), degrees)) / 360.0)
            with np.errstate(divide="ignore"):
                magnitude.semilogx(f, 20.0 * np.log10(np.abs(L)), color=colour, label=name)
            phase.semilogx(f, degrees, color=colour, label=name)
            for at, marker in ((margin.gain_frequency, "s"), (margin.delay_frequency, "o")):
                if np.isfinite(at):
                    magnitude.plot(at, 20.0 * np.log10(abs(loop.gain(np.array([at]))[0])), marker, color=colour, ms=4)
                    phase.plot(at, np.interp(np.log(at), np.log(f), degrees), marker, color=colour, ms=4)
        magnitude.axhline(0.0, color=BLACK, lw=0.8)
        phase.axhline(-180.0, color=BLACK, lw=0.8)
        magnitude.set(ylabel="loop gain |L| in dB", ylim=(-60.0, 30.0))
        phase.set(ylabel="phase of L in degrees", xlabel="frequency in Hz", xlim=SHOWN, ylim=(-450.0, 135.0))
        phase.set_yticks(range(-450, 136, 90))
        legend(magnitude)
        titled(figure, title, caption)
        return save(figure, stem)


def plot_nyquist(
    loops: Mapping[str, tuple[LinearLoop, Margins]], title: str, stem: Path, caption: str = ""
) -> list[Path]:
    """The loop gain in the complex plane, all of it and near -1, with the circle that M_s keeps free."""
    f = np.geomspace(SHOWN[0], SHOWN[1], 6000)
    turn = np.exp(1j * np.linspace(0.0, 2.0 * np.pi, 361))
    with style.context(STYLE):
        figure = Figure(figsize=(7.2, 4.2), layout=ConstrainedLayoutEngine(w_pad=0.1))
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
        titled(figure, title, caption)
        return save(figure, stem)


def plot_poles(
    found: Mapping[str, Mapping[str, Sequence[Swept]]], title: str, stem: Path, caption: str = ""
) -> list[Path]:
    """The poles of the closed loop by plant and sweep, coloured by the value; returns the files."""
    with style.context(STYLE):
        figure = Figure(figsize=(10.2, 3.3 * len(found) + 0.4), layout=ConstrainedLayoutEngine())
        grid = figure.subplots(len(found), len(SWEEPS), sharex=True, sharey=True, squeeze=False)
        for k, (plant, by_sweep) in enumerate(found.items()):
            for axes, sweep in zip(grid[k], SWEEPS, strict=True):
                scale = (LogNorm if sweep.factor else Normalize)(min(sweep.values), max(sweep.values))
                for each in by_sweep[sweep.name]:
                    colours = np.full(len(each.poles), each.value)
                    shown = axes.scatter(
                        np.real(each.poles),
                        np.imag(each.poles) / (2.0 * np.pi),
                        c=colours,
                        norm=scale,
                        cmap="viridis",
                        s=10,
                    )
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
        titled(figure, title, caption)
        return save(figure, stem)


def _rays(axes: Axes) -> None:
    """The limit of stability, and lines of the same damping ratio."""
    axes.axvline(0.0, color=BLACK, lw=0.8)
    for ratio in DAMPING_RATIOS:
        slope = np.sqrt(1.0 - ratio**2) / ratio / (2.0 * np.pi)
        axes.plot([0.0, -400.0], [0.0, 400.0 * slope], color=GREY, lw=0.6, ls="--", zorder=0)
        x, y = min(140.0, 42.0 / slope), min(140.0 * slope, 42.0)
        axes.annotate(f"{ratio:g}", (-x, y), color="0.4", fontsize=7, ha="left", va="bottom")


def plot_backlash(found: Mapping[str, Sequence[Swing]], title: str, stem: Path, caption: str = "") -> list[Path]:
    """Gain and delay margin while the teeth swing, over the amplitude of the swing; returns the files."""
    with style.context(STYLE):
        figure = Figure(figsize=(7.2, 4.8), layout=ConstrainedLayoutEngine(h_pad=0.11))
        gain, delay = panels = figure.subplots(2, 1, sharex=True)
        for (name, swings), colour in zip(found.items(), COLOURS, strict=False):
            x = [min(swing.amplitude - 1.0, IN_CONTACT) for swing in swings]
            for axes, margin, factor in ((gain, "gain_margin", 1.0), (delay, "delay_margin", 1e3)):
                y = [factor * getattr(swing.margins, margin) if swing.margins else np.nan for swing in swings]
                axes.semilogx(x[:-1], y[:-1], color=colour, label=name)
                axes.plot(x[-1], y[-1], ">", color=colour, ms=5, clip_on=False)
        gain.set_ylabel("gain margin")
        delay.set(ylabel="delay margin in ms", xlim=(0.01, IN_CONTACT))
        delay.set_xlabel(
            r"amplitude of the twist beyond the flanks over $\varphi_B$ (half the gap); arrows: in contact"
        )
        for axes in panels:
            axes.set_ylim(bottom=0.0)
        legend(gain)
        titled(figure, title, caption)
        return save(figure, stem)
