#!/usr/bin/env python3
"""Compiles our sources with another compiler, or against the headers of another ROS distribution.

By default the ROS headers of the build are used. SOURCES is a folder with the ROS packages of another distribution, one
directory each (such as src/ of tools/ros_underlay.py): their headers are used, and the interface headers are first generated
with that distribution's rosidl. Files are compiled with -fsyntax-only -Werror and the options of the build.
"""

import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import xml.etree.ElementTree

from ur_tools import lint
from ur_tools.layout import Layout

ROOT = pathlib.Path(__file__).resolve().parents[1]
INTERFACES = ("msg", "srv", "action")


class Package:
    def __init__(self, folder):
        self.folder = folder
        document = xml.etree.ElementTree.parse(folder / "package.xml").getroot()
        self.name, self.version = document.findtext("name"), document.findtext("version")
        self.has_interfaces = "rosidl_interface_packages" in [group.text for group in document.findall("member_of_group")]
        self.depends = {element.text for element in document if element.tag.endswith("depend")}

    def interfaces(self):
        """Returns the interface files, such as msg/Pose.msg."""
        return sorted(str(file.relative_to(self.folder)) for kind in INTERFACES for file in (self.folder / kind).glob(f"*.{kind}"))


def find_packages(folder):
    """Returns {name: package}; packages with interfaces come after those whose interfaces they use."""
    found = {package.name: package for package in map(Package, sorted(path.parent for path in folder.glob("*/package.xml")))}
    ordered: dict[str, Package] = {}

    def add(package):
        for name in sorted(package.depends & found.keys() - ordered.keys()):
            if package.has_interfaces and found[name].has_interfaces:
                add(found[name])
        ordered.setdefault(package.name, package)

    for package in found.values():
        add(package)
    return ordered


class Headers:
    """The headers of a distribution: those in its repositories and the generated ones."""

    def __init__(self, sources, output):
        self.ros = find_packages(sources)
        self.output = output
        self._ours = {name: package for name, package in find_packages(ROOT).items() if package.has_interfaces}
        self._in_c = self._used_by("rcl") | self._used_by("rcl_action")
        modules = [str(package.folder) for package in self.ros.values()]
        self._environment = {**os.environ, "PYTHONPATH": os.pathsep.join([*modules, os.environ.get("PYTHONPATH", "")])}

    def generate(self):
        for package in self.ros.values():
            self._write_version(package)
        self._write_logging_macros()
        for package in [*self.ros.values(), *self._ours.values()]:
            done = self.output / f"{package.name}.done"
            digest = self._digest(package)
            if package.has_interfaces and package.interfaces() and not (done.exists() and done.read_text() == digest):
                self._generate_interfaces(package)
                done.write_text(digest)

    def _digest(self, package):
        """Of the interfaces and the generators: files of a checkout are as old as their commits."""
        versions = [f"{name} {self.ros[name].version}" for name in sorted(self.ros) if name.startswith("rosidl_")]
        files = [(package.folder / name).read_bytes() for name in package.interfaces()]
        return hashlib.sha256(b"\0".join(["\n".join(versions).encode(), *files])).hexdigest()

    def _used_by(self, name):
        direct = self.ros[name].depends & self.ros.keys()
        return direct.union(*(self._used_by(other) for other in direct))

    def include_folders(self):
        own = [package.folder / "include" for package in self.ros.values() if (package.folder / "include").is_dir()]
        return [*own, self.output / "include"]

    def replaces(self, folder):
        """Returns whether an include folder of the build contains interface headers that are generated here."""
        return pathlib.Path(folder).name in (*self._ours, "rosidl_generator_cpp")

    def _run(self, *command):
        subprocess.run([sys.executable, *map(str, command)], env=self._environment, stdout=subprocess.DEVNULL, check=True)

    def _write(self, name, text):
        file = self.output / "include" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)

    def _write_version(self, package):
        """Writes version.h as ament_generate_version_header() does."""
        cmake = package.folder / "CMakeLists.txt"
        if cmake.exists() and "ament_generate_version_header" in cmake.read_text():
            parts = zip(("MAJOR", "MINOR", "PATCH"), package.version.split("."))
            self._write(f"{package.name}/version.h", "#pragma once\n" + "".join(
                f"#define {package.name.upper()}_VERSION_{part} ({number})\n" for part, number in parts))

    def _write_logging_macros(self):
        """Writes rcutils/logging_macros.h, which is a template up to Kilted and an ordinary header later."""
        folder = self.ros["rcutils"].folder
        template = folder / "resource" / "logging_macros.h.em"
        if template.exists():
            self._write("rcutils/logging_macros.h", "")
            self._run("-m", "em", "-o", self.output / "include" / "rcutils" / "logging_macros.h",
                      "-D", f"rcutils_module_path={str(folder)!r}", template)

    def _generate_interfaces(self, package):
        print(f"    generating the interfaces of {package.name}", flush=True)
        idl, types = self.output / "idl" / package.name, self.output / "types" / package.name
        names = [str(pathlib.Path(name).with_suffix(".idl")) for name in package.interfaces()]
        self._call("rosidl_adapter", package, idl, non_idl_tuples=[f"{package.folder}:{name}" for name in package.interfaces()])
        common = {"idl_tuples": [f"{idl}:{name}" for name in names], "ros_interface_dependencies": [], "target_dependencies": []}
        if "rosidl_generator_type_description" in self.ros:  # since Iron
            self._call("rosidl_generator_type_description", package, types, **common,
                       include_paths=[f"{name}:{self.output / 'types' / name}" for name in (*self.ros, *self._ours)])
        described = [f"{name}:{types / pathlib.Path(name).with_suffix('.json')}" for name in names]
        languages = [("rosidl_generator_c", "h"), ("rosidl_generator_cpp", "hpp")]
        for generator, suffix in languages if package.name in self._in_c else languages[1:]:
            folder = self.ros[generator].folder / "resource"
            self._call(generator, package, self.output / "include" / package.name, **common, template_dir=str(folder),
                       type_description_tuples=described)
            name = f"{generator}__visibility_control.{suffix}"
            text = (folder / f"{name}.in").read_text().replace("@PROJECT_NAME@", package.name)
            self._write(f"{package.name}/msg/{name}", text.replace("@PROJECT_NAME_UPPER@", package.name.upper()))

    def _call(self, generator, package, output, **arguments):
        """Runs a generator with an argument file like the one that CMake writes."""
        output.mkdir(parents=True, exist_ok=True)
        file = self.output / f"{generator}.json"
        file.write_text(json.dumps({"package_name": package.name, "output_dir": str(output), **arguments}))
        if generator == "rosidl_adapter":
            self._run("-m", generator, "--package-name", package.name, "--arguments-file", file, "--output-dir", output,
                      "--output-file", self.output / "idl.txt")
        else:
            self._run(self.ros[generator].folder / "bin" / generator, "--generator-arguments-file", file)


def rewrite(command, compiler, prefix, headers):
    """Returns the build's command with another compiler, and with `headers` instead of those of the ROS `prefix`."""
    words = iter(shlex.split(command)[1:])
    result = [compiler, "-fsyntax-only", "-Werror"]
    for word in words:
        if word in ("-o", "-include", "-MF", "-MT", "-Xclang"):  # outputs and precompiled headers
            next(words)
        elif word == "-isystem":
            folder = next(words)
            if not headers or not (folder.startswith(f"{prefix}/") or headers.replaces(folder)):
                result += [word, folder]
        elif word.startswith("-I") and headers and headers.replaces(word[2:]):
            continue
        elif word not in ("-c", "-MD", "-Winvalid-pch", "-fpch-preprocess"):
            result.append(word)
    for folder in headers.include_folders() if headers else ():
        result += ["-isystem", str(folder)]
    return result


def commands(build, pattern):
    """Returns (file, folder, command) for each of our files that the build compiles. Raises SystemExit if it lacks one, as a unity build
    does, whose compiler gets generated files."""
    found = {}
    for database in sorted(build.glob("*/compile_commands.json")):
        for entry in json.loads(database.read_text()):
            file = pathlib.Path(entry["directory"], entry["file"])
            if ROOT in file.parents and build not in file.parents and re.search(pattern, str(file.relative_to(ROOT))):
                found[file] = (file, entry["directory"], entry["command"])
    built = {package.parent.name for package in build.glob("*/compile_commands.json")}
    sources = [source for source in sorted(ROOT.glob("*/src/**/*.cpp")) if source.relative_to(ROOT).parts[0] in built]
    missing = [str(source) for source in sources if source not in found and re.search(pattern, str(source.relative_to(ROOT)))]
    if missing:
        raise SystemExit(f"{build} does not compile {len(missing)} sources, among them {missing[0]}: build with -DCMAKE_UNITY_BUILD=OFF")
    return list(found.values())


def check(compiler, options, headers):
    """Returns the number of files that do not compile."""

    def compile_file(job):
        file, folder, command = job
        result = subprocess.run(rewrite(command, compiler, options.prefix, headers), cwd=folder, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, text=True)
        if result.returncode:
            print(f"{compiler}: {file.relative_to(ROOT)}\n{result.stdout}", flush=True)
        return result.returncode != 0

    jobs = commands(options.build, options.files)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        failed = sum(pool.map(compile_file, jobs))
    against = f"rcl {headers.ros['rcl'].version}" if headers else "the ROS headers of the build"
    print(f"{compiler}, {against}: {len(jobs)} files, {failed} failed", flush=True)
    return failed if jobs else 1


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sources", nargs="?", type=pathlib.Path, help="folder with the ROS packages of a distribution")
    parser.add_argument("--compiler", action="append", help="compiler; may be repeated (default: g++)")
    parser.add_argument("--build", type=pathlib.Path, help="folder with a folder per package, each with compile_commands.json, of a build "
                        "without CMAKE_UNITY_BUILD (default: is written, as for ./ur lint --tidy)")
    parser.add_argument("--prefix", type=pathlib.Path, default=ROOT / ".ur" / "jazzy" / "venv",
                        help="prefix of the ROS headers of that build (default: %(default)s)")
    parser.add_argument("--files", default="", help="regular expression of the files to compile (default: all)")
    parser.add_argument("--output", type=pathlib.Path, help="folder for the generated headers, which are kept (default: SOURCES-generated)")
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)),
                        help="parallel jobs (default: all cores)")
    options = parser.parse_args()
    headers = None
    options.build = options.build or lint.databases(Layout())[0].parents[1]
    if options.sources:
        sources = options.sources.resolve()
        headers = Headers(sources, (options.output or sources.with_name(sources.name + "-generated")).resolve())
        headers.generate()
    return 1 if sum(check(compiler, options, headers) for compiler in options.compiler or ["g++"]) else 0


if __name__ == "__main__":
    sys.exit(main())
