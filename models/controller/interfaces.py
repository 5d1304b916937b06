"""What a controller is made of: an estimator and a law, each a module with these names.

A part has a record `Parameters` with its declared parameters, a state that is a record, and pure
functions. p holds the parameters of all parts and of the supervision by name, T_s is the sample time
in s. All quantities are referred to the motor side.
"""

from typing import Annotated, Any, NamedTuple, Protocol

from ..block.declaration import Real


class Motion(NamedTuple):
    """Motion of the drive train as an estimator sees it."""

    omega_1: Annotated[float, Real("rad/s", "speed of the motor")]
    omega_2: Annotated[float, Real("rad/s", "speed of the wheels, motor side")]
    phi: Annotated[float, Real("rad", "twist, motor side")]
    T_gear: Annotated[float, Real("N.m", "gear torque, motor side")]


class Addition(NamedTuple):
    """What a law adds to the driver's demand."""

    damping: Annotated[float, Real("N.m", "torque against the oscillation")]
    landing: Annotated[float, Real("N.m", "change of the demand that lets the teeth land softly")]


class Estimator(Protocol):
    """Tells the motion of the drive train from motor torque, motor speed and wheel speed."""

    Parameters: type[Any]

    def start(self, omega_1: Any, T_mot: Any, wheel: Any, p: Any) -> Any:
        """State for a motor speed (rad/s) and torque (N.m), nothing else being known; `wheel`: a wheel speed comes."""
        ...

    def restart(self, x: Any, omega_1: Any, T_mot: Any, p: Any) -> Any:
        """State that has forgotten what it estimated, as at the start."""
        ...

    def predict(self, x: Any, T_mot: Any, T_s: Any, p: Any) -> Any:
        """State one sample later under the mean motor torque of that sample."""
        ...

    def take_motor_speed(self, x: Any, omega_1: Any, p: Any) -> Any:
        """State corrected by the measured motor speed."""
        ...

    def take_wheel_speed(self, x: Any, omega_2: Any, T_s: Any, p: Any) -> Any:
        """State corrected by a message that has just arrived."""
        ...

    def finish(self, x: Any, wheel: Any, T_s: Any, p: Any) -> Any:
        """State at the end of the sample; `wheel`: the wheel speed is in use."""
        ...

    def motion(self, x: Any, p: Any) -> Motion:
        """The estimate."""
        ...

    def motion_after(self, x: Any, T_mot: Any, h: Any, p: Any) -> Motion:
        """The estimate h seconds later under a motor torque (N.m), its mean over that time."""
        ...


class Law(Protocol):
    """Says what is to be added to the driver's demand."""

    Parameters: type[Any]

    def start(self, motion: Motion, T_driver: Any, p: Any) -> Any:
        """State in which motion and demand (N.m) of the start are taken for stationary."""
        ...

    def update(self, x: Any, motion: Motion, later: Any, T_driver: Any, T_s: Any, p: Any) -> tuple[Any, Addition]:
        """Next state, and what is to be added; the supervision limits it.

        Args:
            motion: of this sample.
            later: gives the motion so many seconds later, under the torque that the motor will have by then.
            T_driver: demand in N.m.
        """
        ...
