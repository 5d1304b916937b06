"""What the design works with: the car, as the blocks know it and as the design sees it, and the designer's weights."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import sqrt
from typing import Any, NamedTuple

from fmublocks.description.variables import interface

from ...fmus.building.one_car import of_one_car
from ...models import motor_torque_loop, two_mass_driveline, wheel_speed_can
from ...models.controller import T_S
from ...models.damping_controller import BLOCK

Plant = two_mass_driveline.Parameters
Motor = motor_torque_loop.Parameters
Can = wheel_speed_can.Parameters

PLANT, MOTOR, CAN = Plant(), Motor(), Can()
"""The default car."""

PARAMETERS = {variable.name: variable for variable in interface(BLOCK) if variable.causality == "parameter"}
"""Of the controller, as they are declared."""


def records(vehicle: Mapping[str, Any]) -> tuple[Plant, Motor, Can]:
    """A car by the entries of its vehicle file; what these do not name follows or is that of the default car.

    Raises:
        ParameterFileError: see `of_one_car`.
    """
    car = of_one_car(vehicle, Plant._fields)

    def of(record: Any) -> Any:
        return record(**{name: car[name] for name in record._fields if name in car})

    return of(Plant), of(Motor), of(Can)


@dataclass(frozen=True)
class Weights:
    """What the designer decides, without dimension. With these the default car gets round parameters.

    Attributes:
        wheel_share: share of the gear torque that moves the wheels alone, over what is theirs when they move as one
            with the vehicle. With less than 1 the estimated wheels follow the motor less, as on a slipping tyre.
        torque_error, load_error, slow_load_error: standard deviations of what the estimator's model does not know
            of the torques at the motor and at wheels and vehicle per sample, the last one added up; over T_max.
        slip_load_error: the last one while the wheels slip.
        twist_error: the same of the twist; over T_max/C.
        message_error: standard deviation of a wheel-speed message, over the speed that T_max adds to the car
            within a cycle and the spread of the delays.
        damping_ratio: of the drive train with the feedback of the speed difference alone, at the least.
        phase: that the dead time may take where the loop crosses over, rad; a drive train that is damped well with
            less is damped more.
        look_ahead: time that the estimate is taken ahead, over omega_0 T_dead^2.
        washout: its corner frequency, over omega_0.
        shape_1, shape_2, k_gap, landing_brake, landing_share, demand_lead: see the damping law.
        shape: corner frequency of the lags that shape the demand, over omega_0.
        landing_ahead: time that the estimate is taken ahead for a landing, over T_dead.
        landing: torque that brakes before an impact, over T_max.
        largest: demand from which on impacts are no harder, over T_max.
        impact: gear torque that the largest speed of a landing could make, over T_max.
        learning: change of the half gap by a crossing, over that of the twist which makes J_1 as much faster in a
            sample as the innovations of the crossing are.
        recent: corner frequency that tells which change of the demand is recent, over omega_v.
        comeback: time constant with which the torque that a landing withheld comes back, times omega_0.
        longest_landing: how long a landing may last, times omega_v.
        take, add: what may be taken from the demand at the least, and added to it, over T_max.
        catch: what may be taken, over the torque by which the drive train would be twisted if T_max accelerated the
            motor from flank to flank.
    """

    wheel_share: float = 0.5235932
    torque_error: float = 1.0 / 180.0
    load_error: float = 0.3192848
    slow_load_error: float = 0.01 / 180.0
    slip_load_error: float = 0.6 / 180.0
    twist_error: float = 6.52222e-4
    message_error: float = 0.4698217
    damping_ratio: float = 0.5036608
    phase: float = 0.31
    look_ahead: float = 0.4093712
    k_gap: float = 0.97
    washout: float = 0.06442173
    shape_1: float = 0.57
    shape_2: float = -0.46
    shape: float = 1.803808
    landing_ahead: float = 1.104569
    landing: float = 0.3166667
    largest: float = 0.6666667
    impact: float = 0.45
    learning: float = 0.006232873
    landing_share: float = 0.5
    landing_brake: float = 0.93
    demand_lead: float = 1.1
    recent: float = 1.43854
    comeback: float = 0.2188702
    longest_landing: float = 0.8063731
    take: float = 0.5555556
    add: float = 0.3333333
    catch: float = 0.868


WEIGHTS = Weights()


class DriveTrain(NamedTuple):
    """A car as the design sees it; inertias in kg.m2 of the motor side, frequencies in rad/s, times in s.

    Attributes:
        M: inertia of the vehicle, m r^2/i^2.
        lambda_v: share of the gear torque that the vehicle takes, 1 - wheel_share J_2/(J_2 + M).
        omega_0: natural frequency of the drive train, sqrt(C/J_1 + (1 - lambda_v) C/J_2).
        omega_v: natural frequency of vehicle and wheels on the drive train with the motor held, sqrt(C/(M + J_2)).
        T_dead: computation and hold of the controller, lag of the motor.
        T_age: mean age of a wheel-speed message.
    """

    M: float
    lambda_v: float
    omega_0: float
    omega_v: float
    T_dead: float
    T_age: float


def drive_train(plant: Plant, motor: Motor, can: Can, weights: Weights = WEIGHTS) -> DriveTrain:
    M = plant.m * plant.r**2 / plant.i**2
    # where the wheels are next to nothing the controller takes no larger share for the vehicle
    lambda_v = min(1.0 - weights.wheel_share * plant.J_2 / (plant.J_2 + M), PARAMETERS["lambda_v"].bounds()[1])
    return DriveTrain(
        M=M,
        lambda_v=lambda_v,
        omega_0=sqrt(plant.C * (1.0 / plant.J_1 + (1.0 - lambda_v) / plant.J_2)),
        omega_v=sqrt(plant.C / (M + plant.J_2)),
        T_dead=1.5 * T_S + sqrt(2.0) * motor.tau,
        T_age=0.5 * (can.T_cyc + can.d_min + max(can.d_min, can.d_max)),
    )
