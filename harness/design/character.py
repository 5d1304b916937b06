"""The driver's choice, from 0, sport, to 1, comfort, with 0.5 in the middle: what it makes of the designed gains."""

from collections.abc import Mapping

FACTORS: Mapping[str, tuple[float, float]] = {
    "k_d": (0.88, 1.2),
    "omega_w": (1.4, 0.75),
    "landing_share": (1.4, 0.6),
    "t_return": (0.5, 2.0),
}
"""On gains, at both ends: less damping and a harder landing answer sooner."""


def factors(character: float) -> dict[str, float]:
    """On gains, by name, for a character from 0 to 1; in the middle they are 1."""
    share = abs(2.0 * character - 1.0)
    return {name: both[character > 0.5] ** share for name, both in FACTORS.items()}
