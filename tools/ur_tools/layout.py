"""Paths: sources in the checkout, generated files in .ur/."""

import importlib.util
import os
import pathlib
import sys
from dataclasses import dataclass
from typing import Any, Tuple

ROOT = pathlib.Path(__file__).resolve().parents[2]
STATE = ROOT / ".ur"
DOWNLOADS = STATE / "downloads"
WHEELS = ("jazzy", "kilted")  # the first is the default
DEFAULT = WHEELS[0]
INSTALLED = "installed"  # instead of wheels, the distribution whose setup script has been sourced
DISTRIBUTIONS = (*WHEELS, INSTALLED)
SUPPORTED_DISTRIBUTIONS = ("humble", "jazzy", "kilted", "lyrical", "rolling")
# The command that the user types: in `./ur shell` it is `ur`.
PROGRAM = "ur" if os.environ.get("UR_CHECKOUT") == str(ROOT) else "./ur"
SANITIZERS = ("address", "undefined", "thread")


def load(path: str) -> Any:
    """Returns a module of another package, which need not be built."""
    spec = importlib.util.spec_from_file_location(pathlib.Path(path).stem, ROOT / path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # for dataclasses
    spec.loader.exec_module(module)
    return module


def sourced() -> str:
    """Returns the distribution whose setup script has been sourced; empty if there is none, or only that of our own shell."""
    ours = "ROS_WHEELS_PREFIX" in os.environ or not os.environ.get("AMENT_PREFIX_PATH")
    return "" if ours else os.environ.get("ROS_DISTRO", "")


@dataclass(frozen=True)
class Layout:
    """The paths of one build: of one of DISTRIBUTIONS and a variant ("", "debug", or the name of a sanitizer)."""

    ros: str = DEFAULT
    variant: str = ""

    @staticmethod
    def of_environment() -> "Layout":
        """Returns the layout in UR_LAYOUT, which our commands set for the programs they start, as in jazzy:address; without it that of
        an installed ROS which has been sourced."""
        ros, _, variant = os.environ.get("UR_LAYOUT", f"{INSTALLED if sourced() else DEFAULT}:").partition(":")
        return Layout(ros, variant)

    @property
    def is_installed(self) -> bool:
        return self.ros == INSTALLED

    @property
    def distribution(self) -> str:
        """Its name: "humble"."""
        return sourced() if self.is_installed else self.ros

    @property
    def title(self) -> str:
        return f"ROS 2 {self.distribution.capitalize()}" + (" as installed" if self.is_installed else "")

    @property
    def base(self) -> pathlib.Path:
        return STATE / (f"{INSTALLED}_{self.distribution}" if self.is_installed else self.ros)

    @property
    def venv(self) -> pathlib.Path:
        return self.base / "venv"

    @property
    def python(self) -> pathlib.Path:
        return self.venv / "bin" / "python"

    def _variant(self, name: str, suffix: str = "") -> pathlib.Path:
        return self.base / (f"{name}-{self.variant}{suffix}" if self.variant else name + suffix)

    @property
    def build(self) -> pathlib.Path:
        return self._variant("build")

    @property
    def install(self) -> pathlib.Path:
        return self._variant("install")

    @property
    def log(self) -> pathlib.Path:
        return self._variant("log")

    @property
    def build_times(self) -> pathlib.Path:
        return self._variant("build_times", ".json")

    @property
    def durations(self) -> pathlib.Path:
        """Of the tests."""
        return self._variant("durations", ".json")

    @property
    def requirements(self) -> Tuple[pathlib.Path, ...]:
        """Of the virtual environment. An installed ROS has its own libraries."""
        names = ["tools"] if self.is_installed else [self.ros, "libraries", "tools"]
        return tuple(ROOT / "wheels" / f"{name}.txt" for name in names)

    @property
    def viewer_requirements(self) -> Tuple[pathlib.Path, ...]:
        """Installed on the first use of the viewer."""
        return (ROOT / "wheels" / "viewer.txt",)

    @property
    def provider(self) -> pathlib.Path:
        """Adapts a build to the wheels."""
        return ROOT / "wheels" / "provider.cmake"

    def site_packages(self, prefix: pathlib.Path) -> pathlib.Path:
        """Returns the site-packages folder of an installation prefix for the Python of the virtual environment."""
        found = sorted(self.venv.glob("lib/python3.*"))
        version = found[0].name if found else "python3"
        return prefix / "lib" / version / "site-packages"
