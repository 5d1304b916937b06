"""Random numbers as pure functions of a seed, a stream and an index: no hidden generator state.

A permutation of the whole numbers below the prime M = 2^26 - 5 (rounds of x -> x^3 + c, a bijection
because 3 does not divide M - 1) scrambles the three arguments. All products stay below 2^53, so the
result is exact in double precision and the same on every machine.
"""

from .operators import cos, log, sin, sqrt

M = 67108859.0


def _scramble(x: float, c: float) -> float:
    return (x * x % M * x + c) % M


def uniform(seed: float, stream: float, index: float) -> float:
    """A number in (0, 1), for whole seed and index from 0 to 2^26 and stream from 0 to 60."""
    x = _scramble((seed * 40692.0 + 7368787.0) % M, 19088743.0)
    x = _scramble(x, 1013904.0 * stream + 40014.0)
    x = _scramble((x + index) % M, 40503.0)
    x = _scramble(x, 29282417.0)
    x = _scramble(x, 52711.0)
    return (x + 0.5) / M


def normals(seed: float, stream: float, index: float) -> tuple[float, float]:
    """Two independent numbers from N(0, 1), at most 6.2, from the streams `stream` and `stream + 1`.

    G. E. P. Box, M. E. Muller, "A note on the generation of random normal deviates", 1958.
    """
    radius = sqrt(-2.0 * log(uniform(seed, stream, index)))
    angle = 6.283185307179586 * uniform(seed, stream + 1.0, index)
    return radius * cos(angle), radius * sin(angle)
