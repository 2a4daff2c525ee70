"""Errors that are reported to the user."""


class ViewerError(Exception):
    """The viewer cannot do what was asked. The text states the cause and the remedy."""
