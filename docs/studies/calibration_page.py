"""Writes docs/calibration.md, how to calibrate the controller: `python -m docs.studies.calibration_page`."""

from pathlib import Path
from shutil import copyfile
from tempfile import TemporaryDirectory

from docs.studies.calibration import FACTOR, STANDSTILL, answered, cases, stiff_vehicle
from docs.studies.calibration_figure import plot_calibration
from docs.studies.calibration_tables import (
    COLUMNS,
    HEADINGS,
    LEAST,
    Found,
    cars,
    changes,
    fallback,
    nominal,
    rest,
    symptoms,
    unknown_and_known,
    value,
    without_effect,
)
from driveline.harness.base.atomic_files import write_text
from driveline.harness.base.interruption import script
from driveline.harness.design.uncertainty_box import Deviation
from driveline.harness.loop.places import PLANTS
from driveline.harness.simulation.many_runs import run_many
from driveline.harness.views.markdown import markdown_table
from driveline.harness.views.metrics_table import number

DOCS = Path(__file__).parents[2] / "docs"

PAGE = """\
# Calibration in a car

How to set the controller up in a car, and what to turn when something is not as it should be. All figures are those of
the default car, means over the noise of three seeds, on both plants: `TwoMassDriveline` is the model that the
controller knows, `ValidationVehicle` one that it does not. [derivation.md](derivation.md) says what each parameter
does in the law.

## Order of steps

1. **Describe the car** in a vehicle file ([control.md](control.md#where-the-gains-come-from)).

    - `J_1`: the rotor and all that turns with it up to the gap.
    - `phi_B`: with the wheels held, turn the motor gently from flank to flank; the way is 2 `phi_B`.
    - `C`: from the frequency f of the shuffle after a tip-in with `enable` off. It lies between
      (2 pi f)^2 J_1 J_2/(J_1 + J_2), if the wheels swing freely, and (2 pi f)^2 J_1, if the tyres hold them.
    - `tau`: from the response of the motor's torque to a step.

    [A car that the controller does not know](#a-car-that-the-controller-does-not-know) says which of them matter.

2. **Compute the gains**: `driveline design --vehicle car.toml --output gains.toml`.
3. **Look at the signals**, with the damping off. At standstill the noise of the motor speed stays far below
   `omega_still` ([Rattle at standstill](#rattle-at-standstill)). In a drive `status` is never `fallback` once the
   damping is on ([Fallback without a fault](#fallback-without-a-fault)), and in a long acceleration `T_gear_hat` is
   `T_mot_est` less what accelerates the rotor.
4. **Teeth in contact**: tip-ins from a torque that keeps the teeth on the flank (`tipin0`). `k_d` first, then
   `omega_w`.
5. **Landing in a jump**: tip-ins through the gap and letting go of the pedal (`tipin15`, `tipin50`, `tipout`). `T_gap`,
   `bounce`, then `t_return`.
6. **Landing in ramps**: `tipin15r`, `launch`, `creep`. `bounce`, `brake`, `haste`, `k_gap`.
7. **Look at the whole**: `driveline compare --parameters gains.toml`, `driveline robustness` for cars that differ, and
   `python -m docs.studies.goals --parameters gains.toml`. Steps 4 to 6 on the models are what
   `driveline design --search` does ([tuning.md](tuning.md)).

One parameter at a time, and the same tip-in before and after.

## Which parameter for which symptom

What it does to the symptom and what it costs: changes from the values of the default car, on the design model; on the
validation vehicle.

{symptoms}

## Sensitivities of the damping law

Each parameter divided / multiplied by {factor:g}, one at a time: by how much the metric changes. Rows in which nothing
changes by more than {least} % are left out. {silent}

{plants}

## A car that the controller does not know

The car is another one. The controller takes it for the default car / is told, and has the gains that `driveline design`
computes for it. By how many % each metric changes for 1 % of any parameter of car and controller is in
[analysis.md](analysis.md#sensitivity), random cars are in [robustness.md](robustness.md).

{cars}

Figures not told / told, on the design model; on the validation vehicle:

- `C` and `phi_B` are worth measuring. Half the stiffness: a tip-in settles after {soft}. Twice the gap: it
  overshoots by {wide}.
- The design knows the design model alone. With doubled stiffness a tip-in overshoots by {stiff}. On the vehicle
  {factor:g} times the `k_d` that is designed takes that to {stiffer}.
- With a motor that is twice as slow, and is known to be, the look-ahead counts on the torque that is under way. The
  torque of a tip-in is there sooner ({slow}), and lands harder (jerk {slow_jerk}).
- Whether `J_2` and the transport delay are known hardly matters: the estimate lives on the motor speed.

## Rattle at standstill

At rest the damping fades out: when the demand has been within `T_still` and the motor speed within `omega_still` for
`t_rest`. Noise that reaches `omega_still` keeps it awake. Standing for {standing:g} s without demand: the torque that
the controller adds, rms in N.m.

{rest}

So `omega_still` is to be at least five times the rms noise. Below it a car that rolls without demand is not damped.

## Fallback without a fault

The uneven drive (`drive`), with car or sensors off: share of the samples in fallback, and what helps. The thresholds
are in [control.md](control.md#signals-that-fail); how far healthy drives stay away from them is printed by
`python -m docs.studies.healthy_hours`.

{fallback}

The torque estimate is compared with what `T_ref` and `tau` let expect, up to 5 % of `T_max` and 35 %. With five times
the lag the torque comes so late that the damping feeds the swing, and that is what is found.

Made by `python -m docs.studies.calibration_page`; do not edit.
"""

PLANT = """\
### {plant}

As it is:

{nominal}

{changes}

![tornado of {plant}](figures/{stem}.png)
"""


def page(found: Found) -> str:
    """The page as Markdown."""
    return PAGE.format(
        factor=FACTOR,
        least=f"{1e2 * LEAST:g}",
        standing=STANDSTILL.duration,
        symptoms=symptoms(found),
        silent=without_effect(found),
        plants="\n".join(_plant(found, plant) for plant in PLANTS).rstrip(),
        cars=markdown_table(["plant", "car", "manoeuvre", *HEADINGS], cars(found), labels=3),
        rest=rest(found),
        fallback=fallback(found),
        soft=unknown_and_known(found, Deviation(C=0.5), "settling_time"),
        wide=unknown_and_known(found, Deviation(phi_B=2.0), "overshoot"),
        stiff=unknown_and_known(found, Deviation(C=2.0), "overshoot"),
        stiffer=f"{number(value(found, stiff_vehicle(), 'overshoot'), COLUMNS['overshoot'])} %",
        slow=unknown_and_known(found, Deviation(tau=2.0), "response_delay"),
        slow_jerk=unknown_and_known(found, Deviation(tau=2.0), "jerk_rms"),
    )


def _plant(found: Found, plant: str) -> str:
    return PLANT.format(
        plant=plant,
        stem=figure_stem(plant),
        nominal=markdown_table(["manoeuvre", *HEADINGS], nominal(found, plant), labels=1),
        changes=markdown_table(["parameter", "manoeuvre", *HEADINGS], changes(found, plant), labels=2),
    )


def figure_stem(plant: str) -> str:
    return f"calibration_{plant}"


def main() -> None:
    todo = cases()
    found = dict(zip(todo, run_many(answered, todo), strict=True))
    with TemporaryDirectory() as folder:
        for plant in PLANTS:
            picture, _ = plot_calibration(found, plant, Path(folder) / figure_stem(plant))
            copyfile(picture, DOCS / "figures" / picture.name)
    path = DOCS / "calibration.md"
    write_text(page(found), path)
    print(path)


if __name__ == "__main__":
    script(main)
