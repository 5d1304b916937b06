"""What a data sheet does not have, estimated from what it has: mass, radius, ratio and torque.

Scaling laws, each through the default car, no regressions: there is no public table of rotors, wheels and shafts of
electric cars that would bear one. An estimate is a product of powers, so a car that differs in nothing is the default.

    J_1     ~ T_max^(4/3)  a motor makes T ~ D^2 L with an inertia J ~ D^4 L: J ~ T if it is only longer, or if there
                           are two, and J ~ T^(5/3) if it is larger in all directions; the middle of both
    J_2     ~ r^5/i^2      wheels that are larger in all directions
    C       ~ T_max/i      half shafts that the full torque twists by the same angle
    phi_B   ~ i            the same gap at the wheel
    c_slip  ~ F_z0, m      tyres pull in proportion to their load (H. B. Pacejka, "Tire and Vehicle Dynamics", 3rd ed.,
                           2012, section 4.3: the slip stiffness over the load hardly changes)
    F_z0    ~ m            up to what a driven axle may carry in the European Union
"""

from collections.abc import Mapping

from ...models.physics.vehicle import CAR
from ...models.validation_vehicle import Parameters

LAWS: Mapping[str, Mapping[str, float]] = {
    "J_1": {"T_max": 4.0 / 3.0},
    "J_2": {"r": 5.0, "i": -2.0},
    "C": {"T_max": 1.0, "i": -1.0},
    "phi_B": {"i": 1.0},
    "c_slip": {"F_z0": 1.0},
}
"""Of what is estimated the exponents of what it follows from."""

HEAVIEST = 11500.0 * CAR.g
"""In N, of a driven axle (Council Directive 96/53/EC, Annex I, 3.4.1)."""

SHEET = ("m", "r", "i", "T_max")
"""What a data sheet has of a car."""

DECIDE = (*LAWS, "tau")
"""What decides how good the damping is and stands in no data sheet."""


def law(name: str, known: Mapping[str, float]) -> dict[str, float]:
    """Exponents of the entries of a car from which one of LAWS follows; empty: of none that is given."""
    powers = LAWS[name]
    if "F_z0" in powers and "F_z0" not in known:  # which follows from the mass itself
        powers = {"m": 1.0}
    return {source: power for source, power in powers.items() if source in known}


def estimated(known: Mapping[str, float]) -> dict[str, float]:
    """The entries of LAWS that are not given, where something is that they follow from.

    Args:
        given: entries of a car in SI units.
    """
    usual = {"F_z0": Parameters().F_z0, **CAR._asdict()}
    estimates: dict[str, float] = {}
    if "F_z0" not in known and usual["F_z0"] * known.get("m", 0.0) / usual["m"] > HEAVIEST:
        known = {**known, "F_z0": HEAVIEST}
        estimates["F_z0"] = HEAVIEST
    for name in LAWS:
        if name not in known and (powers := law(name, known)):
            estimates[name] = usual[name]
            for source, power in powers.items():
                estimates[name] *= (known[source] / usual[source]) ** power
    return estimates
