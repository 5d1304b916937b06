"""The figure of an identified model: prediction and recording, frequency response, and how certain it is."""

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from scipy.signal import csd, welch
from scipy.stats import chi2

from driverecords.measurement import Measurement

from ..metrics.spectrum import decibels
from ..views.colours import BLACK, BLUE, GREY, VERMILION
from ..views.figure_options import PLAIN, FigureOptions
from ..views.figure_style import plot
from ..views.panels import DASHED, DOTTED, SOLID, Axis, Band, Curve, Level, Panel, Part, Points
from .car_file import meaning
from .drive_train_response import FREQUENCIES, Tyre, response
from .free_runs import SIMULATED, free_runs
from .identify import Identified
from .prediction import BURN_IN

STRETCH = 3.0
"""Of the recording, its end, in s."""

LABELS = {"J_2": "$J_2$", "C": "$C$", "phi_B": "$\\varphi_B$"}
"""The parameters whose pairs are drawn."""

INSIDE = float(np.sqrt(chi2.ppf(0.95, 2)))
"""Distance of two parameters in their covariance, within which 95 % are."""

ABOUT = 1.6
"""Half of the width of a panel over that of its ellipse."""

FREQUENCY = Axis("frequency in Hz", (float(FREQUENCIES[0]), float(FREQUENCIES[-1])))

BEYOND = (-3.0, 6.0)
"""In dB below and above all that is finite, the ends of the axis; a model without damping has no highest."""

WINDOW = 1024
"""Samples of a window of the spectra."""

DRAWS, PERCENTILES = 500, (2.5, 97.5)
"""Of the parameters, and between which the band lies."""

READING = (
    "0 dB: 1 rad/s per N·m; bands, ellipses: 95 % by the covariance; the recording crosses the gap, the models do not"
)


def plot_fit(identified: Identified, recording: Measurement, stem: Path, options: FigureOptions = PLAIN) -> list[Path]:
    """Measured and predicted speeds and torques in the units of the file, over a window or the last STRETCH, as in
    Fig. 5 of the paper; below them the frequency response with its 95 % band and what the recording itself shows, and
    the 95 % ellipses of J_2, C and phi_B.

    Args:
        recording: from which it was identified.
        stem: path of the files without their ending.

    Returns:
        The files written.
    """
    begin, end = float(recording.time[0]), float(recording.time[-1])
    window = options.clipped(begin, end) if options.window else (max(end - STRETCH, begin), end)
    alone = [*predicted(identified, recording, window), *responses(identified)]
    rows = [*([panel] for panel in alone), ellipses(identified)]
    title = f"Prediction, frequency response (teeth in contact) and certainty\n{identified.name}"
    options = options._replace(caption=f"{options.caption}\n{READING}; {meaning(identified)}".strip())
    return plot(rows, Axis("time in s", window), title, stem, options, size=(7.2, 1.75), same_y=False)


def predicted(identified: Identified, recording: Measurement, window: tuple[float, float]) -> list[Panel]:
    """Speeds and torques, measured and of free runs, in the units of the file; the recorded wheel speed as much earlier
    as it is late.

    Args:
        window: from and to when in s, as recorded; the first runs begin after BURN_IN.
    """
    file_units, t, T_s = recording.file_units, recording.time, identified.drive.T_s
    first = max(round((window[0] - t[0]) / T_s), round(BURN_IN / T_s))
    first = max(min(first, len(identified.drive) - round(SIMULATED / T_s)), 1)
    p = identified.found.p
    at, runs = free_runs(identified.predictor, p, identified.found.predicted.states, first)
    gap = np.full((len(at), 1), np.nan)
    x = np.hstack([t[at], gap]).ravel()
    omega_1, omega_2, T_gear, T_load = (np.hstack([runs[..., k], gap]).ravel() for k in range(4))
    valid = np.ones(len(t), bool) if recording.valid is None else recording.valid
    starts = list(identified.drive.starts[1:])
    age = identified.late_wheel_speed.time if identified.late_wheel_speed else 0.0

    def measured(y: np.ndarray, quantity: str, label: str = "measured", width: float = 1.6) -> Curve:
        y = y / file_units[quantity].factor
        y[starts] = np.nan  # a gap
        return Curve(t, y, label, GREY, width=width)

    def model(y: np.ndarray, quantity: str, label: str = "", width: float = 1.0) -> Curve:
        return Curve(x, y / file_units[quantity].factor, label, BLUE, width=width)

    off = np.hstack([runs[..., 0] - recording.omega_1[at], gap]).ravel()
    wheels = measured(
        np.where(valid, recording.omega_2, np.nan), "omega_2", f"measured, drawn {1e3 * age:.0f} ms earlier"
    )
    runs_of = f"predicted {SIMULATED:g} s from the motor torque alone"
    panels = [
        Panel(
            f"motor speed\n{file_units['omega_1']}",
            [measured(recording.omega_1, "omega_1", width=2.4), model(omega_1, "omega_1", runs_of)],
        ),
        Panel(f"difference\n{file_units['omega_1']}", [model(off, "omega_1", width=0.6)], height=0.62),
        Panel(
            f"wheel speed\n{file_units['omega_2']}",
            [wheels._replace(x=t - age, held=True), model(omega_2, "omega_2", "predicted")],
        ),
        Panel(
            f"torque\n{file_units['T_mot']}",
            [measured(recording.T_mot, "T_mot", "motor, measured"), model(T_gear, "T_mot", "gear, predicted")],
        ),
    ]
    if recording.T_load is not None:
        load = measured(-recording.T_load, "T_load", "measured, positive when it drives", 1.0)
        panels.append(
            Panel(f"load torque\n{file_units['T_load']}", [load, model(-p.g_L * T_load, "T_load", "predicted")])
        )
    return panels


def responses(identified: Identified) -> list[Panel]:
    """Amplitude and phase of the recording and of the model, on its own and, with a tyre, with the load torque held."""
    f, recorded = recorded_response(identified)
    at = (f >= FREQUENCIES[0]) & (f <= FREQUENCIES[-1])
    f, recorded = f[at], recorded[at]
    own: list[tuple[Callable[..., Tyre | None], str, str, tuple[float, ...]]] = [
        (identified.tyre_of, f"car on its own, peak at {identified.resonance:.2f} Hz", VERMILION, SOLID)
    ]
    models = [*own, *[(lambda _: None, "load torque held", BLUE, DASHED)] * identified.predictor.measured]
    answers = [response(identified.p, FREQUENCIES, tyre(identified.p)) for tyre, *_ in models]
    drawn = [drawn_responses(identified, tyre) for tyre, *_ in models]

    def parts(of: Callable[[np.ndarray], np.ndarray]) -> Iterator[Part]:
        yield Level(identified.resonance, VERMILION, DOTTED, upright=True)
        yield Points(f, of(recorded), "recording", "#666666", 3.0)
        for answer, others, (_, name, color, dashes) in zip(answers, drawn, models, strict=True):
            low, high = np.percentile(of(others), PERCENTILES, axis=0)
            yield Band(FREQUENCIES, low, high, color=color)
            yield Curve(FREQUENCIES, of(answer), name, color, dashes)

    amplitude, phase = (list(parts(of)) for of in (decibels, lambda answer: np.degrees(np.angle(answer))))
    shown = np.concatenate([decibels(recorded), decibels(answers[0])])
    shown = shown[np.isfinite(shown)]
    return [
        Panel(
            "motor speed over\ntorque in dB",
            amplitude,
            bounds=(shown.min() + BEYOND[0], shown.max() + BEYOND[1]),
            height=1.3,
            x=FREQUENCY,
        ),
        Panel("phase in degrees", phase, ticks={k: str(k) for k in range(-90, 91, 45)}, height=0.9, x=FREQUENCY),
    ]


def drawn_responses(identified: Identified, tyre: Callable[..., Tyre | None], seed: int = 1) -> np.ndarray:
    """omega_1/T_mot of parameters drawn from the covariance, shape (DRAWS, frequencies)."""
    p, answer = identified.p, identified.found
    centre = [getattr(p, name) for name in answer.free]
    drawn = np.random.default_rng(seed).multivariate_normal(centre, answer.covariance, DRAWS)
    others = [p._replace(**dict(zip(answer.free, map(float, values), strict=True))) for values in drawn]
    # no damper drives, and no spring pushes
    others = [
        q._replace(**{n: max(getattr(q, n), 1e-3 * getattr(p, n)) for n in ("J_2", "C", "d", "c_t")}) for q in others
    ]
    return np.array([response(other, FREQUENCIES, tyre(other)) for other in others])


def recorded_response(identified: Identified) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies in Hz and omega_1/T_mot there, by the spectra of both (Welch), of which the means of the samples are
    taken, in the longest piece. Of a recording that crosses the gap it is not that of teeth in contact."""
    drive, p = identified.drive, identified.p
    at = slice(drive.longest.start, drive.longest.stop - 1)
    T_mot = drive.torque(p.late_T)[at].mean(axis=1) / p.g_T
    omega_1 = 0.5 * (drive.omega_1[1:] + drive.omega_1[:-1])[at]
    rate, length = 1.0 / drive.T_s, min(WINDOW, len(T_mot))
    f, cross = csd(T_mot, omega_1, rate, nperseg=length, detrend="linear")
    _, power = welch(T_mot, rate, nperseg=length, detrend="linear")
    return f, cross / power


def ellipses(identified: Identified) -> list[Panel]:
    """Within which 95 % of each pair of LABELS are, in % of the answer."""
    p, answer, turn = identified.p, identified.found, np.linspace(0.0, 2.0 * np.pi, 181)
    panels = []
    for x, y in (("J_2", "C"), ("J_2", "phi_B"), ("C", "phi_B")):
        pair = [answer.free.index(name) for name in (x, y)]
        shares = 100.0 / np.array([getattr(p, name) for name in (x, y)])
        covariance = answer.covariance[np.ix_(pair, pair)] * np.outer(shares, shares)
        around = INSIDE * np.linalg.cholesky(covariance) @ np.array([np.cos(turn), np.sin(turn)])
        half_x, half_y = ABOUT * INSIDE * np.sqrt(np.diag(covariance))
        parts = [Curve(*around, color=VERMILION), Points(np.zeros(1), np.zeros(1), color=BLACK)]
        axis = Axis(f"{LABELS[x]} off by, %", (-half_x, half_x))
        panels.append(Panel(f"{LABELS[y]} off by, %", parts, bounds=(-half_y, half_y), height=1.3, x=axis))
    return panels
