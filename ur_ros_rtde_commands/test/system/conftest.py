import shutil

import pytest
from robot_fixtures import addresses, client, destroy_subscriptions_after_test, driver, processes, robot, simulator

__all__ = ["addresses", "client", "driver", "destroy_subscriptions_after_test", "processes", "robot", "simulator"]


@pytest.fixture
def plugin_prefix(tmp_path):
    """Returns a function that creates an ament prefix with one plugin package in it."""

    def create(package, description, libraries=()):
        index = tmp_path / "share" / "ament_index" / "resource_index"
        for kind, content in (("ur_ros_rtde__pluginlib__plugin", f"share/{package}/plugins.xml\n"), ("packages", "")):
            (index / kind).mkdir(parents=True, exist_ok=True)
            (index / kind / package).write_text(content)
        (tmp_path / "share" / package).mkdir(parents=True)
        (tmp_path / "share" / package / "plugins.xml").write_text(description)
        (tmp_path / "lib").mkdir(exist_ok=True)
        for library in libraries:
            shutil.copy(library, tmp_path / "lib")
        return tmp_path

    return create
