"""Figures of how certain an identified model is: cost over pairs of parameters, frequency response with its band."""

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator, ScalarFormatter
from scipy.signal import csd, welch
from scipy.stats import chi2

from ..metrics.spectrum import decibels
from ..views.colours import BLACK, BLUE, GREY, VERMILION
from ..views.figure_options import PLAIN, FigureOptions
from ..views.figure_style import plot, sheet
from ..views.panels import DASHED, DOTTED, SOLID, Axis, Band, Curve, Level, Panel, Part, Points
from .car_file import MEANS, NOT_DETERMINED, peak
from .cost_surface import POINTS, cost_over, curvature, ellipse, exact
from .drive_train_response import FREQUENCIES, WINDOW, Tyre, response
from .fit_figures import headline
from .identify import Identified

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

FREQUENCY = Axis("frequency in Hz", (float(RESPONSE[0]), float(RESPONSE[-1])))

BEYOND = (-3.0, 6.0)
"""In dB below and above all that is finite, the ends of the axis; a model without damping has no highest."""

READING = (
    "0 dB: 1 rad/s per N·m; bands: 95 % by the covariance, the tyre as it is; the recording crosses the gap, the "
    "models do not"
)


def plot_cost(identified: Identified, stem: Path, options: FigureOptions = PLAIN) -> list[Path]:
    """The cost over each pair of J_2, C and phi_B, with the 95 % ellipse of the answer.

    Args:
        stem: path of the files without their ending.

    Returns:
        The files written.
    """
    J_2, C, phi_B = LABELS
    H = curvature(identified)
    title = f"Cost above that of the answer\n{headline(identified)}"
    options = options._replace(caption=f"{options.caption}\n{_of(identified)}".strip())
    with sheet((7.2, 6.6), title, stem, options, pads=(0.06, 0.06)) as (figure, files):
        ((C_J_2, key), (phi_J_2, phi_C)) = figure.subplots(2, 2, sharex="col")
        for axes, x, y in ((C_J_2, J_2, C), (phi_J_2, J_2, phi_B), (phi_C, C, phi_B)):
            _cost(axes, identified, x, y, H)
            axes.set(ylabel=LABELS[y], xlabel=LABELS[x] if y == phi_B else "")
        key.axis("off")
        key.legend(*C_J_2.get_legend_handles_labels(), loc="lower left")
    return files


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
    return f"cost: {how}; the other free parameters are the likeliest; {MEANS[identified.name]}"


def plot_response(identified: Identified, stem: Path, options: FigureOptions = PLAIN, seed: int = 1) -> list[Path]:
    """Frequency response from motor torque to motor speed with its 95 % band, and what the recording itself shows.

    Args:
        stem: path of the files without their ending.
        seed: of the parameters that are drawn for the band.

    Returns:
        The files written.
    """
    title, caption = (
        f"Frequency response, teeth in contact\n{headline(identified)}",
        f"{options.caption}\n{READING}".strip(),
    )
    rows = [[panel] for panel in responses(identified, seed)]
    return plot(rows, FREQUENCY, title, stem, options._replace(caption=caption), size=(7.2, 2.8))


def responses(identified: Identified, seed: int = 1) -> list[Panel]:
    """Amplitude and phase of the recording and of the model, on its own and, with a tyre, with the load torque held."""
    f, recorded = recorded_response(identified)
    at = (f >= RESPONSE[0]) & (f <= RESPONSE[-1])
    f, recorded = f[at], recorded[at]
    most = peak(identified)
    own_peak = "" if most == NOT_DETERMINED else f", peak at {most} Hz"
    models = [(identified.tyre, f"car on its own{own_peak}", VERMILION, SOLID)]
    models += [(None, "load torque held", BLUE, DASHED)] * (identified.tyre is not None)
    answers = [response(identified.p, RESPONSE, tyre) for tyre, *_ in models]
    drawn = [drawn_responses(identified, RESPONSE, tyre, seed) for tyre, *_ in models]

    def parts(of: Callable[[np.ndarray], np.ndarray]) -> Iterator[Part]:
        if own_peak:
            yield Level(identified.resonance, VERMILION, DOTTED, upright=True)
        yield Points(f, of(recorded), "recording", "#666666", 3.0)
        for answer, others, (_, name, color, dashes) in zip(answers, drawn, models, strict=True):
            low, high = np.percentile(of(others), PERCENTILES, axis=0)
            yield Band(RESPONSE, low, high, color=color)
            yield Curve(RESPONSE, of(answer), name, color, dashes)

    amplitude, phase = (list(parts(of)) for of in (decibels, lambda answer: np.degrees(np.angle(answer))))
    own = np.concatenate([decibels(recorded), decibels(answers[0])])
    own = own[np.isfinite(own)]
    return [
        Panel("motor speed over\ntorque in dB", amplitude, bounds=(own.min() + BEYOND[0], own.max() + BEYOND[1])),
        Panel("phase in degrees", phase, ticks={k: str(k) for k in range(-90, 91, 45)}, height=0.67),
    ]


DRAWS = 500

PERCENTILES = (2.5, 97.5)
"""Between which the band lies."""


def drawn_responses(identified: Identified, frequencies: np.ndarray, behind: Tyre | None, seed: int) -> np.ndarray:
    """omega_1/T_mot of parameters drawn from the covariance, the tyre as it is, shape (DRAWS, frequencies).

    Args:
        frequencies: in Hz.
        behind: what hangs on the wheels.
    """
    p, free = identified.p, identified.free
    drawn = np.random.default_rng(seed).multivariate_normal([getattr(p, x) for x in free], identified.covariance, DRAWS)
    others = [p._replace(**dict(zip(free, map(float, values), strict=True))) for values in drawn]
    return np.array([response(other, frequencies, behind) for other in others])


def recorded_response(identified: Identified) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies in Hz and omega_1/T_mot there, by the spectra of both (Welch), of which the means of the samples are
    taken. Of a recording that crosses the gap it is not that of teeth in contact."""
    drive = identified.drive.acting(identified.p)
    T_mot = drive.T_mot.mean(axis=1) / identified.p.g_T
    omega_1 = 0.5 * (drive.omega_1[1:] + drive.omega_1[:-1])
    rate, length = 1.0 / drive.T_s, min(WINDOW, len(drive))
    f, cross = csd(T_mot, omega_1, rate, nperseg=length, detrend="linear")
    _, power = welch(T_mot, rate, nperseg=length, detrend="linear")
    return f, cross / power
