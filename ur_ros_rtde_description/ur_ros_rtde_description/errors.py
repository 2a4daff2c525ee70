"""Errors of the input."""

import difflib
from typing import Iterable


class DescriptionError(ValueError):
    """Invalid input. The text states the field, its value and the allowed values."""


def nearest(name: str, known: Iterable[str]) -> str:
    """Returns "did you mean …? " with the most similar known name, or an empty string."""
    close = difflib.get_close_matches(name.lower(), list(known), 1, 0.5)
    return f"did you mean {close[0]}? " if close else ""
