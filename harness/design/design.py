"""Design of the damping controller for a car: Riccati equations and a few formulas, with dimensionless weights.

The estimator's gains are those of a Kalman filter (kalman). The damping law follows from three times of the
car (weights): the drive train swings at omega_0, the vehicle would swing on it at omega_v if the motor were
held, and the loop acts T_dead late.
"""

from collections.abc import Mapping
from math import inf, sqrt
from typing import Any

from fmublocks.description.variables import Variable

from ...fmus.building.parameter_files import of_vehicle
from ...models.controller import T_S
from .character import factors
from .design_weights import (
    CAN,
    MOTOR,
    PARAMETERS,
    PLANT,
    WEIGHTS,
    Can,
    DriveTrain,
    Motor,
    Plant,
    Weights,
    drive_train,
    records,
)
from .kalman import DesignError, estimator_gains

AUTHORITY = ("T_take_max", "T_add_max")
"""How much the control may change of the demand: the design asks for what it needs, a user may allow less."""


def design(
    vehicle: Mapping[str, Any] | None = None,
    weights: Weights = WEIGHTS,
    limits: Mapping[str, float] | None = None,
    character: float = 0.5,
) -> dict[str, float]:
    """All parameters of the controller that are designed for a car, by name, in SI units.

        gains = driveline.design({"m": 1900.0, "C": 150.0})
        gains["k_d"]  # in N.m.s/rad

    Args:
        vehicle: entries of a vehicle file, in SI units, as `read_vehicle` gives them; what they do not name follows
            from them or is that of the default car.
        weights: what the designer decides.
        limits: the most that T_take_max and T_add_max may be, in N.m, by these names.
        character: from 0, sport, to 1, comfort.

    Raises:
        ParameterFileError: one is not known, no number or out of range; they disagree, or there is no such car.
        DesignError: the car leaves something undetermined, or needs what the controller cannot be set to.
    """
    return gains_of(*records(of_vehicle(vehicle)), weights, limits, character)


def gains_of(
    plant: Plant = PLANT,
    motor: Motor = MOTOR,
    can: Can = CAN,
    weights: Weights = WEIGHTS,
    limits: Mapping[str, float] | None = None,
    character: float = 0.5,
) -> dict[str, float]:
    """The same for the records of a car.

    Args:
        plant, motor, can: the car.
        character: see `design`.

    Raises:
        DesignError: the car leaves something undetermined, or needs what the controller cannot be set to.
    """
    train = drive_train(plant, motor, can, weights)
    of_messages = possible({"T_age": train.T_age})
    gains = estimator_gains(plant, motor, can, train, weights)
    law = damping_law(plant, motor, train, weights)
    law |= {name: factor * law[name] for name, factor in factors(character).items()}
    learned = {"L_phi_B": weights.learning * plant.J_1 / (plant.C * T_S)}
    allowed = {
        name: min(asked, (limits or {}).get(name, inf)) for name, asked in authority(plant, motor, weights).items()
    }
    return possible({"lambda_v": train.lambda_v, **gains, **of_messages, **learned, **law, **allowed})


def literal_observer(
    plant: Plant = PLANT, motor: Motor = MOTOR, can: Can = CAN, weights: Weights = WEIGHTS
) -> dict[str, float]:
    """The gains of the paper's observer taken literally, by name; args and errors as of `gains_of`."""
    return possible(estimator_gains(plant, motor, can, drive_train(plant, motor, can, weights), weights, literal=True))


def possible(parameters: dict[str, float]) -> dict[str, float]:
    """The parameters, if the controller can be set to them.

    Raises:
        DesignError: names those that are out of their bounds.
    """
    problems = []
    for name, value in parameters.items():
        low, high = PARAMETERS[name].bounds()
        if not low <= value <= high:
            problems.append(f"{name} would be {value:.4g}; the controller takes {PARAMETERS[name].allowed()}")
    if problems:
        raise DesignError("\n".join(problems))
    return parameters


def damping_law(plant: Plant, motor: Motor, train: DriveTrain, weights: Weights) -> dict[str, float]:
    """The parameters of the damping law.

    In contact k_d damps the drive train with the ratio k_d/(2 J_1 omega_0). Above the resonance, where J_1 alone
    is left, the loop crosses over at k_d/J_1, and there the dead time takes the phase T_dead k_d/J_1. What the estimate
    is taken ahead makes up for the part omega_0 T_dead of the dead time: the slower the motor is for its drive train,
    the more it has to. A landing is a motion of the motor alone, which the whole dead time delays.
    """
    k_d = plant.J_1 * max(2.0 * weights.damping_ratio * train.omega_0, weights.phase / train.T_dead)
    furthest, furthest_landing = (PARAMETERS[name].bounds()[1] for name in ("T_pred", "T_pred_land"))
    return {
        "T_pred": min(weights.look_ahead * train.omega_0 * train.T_dead**2, furthest),
        "k_d": k_d,
        "omega_w": weights.washout * train.omega_0,
        "shape_1": weights.shape_1,
        "shape_2": weights.shape_2,
        "omega_shape": min(weights.shape * train.omega_0, PARAMETERS["omega_shape"].bounds()[1]),
        "k_gap": weights.k_gap,
        "T_pred_land": min(weights.landing_ahead * train.T_dead, furthest_landing),
        "T_gap": largest_landing(plant, motor, weights),
        "landing_brake": weights.landing_brake,
        "landing_share": weights.landing_share,
        "T_impact": weights.largest * motor.T_max,
        "demand_lead": weights.demand_lead,
        "omega_slow": weights.recent * train.omega_v,
        "t_return": max(weights.comeback / train.omega_0, PARAMETERS["t_return"].bounds()[0]),
        "t_land": weights.longest_landing / train.omega_v,
    }


def largest_landing(plant: Plant, motor: Motor, weights: Weights) -> float:
    """T_gap in N.m: a share of T_max, or less where the flight from flank to flank would become too fast.

    Braked by T_gap over 2 phi_B, the motor may have the speed that the spring turns into the torque T_peak of
    4 T_gap C phi_B = T_peak^2.
    """
    T_peak = weights.impact * motor.T_max
    bearable = T_peak**2 / (4.0 * plant.C * plant.phi_B) if plant.phi_B else inf
    return min(weights.landing * motor.T_max, bearable)


def authority(plant: Plant, motor: Motor, weights: Weights) -> dict[str, float]:
    """What the control may take from and add to the demand, in N.m.

    Both are shares of T_max, as the steps of the demand are. A landing takes more in a wide gap: T_max over the whole
    gap makes J_1 so fast that its impact twists the drive train by the torque T_flight,
    T_flight^2/(2 C) = 2 phi_B T_max.
    """
    T_flight = 2.0 * sqrt(plant.C * plant.phi_B * motor.T_max)
    return {
        "T_take_max": max(weights.take * motor.T_max, weights.catch * T_flight),
        "T_add_max": weights.add * motor.T_max,
    }


def gains_file(parameters: Mapping[str, float], comment: str, declared: Mapping[str, Variable] = PARAMETERS) -> str:
    """Designed parameters as TOML, to six significant digits, each with its unit and meaning, under a comment.

    Args:
        declared: the parameters of the controller.
    """
    entries = [f"{name} = {float(f'{value:.6g}')!r}" for name, value in parameters.items()]
    width = max(map(len, entries))
    lines = [f"# {line}" for line in comment.splitlines()] + [""]
    for name, entry in zip(parameters, entries, strict=True):
        declaration: Any = declared[name].declaration
        lines.append(f"{entry:{width}}  # {declaration.unit}, {declaration.description}")
    return "\n".join(lines) + "\n"
