"""Errors that are reported to the user."""


class CliError(Exception):
    """A command that cannot be carried out as it was given. The text states the cause and the remedy."""

    exit_status = 2


class OperationFailed(CliError):
    """The command was right, but the driver, the network or the disk did not do it."""

    exit_status = 1
