"""Steps of a linearly implicit method, for where a block is stiff: they damp what they do not resolve.

The matrix df/dx is taken by differences, so that nothing need be known of a block but its derivative.
Kinks are left to the error of the steps.
"""

import math

from .declaration import Record
from .explicit import TOLERANCE, Work, change, small_sizes
from .rodas import GAMMA, A, G
from .types import ContinuousBlock

DIFFERENCE = 1e-7
"""By what a state is moved for a difference, over its size."""

SHORTEST_STEP = 1e-13
"""In s: a step that must be shorter is not made."""

MOST_STEPS = 3_000
"""Steps tried in one stretch before it is given up."""

IMPLICIT_WORK = 4
"""Of one step, in explicit ones."""

Vector = list[float]
Matrix = list[Vector]


class NotIntegrable(ArithmeticError):
    """A block changes too fast to be followed; the argument is the name of the state that changes fastest."""


class Implicit:
    """Advances the state of one continuous block; keeps nothing between two calls."""

    def __init__(self, block: ContinuousBlock) -> None:
        self._derivative, self._State = block.derivative, block.State
        self._size, self._small = range(len(block.State._fields)), small_sizes(block)

    def advance(self, x: Record, u: object, p: object, duration: float, work: Work) -> Record:
        """The state `duration` s after x; the work is added up.

        Raises:
            NotIntegrable: the steps become too short or too many.
        """
        remaining = length = duration
        dx = self._derivative(x, u, p)
        jacobian = self._jacobian(x, dx, u, p)
        for _ in range(MOST_STEPS):
            work.steps += IMPLICIT_WORK
            end, error = self._step(x, dx, jacobian, u, p, length)
            if error <= 1.0:
                remaining -= length
                x = end
                if remaining <= 0.0:
                    return x
                dx = self._derivative(x, u, p)
                jacobian = self._jacobian(x, dx, u, p)
            elif length < SHORTEST_STEP:
                break
            length = min(remaining, length * change(error, 2))
        raise NotIntegrable(self.fastest(x, dx))

    def _jacobian(self, x: Record, dx: Record, u: object, p: object) -> Matrix:
        """Row n holds what moves state n."""
        moved, columns = list(x), Matrix()
        for j in self._size:
            moved[j] = x[j] + DIFFERENCE * (abs(x[j]) + self._small[j])
            by = moved[j] - x[j]
            there = self._derivative(self._State._make(moved), u, p)
            columns.append([(there[n] - dx[n]) / by for n in self._size])
            moved[j] = x[j]
        return [[column[n] for column in columns] for n in self._size]

    def _step(self, x: Record, dx: Record, J: Matrix, u: object, p: object, h: float) -> tuple[Record, float]:
        """The state after one step and its error, in units of what is tolerated."""
        rows = [[-value for value in row] for row in J]
        order = factorised(rows, 1.0 / (h * GAMMA))
        if not order:
            return x, math.inf
        at, rate, stages = x, dx, Matrix()
        for i, (weights, rates) in enumerate(zip(A, G, strict=True)):
            if i > 0:
                at = self._State._make(x[n] + weighted(weights, stages, n) for n in self._size)
                rate = self._derivative(at, u, p)
            stages.append(solved(rows, order, [rate[n] + weighted(rates, stages, n) / h for n in self._size]))
        last = stages[-1]
        end = self._State._make(at[n] + last[n] for n in self._size)
        total = 0.0
        for n in self._size:
            e = last[n] / (TOLERANCE * (max(abs(x[n]), abs(end[n])) + self._small[n]))
            total += e * e
        return end, math.sqrt(total / len(self._size))

    def fastest(self, x: Record, dx: Record) -> str:
        """The name of the state that changes fastest for its size."""
        changes = [abs(dx[n]) / (abs(x[n]) + self._small[n]) for n in self._size]
        return self._State._fields[max(self._size, key=lambda n: changes[n])]


def weighted(weights: tuple[float, ...], stages: Matrix, n: int) -> float:
    total = 0.0
    for j, weight in enumerate(weights):
        total += weight * stages[j][n]
    return total


def factorised(rows: Matrix, diagonal: float) -> list[int]:
    """Gaussian elimination with row pivoting, in place, of the matrix with that added to its diagonal.

    Returns:
        The rows in the order in which they were taken; none if the matrix is singular.
    """
    size = len(rows)
    order = list(range(size))
    for n in range(size):
        rows[n][n] += diagonal
    for k in range(size):
        pivot = k
        for i in range(k + 1, size):
            if abs(rows[i][k]) > abs(rows[pivot][k]):
                pivot = i
        rows[k], rows[pivot] = rows[pivot], rows[k]
        order[k], order[pivot] = order[pivot], order[k]
        top = rows[k]
        if top[k] == 0.0:
            return []
        for row in rows[k + 1 :]:
            if row[k] != 0.0:
                factor = row[k] / top[k]
                row[k] = factor
                for j in range(k + 1, size):
                    row[j] -= factor * top[j]
    return order


def solved(rows: Matrix, order: list[int], right: Vector) -> Vector:
    """The solution for a right-hand side."""
    size = len(rows)
    result = [right[n] for n in order]
    for i in range(size):
        row = rows[i]
        for j in range(i):
            result[i] -= row[j] * result[j]
    for i in range(size - 1, -1, -1):
        row = rows[i]
        for j in range(i + 1, size):
            result[i] -= row[j] * result[j]
        result[i] /= row[i]
    return result
