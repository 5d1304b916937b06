"""Mechanical energy of the plants, and the power that changes it.

The energy is that of all inertias and of the springs of shafts, mounts and body. What changes it is the work of the
motor, of the gear, of the brakes, of the tyres (between wheels and hubs, with their rolling resistance), of the road
and the air, and of all friction and damping; so that energy less work is constant, whatever the steps. The models add
up torques and forces; here they are multiplied with the speeds at which they act.

The gear is kept apart. Where its damper cancels its spring, the teeth part without a force, and what is left in the
spring is lost at a rate with a kink at the flank that no state feels and no step needs to end at. What the gear took
is never less than what its spring holds.
"""

from typing import Any, NamedTuple

from driveline.models import two_mass_driveline as driveline
from driveline.models import validation_vehicle
from driveline.models.physics import brake, vehicle
from driveline.models.physics.backlash import dead_zone
from fmublocks.block.operators import tanh


class Energy(NamedTuple):
    """Of a plant: `stored` without the spring of the gear, and in that spring, in J; `powers` that change what is
    stored, without that of the gear, and the one that the gear takes, in W."""

    stored: Any
    powers: list[Any]
    spring: Any
    taken: Any


def of_driveline(x: driveline.State, u: Any, p: driveline.Parameters) -> Energy:
    F = driveline.tyre_force(x, p)
    dz = brake.bristle_rate(x.omega_2 / p.i, x.z, p)
    y = dead_zone(x.phi, p.phi_B)
    return Energy(
        stored=0.5 * (p.J_1 * x.omega_1 * x.omega_1 + p.J_2 * x.omega_2 * x.omega_2 + p.m * x.v * x.v),
        powers=[
            u.T_mot * x.omega_1,
            driveline.load_torque(x, u, F, dz, p) * x.omega_2,
            (F - vehicle.resistance(x.v, u.slope, p.m * p.g, p)) * x.v,
        ],
        spring=0.5 * p.C * y * y,
        taken=driveline.gear_torque(x, p) * (x.omega_1 - x.omega_2),
    )


def of_vehicle(x: validation_vehicle.State, u: Any, p: validation_vehicle.Parameters) -> Energy:
    rotor, mounts = x.omega_1 + x.omega_p, x.theta_p + x.theta_b
    terms = [
        p.J_1 * rotor * rotor,
        p.J_p * x.omega_p * x.omega_p,
        p.J_g * x.omega_g * x.omega_g,
        p.J_d * x.omega_d * x.omega_d,
        0.5 * p.J_w * (x.omega_L * x.omega_L + x.omega_R * x.omega_R),
        p.m_h * x.v_h * x.v_h,
        (p.m - p.m_h) * x.v * x.v,
        p.J_y * x.omega_b * x.omega_b,
        p.k_p * mounts * mounts,
        0.5 * p.k_s * ((1.0 - p.asym) * x.x_L * x.x_L + (1.0 + p.asym) * x.x_R * x.x_R),
        p.k_x * x.s_h * x.s_h,
        p.k_th * x.theta_b * x.theta_b,
    ]
    k = validation_vehicle.wheels(x, u, p)
    dx_L, dx_R = x.omega_g + x.omega_d - x.omega_L, x.omega_g - x.omega_d - x.omega_R
    turning, bushing = x.omega_p + x.omega_b, x.v_h - x.v
    F_h = validation_vehicle.bushing_force(x, p)
    y = dead_zone(x.gamma, p.phi_B / p.i)
    return Energy(
        stored=0.5 * sum(terms),
        powers=[
            validation_vehicle.air_gap_torque(x, u, p) * x.omega_1,
            -(p.c_fg * tanh(x.omega_g / p.omega_fg) + p.v_fg * x.omega_g) * x.omega_g,
            -0.5 * p.d_s * (dx_L * dx_L + dx_R * dx_R) - p.d_d * x.omega_d * x.omega_d,
            -p.d_p * turning * turning - p.d_x * bushing * bushing - p.d_th * x.omega_b * x.omega_b,
            -(p.r * k.F_L + k.T_rL + k.T_brL) * x.omega_L,
            -(p.r * k.F_R + k.T_rR + k.T_brR) * x.omega_R,
            (k.F_L + k.F_R) * x.v_h,
            -vehicle.resistance(x.v, u.slope, p.m * p.g - p.F_z0, p) * x.v,
            (F_h * (p.h - p.r) - k.T_brL - k.T_brR) * x.omega_b,
        ],
        spring=0.5 * p.k_g * y * y,
        taken=validation_vehicle.gear_torque(x, p) * (x.omega_1 / p.i + x.omega_p - x.omega_g),
    )


ENERGIES = {driveline.BLOCK.name: of_driveline, validation_vehicle.BLOCK.name: of_vehicle}
"""By the names of the plants."""
