"""What a controller is made of: an estimator and a law, each a module with these names.

A part has a record `Parameters` with its declared parameters, a state that is a record, and pure
functions. p holds the parameters of all parts and of the supervision by name, T_s is the sample time
in s. All quantities are referred to the motor side.
"""

from typing import Annotated, Any, NamedTuple, Protocol, TypeVar

from fmublocks.block.declaration import Real

S = TypeVar("S")
P = TypeVar("P", contravariant=True)
"""State and parameters of a part."""


class Motion(NamedTuple):
    """Motion of the drive train as an estimator sees it."""

    omega_1: Annotated[float, Real("rad/s", "speed of the motor")]
    omega_2: Annotated[float, Real("rad/s", "speed of the wheels, motor side")]
    phi: Annotated[float, Real("rad", "twist, motor side")]
    T_gear: Annotated[float, Real("N.m", "gear torque, motor side")]
    omega: Annotated[float, Real("rad/s", "speed of the motor less that of the wheels, before either is rounded")]
    phi_B: Annotated[float, Real("rad", "half of the gap")] = 0.0
    slip: Annotated[float, Real("1", "how clearly the wheels slip, from 0 to 1")] = 0.0


class Addition(NamedTuple):
    """What a law adds to the driver's demand."""

    damping: Annotated[float, Real("N.m", "torque against the oscillation, whose half swings are counted")]
    landing: Annotated[
        float, Real("N.m", "what else changes the demand: its shape, a soft landing, less damping where wheels slip")
    ]


class Part(Protocol):
    """A part with its declared parameters."""

    Parameters: type[Any]


class Estimator(Part, Protocol[S, P]):
    """Tells the motion of the drive train from motor torque, motor speed and wheel speed."""

    def start(self, omega_1: float, T_mot: float, wheel: bool, p: P) -> S:
        """State for a motor speed (rad/s) and torque (N.m), nothing else being known; `wheel`: a wheel speed comes."""
        ...

    def restart(self, x: S, omega_1: float, T_mot: float, p: P) -> S:
        """State that has forgotten what it estimated, as at the start."""
        ...

    def take_motor_speed(self, x: S, omega_1: float, slips: bool, T_s: float, p: P) -> S:
        """State corrected by the measured motor speed; `slips`: the car says that its wheels slip."""
        ...

    def take_wheel_speed(self, x: S, omega_2: float, T_s: float, p: P) -> S:
        """State corrected by a message that has just arrived."""
        ...

    def learn(self, x: S, innovation: float, hold: bool, T_s: float, p: P) -> S:
        """State that has learned of the car what the signals of this sample tell.

        Args:
            innovation: measured less expected motor speed, rad/s.
            hold: nothing is learned: the signals are not trusted, or the damping feeds an oscillation.
        """
        ...

    def predict(self, x: S, T_mot: float, wheel: bool, T_s: float, p: P) -> S:
        """State one sample later under the mean motor torque (N.m) until then; `wheel`: the wheel speed is in use."""
        ...

    def motion(self, x: S, p: P) -> Motion:
        """The estimate."""
        ...


class Law(Part, Protocol[S, P]):
    """Says what is to be added to the driver's demand."""

    def start(self, motion: Motion, T_driver: float, p: P) -> S:
        """State in which motion and demand (N.m) of the start are taken for stationary."""
        ...

    def update(self, x: S, motion: Motion, expected: Motion, T_driver: float, T_s: float, p: P) -> tuple[S, Addition]:
        """Next state, and what is to be added; the supervision limits the whole.

        Args:
            motion: of this sample.
            expected: motion of the next sample, in which what is added begins to act.
            T_driver: demand in N.m.
        """
        ...
