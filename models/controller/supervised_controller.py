"""A controller: an estimator and a law under the supervision, as a block."""

from dataclasses import dataclass
from typing import Any, Generic

from ..block.declaration import merged
from ..block.operators import branch, clip, logical_and, logical_not, logical_or, where
from ..block.types import SampledBlock
from . import launch_direction, oscillation_monitor, signal_trust, standstill, torque_loop
from . import signal_monitor as monitor
from . import wheel_monitor as wheels
from .fading import toward
from .interfaces import Addition, Estimator, Law, Motion
from .launch_direction import LaunchState
from .signal_monitor import MonitorState
from .supervision import (
    T_S,
    E,
    L,
    Output,
    State,
    damping_limited,
    demand,
    is_launching,
    is_suspect,
    limited,
    output,
    status,
    trust_after,
)
from .supervision_interface import Input, Parameters
from .wheel_monitor import WheelState


@dataclass(frozen=True)
class Supervised(Generic[E, L]):
    """An estimator and a law under supervision; both find more parameters in p than those of the supervision."""

    estimator: Estimator[E, Any]
    law: Law[L, Any]

    def start(self, u: Input, p: Parameters) -> State[E, L]:
        """Estimate from the motor signals of t = 0, the driver's demand passed through."""
        T_driver = demand(u, p)
        signals, wheel = monitor.start(u, p), wheels.has_wheel_speed(u, p)
        e = self.estimator.start(signals.omega_1, signals.T_mot, wheel, p)
        motion = self.estimator.motion(e, p)
        return State(
            estimator=e,
            law=self.law.start(motion, T_driver, p),
            monitor=signals,
            wheels=wheels.start(u, signals.omega_1, signals.T_mot, p),
            launch_direction=launch_direction.start(),
            swings=oscillation_monitor.start(T_driver),
            trust=signal_trust.start(p),
            level=where(u.enable, 1.0, 0.0),
            quiet=where(standstill.is_still(T_driver, signals.omega_1, p), standstill.longest(p), 0.0),
            since_rest=standstill.LAUNCH,
            opposing=0.0,
            added=Addition(0.0, 0.0),
            T_ref=T_driver,
            T_damp=0.0,
            T_landing=0.0,
            ahead=motion,
            status=status(u.enable, True, wheel),
        )

    def update(self, x: State[E, L], u: Input, p: Parameters) -> State[E, L]:
        """What was measured, whether it is trusted, and what is added to the demand."""
        e, signals, wheel_state, launch = self.measured(x, u, p)
        T_driver = demand(u, p)
        quiet = standstill.quiet_time(x.quiet, standstill.is_still(T_driver, signals.omega_1, p), T_S, p)
        resting = standstill.share(quiet, p)
        trusting = trust_after(x, signals, wheel_state, launch, resting >= 1.0, p)
        trusted = signal_trust.is_trusted(trusting)
        wheel = logical_and(wheels.wheel_speed_in_use(wheel_state, u, p), trusted)

        suspect = logical_or(is_suspect(signals, wheel_state), is_suspect(x.monitor, x.wheels))
        restart = logical_and(suspect, logical_not(trusted))
        e = self.restarted(e, signals, restart, resting >= 1.0, p)
        acting, adding = self.acting(x, e, signals.T_mot, T_driver, restart, p)

        added = branch(trusted, lambda: damping_limited(adding, p), lambda: x.added)
        level = toward(x.level, where(logical_and(u.enable, trusted), 1.0, 0.0), T_S, p.t_fade)
        share = level * (1.0 - resting)
        T_ref = clip(T_driver + limited(share * (added.damping + added.landing), T_driver, p), -p.T_max, p.T_max)
        T_landing = limited(share * added.landing, T_driver, p)
        T_damping = T_ref - T_driver - T_landing
        return State(
            estimator=self.estimator.finish(e, wheel, T_S, p),
            law=acting,
            monitor=signals,
            wheels=wheel_state,
            launch_direction=launch,
            swings=oscillation_monitor.update(x.swings, T_damping, T_driver, trusted, T_S, p),
            trust=trusting,
            level=level,
            quiet=quiet,
            since_rest=standstill.time_since(x.since_rest, resting >= 1.0, T_S),
            opposing=adding.damping,
            added=added,
            T_ref=T_ref,
            T_damp=T_ref - T_driver,
            T_landing=T_landing,
            ahead=self.estimator.motion_after(e, signals.T_mot, T_S, p),
            status=status(u.enable, trusted, wheel),
        )

    def measured(self, x: State[E, L], u: Input, p: Parameters) -> tuple[E, MonitorState, WheelState, LaunchState]:
        """The states of the estimator and of the monitors with the signals of this sample."""
        T_mot = monitor.torque(u.T_mot_est, x.monitor.loop, p)
        e = self.estimator.predict(x.estimator, 0.5 * (x.monitor.T_mot + T_mot), T_S, p)
        increment = self.estimator.motion(e, p).omega_1 - self.estimator.motion(x.estimator, p).omega_1
        signals = monitor.update(x.monitor, u, increment, x.T_ref, T_S, p)
        launch = launch_direction.update(
            x.launch_direction,
            demand(u, p),
            x.monitor.loop.T_mot,
            signals.omega_1,
            signals.omega_1_change,
            x.since_rest <= 0.0,
            is_launching(x),
            signal_trust.is_trusted(x.trust),
            T_S,
            p,
        )
        e = self.estimator.take_motor_speed(e, signals.omega_1, p)
        omega_2_hat = self.estimator.motion(e, p).omega_2
        wheel_state = wheels.update(
            x.wheels, u, signals.omega_1, signals.T_mot, signals.bad, launch, omega_2_hat, T_S, p
        )
        corrected = branch(
            wheel_state.usable, lambda: self.estimator.take_wheel_speed(e, wheel_state.omega_2, T_S, p), lambda: e
        )
        return corrected, signals, wheel_state, launch

    def restarted(self, e: E, signals: MonitorState, restart: bool, resting: bool, p: Parameters) -> E:
        """The estimator, restarted where the signals are doubtful, and held at rest."""
        followed = branch(restart, lambda: self.estimator.restart(e, signals.omega_1, signals.T_mot, p), lambda: e)
        return branch(resting, lambda: self.estimator.restart(followed, 0.0, 0.0, p), lambda: followed)

    def acting(
        self, x: State[E, L], e: E, T_mot: float, T_driver: float, restart: bool, p: Parameters
    ) -> tuple[L, Addition]:
        """The state of the law, restarted with the estimator, and what it would add to the demand.

        Args:
            x: of the whole controller, of the last sample.
        """

        def later(h: float) -> Motion:
            return self.estimator.motion_after(e, T_mot + torque_loop.change(x.monitor.loop, x.T_ref, h, p), h, p)

        motion = self.estimator.motion(e, p)
        before = branch(restart, lambda: self.law.start(motion, T_driver, p), lambda: x.law)
        return self.law.update(before, motion, later, T_driver, T_S, p)


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
