"""Errors that are reported to the user."""


class CliError(Exception):
    """A command that cannot be carried out. The text states the cause and the remedy."""
