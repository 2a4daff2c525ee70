"""Values of sliders."""

from typing import Any


def within_limits(slider: Any) -> float:
    """The number beside a slider can be outside its range."""
    return float(min(max(slider.value, slider.min), slider.max))
