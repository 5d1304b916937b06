"""Cases of the calibration: parameters of the damping law, cars behind the back of the controller, sensors.

"not told" is a controller that takes another car for the default one, "told" one that is designed for it.
"""

from functools import cache
from typing import NamedTuple

import numpy as np

from driveline.harness.design.design import damping_law, design
from driveline.harness.design.design_weights import CAN as BUS
from driveline.harness.design.design_weights import MOTOR, PARAMETERS, PLANT, WEIGHTS, drive_train
from driveline.harness.design.loop_parameters import loop_parameters
from driveline.harness.design.uncertainty_box import NOMINAL, Deviation, deviating
from driveline.harness.loop.places import PLACES, PLANTS
from driveline.harness.loop.settings import Settings
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.manoeuvres.manoeuvre import Manoeuvre
from driveline.harness.manoeuvres.signals import NOTHING
from driveline.harness.metrics.evaluate import evaluate
from driveline.harness.metrics.run_metrics import Metrics
from driveline.harness.simulation.simulate import simulate
from driveline.models.controller.supervision import FALLBACK

from .design_trials import mean

SEEDS = (1, 2, 3)

FACTOR = 1.5
"""By which each parameter of the law is divided and multiplied."""

STANDSTILL = Manoeuvre("standstill", "stand without demand", duration=4.0, v_0=0.0, T_driver=NOTHING)

DRIVEN = ("tipin15", "tipin15r", "tipout", "launch", "creep")
"""The manoeuvres in which the parameters of the law are changed."""

CAR_DRIVEN = ("tipin15", "launch")
"""Those in which the car is another one."""

LAW = tuple(damping_law(PLANT, MOTOR, drive_train(PLANT, MOTOR, BUS), WEIGHTS))
"""The parameters of the law that are designed."""

DEVIATIONS = (
    Deviation(C=0.5),
    Deviation(C=2.0),
    Deviation(J_2=0.5),
    Deviation(J_2=2.0),
    Deviation(phi_B=0.5),
    Deviation(phi_B=2.0),
    Deviation(tau=0.5),
    Deviation(tau=2.0),
    Deviation(delay=0.0),
    Deviation(delay=0.04),
)
"""Cars of which the controller knows nothing."""

Given = tuple[tuple[str, float], ...]
"""Parameters that are set, `instance.name` and value."""


class Case(NamedTuple):
    """A manoeuvre on a plant, with parameters that are set."""

    plant: str
    manoeuvre: str
    parameters: Given = ()


class Answer(NamedTuple):
    """Of a case, means over the seeds of the noise: its metrics, and the share of the samples in fallback."""

    metrics: Metrics
    fallback: float


def answered(case: Case, seeds: tuple[int, ...] = SEEDS, settings: Settings | None = None) -> Answer:
    """What a case gives.

    Args:
        settings: of the runs beside what the case says.
    """
    manoeuvre = {**MANOEUVRES, STANDSTILL.name: STANDSTILL}[case.manoeuvre]
    runs = [
        simulate(manoeuvre, settings, plant=case.plant, parameters=dict(case.parameters), seed=seed) for seed in seeds
    ]
    fallback = np.mean([np.mean(run["controller.status"] == FALLBACK) for run in runs])
    return Answer(mean([evaluate(run, manoeuvre) for run in runs]), float(fallback))


def changed_law(name: str) -> tuple[Given, Given]:
    """A parameter of the law, smaller and larger by FACTOR."""
    start = float(PARAMETERS[name].start)
    return ((f"controller.{name}", start / FACTOR),), ((f"controller.{name}", start * FACTOR),)


@cache
def another_car(plant: str, deviation: Deviation) -> tuple[Given, Given]:
    """A car that the controller takes for the default one, and the same car with a controller designed for it."""
    controller = PLACES["controller"][0]
    car = deviating({}, plant, controller, deviation)
    vehicle = {name.partition(".")[2]: value for name, value in deviating({}, PLANTS[0], controller, deviation).items()}
    own = loop_parameters(vehicle | design(vehicle), plant)
    assumed = {name: value for name, value in own.items() if name.startswith("controller.")}
    return tuple(car.items()), tuple((car | assumed).items())


STIFF = Deviation(C=2.0)


def stiff_vehicle() -> Case:
    """A tip-in on the validation vehicle of doubled stiffness, with its own gains and FACTOR times its own k_d."""
    own = dict(another_car(PLANTS[1], STIFF)[1])
    return Case(PLANTS[1], "tipin15", tuple((own | {"controller.k_d": FACTOR * own["controller.k_d"]}).items()))


def deviation_name(deviation: Deviation) -> str:
    """What is another one in a deviation, in words."""
    (name,) = (n for n in Deviation._fields if getattr(deviation, n) != getattr(NOMINAL, n))
    value = getattr(deviation, name)
    return f"transport delay {1e3 * value:g} ms" if name == "delay" else f"{name} x{value:g}"


class Suspect(NamedTuple):
    """What could lead to fallback without a fault: in words, what is set in car and controller, and what helps."""

    what: str
    parameters: Given
    helps: str


def _slow_motor(factor: float, **known: float) -> Given:
    """A motor with so many times its lag, and what the controller assumes."""
    return ("motor.tau", factor * MOTOR.tau), *((f"controller.{name}", value) for name, value in known.items())


K_D = float(PARAMETERS["k_d"].start)

SUSPECTS = (
    Suspect("nothing", (), ""),
    Suspect("noise of the motor speed, 2 rad/s rms", (("motor.sigma_omega", 2.0),), ""),
    Suspect("noise of the motor speed, 3 rad/s rms", (("motor.sigma_omega", 3.0),), "a larger jump"),
    Suspect("the same, jump 1.9", (("motor.sigma_omega", 3.0), ("controller.jump", 1.9)), ""),
    Suspect("torque estimate x1.4", (("motor.g_T", 1.4),), ""),
    Suspect("torque estimate x1.5", (("motor.g_T", 1.5),), "a better estimate"),
    Suspect("torque estimate + 9 N.m", (("motor.o_T", 9.0),), ""),
    Suspect("torque estimate + 12 N.m", (("motor.o_T", 12.0),), "a better estimate"),
    Suspect("lag of the motor x4", _slow_motor(4.0), "the true tau"),
    Suspect("the same, tau known", _slow_motor(4.0, tau=4.0 * MOTOR.tau), ""),
    Suspect("lag of the motor x5", _slow_motor(5.0), "the true tau, and less k_d"),
    Suspect("the same, tau known", _slow_motor(5.0, tau=5.0 * MOTOR.tau), "less k_d"),
    Suspect("the same, tau known and k_d / 2", _slow_motor(5.0, tau=5.0 * MOTOR.tau, k_d=0.5 * K_D), ""),
    Suspect("wheel speed x1.1", (("can.g_w2", 1.1),), ""),
    Suspect("wheel speed x1.15", (("can.g_w2", 1.15),), "the true radius; a larger g_radius"),
    Suspect("the same, g_radius 0.15", (("can.g_w2", 1.15), ("controller.g_radius", 0.15)), ""),
)

NOISES = (0.15, 0.6, 1.0, 1.5)
"""Of the motor speed at standstill, rms in rad/s."""

STILL = (3.0, 6.0)
"""Values of omega_still in rad/s that they are met with."""


def at_rest(sigma_omega: float, omega_still: float) -> Given:
    return ("motor.sigma_omega", sigma_omega), ("controller.omega_still", omega_still)
