"""Exact solution of the design plant with a recorded load: parabolas in the gap, sinusoids in contact."""

from dataclasses import dataclass
from math import acos, atan2, cos, hypot, pi, sin, sqrt

from driveline.models.two_mass_driveline import Parameters

INSTANT = 1e-13
"""Crossings closer than this to the present instant (in s) are the one just made."""


@dataclass
class ExactDriveline:
    """Two inertias, spring and gap under held torques; starts at rest in the middle of the gap."""

    p: Parameters
    omega_1: float = 0.0
    omega_2: float = 0.0
    phi: float = 0.0
    side: int = 0
    crossings: int = 0

    def advance(self, T_mot: float, T_load: float, h: float) -> None:
        """h seconds on, from flank to flank."""
        J_1, J_2 = self.p.J_1, self.p.J_2
        momentum = J_1 * self.omega_1 + J_2 * self.omega_2 + (T_mot + T_load) * h
        d, remaining = self.omega_1 - self.omega_2, h
        a = T_mot / J_1 - T_load / J_2
        while True:
            move = self._in_gap if self.side == 0 else self._in_contact
            length, side, phi, d = move(d, a, remaining)
            remaining -= length
            self.phi = phi
            if side is None:
                break
            self.side = side
            self.crossings += 1
        self.omega_2 = (momentum - J_1 * d) / (J_1 + J_2)
        self.omega_1 = self.omega_2 + d

    def _in_gap(self, d: float, a: float, h: float) -> tuple[float, int | None, float, float]:
        hits = []
        for side in (1, -1):
            for t in _roots(0.5 * a, d, self.phi - side * self.p.phi_B):
                if INSTANT < t <= h and side * (d + a * t) >= 0.0:
                    hits.append((t, side))
        if hits:
            t, side = min(hits)
            return t, side, side * self.p.phi_B, d + a * t
        return h, None, self.phi + d * h + 0.5 * a * h * h, d + a * h

    def _in_contact(self, d: float, a: float, h: float) -> tuple[float, int | None, float, float]:
        omega = sqrt(self.p.C * (1.0 / self.p.J_1 + 1.0 / self.p.J_2))
        flank = self.side * self.p.phi_B
        rest = flank + a / omega**2
        X = self.phi - rest
        radius, angle = hypot(X, d / omega), atan2(d / omega, X)

        def slope(t: float) -> float:
            return -X * omega * sin(omega * t) + d * cos(omega * t)

        if abs(flank - rest) < radius:
            turn = acos((flank - rest) / radius)
            times = [(angle + s * turn + 2.0 * pi * k) / omega for s in (1, -1) for k in range(-2, 3)]
            leaving = [t for t in times if INSTANT < t <= h and self.side * slope(t) < 0.0]
            if leaving:
                t = min(leaving)
                return t, 0, flank, slope(t)
        return h, None, rest + X * cos(omega * h) + d / omega * sin(omega * h), slope(h)


def _roots(a: float, b: float, c: float) -> list[float]:
    """Real roots of a t^2 + b t + c, without cancellation."""
    if a == 0.0:
        return [-c / b] if b != 0.0 else []
    discriminant = b * b - 4.0 * a * c
    if discriminant < 0.0:
        return []
    q = -0.5 * (b + (sqrt(discriminant) if b >= 0.0 else -sqrt(discriminant)))
    return [q / a] + ([c / q] if q != 0.0 else [])
