"""The interfaces in wheels/interfaces are the published ones: clients of an installed ROS 2 understand them."""

import json
import pathlib

from ament_index_python.packages import get_package_share_directory
from ur_tools.layout import ROOT

# Computed with rosidl from the published definitions. FollowJointTrajectory is that before June 2025, when its feedback got two
# more fields.
PUBLISHED = {
    "tf2_msgs/msg/TFMessage": "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087",
    "control_msgs/msg/JointTolerance": "RIHS01_c254f9cece0f3b733017b6990fd46d1326e25242d6b8844398c97d9a88e7d648",
    "control_msgs/action/FollowJointTrajectory": "RIHS01_738ebcb7a2d7cfa42f9f1001cc99ce3a4383d1cfe508015d9be8485e4b1c66f6",
}


def installed_hash(name):
    package, kind, interface = name.split("/")
    installed = json.loads((pathlib.Path(get_package_share_directory(package)) / kind / f"{interface}.json").read_text())
    return {entry["type_name"]: entry["hash_string"] for entry in installed["type_hashes"]}[name]


def test_the_type_hashes_are_those_of_the_published_interfaces():
    assert {name: installed_hash(name) for name in PUBLISHED} == PUBLISHED


def test_every_package_of_the_folder_is_compared():
    assert {path.parent.name for path in ROOT.glob("wheels/interfaces/*/package.xml")} == {name.split("/")[0] for name in PUBLISHED}
