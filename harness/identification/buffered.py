"""A function of CasADi that is called with arrays of numpy, without the copies that its own call makes."""

import casadi as ca
import numpy as np


class Buffered:
    """
    Args:
        function: of dense matrices.
    """

    def __init__(self, function: ca.Function) -> None:
        self._given = [np.zeros(function.nnz_in(k)) for k in range(function.n_in())]
        self._results = [np.zeros(function.nnz_out(k)) for k in range(function.n_out())]
        self._shapes = [function.size_out(k) for k in range(function.n_out())]
        self._buffer, self._run = function.buffer()
        for k, values in enumerate(self._given):
            self._buffer.set_arg(k, memoryview(values))  # pyright: ignore[reportCallIssue, reportArgumentType]
        for k, values in enumerate(self._results):
            self._buffer.set_res(k, memoryview(values))  # pyright: ignore[reportCallIssue, reportArgumentType]

    def __call__(self, *arguments: np.ndarray) -> list[np.ndarray]:
        """The results, which the next call overwrites. A vector may be given for a matrix of one row or column."""
        for place, values in zip(self._given, arguments, strict=True):
            place[:] = np.ravel(values, order="F")
        self._run()
        return [values.reshape(shape, order="F") for values, shape in zip(self._results, self._shapes, strict=True)]
