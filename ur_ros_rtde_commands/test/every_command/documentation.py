"""Reads the documentation of the commands: docs/use/commands/*.md has a section with an example for each action."""

import json
import pathlib
import re
import shlex
from dataclasses import dataclass, field
from typing import List, Tuple

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[3]
FOLDER = ROOT / "docs" / "use" / "commands"
INDEX = FOLDER / "README.md"


@dataclass(frozen=True)
class Setup:
    """Configuration of a cell."""

    controller: str = "ur10e"  # model of the arm
    parameters: Tuple[str, ...] = ()  # parameters of the driver


@dataclass
class Topic:
    """A topic that is published during an example."""

    name: str  # "visual_servo/target"
    type: str  # "geometry_msgs/msg/PoseStamped"
    message: dict
    rate: float  # Hz


@dataclass
class Example:
    action: str  # "move_j"
    type: str  # "ur_ros_rtde_msgs/action/MoveJ"
    goal: dict
    scene: List[dict] = field(default_factory=list)  # commands to the simulator's control port
    topics: List[Topic] = field(default_factory=list)
    setup: Setup = Setup()


@dataclass
class Section:
    name: str
    file: pathlib.Path
    text: str

    def example(self):
        """Returns the first `ros2 action send_goal` of the section for this action."""
        for command in _commands(self.text):
            if command[:3] == ["ros2", "action", "send_goal"]:
                action, kind, goal = [word for word in command[3:] if word not in ("--feedback", "-f")]
                if action == f"/{self.name}":
                    return Example(self.name, kind, yaml.safe_load(goal) or {}, self.scene(), self.topics(), self.setup())
        raise ValueError(f"{self.file.name}: the section {self.name} has no `ros2 action send_goal /{self.name} …`")

    def _comment(self, name):
        found = re.search(rf"<!--\s*{name}:\s*(.*?)\s*-->", self.text, re.S)
        return found.group(1) if found else None

    def scene(self):
        return json.loads(self._comment("scene") or "[]")

    def topics(self):
        """Returns the topics that the section publishes with `ros2 topic pub --rate RATE /NAME TYPE MESSAGE`."""
        found = []
        for command in _commands(self.text):
            if command[:4] == ["ros2", "topic", "pub", "--rate"]:
                rate, name, kind, message = command[4:8]
                found.append(Topic(name.lstrip("/"), kind, yaml.safe_load(message), float(rate)))
        return found

    def setup(self):
        return Setup(self._comment("controller") or Setup.controller, tuple((self._comment("parameters") or "").split()))


def _commands(text):
    for block in re.findall(r"^```bash\n(.*?)^```", text, re.S | re.M):
        command = ""
        for line in block.replace("\\\n", " ").splitlines():
            command += line + " "
            try:
                yield shlex.split(command, comments=True)
            except ValueError:
                continue  # a quoted text continues on the next line
            command = ""


def sections():
    """Returns the sections in the order of the files. Duplicate names are not removed."""
    found = []
    for file in sorted(FOLDER.glob("*.md")):
        if file == INDEX:
            continue
        parts = re.split(r"^### (.*)$", file.read_text(), flags=re.M)
        for title, text in zip(parts[1::2], parts[2::2]):
            # A heading of a higher level ends the section.
            found.append(Section(title.strip().strip("`"), file, re.split(r"^##? ", text, flags=re.M)[0]))
    return found


def section(name):
    for candidate in sections():
        if candidate.name == name:
            return candidate
    raise ValueError(f"{name} has no section `### {name}` in docs/use/commands/*.md")


def example(name):
    return section(name).example()
