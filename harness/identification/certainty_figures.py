"""Figures of how certain an identified model is: cost over pairs of parameters, frequency response with its band."""

from pathlib import Path

import numpy as np
from matplotlib import style
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator, ScalarFormatter
from scipy.signal import csd, welch
from scipy.stats import chi2

from ..reports.figures import BLACK, BLUE, GREY, STYLE, VERMILION, legend, save, titled
from .cost import POINTS, SPAN, cost_over, ellipse, exact
from .figures import said
from .identify import Identified
from .response import FREQUENCIES, WINDOW, Tyre, resonance, response

LABELS = {"J_2": r"$J_2$ in kg·m²", "C": r"$C$ in N·m/rad", "phi_B": r"$\varphi_B$ in rad"}
"""The parameters whose pairs are drawn."""

INSIDE = float(chi2.ppf(0.95, 2))
"""Square of the distance of two parameters, within which 95 % are."""

LEVELS = [digit * 10.0**power for power in range(9) for digit in (1.0, 2.0, 5.0)]
"""Of the cost."""

LEVELS_SHOWN = 7

BAND = (2.5, 97.5)
"""In %."""

DRAWS = 500


def plot_cost(identified: Identified, stem: Path, caption: str = "") -> list[Path]:
    """The cost over each pair of J_2, C and phi_B, with the 95 % ellipse of the answer.

    Args:
        stem: path of the files without their ending.
        caption: what was set, in small below.

    Returns:
        The files written.
    """
    J_2, C, phi_B = LABELS
    with style.context(STYLE):
        figure = Figure(figsize=(7.2, 6.6), layout=ConstrainedLayoutEngine(h_pad=0.06, w_pad=0.06))
        grid = figure.subplots(2, 2, sharex="col")
        for axes, (x, y) in zip((grid[0, 0], grid[1, 0], grid[1, 1]), ((J_2, C), (J_2, phi_B), (C, phi_B)), strict=True):
            _cost(axes, identified, x, y)
        for axes in (grid[0, 0], grid[1, 0]):
            axes.set_ylabel(LABELS[C if axes is grid[0, 0] else phi_B])
        grid[1, 0].set_xlabel(LABELS[J_2])
        grid[1, 1].set_xlabel(LABELS[C])
        _key(grid[0, 1])
        figure.align_ylabels()
        titled(figure, f"Cost above that of the answer\n{said(identified)}", f"{caption}\n{_of(identified)}".strip())
        return save(figure, stem)


def _cost(axes: Axes, identified: Identified, x: str, y: str) -> None:
    at_x, at_y, cost = cost_over(identified, x, y)
    levels = [level for level in LEVELS if level < cost.max()][-LEVELS_SHOWN:]
    axes.clabel(axes.contour(at_x, at_y, cost.T, levels, colors=GREY, linewidths=0.8), fmt="%g", fontsize=7)
    axes.contour(at_x, at_y, cost.T, [0.5 * INSIDE], colors=BLUE, linewidths=1.2)
    axes.plot(*ellipse(identified, x, y, INSIDE), color=VERMILION, ls="--", lw=1.2)
    axes.plot(getattr(identified.p, x), getattr(identified.p, y), "+", color=BLACK)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(4))
        axis.set_major_formatter(ScalarFormatter(useOffset=False))


def _key(axes: Axes) -> None:
    lines = {
        "answer": Line2D([], [], color=BLACK, marker="+", ls=""),
        "95 % of the answer, by its covariance": Line2D([], [], color=VERMILION, ls="--"),
        f"cost of {0.5 * INSIDE:.1f}: 95 % by the likelihood": Line2D([], [], color=BLUE),
        "cost": Line2D([], [], color=GREY),
    }
    axes.axis("off")
    axes.legend(lines.values(), lines.keys(), loc="lower left")


def _of(identified: Identified) -> str:
    """How the cost was found."""
    follow = "the other free parameters follow"
    if not exact(identified):
        return f"quadratic, by the covariance; within {SPAN:g} standard deviations; {follow}"
    return f"one pass of the filter at each of {POINTS} x {POINTS} points within {SPAN:g} standard deviations; {follow}"


def plot_response(identified: Identified, stem: Path, caption: str = "", seed: int = 1) -> list[Path]:
    """Frequency response from motor torque to motor speed with its 95 % band, and what the recording itself shows.

    Args:
        stem: path of the files without their ending.
        caption: what was set, in small below.
        seed: of the parameters that are drawn for the band.

    Returns:
        The files written.
    """
    with style.context(STYLE):
        figure = Figure(figsize=(7.2, 5.6), layout=ConstrainedLayoutEngine(h_pad=0.1))
        amplitude, phase = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
        _recorded(amplitude, phase, identified)
        if identified.tyre:
            _modelled(amplitude, phase, identified, None, "load torque held", BLUE, seed)
        _modelled(amplitude, phase, identified, identified.tyre, "car on its own", VERMILION, seed)
        amplitude.set_ylabel(r"amplitude of $\omega_1/T_{mot}$ in dB" "\n" "(0 dB: 1 rad/s per N·m)")
        phase.set(ylabel="phase in degrees", xlabel="frequency in Hz", xlim=(FREQUENCIES[0], FREQUENCIES[-1]))
        phase.set_yticks(range(-90, 91, 45))
        legend(amplitude)
        note = "recording: with the gap, which the models in contact leave out"
        titled(figure, f"Frequency response, teeth in contact\n{said(identified)}", f"{caption}\n{note}".strip())
        return save(figure, stem)


def _modelled(
    amplitude: Axes, phase: Axes, identified: Identified, behind: Tyre | None, name: str, colour: str, seed: int
) -> None:
    """The response, its peak and its band. The tyre is taken as it is."""
    p, peak = identified.p, resonance(identified.p, behind)
    values = [getattr(p, name) for name in identified.free]
    drawn = np.random.default_rng(seed).multivariate_normal(values, identified.covariance, DRAWS)
    others = [p._replace(**dict(zip(identified.free, map(float, each), strict=True))) for each in drawn]
    answers = np.array([response(other, FREQUENCIES, behind) for other in others])
    at_peak = response(p, np.array([peak]), behind)
    for axes, of in ((amplitude, _decibels), (phase, _degrees)):
        axes.fill_between(FREQUENCIES, *np.percentile(of(answers), BAND, axis=0), color=colour, alpha=0.3, lw=0)
        axes.plot(FREQUENCIES, of(response(p, FREQUENCIES, behind)), color=colour, label=f"{name}, peak at {peak:.2f} Hz")
        axes.axvline(peak, color=colour, ls=":", lw=0.8)
    amplitude.plot(peak, _decibels(at_peak), "o", color=colour, ms=4)


def _recorded(amplitude: Axes, phase: Axes, identified: Identified) -> None:
    """By the spectra of motor torque and motor speed, both as means of the samples."""
    drive = identified.drive
    T_mot, omega_1 = drive.T_mot.mean(axis=1) / identified.p.g_T, 0.5 * (drive.omega_1[1:] + drive.omega_1[:-1])
    window = {"fs": 1.0 / drive.T_s, "nperseg": min(WINDOW, len(drive)), "detrend": "linear"}
    f, cross = csd(T_mot, omega_1, **window)
    answer = cross / welch(T_mot, **window)[1]
    at = (f >= FREQUENCIES[0]) & (f <= FREQUENCIES[-1])
    for axes, of in ((amplitude, _decibels), (phase, _degrees)):
        axes.plot(f[at], of(answer[at]), ".", color="0.4", ms=4, label="recording")


def _decibels(answer: np.ndarray) -> np.ndarray:
    return 20.0 * np.log10(np.abs(answer))


def _degrees(answer: np.ndarray) -> np.ndarray:
    return np.degrees(np.angle(answer))
