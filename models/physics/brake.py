"""Wheel brake as bristle friction: slides under load, holds as a spring at rest.

    z' = w_s - |w_s| z/z_br,   w_s = omega limited to +-omega_sat
    T  = T_brake q,   q = (z + t_br z')/z_br limited to +-1

Sliding, z tends to z_br sign(omega) and the torque to T_brake sign(omega); at rest the bristle is a
spring T_brake/z_br with a damper. omega_sat only limits the rate of z, not the torque. The limit of q acts
while a wheel breaks loose: the damper would add to the spring, and a brake has no more than its capacity.

P. R. Dahl, "A solid friction model", Aerospace Corporation TOR-0158(3107-18)-1, 1968; with the damper it is
LuGre friction without Stribeck effect: C. Canudas de Wit, H. Olsson, K. J. Astrom, P. Lischinsky, "A new
model for control of systems with friction", IEEE Trans. Automatic Control 40(3), 1995.
"""

from typing import Annotated, NamedTuple, Protocol

from fmublocks.block.declaration import Real
from fmublocks.block.operators import clip

BristleDeflection = Annotated[float, Real("rad", "twist of the brake bristles at sliding", 1e-4, 0.1)]
BristleDamping = Annotated[float, Real("s", "damping time of the brake bristles", 1e-4, 0.1)]
BristleSpeedLimit = Annotated[float, Real("rad/s", "wheel speed that limits the rate of the bristles", 1.0, 50.0)]


class Bristles(NamedTuple):
    """The brake that every plant starts with."""

    z_br: BristleDeflection = 0.005
    t_br: BristleDamping = 0.005
    omega_sat: BristleSpeedLimit = 20.0


BRAKE = Bristles()


class BristleParameters(Protocol):
    """Those of the brake, whatever else is in the record."""

    @property
    def z_br(self) -> float: ...
    @property
    def t_br(self) -> float: ...
    @property
    def omega_sat(self) -> float: ...


def bristle_rate(omega: float, z: float, p: BristleParameters) -> float:
    """dz/dt in rad/s for a wheel speed omega (rad/s) and a bristle twist z (rad)."""
    w_s = clip(omega, -p.omega_sat, p.omega_sat)
    return w_s - 1.0 / p.z_br * abs(w_s) * z


def grip(z: float, dz: float, p: BristleParameters) -> float:
    """Share of the brake torque capacity that acts: q in [-1, 1]."""
    return clip(1.0 / p.z_br * (z + p.t_br * dz), -1.0, 1.0)
