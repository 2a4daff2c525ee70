"""The percentile of measured values."""

from typing import Sequence


def percentile(values: Sequence[float], fraction: float) -> float:
    """Returns one of the values. Of fewer than 1/(1 - fraction), it is the largest."""
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(fraction * len(ordered)))]
