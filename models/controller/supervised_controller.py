"""A controller: an estimator and a law under the supervision, as a block."""

from dataclasses import dataclass
from typing import Any, Generic

from ..block.declaration import merged
from ..block.operators import branch, clip, logical_and, logical_not, logical_or, maximum, sign, where
from ..block.types import SampledBlock
from . import causes, launch, motor_signals, oscillation, standstill, torque_loop, trust, wheel_messages
from .fading import toward
from .interfaces import Addition, Estimator, Law, Motion
from .supervision import T_S, E, L, Output, State, demand, limited, output, status
from .supervision_interface import Input, Parameters
from .trust import Found


@dataclass(frozen=True)
class Supervised(Generic[E, L]):
    """An estimator and a law under supervision; both find more parameters in p than those of the supervision."""

    estimator: Estimator[E, Any]
    law: Law[L, Any]

    def start(self, u: Input, p: Parameters) -> State[E, L]:
        """Estimate from the motor signals of t = 0, the driver's demand passed through."""
        T_driver = demand(u, p)
        motor, wheel = motor_signals.start(u, p), wheel_messages.tells_a_speed(u, p)
        e = self.estimator.start(motor.omega_1, motor.T_mot, wheel, p)
        motion = self.estimator.motion(e, p)
        return State(
            estimator=e,
            law=self.law.start(motion, T_driver, p),
            motor=motor,
            wheel=wheel_messages.start(u, motor.omega_1, p),
            swings=oscillation.start(),
            launch=launch.start(T_S, p),
            trust=trust.start(motor.omega_1, p),
            level=where(u.enable, 1.0, 0.0),
            quiet=where(standstill.is_still(T_driver, motor.omega_1, p), standstill.longest(p), 0.0),
            T_ref=T_driver,
            T_damp=0.0,
            T_landing=0.0,
            ahead=motion,
            status=status(u.enable, True, wheel),
        )

    def update(self, x: State[E, L], u: Input, p: Parameters) -> State[E, L]:
        """What was measured, whether it is trusted, and what is added to the demand."""
        before, x = x, self.measured(x, u, p)
        T_driver, trusted = demand(u, p), trust.is_trusted(x.trust)
        law, adding = self.acting(before, x, T_driver, p)

        level = toward(x.level, where(logical_and(u.enable, trusted), 1.0, 0.0), T_S, p.t_fade)
        share = level * (1.0 - standstill.share(x.quiet, p))
        change = T_driver - (x.T_ref - x.T_damp)
        swings = oscillation.update(x.swings, share * adding.damping, change, trusted, T_S, p)
        share = share * oscillation.share(swings)
        fading = level / maximum(x.level, T_S / p.t_fade) * x.T_damp
        added = limited(where(trusted, share * (adding.damping + adding.landing), fading), T_driver, p)
        T_ref = clip(T_driver + added, -p.T_max, p.T_max)
        wheel = logical_and(wheel_messages.is_reference(x.wheel, u, p), trusted)
        return x._replace(
            estimator=self.estimator.finish(x.estimator, wheel, T_S, p),
            law=law,
            swings=swings,
            level=level,
            T_ref=T_ref,
            T_damp=T_ref - T_driver,
            T_landing=where(trusted, limited(share * adding.landing, T_driver, p), 0.0),
            ahead=self.estimator.motion_after(x.estimator, x.motor.T_mot, T_S, p),
            status=status(u.enable, trusted, wheel),
        )

    def measured(self, x: State[E, L], u: Input, p: Parameters) -> State[E, L]:
        """The state with the signals of this sample: what they are, whether they are trusted, and the estimate."""
        T_driver = demand(u, p)
        T_mot = motor_signals.torque(u.T_mot_est, x.motor.loop, p)
        e = self.estimator.predict(x.estimator, 0.5 * (x.motor.T_mot + T_mot), T_S, p)
        increment = self.estimator.motion(e, p).omega_1 - self.estimator.motion(x.estimator, p).omega_1
        motor, finding = motor_signals.update(x.motor, u, increment, x.T_ref, T_S, p)
        bad = finding != causes.NONE
        resting = standstill.share(x.quiet, p) >= 1.0
        launching, against = launch.update(x.launch, T_driver, x.motor.loop.T_mot, motor.omega_1, resting, T_S, p)
        way = where(against, sign(launching.free), trust.direction(x.trust, u, motor.omega_1, logical_not(bad), p))
        turned = way * motor.omega_1 < -p.omega_still
        wheel, taken = wheel_messages.update(x.wheel, u, motor.omega_1, bad, way, T_S, p)
        told = logical_and(turned, u.direction != 0)
        contradiction = where(told, causes.WRONG_DIRECTION, causes.WHEEL_CONTRADICTS)
        found = {"t_bad": Found(finding, motor.bad), "t_apart": Found(contradiction, wheel.contradicting)}
        trusting = trust.update(x.trust, found, against, way, turned, T_S, p)
        quiet = standstill.quiet_time(x.quiet, standstill.is_still(T_driver, motor.omega_1, p), T_S, p)

        resting = standstill.share(quiet, p) >= 1.0
        begins = logical_or(resting, trust.is_healing(trusting, T_S))
        omega_1, T_mot = where(resting, 0.0, motor.omega_1), where(resting, 0.0, motor.T_mot)
        e = self.estimator.take_motor_speed(e, motor.omega_1, T_S, p)
        e = branch(taken, lambda: self.estimator.take_wheel_speed(e, way * wheel.omega_2, T_S, p), lambda: e)
        e = self.estimated(e, u, p)
        e = branch(begins, lambda: self.estimator.restart(e, omega_1, T_mot, p), lambda: e)
        motion = self.estimator.motion(e, p)
        return x._replace(
            estimator=e,
            law=branch(begins, lambda: self.law.start(motion, T_driver, p), lambda: x.law),
            motor=motor,
            wheel=wheel,
            launch=launching,
            trust=trusting,
            quiet=quiet,
        )

    def estimated(self, e: E, u: Input, p: Parameters) -> E:
        """The estimate from the signals of this sample."""
        return e

    def acting(self, before: State[E, L], x: State[E, L], T_driver: float, p: Parameters) -> tuple[L, Addition]:
        """The state of the law, and what it would add to the demand.

        Args:
            before: the state of the last sample.
        """

        def later(h: float) -> Motion:
            T_mot = x.motor.T_mot + torque_loop.change(before.motor.loop, before.T_ref, h, p)
            return self.estimator.motion_after(x.estimator, T_mot, h, p)

        motion = self.estimator.motion(x.estimator, p)
        law, adding = self.law.update(x.law, motion, later, T_driver, T_S, p)
        return law, adding._replace(damping=clip(adding.damping, -p.T_add_max, p.T_add_max))


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
        output=output,
        update=controller.update,
        sample_time=T_S,
        tolerates_bad_input=True,
    )
