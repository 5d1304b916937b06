"""The documentation page that `driveline coupling` writes."""

from collections.abc import Iterable, Mapping, Sequence

from ...cosimulation.schedule import Transfer
from ...cosimulation.system import Scheme
from ...views.markdown import markdown_table
from .coupling import SIGNALS, Comparison
from .step_dependence import STEPS, Case

PAGE = """\
# Coupling error and dead time of the master

The master steps FMUs that know of each other only at the communication points. What that does to the
loop is measured here against its monolithic solution (`harness/studies/coupling/monolithic.py`): motor and plant
integrated as one system, the sampled blocks ticking with the values of exactly that instant. Noise and
rounding are off; delays and losses on the bus are the same in all runs.

Over a step from t to t + h,

- **propagated** (the default) gives every FMU the values of t. A continuous signal then goes on, if the FMUs can. If
  the FMU that puts it out has been stepped before, it interpolates ({interpolated}), along the straight line nearest
  to the cubic through its values and derivatives at t and t + h, or along the chord where derivatives are not told.
  Else it extrapolates along its derivative ({extrapolated}). If the FMUs cannot (Python builds, FMUs from
  elsewhere), it is held.
  At t + h outputs go on to inputs along the declared dependencies until every output is that of t + h with the inputs
  of t + h: `motor.omega_1_meas` follows from `plant.omega_1`, so the motor is asked again after the plant. Declared
  dependencies that form an algebraic loop are refused before the run;
- **Gauss-Seidel** steps one after the other and hands each the newest outputs: an FMU gets from those before it the
  values of t + h, from those after it the values of t. The order is {order};
- **Jacobi** gives all of them the values of t, and reads all outputs afterwards. Of hosts, libcosim, ecos and MasterSim
  do the same; OMSimulator propagates.

What that does:

- A continuous FMU that holds what it gets over the step gets the value of t late by h/2 on average and that
  of t + h early by h/2. On a straight line nothing is late or early: with derivatives the error falls with the
  fourth power of the step, without with the square.
- A sampled FMU ticks at t, with what it gets for the step: the value of t is exact there, that of t + h
  early by h. What it computed before changes at its tick: the value of t is exact, that of t + h early
  by h.
- `motor.omega_1_meas` follows from `plant.omega_1`, which under Gauss-Seidel and Jacobi the motor has held since the
  beginning of its last step: late by h, unless the plant comes before the motor.

## Dead time

In ms, measured with a sine in the open loop as a shift in time against the monolithic solution
(`harness/studies/coupling/dead_time.py`); negative where a signal comes too early. The delay of the controller (one
sample) and of the bus are part of the loop and not counted.

{dead_times}

## Error at a communication step of {step:g} ms

The largest and the rms distance from the monolithic solution, in % of the range of the signal, over
{duration:g} s of a tip-in with damping. Through the backlash, some decisions of the controller (teeth in the
gap or not) fall one sample earlier or later under Gauss-Seidel and Jacobi, and single samples of `T_ref` differ
by as much as these change it.

{errors}

## Order

The rms error of `T_gear` in % of its range by the communication step in ms, and the power of the step
with which it falls. Through the backlash that of Gauss-Seidel and Jacobi is blurred: a decision that falls one
sample off makes the same difference at any step, until at a small enough one it falls in time.

{orders}

## What it does to the metrics

Every manoeuvre with noise, as `driveline compare` runs it, under the propagated scheme at {coarse:g} ms and at
{fine:g} ms: of all metrics that a run has, the one that deviates most, in % of its value at {fine:g} ms. A settling
time or a delay that is a sample earlier or later counts as equal. The impact speed is read between the rows of a run,
so it is as good as they are dense.

{metrics}

Made by `driveline coupling`; do not edit.
"""


def page(
    comparisons: Sequence[Comparison],
    dead_times: Mapping[tuple[Scheme, float], Mapping[str, float]],
    transfers: Mapping[str, Transfer],
    order: Sequence[str],
    step_size: float,
    metrics: Mapping[Case, Mapping[str, float]],
) -> str:
    """The page as Markdown.

    Args:
        comparisons: each with a deviation at `step_size` (s).
        dead_times: by scheme and communication step, then by section of the loop, in s.
        transfers: of inputs under the propagated scheme.
        order: of the instances.
        metrics: deviations of the metrics by case, see `.step_dependence`.
    """
    moving = {t: _names(name for name in transfers if transfers[name] is t) or "none here" for t in Transfer}
    return PAGE.format(
        interpolated=moving[Transfer.INTERPOLATED],
        extrapolated=moving[Transfer.EXTRAPOLATED],
        order=_names(order),
        step=1e3 * step_size,
        duration=comparisons[0].manoeuvre.duration,
        dead_times=_dead_times(dead_times),
        errors=_errors(comparisons, step_size),
        orders=_orders(comparisons),
        coarse=1e3 * STEPS[0],
        fine=1e3 * STEPS[1],
        metrics=_metrics(metrics),
    )


def _names(names: Iterable[str]) -> str:
    return ", ".join(f"`{name}`" for name in names)


def _dead_times(found: Mapping[tuple[Scheme, float], Mapping[str, float]]) -> str:
    columns = list(found.values())
    heads = [f"{scheme.value}, h = {1e3 * step:g} ms" for scheme, step in found]
    # adding zero turns a rounded -0 into 0
    rows = [[name, *(f"{round(1e3 * column[name], 2) + 0.0:.2f}" for column in columns)] for name in columns[0]]
    return markdown_table(["connection", *heads], rows, labels=1)


def _errors(comparisons: Sequence[Comparison], step_size: float) -> str:
    rows = [
        [
            *_case(c),
            *(f"{_percent(d.largest)} / {_percent(d.rms)}" for d in c.deviations[step_size].values()),
        ]
        for c in comparisons
    ]
    return markdown_table([*CASE, *(f"`{name}`" for name in SIGNALS)], rows, labels=3)


def _orders(comparisons: Sequence[Comparison]) -> str:
    steps = list(comparisons[0].deviations)
    rows = [
        [
            *_case(c),
            *(_percent(c.deviations[step]["plant.T_gear"].rms) for step in steps),
            f"{c.order('plant.T_gear'):.1f}",
        ]
        for c in comparisons
    ]
    return markdown_table([*CASE, *(f"{1e3 * step:g}" for step in steps), "order"], rows, labels=3)


def _metrics(found: Mapping[Case, Mapping[str, float]]) -> str:
    runs = dict.fromkeys((case.plant, case.manoeuvre) for case in found)
    rows = [[*run, *(_worst(found[Case(*run, control)]) for control in (False, True))] for run in runs]
    return markdown_table(["plant", "manoeuvre", "without damping", "with damping"], rows, labels=2)


def _worst(deviations: Mapping[str, float]) -> str:
    name = max(deviations, key=deviations.__getitem__)
    return f"{_percent(deviations[name])} ({name.replace('_', ' ')})"


CASE = ("plant", "tip-in", "scheme")


def _case(c: Comparison) -> tuple[str, str, str]:
    return c.plant, c.manoeuvre.description, c.scheme.value


def _percent(share: float) -> str:
    return f"{100.0 * share:.2g}"
