"""Errors that are reported to the user."""

from ur_ros_rtde_cli.errors import CliError


class ViewerError(CliError):
    """The viewer cannot do what was asked. The text states the cause and the remedy."""
