"""The coefficients of RODAS are those of one method: times and weights of the rate follow from those of the stages."""

import numpy as np

from fmublocks.block.rodas import GAMMA, A, C, D, G


def square(rows: tuple[tuple[float, ...], ...]) -> np.ndarray:
    matrix = np.zeros((len(rows), len(rows)))
    for k, row in enumerate(rows):
        matrix[k, : len(row)] = row
    return matrix


def test_times_and_weights_of_the_rate_are_the_sums_of_the_stages() -> None:
    """Hairer and Wanner, section IV.7: G = 1/GAMMA - inv(of gamma_ij), A = alpha_ij inv(of gamma_ij)."""
    gamma = np.linalg.inv(np.eye(len(G)) / GAMMA - square(G))
    np.testing.assert_allclose(gamma.sum(axis=1), D, atol=1e-12)
    np.testing.assert_allclose((square(A) @ gamma).sum(axis=1), C, atol=1e-12)
