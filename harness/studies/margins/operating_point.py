"""What is analysed: a car with its controller, and where it is."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from fmublocks.block.types import ContinuousBlock, SampledBlock

from ....models import damping_controller, motor_torque_loop, two_mass_driveline, wheel_speed_can

MOTOR, CAN = motor_torque_loop.BLOCK, wheel_speed_can.BLOCK


@dataclass(frozen=True)
class Point:
    """The loop at an operating point, with the teeth in contact on the driving side.

    Attributes:
        plant, controller: the blocks.
        parameters: values by instance (plant, motor, can, controller) and name; others keep their start value.
        v: speed of the car in m/s.
        T: stationary motor torque in N.m.
        late: dead time in s between the demand and the motor, beside that of the controller.
        wheel: whether valid wheel speeds come; None: as the speed says.
    """

    plant: ContinuousBlock = two_mass_driveline.BLOCK
    controller: SampledBlock = damping_controller.BLOCK
    parameters: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    v: float = 15.0 / 3.6
    T: float = 40.0
    late: float = 0.0
    wheel: bool | None = None

    def of(self, instance: str, block: Any) -> Any:
        """The parameters of a block."""
        return block.Parameters(**self.parameters.get(instance, {}))

    def with_parameters(self, **values: Mapping[str, Any]) -> "Point":
        """The same with other parameters, by instance."""
        given = {name: {**self.parameters.get(name, {}), **entries} for name, entries in values.items()}
        return replace(self, parameters={**self.parameters, **given})

    @property
    def wheel_speed_in_use(self) -> bool:
        """Whether valid wheel speeds come."""
        return self.v > self.of("can", CAN).v_on if self.wheel is None else self.wheel
