"""The loop as a linear sampled system, from the torque that the motor is to give to the torque that is demanded next.

Opened between controller and motor, it is driven there by r(k), held for a sample and `late` seconds late. Its state
is that of motor and plant, the last r, the last means of the wheel speed, and the controller. A message arrives in
every cycle-th sample, so that the loop repeats itself only from cycle to cycle:

    z(k+1) = A(k) z(k) + B r(k),    T_ref(k) = C z(k)

Its gain L(f) is the share of the frequency f in -T_ref when r is a sine of that frequency: the whole of it where the
wheel speed is not used, and its mean over a cycle where it is. The closed loop, r = T_ref, is stable if its
poles over a cycle are, which is exact in either case.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from math import floor
from typing import NamedTuple

import numpy as np
from scipy.linalg import expm, schur

from ....models.controller import T_S
from .averaged_messages import Messages, messages
from .linear_controller import LinearController, Sample, linear_controller
from .linear_plant import MESSAGE, LinearPlant, linear_plant
from .operating_point import Point


class Step(NamedTuple):
    """Motor and plant over a sample: x(k+1) = F x(k) + G r, mean wheel speed over it f x(k) + g r.

    Attributes:
        F, f: (n, n) and (n,).
        G, g: (n, m) and (m,), over r(k), r(k-1), ... r(k-m+1).
    """

    F: np.ndarray
    f: np.ndarray
    G: np.ndarray
    g: np.ndarray


def step(drive: LinearPlant, late: float) -> Step:
    """Motor and plant over a sample, with the demand `late` s late."""
    n, whole = len(drive.A), floor(late / T_S + 1e-9)
    part = max(late - whole * T_S, 0.0)
    M = np.zeros((n + 2, n + 2))  # with the integral of the wheel speed, and the demand
    M[:n, :n], M[:n, n + 1], M[n, :n] = drive.A, drive.B, drive.rows([MESSAGE])[0]
    over, before, after = (expm(M * h) for h in (T_S, part, T_S - part))
    old = after[: n + 1, : n + 1] @ before[: n + 1, n + 1]
    G = np.zeros((n + 1, whole + 2))
    G[:, whole], G[:, whole + 1] = after[: n + 1, n + 1], old
    return Step(over[:n, :n], over[n, :n] / T_S, G[:n], G[n] / T_S)


@dataclass(frozen=True)
class LinearLoop:
    """The loop of a point; matrices as above.

    Attributes:
        quiet, message: (n, n), A in a sample without and with a message.
        B, C: (n,).
        T_gear: (n,), the gear torque over the state.
        cycle: samples from message to message; 1 where none are used.
    """

    quiet: np.ndarray
    message: np.ndarray
    B: np.ndarray
    C: np.ndarray
    T_gear: np.ndarray
    cycle: int

    def closed(self, gain: float = 1.0) -> np.ndarray:
        """(n, n), the closed loop over a cycle, with what the controller adds times a gain."""
        back = gain * np.outer(self.B, self.C)
        return np.linalg.matrix_power(self.quiet + back, self.cycle - 1) @ (self.message + back)

    @property
    def mean(self) -> "LinearLoop":
        """The loop with the mean of its samples, which repeats itself from sample to sample."""
        A = self.quiet + (self.message - self.quiet) / self.cycle
        return replace(self, quiet=A, message=A, cycle=1)

    def gain(self, f: np.ndarray) -> np.ndarray:
        """L at frequencies in Hz."""
        z = np.exp(2j * np.pi * np.asarray(f) * T_S)
        triangle, seen, pushed = self._cycle
        ahead = z[:, None] ** np.arange(self.cycle)
        turned = z**self.cycle
        x = (ahead[:, ::-1] @ pushed).T
        for k in range(len(x) - 1, -1, -1):  # at all frequencies
            x[k] = (x[k] + triangle[k, k + 1 :] @ x[k + 1 :]) / (turned - triangle[k, k])
        answers = pushed @ seen[0]
        T_ref = (seen @ x).T
        for k in range(1, self.cycle):
            T_ref[:, k] += ahead[:, :k] @ answers[k - 1 :: -1]
        return -np.mean(T_ref / ahead, axis=1)

    @cached_property
    def _cycle(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Of a cycle, which begins with a message, in coordinates in which A over the whole of it is a triangle
        (complex Schur form): that; in each sample k the row that gives T_ref(k) from the state at its begin, and what
        is left of r(0) after k + 1 samples without a message."""
        seen, over, pushed = [self.C], self.message, [self.B]
        for _ in range(1, self.cycle):
            seen.append(self.C @ over)
            over = self.quiet @ over
            pushed.append(self.quiet @ pushed[-1])
        triangle, turn, *_ = schur(over, output="complex")
        return triangle, np.array(seen) @ turn, np.array(pushed) @ turn.conj()


def linear_loop(point: Point) -> LinearLoop:
    """The loop at a point.

    Raises:
        NotLinear: the controller is not linear there.
    """
    return loop_parts(point).loop(point.late)


class LoopParts(NamedTuple):
    """What the loop of a point consists of, whatever its dead time is."""

    point: Point
    drive: LinearPlant
    control: LinearController
    bus: Messages

    def serve(self, point: Point) -> bool:
        """Whether they are those of another point too."""
        return replace(self.point, late=point.late) == point

    def loop(self, late: float) -> LinearLoop:
        """With a dead time in s between controller and motor."""
        return assembled(self.drive, self.control, self.bus, late)


def loop_parts(point: Point) -> LoopParts:
    """Those of a point; raises as `linear_loop` does."""
    drive = linear_plant(point)
    return LoopParts(point, drive, linear_controller(point, drive), messages(point))


def assembled(drive: LinearPlant, control: LinearController, bus: Messages, late: float = 0.0) -> LinearLoop:
    """The loop of motor and plant with a controller; late: dead time in s between the two."""
    hears = MESSAGE in control.used
    over, taken = step(drive, late), drive.rows(control.signals)
    n, held, means, m = len(drive.A), over.G.shape[1] - 1, bus.cycle + bus.delay - 1 if hears else 0, len(control.C)
    size = n + held + means + m
    x, r, w, c = np.split(np.arange(size), np.cumsum([n, held, means]))

    A, B = np.zeros((size, size)), np.zeros(size)
    A[np.ix_(x, x)], A[np.ix_(x, r)], B[x] = over.F, over.G[:, 1:], over.G[:, 0]
    A[r[1:], r[:-1]], B[r[:1]] = 1.0, 1.0
    A[w[1:], w[:-1]] = 1.0
    if hears:
        A[w[0], x], A[w[0], r], B[w[0]] = over.f, over.g[1:], over.g[0]

    def in_sample(sample: Sample, arriving: bool) -> np.ndarray:
        whole = A.copy()
        whole[np.ix_(c, c)] = sample.A
        for k, name in enumerate(control.signals):
            if name != MESSAGE:
                whole[np.ix_(c, x)] += np.outer(sample.B[:, k], taken[k])
            elif arriving:
                whole[np.ix_(c, w[bus.delay - 1 :])] = sample.B[:, [k]] / bus.cycle
        return whole

    C, T_gear = np.zeros(size), np.zeros(size)
    C[c], T_gear[x] = control.C, drive.rows(["T_gear"])[0]
    quiet = in_sample(control.quiet, False)
    message = in_sample(control.message, True) if hears else quiet
    return LinearLoop(quiet, message, B, C, T_gear, bus.cycle if hears else 1)
