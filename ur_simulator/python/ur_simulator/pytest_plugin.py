"""The pytest fixture ur_robot: a simulated robot for each test.

A marker selects the robot: @pytest.mark.ur_robot(model="ur5e", polyscope="5.13", options=["--powered-off"]).
"""

from typing import Iterator

import pytest

from .robot import SimulatedRobot

_SETTINGS = ("model", "polyscope", "options")


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "ur_robot(model, polyscope, options): the robot of the fixture ur_robot")


@pytest.fixture
def ur_robot(request: pytest.FixtureRequest) -> Iterator[SimulatedRobot]:
    """A simulated Universal Robots controller on an address of its own, powered on with released brakes."""
    marker = request.node.get_closest_marker("ur_robot")
    settings = dict(marker.kwargs) if marker else {}
    unknown = sorted(set(settings) - set(_SETTINGS))
    if unknown:
        raise pytest.UsageError(f"@pytest.mark.ur_robot has no {', '.join(unknown)}: it has {', '.join(_SETTINGS)}")
    options = settings.get("options", ())
    with SimulatedRobot(settings.get("model", "ur10e"), *options, polyscope=settings.get("polyscope")) as robot:
        yield robot
