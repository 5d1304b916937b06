"""A controller: an estimator and a law under the supervision, as a block."""

from dataclasses import dataclass
from typing import Any, Generic

from fmublocks.block.declaration import merged
from fmublocks.block.operators import branch, clip, logical_and, logical_not, logical_or, maximum, where
from fmublocks.block.types import SampledBlock

from . import T_S, causes, launch, motor_signals, oscillation, standstill, torque_loop, trust, wheel_messages
from .fading import faded
from .interfaces import Estimator, Law
from .supervision import E, L, Output, State, demand, limited, status
from .supervision_interface import Input, Parameters


@dataclass(frozen=True)
class Supervised(Generic[E, L]):
    """An estimator and a law under supervision; both find more parameters in p than those of the supervision."""

    estimator: Estimator[E, Any]
    law: Law[L, Any]

    def start(self, u: Input, p: Parameters) -> State[E, L]:
        """Estimate from the motor signals of t = 0, the driver's demand passed through."""
        T_driver, wheel = demand(u, p), wheel_messages.tells_a_speed(u, p)
        motor = motor_signals.start(u, p)
        e = self.estimator.start(motor.omega_1, motor.loop.T_mot, wheel, p)
        return State(
            estimator=e,
            law=self.law.start(self.estimator.motion(e, p), T_driver, p),
            motor=motor,
            wheel=wheel_messages.start(u, motor.omega_1, p),
            swings=oscillation.SwingState(),
            launch=launch.start(T_S, p),
            trust=trust.start(),
            level=where(u.enable, 1.0, 0.0),
            quiet=where(standstill.is_still(T_driver, motor.omega_1, p), standstill.longest(p), 0.0),
            T_ref=T_driver,
            T_damp=0.0,
            status=status(u.enable, True, wheel),
        )

    def output(self, x: State[E, L], u: Input, p: Parameters) -> Output:
        """What was computed at the last sample, and the estimate for this one."""
        motion = self.estimator.motion(x.estimator, p)
        feeding = where(oscillation.is_less(x.swings), causes.FEEDS, causes.NONE)
        return Output(
            T_ref=x.T_ref,
            T_damp=x.T_damp,
            T_gear_hat=motion.T_gear,
            phi_hat=motion.phi,
            omega_2_hat=motion.omega_2,
            status=x.status,
            cause=where(trust.is_trusted(x.trust), feeding, x.trust.cause),
            phi_B_hat=motion.phi_B,
        )

    def update(self, x: State[E, L], u: Input, p: Parameters) -> State[E, L]:
        """What was measured, whether it is trusted, what is added to the demand, and what is expected next."""
        u = motor_signals.filled(x.motor, u, self.estimator.motion(x.estimator, p).omega_1)
        T_driver, T_mot = demand(u, p), motor_signals.torque(x.motor, u.T_mot_est, p)
        x = self.measured(x, u, T_driver, T_mot, p)
        trusted = trust.is_trusted(x.trust)

        wheel = logical_and(wheel_messages.is_reference(x.wheel, u, p), trusted)
        loop = torque_loop.update(x.motor.loop, x.T_ref, T_S, p)
        e = self.estimator.predict(x.estimator, T_mot + 0.5 * (loop.T_mot - x.motor.loop.T_mot), wheel, T_S, p)
        motion, expected = self.estimator.motion(x.estimator, p), self.estimator.motion(e, p)

        law, adding = self.law.update(x.law, motion, expected, T_driver, T_S, p)
        damping = clip(adding.damping, -p.T_add_max, p.T_add_max)

        level = faded(x.level, logical_and(u.enable, trusted), T_S, p.t_fade)
        share = level * standstill.remaining_damping(x.quiet, p)
        counts = logical_and(trusted, logical_not(u.slip_control))
        swings = oscillation.update(x.swings, share * damping, T_driver - (x.T_ref - x.T_damp), counts, T_S, p)
        share = share * oscillation.share(swings)
        fading = level / maximum(x.level, T_S / p.t_fade) * x.T_damp
        added = limited(where(trusted, share * (damping + adding.landing), fading), T_driver, p)
        T_ref = clip(T_driver + added, -p.T_max, p.T_max)

        return x._replace(
            estimator=e,
            law=law,
            motor=motor_signals.predict(x.motor, loop, expected.omega_1 - motion.omega_1, T_S, p),
            swings=swings,
            level=level,
            T_ref=T_ref,
            T_damp=T_ref - T_driver,
            status=status(u.enable, trusted, wheel),
        )

    def measured(self, x: State[E, L], u: Input, T_driver: float, T_mot: float, p: Parameters) -> State[E, L]:
        """The state with the signals of this sample: what they are, whether they are trusted, and the estimate.

        Args:
            T_driver, T_mot: torque that the driver demands and that of the motor, N.m.
        """
        expected = self.estimator.motion(x.estimator, p).omega_1
        motor, omega_1, failures = motor_signals.update(x.motor, u, expected, trust.is_trusted(x.trust), T_S, p)
        bad = causes.first_of(failures) != causes.NONE
        unclear = logical_or(wheel_messages.tells_a_speed(u, p), bad)
        rested = logical_and(standstill.is_complete(x.quiet, p), logical_not(unclear))
        launching, against = launch.update(x.launch, T_driver, motor.loop.T_mot, omega_1, rested, T_S, p)
        pushed = logical_and(rested, abs(T_driver) > p.T_still)
        sure = logical_or(against, logical_and(pushed, standstill.is_seen(x.quiet, p)))
        direction = trust.direction(x.trust, u, sure, pushed, omega_1, logical_not(bad), T_S, p)
        side = trust.sign_of(direction)
        turned = side * omega_1 < -p.omega_still
        wheel, taken, contradicts = wheel_messages.update(x.wheel, u, omega_1, bad, x.trust.apart > 0.0, side, T_S, p)
        failures |= {
            causes.WHEEL_CONTRADICTS: logical_and(contradicts, logical_not(u.slip_control)),
            causes.WRONG_DIRECTION: logical_and(turned, u.direction != 0),
            causes.WRONG_LAUNCH: logical_or(against, logical_and(turned, x.trust.cause == causes.WRONG_LAUNCH)),
        }
        trusting = trust.update(x.trust._replace(direction=direction), failures, turned, T_S, p)
        quiet = standstill.quiet_time(x.quiet, standstill.is_still(T_driver, omega_1, p), T_S, p)

        rests = standstill.is_complete(quiet, p)
        begins = logical_or(rests, trust.is_healing(trusting, T_S))
        e = self.estimator.take_motor_speed(x.estimator, omega_1, u.slip_control, T_S, p)
        e = branch(taken, lambda: self.estimator.take_wheel_speed(e, side * wheel.omega_2, T_S, p), lambda: e)
        e = self.estimated(e, u, p)
        omega_1, T_mot = where(rests, 0.0, omega_1), where(rests, 0.0, T_mot)
        e = branch(begins, lambda: self.estimator.restart(e, omega_1, T_mot, p), lambda: e)
        hold = logical_or(logical_or(bad, oscillation.is_less(x.swings)), logical_not(trust.is_trusted(trusting)))
        e = self.estimator.learn(e, motor.omega_1 - expected, hold, T_S, p)
        return x._replace(
            estimator=e,
            law=branch(begins, lambda: self.law.start(self.estimator.motion(e, p), T_driver, p), lambda: x.law),
            motor=motor,
            wheel=wheel,
            launch=launching,
            trust=trusting,
            quiet=quiet,
        )

    def estimated(self, e: E, u: Input, p: Parameters) -> E:
        """The estimate from the signals of this sample."""
        return e


def supervised(
    name: str, description: str, module: str, estimator: Estimator[E, Any], law: Law[L, Any]
) -> SampledBlock:
    """A controller as a block: its parameters are those of the estimator, of the law and of the supervision.

    Args:
        name, description, module: see `SampledBlock`.
    """
    controller = Supervised(estimator, law)
    return SampledBlock(
        name=name,
        description=description,
        module=module,
        Parameters=merged("Parameters", estimator.Parameters, law.Parameters, Parameters),
        Input=Input,
        State=State,
        Output=Output,
        start=controller.start,
        output=controller.output,
        update=controller.update,
        sample_time=T_S,
        tolerates_bad_input=True,
    )
