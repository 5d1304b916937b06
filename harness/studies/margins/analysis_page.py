"""The page that `driveline analyse` writes."""

from collections.abc import Iterator
from math import isfinite, isnan

from ...manoeuvres.catalogue import MANOEUVRES
from ...metrics.declaration import declared
from ...metrics.estimate import EstimateMetrics
from ...metrics.run_metrics import Metrics
from ...views.markdown import markdown_table
from ...views.metrics_table import number
from .describing_function import LimitCycle
from .loop_analysis import TORQUE, Analysis
from .margins import Margins
from .parameter_sweeps import SWEEPS
from .sensitivity import SHOWN
from .sensitivity_figure import most_important

PAGE = """\
# The loop with {controller}

The loop is linear while the teeth stay on one flank. Its model comes from the functions of the blocks themselves: they
are differentiated where car and controller have settled under {torque:.0%} of the largest torque, so any controller of
the catalogue can be analysed, and nothing is written a second time. The delays are the true ones: the sample in which
the controller computes, the hold of its torque, the torque loop, and for the wheel speed the mean over a cycle of the
bus, its transport and the sample that takes it. Tests confirm the margins by the true loop: with a dead time or gain
just below them a swing dies away, just above it grows.

## Margins

The loop is opened between controller and motor. `L` is what comes back there, `1 + L = 0` is a swing that lasts.

{margins}

- **Gain margin**: by how much more the controller may act, or how much lighter the motor may be, before the loop swings
  for ever. Below 2 is little.
- **Delay margin**: dead time that may be added to the torque: a slower inverter, another sample, a bus in between.
- **Phase margin**: the same as an angle, in either direction.
- **M_s**: how much a disturbance at the worst frequency is amplified; from 2 on the loop is nervous.
- **Damping ratio**: of the least damped mode of the drive train, from 2 to 16 Hz, with the mean of quiet samples and
  those with a message.

![Bode](figures/analysis_bode.png)

Dots mark where the delay margin is read, squares the gain margin; both at 15 km/h, as below.

![Nyquist](figures/analysis_nyquist.png)

## Poles

What changes is the car, not what the controller knows of it. Dashed lines have the same damping ratio.

![poles](figures/analysis_poles.png)

{swept}

## Backlash

Swinging with an amplitude A about the middle of the gap, the teeth act like a spring that is softer than the stiffness
by the describing function N(A). With the mean of contact and gap that belongs to N, in car and controller, the loop has
poles and margins of its own. Where a pole is on the stability limit there is a limit cycle:

{excluded}

A swing that hardly leaves the gap (just above 1 φ_B) is the teeth floating from flank to flank without load; in the gap
no signal tells the twist. It takes a mean torque of zero.

![margins over the amplitude](figures/analysis_backlash.png)

No line is drawn where such a swing grows. A margin that is smaller somewhere than in contact says from which gain or
further dead time on a car that is stable in contact keeps swinging once it has been thrown through the gap. The method
takes the swing for a sine, and the twist that the controller knows for the true one.

## The estimate

From runs of the loop with all noise. Bias: mean error in contact over the gear torque; wrong mode: share of the time in
which the estimate has the teeth elsewhere than they are (one flank, the gap, the other flank).

{estimates}

## Sensitivity

By how many % a metric changes for 1 % of a parameter (from runs with 10 % more and less, same noise). Parameters of
plant, motor and bus change the car alone, those of the controller what it knows and does. The {most} largest; all are
in `sensitivity.csv`.

![sensitivity](figures/analysis_sensitivity.png)

{sensitivities}

Made by `driveline analyse --output FOLDER{arguments}`; do not edit.
"""


def page(found: Analysis, arguments: str) -> str:
    """The page as Markdown; arguments: of the command beside --output."""
    return PAGE.format(
        controller=found.controller,
        arguments=arguments,
        torque=TORQUE,
        margins=markdown_table(margin_headings(), margin_rows(found), labels=1),
        swept=markdown_table(["plant", "what", "value", *SWEPT], _swept_rows(found), labels=2),
        excluded=_excluded(found),
        estimates=markdown_table(["plant", "manoeuvre", *_headings(EstimateMetrics)], _estimate_rows(found), labels=2),
        most=MOST,
        sensitivities=markdown_table(
            ["parameter", "plant", "manoeuvre", *_short()], _sensitivity_rows(found), labels=3
        ),
    )


SWEPT = ("drive train, Hz", "damping ratio", "gain margin", "delay margin, ms", "M_s")

SMALLEST = ("gain_margin", "delay_margin")

MOST = 12


def _headings(record: type) -> list[str]:
    return [
        f"{metric.column.plain_heading}{'' if metric.column.unit == '1' else ', ' + metric.column.unit}"
        for metric in declared(record)
        if metric.column
    ]


def margin_headings() -> list[str]:
    """Of the table of margins."""
    return ["plant", "speed, km/h", "drive train, Hz", "damping ratio", *_headings(Margins)]


def margin_rows(found: Analysis) -> Iterator[list[str]]:
    """The margins of each plant at each speed."""
    for at in found.at:
        yield [at.plant, f"{at.speed:g}", *_mode(at.mode), *_cells(at.margins)]


def _mode(mode: tuple[float, float]) -> list[str]:
    return ["-" if isnan(mode[0]) else f"{mode[0]:.1f}", "-" if isnan(mode[0]) else f"{mode[1]:.2f}"]


def _cells(record: object) -> list[str]:
    shown = [(metric.of(record), metric.column) for metric in declared(type(record)) if metric.column]
    return ["any" if value == float("inf") else number(value, column) for value, column in shown]


def _swept_rows(found: Analysis) -> Iterator[list[str]]:
    for plant, sweeps in found.swept.items():
        for sweep in SWEEPS:
            each = sweeps[sweep.name]
            for swept in (each[0], each[len(each) // 2], each[-1]):
                margin = swept.margins
                cells = (
                    ["unstable"] * 3
                    if margin is None
                    else [
                        _finite(margin.gain_margin, 1.0, 1),
                        _finite(margin.delay_margin, 1e3, 1),
                        f"{margin.M_s:.2f}",
                    ]
                )
                yield [plant, f"{sweep.name}, {sweep.unit}", f"{swept.value:.3g}", *_mode(swept.mode), *cells]


def _finite(value: float, factor: float, decimals: int) -> str:
    return f"{factor * value:.{decimals}f}" if isfinite(value) else "any"


def _excluded(found: Analysis) -> str:
    """What the describing function says, a sentence or two for each plant."""
    lines = []
    for plant, cycles in found.limit_cycles.items():
        known = [(swing.amplitude, swing.margins) for swing in found.swings[plant] if swing.margins]
        text = "; ".join(map(_cycle, cycles)) or "none at any amplitude"
        line = f"- `{plant}`: {text}."
        if known:
            gain, delay = (min(known, key=lambda each: getattr(each[1], name)) for name in SMALLEST)
            line += (
                f" Where swings die away the smallest gain margin is {_finite(gain[1].gain_margin, 1.0, 1)} "
                f"({_where(gain[0])}), the smallest delay margin {_finite(delay[1].delay_margin, 1e3, 1)} ms "
                f"({_where(delay[0])})."
            )
        lines.append(line)
    return "\n".join(lines)


def _cycle(cycle: LimitCycle) -> str:
    kind = "one that lasts" if cycle.lasting else "one from which larger swings grow"
    return f"{kind}, {cycle.amplitude:.2f} φ_B at {cycle.frequency:.2g} Hz (N = {cycle.N:.2g})"


def _where(amplitude: float) -> str:
    return f"at {amplitude:.3g} φ_B" if isfinite(amplitude) else "in contact"


def _estimate_rows(found: Analysis) -> Iterator[list[str]]:
    for (plant, manoeuvre), metrics in found.estimates.items():
        yield [plant, f"{manoeuvre}, {MANOEUVRES[manoeuvre].description}", *_cells(metrics)]


def _short() -> list[str]:
    return [metric.column.plain_heading for metric in declared(Metrics) if metric.name in SHOWN and metric.column]


def _sensitivity_rows(found: Analysis) -> Iterator[list[str]]:
    for parameter in most_important(found.sensitivities, MOST):
        for each in found.sensitivities:
            if each.parameter == parameter:
                cells = ["-" if isnan(value) else f"{value:+.2f}" for value in each.changes.values()]
                yield [f"`{parameter}`", each.plant, each.manoeuvre, *cells]
