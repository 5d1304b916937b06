"""Both plants once more, straight from the specification, and their solution by SciPy.

Written from the text of the specification with its own names and order of states, independently of
the models: a slip of the pen in a model shows as a difference. Direct mode: T_mot is an input.
"""

from collections.abc import Callable, Sequence
from math import atan, sin, tanh
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

Rates = Callable[[np.ndarray, "Held"], list[float]]


class Held(NamedTuple):
    """Inputs: N.m at the motor, N.m at the wheels, rad."""

    T_mot: float
    T_brake: float
    slope: float


class Reference(NamedTuple):
    """Right-hand side, the functions whose zeros are its kinks, and the outputs."""

    rates: Rates
    kinks: Rates
    outputs: Rates


J1, J2, C, phiB, i, m, r, g = 0.055, 0.30, 117.4, 0.157, 9.0, 1450.0, 0.29, 9.81
cslip, sigs, dlow, vlow = 140000.0, 0.05, 4000.0, 0.5
crr, vrr, cwa = 0.012, 0.1, 0.42
zbr, tbr, wsat = 0.005, 0.005, 20.0
Jw, ks, ds, asym, Jg = 1.8, 25800.0, 20.0, 0.1, 0.10
kg, dg, yg, Jd, dd, Jp = 120000.0, 12.0, 0.002, 0.03, 5.0, 6.0
kp, dp, sigma, mu, Cx, tasym, Fz0 = 70000.0, 120.0, 0.22, 1.0, 1.65, 0.05, 8500.0
mh, kx, dx, Jy, kth, dth, h, Lw = 90.0, 1.6e6, 1500.0, 1600.0, 125000.0, 7000.0, 0.55, 2.42
cfm, wfm, cfg, wfg, vfg = 0.6, 5.0, 5.0, 0.5, 0.2
pp, r6a, r6b, r12a, r12b, wrip = 2.0, 0.4, 0.008, 0.15, 0.003, 100.0

SIMPLE_STATES = ("omega_1", "omega_2", "phi", "v", "u", "z")
VEHICLE_STATES = (
    *("omega_1", "theta_p", "omega_p", "gamma", "omega_g", "omega_d", "x_L", "x_R"),
    *("omega_L", "omega_R", "u_L", "u_R", "s_h", "v_h", "v", "theta_b", "omega_b"),
    *("theta_1", "z_L", "z_R"),
)
"""Names that the models give to the states, in the order of the specification (w1, th_p, w_p, ...)."""


def b(x: float, half: float) -> float:
    if x > half:
        return x - half
    return x + half if x < -half else 0.0


def br(w: float, z: float) -> float:
    ws = max(-wsat, min(w, wsat))
    return ws - abs(ws) * z / zbr


def q(w: float, z: float) -> float:
    return max(-1.0, min(1.0, (z + tbr * br(w, z)) / zbr))


def simple(state: np.ndarray, held: Held) -> tuple[list[float], list[float]]:
    """Section c1: derivatives and outputs."""
    w1, w2, phi, v, u, z = state.tolist()
    T_mot, T_brake, slope = held
    w = w2 / i
    vs = r * w - v
    F = (cslip / sigs) * u + dlow * vs / (1.0 + (v / vlow) ** 2)
    Tbr = T_brake * q(w, z)
    T_load = -(r * F + Tbr) / i
    T_gear = C * b(phi, phiB)
    dv = (F - m * g * (crr * tanh(v / vrr) + sin(slope)) - cwa * v * abs(v)) / m
    rates = [
        (T_mot - T_gear) / J1,
        (T_load + T_gear) / J2,
        w1 - w2,
        dv,
        vs - max(abs(r * w), abs(v)) * u / sigs,
        br(w, z),
    ]
    return rates, [w1, w2, w, w, T_gear, T_load, r * F, phi, v, dv, 0.0]


def vehicle(state: np.ndarray, held: Held) -> tuple[list[float], list[float]]:
    """Section c2: derivatives and outputs."""
    w1, th_p, w_p, gam, w_g, w_d, xL, xR, wL, wR, uL, uR, s_h, v_h, v, th_b, w_b, theta_1, zL, zR = state.tolist()
    T_mot, T_brake, slope = held

    dgam = w1 / i + w_p - w_g
    y = b(gam, phiB / i)
    Tg = kg * y + dg * dgam * min(1.0, abs(y) / yg) if y != 0.0 else 0.0
    if Tg * y < 0.0:
        Tg = 0.0

    fa = 1.0 / (1.0 + (w1 / wrip) ** 2)
    sixth = (r6a + r6b * abs(T_mot)) * sin(6.0 * pp * theta_1)
    twelfth = (r12a + r12b * abs(T_mot)) * sin(12.0 * pp * theta_1)
    Ta = T_mot + fa * (sixth + twelfth) - cfm * tanh(w1 / wfm)

    Th = kp * (th_p + th_b) + dp * (w_p + w_b)
    dw_p = (-Ta - (1.0 - 1.0 / i) * Tg - Th) / Jp
    dw1 = (Ta - Tg / i) / J1 - dw_p

    kL, kR = ks / 2.0 * (1.0 - asym), ks / 2.0 * (1.0 + asym)
    dxL, dxR = w_g + w_d - wL, w_g - w_d - wR
    TL, TR = kL * xL + ds / 2.0 * dxL, kR * xR + ds / 2.0 * dxR
    dw_g = (Tg - TL - TR - cfg * tanh(w_g / wfg) - vfg * w_g) / Jg
    dw_d = (TR - TL - dd * w_d) / Jd

    Fz = max(200.0, Fz0 - (kth * th_b + dth * w_b) / Lw)
    B0 = cslip / (Cx * mu * Fz0)

    def wheel(w: float, T: float, u: float, z: float, B: float) -> tuple[float, float, float, float, float]:
        vs = r * w - v_h
        F = 0.5 * mu * Fz * sin(Cx * atan(B * u / sigma)) + 0.5 * dlow * vs / (1.0 + (v_h / vlow) ** 2)
        F = max(-0.5 * mu * Fz, min(F, 0.5 * mu * Fz))
        Tr = 0.5 * crr * Fz * r * tanh(r * w / vrr)
        Tbr = 0.5 * T_brake * q(w, z)
        dw = (T - r * F - Tr - Tbr) / (Jw / 2.0)
        return F, Tr, Tbr, dw, vs - max(abs(r * w), abs(v_h)) * u / sigma

    FL, TrL, TbrL, dwL, duL = wheel(wL, TL, uL, zL, B0 * (1.0 - tasym))
    FR, TrR, TbrR, dwR, duR = wheel(wR, TR, uR, zR, B0 * (1.0 + tasym))

    Fh = kx * s_h + dx * (v_h - v)
    drag = (m * g - Fz0) * crr * tanh(v / vrr) + cwa * v * abs(v) + m * g * sin(slope)
    dv = (Fh - drag) / (m - mh)
    dw_b = (Fh * (h - r) - Th - (TbrL + TbrR) - kth * th_b - dth * w_b) / Jy
    T_rim = r * (FL + FR) + TrL + TrR
    phi = i * (gam + (xL + xR) / 2.0 - th_p)
    rates = [dw1, w_p, dw_p, dgam, dw_g, dw_d, dxL, dxR, dwL, dwR, duL, duR]
    rates += [v_h - v, (FL + FR - Fh) / mh, dv, w_b, dw_b, w1, br(wL, zL), br(wR, zR)]
    omega_2 = i * (wL + wR) / 2.0
    return rates, [w1, omega_2, wL, wR, Tg / i, -(T_rim + TbrL + TbrR) / i, T_rim, phi, v, dv, th_b]


def simple_kinks(state: np.ndarray, held: Held) -> list[float]:
    w2, phi = state[1], state[2]
    return [phi - phiB, phi + phiB, w2]


def vehicle_kinks(state: np.ndarray, held: Held) -> list[float]:
    gam, wL, wR = state[3], state[8], state[9]
    flank = phiB / i
    return [gam - flank, gam + flank, gam - flank - yg, gam + flank + yg, wL, wR]


SIMPLE = Reference(lambda x, u: simple(x, u)[0], simple_kinks, lambda x, u: simple(x, u)[1])
VEHICLE = Reference(lambda x, u: vehicle(x, u)[0], vehicle_kinks, lambda x, u: vehicle(x, u)[1])


def solve(reference: Reference, start: Sequence[float], inputs: Sequence[Held], step: float) -> np.ndarray:
    """Outputs (N, 11) at k step under inputs[k], each held for `step` seconds; DOP853, rtol 1e-10.

    A stretch of equal inputs is integrated in one go, restarted where a kink is located.
    """
    x, rows, first = np.array(start), [], 0
    while first < len(inputs):
        held, last = inputs[first], first
        while last < len(inputs) and inputs[last] == held:
            last += 1
        times = np.arange(last - first + 1) * step
        states = smooth_pieces(reference, x, held, times)
        rows += [reference.outputs(state, held) for state in states[:-1]]
        x, first = states[-1], last
    return np.array(rows)


def smooth_pieces(reference: Reference, x: np.ndarray, held: Held, times: np.ndarray) -> list[np.ndarray]:
    """States at the times, the first of which is that of x."""
    sides = [1.0 if value > 0.0 else -1.0 for value in reference.kinks(x, held)]

    def kink(n: int) -> Callable[[float, np.ndarray], float]:
        """Zero counts as on the side the state is on, so that resting on a kink is no event."""

        def value(_: float, x: np.ndarray) -> float:
            return reference.kinks(x, held)[n] or 1e-300 * sides[n]

        value.terminal, value.direction = True, -sides[n]  # pyright: ignore[reportFunctionMemberAccess]
        return value

    states, t = [x], times[0]
    while len(states) < len(times):
        ahead = times[len(states) :]
        solution = solve_ivp(
            lambda _, x: reference.rates(x, held),
            (t, times[-1]),
            x,
            method="DOP853",
            t_eval=ahead,
            events=[kink(n) for n in range(len(sides))],
            rtol=1e-10,
            atol=1e-12,
        )
        states += list(np.reshape(solution.y, (len(x), -1)).T)
        hits = [n for n, found in enumerate(solution.t_events) if len(found)]
        if hits:
            t, x = solution.t_events[hits[0]][0], solution.y_events[hits[0]][0]
            sides[hits[0]] *= -1.0
    return states
