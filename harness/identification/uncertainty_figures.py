"""Figures of how certain an identified model is: cost over pairs of parameters, frequency response with its band."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib import style
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.ticker import MaxNLocator, ScalarFormatter
from scipy.stats import chi2

from ..metrics.spectrum import decibels
from ..views.colours import BLACK, BLUE, GREY, VERMILION
from ..views.figure_options import PLAIN, FigureOptions
from ..views.figure_style import STYLE, legend, save, titled
from .cost_surface import POINTS, cost_over, curvature, ellipse, exact
from .drive_train_response import FREQUENCIES, Tyre, response
from .fit_figures import headline
from .identify import Identified
from .response_band import PERCENTILES, drawn_responses, recorded_response

LABELS = {"J_2": r"$J_2$ in kg·m²", "C": r"$C$ in N·m/rad", "phi_B": r"$\varphi_B$ in rad"}
"""The parameters whose pairs are drawn."""

INSIDE = float(chi2.ppf(0.95, 2))
"""Square of the distance of two parameters, within which 95 % are."""

LEVELS = [digit * 10.0**power for power in range(9) for digit in (1.0, 3.0)]
"""Of the cost. Where the likelihood has the covariance of the answer, 95 % are within 3.0."""

CONTOURS = 6
"""At most, the highest of them."""

RESPONSE = np.linspace(FREQUENCIES[0], FREQUENCIES[-1], 951)
"""Frequencies in Hz, nearer to each other than those of the tables: peaks are narrow."""

ABOVE = 6.0
"""In dB above the highest of what is finite, the end of the axis; a model without damping has no highest."""

BAND = "bands: 95 % by the covariance, the tyre as it is; the recording crosses the gap, the models do not"


def plot_cost(identified: Identified, stem: Path, options: FigureOptions = PLAIN) -> list[Path]:
    """The cost over each pair of J_2, C and phi_B, with the 95 % ellipse of the answer.

    Args:
        stem: path of the files without their ending.

    Returns:
        The files written.
    """
    J_2, C, phi_B = LABELS
    H = curvature(identified)
    with style.context(STYLE):
        figure = Figure(figsize=(7.2, 6.6), layout=ConstrainedLayoutEngine(h_pad=0.06, w_pad=0.06))
        ((C_J_2, key), (phi_J_2, phi_C)) = figure.subplots(2, 2, sharex="col")
        for axes, x, y in ((C_J_2, J_2, C), (phi_J_2, J_2, phi_B), (phi_C, C, phi_B)):
            _cost(axes, identified, x, y, H)
            axes.set(ylabel=LABELS[y], xlabel=LABELS[x] if y == phi_B else "")
        key.axis("off")
        key.legend(*C_J_2.get_legend_handles_labels(), loc="lower left")
        figure.align_ylabels()
        titled(
            figure,
            f"Cost above that of the answer\n{headline(identified)}",
            f"{options.caption}\n{_of(identified)}".strip(),
        )
        return save(figure, stem, options.kinds)


def _cost(axes: Axes, identified: Identified, x: str, y: str, H: np.ndarray) -> None:
    surface = cost_over(identified, x, y, H)
    fine = surface.fine
    levels = [level for level in LEVELS if level < surface.cost.max()][-CONTOURS:]
    axes.plot(getattr(identified.p, x), getattr(identified.p, y), "+", color=BLACK, label="answer")
    axes.plot(
        *ellipse(identified, x, y, INSIDE),
        color=VERMILION,
        lw=2.5,
        ls="--",
        alpha=0.6,
        label="95 % by the covariance of the answer",
    )
    axes.clabel(axes.contour(fine.x, fine.y, fine.cost.T, levels, colors=BLUE, linewidths=0.8), fmt="%g", fontsize=7)
    axes.plot([], [], color=BLUE, lw=0.8, label="cost")
    if exact(identified):
        axes.plot(*np.meshgrid(surface.x, surface.y), ".", color=GREY, ms=2.5, zorder=1)
        axes.plot([], [], ".", color=GREY, ms=2.5, label="where it was computed")
    axes.set(xlim=(fine.x[0], fine.x[-1]), ylim=(fine.y[0], fine.y[-1]))
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(4))
        axis.set_major_formatter(ScalarFormatter(useOffset=False))


def _of(identified: Identified) -> str:
    """How the cost was found."""
    passes = f"a spline through {POINTS} x {POINTS} passes of the filter"
    how = passes if exact(identified) else "quadratic, by the covariance"
    return f"cost: {how}; the other free parameters are the likeliest"


def plot_response(identified: Identified, stem: Path, options: FigureOptions = PLAIN, seed: int = 1) -> list[Path]:
    """Frequency response from motor torque to motor speed with its 95 % band, and what the recording itself shows.

    Args:
        stem: path of the files without their ending.
        seed: of the parameters that are drawn for the band.

    Returns:
        The files written.
    """
    peak = identified.resonance
    with style.context(STYLE):
        figure = Figure(figsize=(7.2, 5.6), layout=ConstrainedLayoutEngine(h_pad=0.1))
        amplitude, phase = rows = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
        for axes, of in ((amplitude, decibels), (phase, _degrees)):
            f, recorded = recorded_response(identified)
            at = (f >= RESPONSE[0]) & (f <= RESPONSE[-1])
            axes.plot(f[at], of(recorded[at]), ".", color="0.4", ms=4, label="recording")
            axes.axvline(peak, color=VERMILION, ls=":", lw=0.8)
        _model(rows, identified, identified.tyre, f"car on its own, peak at {peak:.2f} Hz", VERMILION, "-", seed)
        amplitude.set_ylim(top=amplitude.dataLim.y1 + ABOVE)
        if identified.tyre:
            _model(rows, identified, None, "load torque held", BLUE, "--", seed)
        amplitude.set_ylabel(r"amplitude of $\omega_1/T_{mot}$ in dB" "\n" "(0 dB: 1 rad/s per N·m)")
        phase.set(ylabel="phase in degrees", xlabel="frequency in Hz", xlim=(RESPONSE[0], RESPONSE[-1]))
        phase.set_xticks(range(2, 21, 2))
        phase.set_yticks(range(-90, 91, 45))
        legend(amplitude)
        titled(
            figure,
            f"Frequency response, teeth in contact\n{headline(identified)}",
            f"{options.caption}\n{BAND}".strip(),
        )
        return save(figure, stem, options.kinds)


def _model(
    rows: Sequence[Axes], identified: Identified, behind: Tyre | None, name: str, colour: str, dashes: str, seed: int
) -> None:
    """The response and its band."""
    answer = response(identified.p, RESPONSE, behind)
    drawn = drawn_responses(identified, RESPONSE, behind, seed)
    for axes, of in zip(rows, (decibels, _degrees), strict=True):
        axes.plot(RESPONSE, of(answer), color=colour, ls=dashes, label=name)
        axes.fill_between(RESPONSE, *np.percentile(of(drawn), PERCENTILES, axis=0), color=colour, alpha=0.3, lw=0)


def _degrees(answer: np.ndarray) -> np.ndarray:
    return np.degrees(np.angle(answer))
