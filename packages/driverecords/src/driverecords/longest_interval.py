"""The longest time for which something holds without a break, in samples."""

import numpy as np


def longest_run(condition: np.ndarray) -> tuple[int, int]:
    """Index of the first sample of the longest run in which the condition (n,) holds, and its length; (0, 0) if it
    never does."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], condition, [False])).astype(int)))
    begins, lengths = edges[::2], edges[1::2] - edges[::2]
    if not len(begins):
        return 0, 0
    k = int(np.argmax(lengths))
    return int(begins[k]), int(lengths[k])
