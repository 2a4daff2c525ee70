"""The files for containers agree with the programs and packages that they name. Continuous integration builds and runs the image."""

import argparse
import fnmatch
import json
import re

import pytest
import yaml
from ur_ros_rtde_launch.launch_arguments import PARAMETERS
from ur_ros_rtde_viewer import arguments
from ur_tools import packages, sbom
from ur_tools.layout import ROOT

BACKGROUND = True
DOCKERFILE = (ROOT / "Dockerfile").read_text()
COMPOSE = {name: yaml.safe_load((ROOT / name).read_text())["services"] for name in ("compose.yaml", "compose.robot.yaml")}
STAGES = re.findall(r"^FROM \S+ AS (\w+)$", DOCKERFILE, re.M)


def commands(program):
    return [service["command"] for services in COMPOSE.values() for service in services.values() if program in service["command"]]


def test_the_parameters_of_the_driver_are_known():
    known = {parameter.name for parameter in PARAMETERS}
    found = commands("driver")
    assert len(found) == 2
    for command in found:
        names = [word.partition(":=")[0] for word in command if ":=" in word]
        assert "robot_ip" in names and set(names) <= known


def test_the_options_of_the_viewer_are_known():
    parser = argparse.ArgumentParser()
    arguments.add_arguments(parser)
    found = [parser.parse_args(command[2:]) for command in commands("view")]  # exits with an unknown one
    assert sorted((options.control, options.port) for options in found) == [(False, arguments.DEFAULT_PORT), (True, arguments.DEFAULT_PORT)]


def test_the_options_of_the_simulator_are_known():
    sources = "".join(path.read_text() for path in (ROOT / "ur_simulator" / "src").rglob("*.cpp"))
    command, = commands("ur_simulator")
    for option in (word for word in command if word.startswith("--")):
        assert f'"{option}"' in sources or f',{option}"' in sources, option


def test_the_page_of_the_simulated_robot_is_published_on_this_host_only():
    published = [port for services in COMPOSE.values() for service in services.values() for port in service.get("ports", [])]
    assert published == [f"127.0.0.1:{arguments.DEFAULT_PORT}:{arguments.DEFAULT_PORT}"]


def test_every_container_runs_without_capabilities():
    assert "\nUSER 1000:1000\n" in DOCKERFILE
    for services in COMPOSE.values():
        for service in services.values():
            assert service["cap_drop"] == ["ALL"] and service["security_opt"] == ["no-new-privileges:true"]


def test_the_development_container_is_a_stage():
    configuration = json.loads((ROOT / ".devcontainer" / "devcontainer.json").read_text())
    assert configuration["build"]["target"] in STAGES
    assert (ROOT / ".devcontainer" / configuration["build"]["dockerfile"]).resolve() == ROOT / "Dockerfile"


def ignored():
    lines = (ROOT / ".dockerignore").read_text().splitlines()
    return [line for line in lines if line and not line.startswith("#")]


@pytest.mark.parametrize("name", [*(package.folder.name for package in packages.discover(ROOT).values()), "wheels", "tools"])
def test_what_the_image_is_built_from_is_not_ignored(name):
    assert not [pattern for pattern in ignored() if fnmatch.fnmatch(name, pattern)]


def test_headers_are_no_run_time_dependency():
    """Those of Boost would be the largest part of what the image adds to that of ROS."""
    headers = {"cli11", "eigen", "libboost-dev", "libboost-thread-dev", "libexpected-dev", "nlohmann-json-dev"}
    at_run_time = {name for manifest in sbom.manifests() for name, tags in sbom.dependencies(manifest).items()
                   if tags & {"depend", "exec_depend"}}
    assert not headers & at_run_time
