"""The page that `driveline bound` writes."""

from collections.abc import Iterator, Sequence

from ...metrics.declaration import Column, declared
from ...metrics.evaluate import T_S, WITHHELD
from ...metrics.run_metrics import Metrics
from ...views.markdown import markdown_table
from ...views.metrics_table import number
from .active_constraints import SWING_RESERVE
from .bound_task import BOUNDED
from .bounds import Bounded
from .constraints import RESERVE
from .contacts import PARTS, Contacts
from .switching_search import BORDER

PAGE = """\
# What is possible, and {controller} beside it

No controller can do better than an optimal torque that is computed with full knowledge: of the car, of its state, of
what the driver will do. Here is that torque for the manoeuvres that are a step or a steep ramp, on the design model, at
the same response to the driver as the controller has: 90 % of the way at the same sample, no more torque withheld (nor
added) over {withheld:g} s, settled no later; with the same limits of the torque about the demand, the same torque loop,
sample time and sample of delay. The controller is measured without the noise of the motor's signals.

{summary}

- **controller / optimum**: the optimum makes the worst of four ratios to what the controller reaches as small as it can
  be: those of {metrics}. This is its inverse; at 1 the
  controller could not be better in all of them.
- **at most**: the same of the lower bound that is proven, see below.
- **contacts**: when the teeth leave a flank and meet the other one, in ms after the step: of the controller, and in the
  optimum.
- **deviation**: largest difference of the gear torque between the convex programme and the nonlinear design model
  driven by its torque.

![optimal torques](figures/bound.png)

The optimum kicks the teeth off their flank with all the torque that it may add, brakes before they land, and then
chatters between the limits. It knows when the demand changes and where the teeth are; a controller that feeds back what
it measures late stays above it.

## Metric by metric

Evaluated on the nonlinear design model, by the definitions of all other pages. *Jointly* is the optimum above; the
others make one metric alone small, with the rest no worse than the controller's. Overshoot alone can be avoided
altogether.

{every}

## How

Once it is given on which flank the teeth are and when they change it, the design model is linear: along a run its
Jacobian is taken from the project's own equations, and over each sample the motion is the exact solution (matrix
exponential), with the switching times on a grid of {grid:g} ms. The run is first that of the controller, then that of
the optimum found so. What the metrics say is then linear in the torque (overshoot, impact speed, 90 % of the way,
withheld torque, swings that count for settling) or a norm of what is linear (both rms values). So for given contacts
the best torque is that of a second-order cone programme, written in [CVXPY](https://www.cvxpy.org) and solved by
[Clarabel](https://clarabel.org), both open. CVXPY and not CasADi: it takes such a programme as it is written down,
refuses what is not convex, and hands back the multipliers that the proof needs, where CasADi is made for smooth
programmes and their local optima. The torque is free in every sample up to {withheld:g} s after the step and then the
demand. To keep the programme small it is held over several samples later on, which the bound does not assume.

## What is proven

- **For given contacts**: by weak duality. For any multipliers the least value of the Lagrangian over all torques within
  the limits, each sample free, is no more than the optimum. It is computed directly from the multipliers, so it holds
  whatever the accuracy of the solver is. Constraints that are looked at in some samples only make it lower.
- **For the switching times**: of the contacts with one passage through the gap, all pairs on the grid are bounded that
  are connected to the best one and not proven to be worse by more than {border:.1%}; the number is in the table. Beyond
  them the ratio rises in all directions. That there is no other valley far away is not proven, nor that teeth that
  bounce more than once could not do better. `tipin0` has no passage: there only contact throughout is looked at.
- **For the model**: of the motion linear along the optimum. The products of deviations that this leaves out are seen in
  the deviation of the run on the nonlinear model, which is the last column.
- **By the run**: that the ratio is reached. The torque of the programme was driven through the design model, and every
  figure of the optima above was measured there. To be safe the programme, and so the bound, asks for {reserve:g} N·m
  more at 90 % of the way and {swing:g} N·m less swing than needed: what a torque without these reserves could gain is
  not in the bound.
- Of the metrics made small alone only that such a run exists; their switching times are those that a descent on the
  grid finds.

The validation vehicle has no such bound: its tyres, ripple and differential are not linear for given contacts.

Made by `driveline bound --output FOLDER{arguments}`; do not edit.
"""

COLUMNS = {metric.name: metric.column for metric in declared(Metrics) if metric.column} | {
    "gear_torque_rms": Column("torque\n5-50 Hz", "N.m", 1.0, 2),
    "jerk_rms_to_50_Hz": Column("jerk\nto 50 Hz", "m/s3", 1.0, 2),
    "overshoot": Column("over-\nshoot", "%", 1e2, 1),
}

SHOWN = (*BOUNDED, "settling_time", "response_delay", "withheld_time")

GRID = 1e3 * T_S / PARTS
"""Of the switching times, in ms."""

SUMMARY = (
    "manoeuvre",
    "controller / optimum",
    "at most",
    "contacts, ms",
    "optimum, ms",
    "looked at",
    "deviation, N.m",
)


def page(found: Sequence[Bounded], controller: str, arguments: str) -> str:
    """The page as Markdown; arguments: of the command beside --output."""
    return PAGE.format(
        controller=controller,
        arguments=arguments,
        withheld=WITHHELD,
        summary=markdown_table(SUMMARY, summary_rows(found), labels=1),
        metrics=", ".join(COLUMNS[name].plain_heading for name in BOUNDED),
        every=markdown_table(["manoeuvre", "", *map(_heading, SHOWN)], _rows(found), labels=2),
        grid=GRID,
        border=BORDER - 1.0,
        reserve=RESERVE,
        swing=SWING_RESERVE,
    )


def summary_rows(found: Sequence[Bounded]) -> Iterator[list[str]]:
    """What is possible in each manoeuvre, beside the controller."""
    for each in found:
        yield [
            each.task.manoeuvre.name,
            f"{1.0 / each.ratio(each.jointly):.3f}",
            f"{1.0 / each.bound:.3f}",
            _times(each.task.contacts),
            _times(each.jointly.contacts),
            str(each.neighbours),
            f"{each.jointly.deviation:.1g}",
        ]


def _times(contacts: Contacts) -> str:
    """Of the changes, in ms after the step."""
    return " / ".join(f"{1e3 * T_S + GRID * end:g}" for end in contacts.ends) or "-"


def _rows(found: Sequence[Bounded]) -> Iterator[list[str]]:
    for each in found:
        runs = {"controller": each.task.reached, "jointly": each.jointly.metrics}
        runs |= {f"{COLUMNS[name].plain_heading} alone": optimum.metrics for name, optimum in each.alone.items()}
        for name, metrics in runs.items():
            cells = (number(getattr(metrics, shown), COLUMNS[shown]) for shown in SHOWN)
            yield [each.task.manoeuvre.name, name, *cells]


def _heading(name: str) -> str:
    column = COLUMNS[name]
    return f"{column.plain_heading}, {column.unit}"
