#!/usr/bin/env python3
"""Builds a ROS 2 distribution from its release repositories, as far as this project needs it.

The result is an installation like that of the distribution's packages, for machines where it has none: docs/internals/testing.md.
What is built are the packages of the distribution on which this project depends, rclpy and a middleware, and what they depend on,
in the released versions. Only what has changed is built again.
"""

import argparse
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
import time
from dataclasses import dataclass
from typing import Any, Dict, Iterable, List, Optional, Sequence, Tuple

ROOT = pathlib.Path(__file__).resolve().parents[1]
ROSDISTRO = "https://github.com/ros/rosdistro.git"
RELEASES = "https://github.com/{owner}/{name}.git"
MIDDLEWARES = {"fastrtps": "rmw_fastrtps_cpp", "cyclonedds": "rmw_cyclonedds_cpp", "zenoh": "rmw_zenoh_cpp"}
# What tests and Python programs need, which no package.xml names. The type supports are members of a group.
ALWAYS = ("rclpy", "rmw_implementation", "rosidl_default_generators", "rosidl_default_runtime", "rosidl_typesupport_introspection_cpp",
          "rosidl_typesupport_introspection_c", "rosidl_generator_py")
# For people; the project builds and passes its tests without them. `--package` builds them too.
OPTIONAL = ("launch", "launch_ros", "rclcpp", "rclcpp_action", "robot_state_publisher", "rviz2")
DEPENDS = ("build_depends", "buildtool_depends", "build_export_depends", "buildtool_export_depends", "exec_depends")
# rmw_implementation names all of them, but takes those that it finds.
OTHER_MIDDLEWARES = ("rmw_connextdds", "rmw_fastrtps_dynamic_cpp", "rmw_gurumdds_cpp", *MIDDLEWARES.values())
# Build tools name these from Lyrical on, but only the tests of ROS itself and programs in Rust use them.
OTHER_USES = ("rmw_test_fixture_implementation", "rosidl_generator_rs",
              *(f"ament_cmake_{linter}" for linter in ("cppcheck", "cpplint", "flake8", "mypy", "pep257", "uncrustify")))
# Python packages of the build. The generators of the newer distributions need the newer empy.
TOOLS = ("colcon-common-extensions", "catkin_pkg", "pyyaml", "lark", "numpy<2", "setuptools<80", "packaging", "pytest", "typing_extensions")
EMPY = {"humble": "empy<4", "jazzy": "empy<4", "kilted": "empy<4"}
NEWER_EMPY = "empy>=4"
INSIDE = "UR_UNDERLAY_TOOLS"  # set while this script runs with the tools


class Failure(Exception):
    """Ends the script with a message."""


@dataclass(frozen=True)
class Release:
    url: str
    tag: str


def run(command: Sequence[object], **options: Any) -> str:
    """Returns the output; raises Failure with its end."""
    result = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)
    if result.returncode != 0:
        raise Failure(f"`{' '.join(str(part) for part in command)}` failed:\n" + "\n".join(result.stdout.splitlines()[-20:]))
    return result.stdout


def version(tag: str) -> List[int]:
    """Returns the version of a release, and, as the last number, the revision of its packaging."""
    return [int(part) for part in re.findall(r"\d+", tag.rpartition("/")[2])]


class Sources:
    """Fetches single tags of release repositories."""

    def __init__(self, pattern: str, folder: pathlib.Path):
        self._pattern, self._folder = pattern, folder

    def url(self, url: str) -> str:
        match = re.fullmatch(r"https://github\.com/([^/]+)/(.+?)(?:\.git)?", url)
        return self._pattern.format(owner=match[1], name=match[2]) if match else url

    def nearest(self, release: Release) -> str:
        """Returns the tag. If the repository does not have it, returns the newest tag of the same or an earlier version of the package:
        of the distribution, otherwise of Rolling, from which each distribution starts. Returns "" if there is none."""
        _, distro, package, _ = release.tag.split("/")
        for origin in dict.fromkeys((distro, "rolling")):
            listing = run(["git", "ls-remote", "--tags", "--refs", self.url(release.url), f"refs/tags/release/{origin}/{package}/*"])
            tags = [line.split("refs/tags/")[1] for line in listing.splitlines() if "refs/tags/" in line]
            candidates = [tag for tag in tags if version(tag)[:-1] <= version(release.tag)[:-1]]
            if candidates:
                return release.tag if release.tag in tags else max(candidates, key=version)
        return ""

    def extract(self, release: Release, folder: pathlib.Path) -> None:
        """Replaces the content of the folder by that of the tag."""
        repository = self._folder / hashlib.sha256(release.url.encode()).hexdigest()[:12]
        if not repository.is_dir():
            run(["git", "init", "--quiet", "--bare", repository])
        run(["git", "-C", repository, "fetch", "--quiet", "--depth", "1", self.url(release.url), f"refs/tags/{release.tag}"])
        if folder.exists():
            shutil.rmtree(folder)
        folder.mkdir(parents=True)
        archive = subprocess.Popen(["git", "-C", str(repository), "archive", "FETCH_HEAD"], stdout=subprocess.PIPE)
        run(["tar", "-x", "-C", folder], stdin=archive.stdout)
        if archive.wait() != 0:
            raise Failure(f"{release.url}: {release.tag} cannot be extracted")


def distribution(name: str, sources: Sources, folder: pathlib.Path) -> Dict[str, Release]:
    """Returns the releases by package."""
    import yaml

    repository = folder / "rosdistro"
    if not repository.is_dir():
        run(["git", "clone", "--quiet", "--depth", "1", sources.url(ROSDISTRO), repository])
    file = repository / name / "distribution.yaml"
    if not file.is_file():
        known = sorted(path.parent.name for path in repository.glob("*/distribution.yaml"))
        raise Failure(f"rosdistro has no distribution {name}; it has {', '.join(known)}")
    found: Dict[str, Release] = {}
    for repository_name, entry in yaml.safe_load(file.read_text())["repositories"].items():
        release = entry.get("release", {})
        if "version" in release and "release" in release.get("tags", {}):
            for package in release.get("packages", [repository_name]):
                tag = release["tags"]["release"].format(package=package, version=release["version"])
                found[package] = Release(release["url"], tag)
    return found


def project_dependencies() -> Iterable[str]:
    from catkin_pkg.package import parse_package

    for manifest in sorted(ROOT.glob("*/package.xml")):
        package = parse_package(str(manifest))
        for kind in (*DEPENDS, "test_depends"):
            yield from (dependency.name for dependency in getattr(package, kind))


class Workspace:
    def __init__(self, options: argparse.Namespace):
        self._distro, self._folder = options.distribution, options.into.resolve()
        # Those of the package ros_environment.
        self._variables = {"ROS_DISTRO": self._distro, "ROS_VERSION": "2", "ROS_PYTHON_VERSION": "3"}
        self._sources = Sources(options.releases, self._folder / "repositories")
        (self._folder / "repositories").mkdir(parents=True, exist_ok=True)
        self._releases = distribution(self._distro, self._sources, self._folder / "repositories")
        self._system: Dict[str, List[str]] = {}  # packages of the system, and who needs them
        self._older: List[str] = []

    def fetch(self, roots: Sequence[str]) -> List[str]:
        """Fetches the packages and all that they depend on. Returns their names."""
        waiting = [name for name in roots if name in self._releases]
        done: Dict[str, None] = {}
        failures: List[str] = []
        while waiting:
            name = waiting.pop()
            if name in done:
                continue
            done[name] = None
            print(f"\r{len(done)} packages: {name:50}", end="", flush=True)
            try:
                dependencies = self._dependencies(name)
            except Failure as error:
                failures.append(str(error))
                continue
            for dependency in dependencies:
                if dependency in (*OTHER_MIDDLEWARES, *OTHER_USES):
                    continue
                if dependency in self._releases:
                    waiting.append(dependency)
                else:
                    self._system.setdefault(dependency, []).append(name)
        print(f"\r{len(done)} packages of {self._distro}{'':50}")
        if failures:
            raise Failure("\n".join(failures))
        if self._older:
            print("Older than released, because the repository does not have the release in parentheses: " + ", ".join(self._older))
        print("From the system: " + ", ".join(sorted(self._system)))
        return list(done)

    def _dependencies(self, name: str) -> List[str]:
        from catkin_pkg.package import parse_package

        package = parse_package(str(self._source(name) / "package.xml"))
        package.evaluate_conditions(self._variables)
        return [dependency.name for kind in DEPENDS for dependency in getattr(package, kind) if dependency.evaluated_condition]

    def _source(self, name: str) -> pathlib.Path:
        folder, release = self._folder / "src" / name, self._releases[name]
        stamp = self._folder / "src" / f"{name}.tag"
        wanted, _, tag = (stamp.read_text() if stamp.is_file() else "").partition(" ")
        if wanted != release.tag or not folder.is_dir():
            tag = self._sources.nearest(release)
            if not tag:
                raise Failure(f"{self._sources.url(release.url)} has no release of {name} for {self._distro}, and none of Rolling")
            self._sources.extract(Release(release.url, tag), folder)
            stamp.write_text(f"{release.tag} {tag}")
        if tag != release.tag:
            _, origin, _, found = tag.split("/")
            branch = "" if origin == self._distro else f" of {origin}"
            self._older.append(f"{name} {found}{branch} ({release.tag.rpartition('/')[2]})")
        return folder

    def build(self, names: Sequence[str], jobs: int) -> None:
        env = {**os.environ, "MAKEFLAGS": f"-j{jobs}", "CMAKE_BUILD_PARALLEL_LEVEL": str(jobs), **self._variables}
        command = ["colcon", "--log-base", self._folder / "log", "build", "--merge-install", "--executor", "sequential",
                   "--base-paths", *(self._folder / "src" / name for name in names), "--build-base", self._folder / "build",
                   "--install-base", self._folder / "install",
                   "--event-handlers", "console_direct-", "console_cohesion-", "console_start_end+",
                   "--cmake-args", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG", "-DBUILD_TESTING=OFF",
                   "-DTRACETOOLS_DISABLED=ON", "-DINSTALL_EXAMPLES=OFF", "-DSECURITY=OFF", f"-DPython3_EXECUTABLE={sys.executable}",
                   f"-DPYTHON_EXECUTABLE={sys.executable}", "-Wno-dev"]
        start = time.monotonic()
        if subprocess.run([str(part) for part in command], env=env, cwd=self._folder).returncode != 0:
            raise Failure(f"The build has failed: {self._folder / 'log' / 'latest_build'}")
        print(f"Built in {time.monotonic() - start:.0f} s. In a shell:\n    . {self._write_setup()}\n    ./ur test --ros installed")

    def _write_setup(self) -> pathlib.Path:
        """Writes a setup script that also provides what the packages of a distribution take from the Python of their system."""
        setup, modules = self._folder / "setup.sh", sysconfig.get_paths()["purelib"]
        setup.write_text(f'. "{self._folder / "install" / "setup.sh"}"\n'
                         f'export {" ".join(f"{name}={value}" for name, value in self._variables.items())}\n'
                         f'export PATH="{pathlib.Path(sys.executable).parent}:$PATH"\n'
                         f'export PYTHONPATH="$PYTHONPATH:{modules}"\n')
        return setup


def enter_tools(options: argparse.Namespace) -> None:
    """Runs this script again with a Python that has what the build needs."""
    tools = options.into.resolve() / "tools"
    requirements = [*TOOLS, EMPY.get(options.distribution, NEWER_EMPY)]
    stamp = tools / "requirements.txt"
    if not stamp.is_file() or stamp.read_text() != "\n".join(requirements):
        print(f"Installing the build tools in {tools}")
        run([sys.executable, "-m", "venv", "--clear", tools])
        run([tools / "bin" / "python", "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *requirements])
        stamp.write_text("\n".join(requirements))
    env = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "AMENT_PREFIX_PATH", "CMAKE_PREFIX_PATH")}
    env.update({INSIDE: str(tools), "VIRTUAL_ENV": str(tools), "PATH": os.pathsep.join([str(tools / "bin"), env.get("PATH", os.defpath)])})
    python = str(tools / "bin" / "python")
    os.execve(python, [python, str(pathlib.Path(__file__).resolve()), *sys.argv[1:]], env)


def parse(arguments: Optional[Sequence[str]] = None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("distribution", help="for example humble")
    parser.add_argument("--into", type=pathlib.Path, required=True, metavar="FOLDER", help="for sources, build and installation (5 GB)")
    parser.add_argument("--middleware", choices=sorted(MIDDLEWARES), action="append",
                        help="several are possible (default: fastrtps)")
    parser.add_argument("--package", action="append", default=[], metavar="NAME", help="a further package, with what it depends on")
    parser.add_argument("--releases", default=RELEASES, metavar="PATTERN",
                        help="where the repositories are, with {owner} and {name} (default: %(default)s)")
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)), help="of the build (default: %(default)s)")
    parser.add_argument("--fetch-only", action="store_true", help="do not build")
    return parser.parse_args(arguments)


def roots_of(options: argparse.Namespace) -> Tuple[str, ...]:
    middlewares = [MIDDLEWARES[name] for name in options.middleware or ["fastrtps"]]
    needed = [name for name in project_dependencies() if name not in OPTIONAL]
    return tuple(dict.fromkeys([*needed, *ALWAYS, *middlewares, *options.package]))


def main() -> int:
    options = parse()
    try:
        if not os.environ.get(INSIDE):
            enter_tools(options)
        workspace = Workspace(options)
        names = workspace.fetch(roots_of(options))
        if not options.fetch_only:
            workspace.build(names, options.jobs)
    except Failure as error:
        print(f"\n{error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
