"""The model run freely over segments of a recording, with its sensitivities to start and parameters."""

from collections.abc import Sequence
from functools import cached_property

import casadi as ca
import numpy as np

from .buffered import Buffered
from .compiled_functions import compiled
from .drive_train import DELAYS, STEPS, Parameters, State, d_torques_by, sample
from .model_inputs import Drive

STATES = len(State._fields)


class Simulator:
    """Free runs over segments of n samples.

    Args:
        free: names of the parameters by which is differentiated.
    """

    def __init__(self, n: int, free: Sequence[str] = ()) -> None:
        self.n, self.free = n, tuple(free)
        x, p, T_s = ca.SX.sym("x", STATES), ca.SX.sym("p", len(Parameters._fields)), ca.SX.sym("T_s")
        T_mot, T_load = ca.SX.sym("T_mot", STEPS), ca.SX.sym("T_load", STEPS)
        state, parameters = State(*ca.vertsplit(x)), Parameters._make(ca.vertsplit(p))
        after = ca.vertcat(*sample(state, ca.vertsplit(T_mot), ca.vertsplit(T_load), T_s, parameters))
        self._given, self._x, self._p, self._after = [T_mot, T_load, p, T_s], x, p, after
        self._torques = ca.vertcat(T_mot, T_load)

    @cached_property
    def _alone(self) -> Buffered:
        return Buffered(compiled(ca.Function("sample", [self._x, *self._given], [self._after])).mapaccum("run", self.n))

    @cached_property
    def _with_derivatives(self) -> Buffered:
        m = STATES + len(self.free)
        d_x = ca.SX.sym("d_x", STATES, m)
        d_p = np.zeros((len(Parameters._fields), m))
        for k, name in enumerate(self.free):
            d_p[Parameters._fields.index(name), STATES + k] = 1.0
        d_acting = ca.SX.sym("d_acting", 2 * STEPS)
        d_torques = ca.horzcat(ca.SX(2 * STEPS, STATES), d_torques_by(self.free, d_acting))
        before = ca.vertcat(self._x, self._p, self._torques)
        d = ca.jtimes(self._after, before, ca.vertcat(d_x, ca.DM(d_p), d_torques))
        alone = compiled(ca.Function("sensitivity", [self._x, d_x, *self._given, d_acting], [self._after, d]))
        return Buffered(alone.mapaccum("runs", self.n, 2))

    def run(self, drive: Drive, first: int, start: np.ndarray, p: Parameters) -> np.ndarray:
        """The states after each sample from `first` on, shape (n, states)."""
        (x,) = self._alone(start, *self._inputs(drive, first, p))
        return x.T.copy()

    def run_with_derivatives(
        self, drive: Drive, first: int, start: np.ndarray, p: Parameters
    ) -> tuple[np.ndarray, np.ndarray]:
        """The same, and the derivatives by start and free parameters, shape (n, states, states + parameters)."""
        m = STATES + len(self.free)
        shifted = {*DELAYS} & {*self.free}
        d_acting = drive.d_acting(p, first, first + self.n) if shifted else np.zeros((2 * STEPS, self.n))
        x, d = self._with_derivatives(start, np.eye(STATES, m), *self._inputs(drive, first, p), d_acting)
        return x.T.copy(), d.reshape(STATES, self.n, m).transpose(1, 0, 2).copy()

    def _inputs(self, drive: Drive, first: int, p: Parameters) -> tuple[np.ndarray, ...]:
        acting = drive.acting(p, first, first + self.n)
        return (
            acting.T_mot.T,
            acting.T_load.T,
            np.tile(np.array(p)[:, None], (1, self.n)),
            np.full((1, self.n), drive.T_s),
        )
