"""Command line of ./ur."""

import argparse
import contextlib
import difflib
import errno
import importlib
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
from typing import Any, Callable, Dict, List, NoReturn, Optional, Tuple
from xml.etree import ElementTree

from . import build as building
from . import console, disk, docs, doctor, fuzz, lint, pin_hashes, sbom, simulation, testing, viewer
from .environment import program, run_environment, shell_environment, workspace_environment
from .layout import DEFAULT, DISTRIBUTIONS, PROGRAM, ROOT, SANITIZERS, STATE, Layout
from .lock import Lock
from .processes import ignore, interrupt_on_termination

Command = Callable[[argparse.Namespace], int]

DESCRIPTION = """\
Builds, tests and demonstrates the ROS 2 driver for Universal Robots arms and its simulated controller. ROS 2 need not
be installed: the first run creates a virtual environment with ROS 2 as wheels and builds everything; later runs build
only what changed. What is downloaded and built is in .ur/; `./ur clean --all` removes it.
"""


COMPLETION_VARIABLE = "_ARGCOMPLETE"  # set when a shell asks for completions

# Commands that the program `ur` of ur_ros_rtde_cli runs.
CLI = {"call": "send a goal: ur call move_j \"{joint_positions: [0, -1.57, 1.57, -1.57, -1.57, 0]}\"",
       "state": "show the state of the robot", "plugins": "list the installed plugins",
       "record": "record RTDE outputs of the robot to a CSV file",
       "plot": "draw a recording: ur plot run.csv",
       "compare": "compare two recordings: ur compare before.csv after.csv",
       "new": "create a package with a plugin: ur new command NAME",
       "completion": "print what lets a shell complete command lines: eval \"$(./ur completion bash)\"",
       "urdf": "print the URDF of an arm: ur urdf --model ur10e",
       "calibration": "save the calibration of an arm for its URDF: ur calibration --robot ADDRESS --output FILE"}
OF_ALL_PACKAGES = ("call", "plugins")  # show the actions and plugins of every package; the others need only that of the program
# To a program, with all options that are not ours.
FORWARDED = ("demo", "bench", "chaos", "plan", "compare-recording", "sim", "view", "doctor", *CLI)


def _add_build_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--ros", choices=DISTRIBUTIONS, default=Layout.of_environment().ros,
                        help="ROS 2 as wheels of this distribution, or the one that is installed and sourced (default: %(default)s)")
    parser.add_argument("-j", "--jobs", type=int, default=0, metavar="N",
                        help="jobs of the build and limit of parallel tests (default: depends on cores and memory)")
    variant = parser.add_mutually_exclusive_group()
    variant.add_argument("--debug", action="store_true", help="use a debug build, which is kept beside the release build")
    variant.add_argument("--sanitize", choices=SANITIZERS, help="use a build with a sanitizer, which is kept beside the release build")


def _layout(options: argparse.Namespace) -> Layout:
    current = Layout.of_environment()  # in `./ur shell`: the build of that shell
    inherited = current.variant if options.ros == current.ros else ""
    return Layout(options.ros, "debug" if options.debug else options.sanitize or inherited)


def _build(options: argparse.Namespace, tests: bool = False, packages: Optional[List[str]] = None) -> Layout:
    layout = _layout(options)
    building.build(building.Options(layout, packages, tests, options.jobs))
    return layout


def command_build(options: argparse.Namespace) -> int:
    _build(options, options.tests, options.package)
    console.line("Everything is built." + (" `./ur shell` opens a shell in which it is found." if PROGRAM == "./ur" else ""))
    return 0


def command_test(options: argparse.Namespace) -> int:
    if options.names and options.changed:
        raise console.Failure("./ur test takes names or --changed, not both")
    return testing.run(testing.Options(_layout(options), options.names, options.changed or bool(options.base), options.base,
                                       options.jobs, options.timeout, options.repeat, options.thorough))


def command_sim(options: argparse.Namespace) -> int:
    layout = _build(options, packages=["ur_simulator"])
    simulator = str(program(layout, "ur_simulator", "ur_simulator"))
    os.execve(simulator, [simulator, *simulation.with_status(_forwarded(options), sys.stdout.isatty())], run_environment(layout))


def command_shell(options: argparse.Namespace) -> int:
    layout = _build(options)
    env = shell_environment(layout)
    command = _forwarded(options)
    if command:
        if shutil.which(command[0], path=env.get("PATH")) is None:
            raise console.Failure(f"there is no program {command[0]} in the environment of the build")
        _execute(command, env)
    shell = env.get("SHELL", "/bin/sh")
    console.line(f"This shell has {layout.title} and this project's packages; `exit` leaves it. `ur` has the commands of "
             "./ur; `ur --help` lists them." + ("" if layout.is_installed else " The wheels do not contain the program `ros2`."))
    is_bash = os.path.basename(shell) == "bash"
    if is_bash:
        env["PS1"] = "(ur) \\w\\$ "
    _execute([shell, "--norc"] if is_bash else [shell], env)


def _execute(command: List[str], env: Dict[str, str]) -> NoReturn:
    """Replaces this process with a program of the user, which then handles signals itself."""
    for number in (signal.SIGPIPE, signal.SIGXFSZ):  # Python ignores them, and the program would inherit that
        signal.signal(number, signal.SIG_DFL)
    if signal.getsignal(signal.SIGHUP) == ignore:
        signal.signal(signal.SIGHUP, signal.SIG_IGN)
    os.execvpe(command[0], command, env)


def command_module(options: argparse.Namespace) -> int:
    """Runs a module of its own: demo, bench, plan, chaos or compare_recording. `--help` and wrong arguments are handled without a build."""
    arguments = _forwarded(options)
    layout = _layout(options)
    name = options.command.replace("-", "_")
    module = importlib.import_module(f"ur_tools.{name}")
    parsed = module.parse(arguments)
    if hasattr(module, "check"):
        module.check(parsed)
    _build(options, packages=module.packages(parsed) if hasattr(module, "packages") else None)
    if getattr(parsed, "view", False):
        viewer.prepare(layout, options.jobs)
    modules = [str(ROOT / "tools"), *([os.environ["PYTHONPATH"]] if layout.is_installed and "PYTHONPATH" in os.environ else [])]
    env = {**os.environ, "UR_LAYOUT": f"{layout.ros}:{layout.variant}", "PYTHONPATH": os.pathsep.join(modules),
           "PYTHONDONTWRITEBYTECODE": "1"}
    os.execve(sys.executable, [sys.executable, "-m", f"ur_tools.{name}", *arguments], env)


def _run_from_sources(package: str, program_name: str, arguments: List[str], python: str = sys.executable) -> None:
    folders = (ROOT / name for name in (package, "ur_ros_rtde_cli", "ur_ros_rtde_description"))
    env = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, folders)), "PYTHONDONTWRITEBYTECODE": "1"}
    os.execve(python, [python, str(ROOT / package / "scripts" / program_name), *arguments], env)


def command_cli(options: argparse.Namespace) -> int:
    """Runs `ur call …` of ur_ros_rtde_cli for `./ur call …`. Builds only if it is missing: the driver may be running."""
    arguments = [options.command, *_forwarded(options)]
    if options.command == "new" or any(argument in ("-h", "--help") for argument in arguments):
        _run_from_sources("ur_ros_rtde_cli", "ur", arguments)
    layout = _layout(options)
    try:
        command = program(layout, "ur_ros_rtde_cli", "ur")
    except FileNotFoundError:
        packages = None if options.command in OF_ALL_PACKAGES else ["ur_ros_rtde_cli"]
        command = program(_build(options, packages=packages), "ur_ros_rtde_cli", "ur")
    os.execve(command, [str(command), *arguments], workspace_environment(layout))


def _complete() -> None:
    """Lets the program `ur` of the build answer a shell that completes a command line. Without a build, there are no completions."""
    layout = Layout.of_environment()
    with contextlib.suppress(FileNotFoundError):
        command = program(layout, "ur_ros_rtde_cli", "ur")
        os.execve(command, [str(command)], workspace_environment(layout))
    sys.exit(1)


def command_view(options: argparse.Namespace) -> int:
    """Runs the viewer. Builds only if it is missing: the driver may be running."""
    arguments, layout = _forwarded(options), _layout(options)
    if any(argument in ("-h", "--help") for argument in arguments):
        _run_from_sources("ur_ros_rtde_viewer", "view", arguments)
    viewer.execute(layout, arguments, options.jobs)
    return 0  # not reached


def command_format(options: argparse.Namespace) -> int:
    return lint.format_sources(_prepared(options))


def command_lint(options: argparse.Namespace) -> int:
    return lint.run(_prepared(options), options.tidy)


def command_fuzz(options: argparse.Namespace) -> int:
    seconds = options.seconds if options.seconds is not None else 0 if options.executions > 0 else 60
    return fuzz.run(_prepared(options), options.names, seconds, options.executions, options.fast, max(options.jobs, 1))


def _prepared(options: argparse.Namespace) -> Layout:
    layout = Layout(options.ros)
    building.setup(layout)
    return layout


def command_docs(options: argparse.Namespace) -> int:
    return docs.run(options)


def command_lock(options: argparse.Namespace) -> int:
    return pin_hashes.run(options)


def command_sbom(options: argparse.Namespace) -> int:
    return sbom.run(options)


def command_doctor(options: argparse.Namespace) -> int:
    """Checks this machine, or a robot with `--robot`, which needs no build. `--report` needs one: it asks the nodes."""
    layout = _layout(options)
    arguments = _forwarded(options)
    if any(argument.startswith("--report") for argument in arguments):
        return command_cli(options)
    if arguments:
        installed = layout.python  # has the modules that read calibrations
        _run_from_sources("ur_ros_rtde_cli", "ur", ["doctor", *arguments], str(installed) if installed.exists() else sys.executable)
    return doctor.run(layout)


def command_clean(options: argparse.Namespace) -> int:
    if options.all:
        folders = [STATE]
    else:
        folders = [path for base in STATE.glob("*") for path in base.glob("*")
                   if path.name.split("-")[0] in ("build", "install", "log", "test")]
    if not STATE.exists():
        return 0
    with Lock("build"):
        for folder in folders:
            if folder.exists():
                console.line(f"removing {folder.relative_to(ROOT)}")
                shutil.rmtree(folder)
    return 0


def _forwarded(options: argparse.Namespace) -> List[str]:
    arguments = list(options.arguments)
    return arguments[1:] if arguments[:1] == ["--"] else arguments


def _version() -> str:
    return ElementTree.parse(ROOT / "ur_ros_rtde" / "package.xml").findtext("version") or ""


def _parser() -> Tuple[argparse.ArgumentParser, List[str]]:
    """Returns the parser and the names of the commands."""
    parser = argparse.ArgumentParser(prog=PROGRAM, description=DESCRIPTION,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--version", action="version", version=f"ur_ros_rtde {_version()}", help="show the version of the driver")
    commands = parser.add_subparsers(dest="command", metavar="command")

    def add(name: str, function: Command, text: str, **more: Any) -> argparse.ArgumentParser:
        sub = commands.add_parser(name, help=text, description=text[0].upper() + text[1:] + ".", **more)
        sub.set_defaults(function=function)
        return sub

    def add_forwarding(name: str, function: Command, text: str) -> None:
        # The program's options follow ours.
        sub = add(name, function, text, add_help=name in ("sim", "shell"))
        _add_build_options(sub)
        sub.add_argument("arguments", nargs=argparse.REMAINDER, help="passed on unchanged")

    add_forwarding("demo", command_module, "simulate a robot, run the nodes, stop a motion on force and draw a figure")

    test = add("test", command_test, "build and run tests; the last line is `N passed, N failed`")
    _add_build_options(test)
    test.add_argument("names", nargs="*", metavar="NAME",
                      help="run only tests whose package, file or GoogleTest case has NAME in its name "
                           "(default: all tests)")
    test.add_argument("--changed", action="store_true",
                      help="run only the tests that the changed files can affect, and the checks of the sources")
    test.add_argument("--base", default="", metavar="COMMIT",
                      help="compare with this commit or branch; implies --changed (default: origin/main if it exists, else HEAD)")
    test.add_argument("--timeout", type=float, default=0.0, metavar="S",
                      help="time limit of one test in seconds (default: the limit that its package sets, else 120)")
    test.add_argument("--repeat", type=int, default=1, metavar="N", help="run each test N times (default: 1)")
    test.add_argument("--thorough", action="store_true",
                      help="in the first hour, fuzz replays of 30 s of processor time instead of 5 s, as in continuous integration")

    build = add("build", command_build, "set up the environment and build what changed")
    _add_build_options(build)
    build.add_argument("--package", action="append", metavar="NAME", help="build only this package and its dependencies")
    build.add_argument("--tests", action="store_true", help="also build the tests")

    add_forwarding("sim", command_sim, "run the simulated controller; options go to ur_simulator (`sim -- --help`)")
    add_forwarding("bench", command_module, "measure latency and load")
    add_forwarding("plan", command_module, "plan a trajectory without a robot and draw it against its limits")
    add_forwarding("view", command_view, "show robots in the browser: 3D scene, plots, state, recordings")
    add_forwarding("chaos", command_module,
                   "send random goals during random faults; with --faults 0 a soak test, with --stops the stop property test")
    add_forwarding("compare-recording", command_module, "compare a recording of a robot with the simulator")
    add_forwarding("shell", command_shell, "open a shell, or run one command, with the environment of the build")

    for name, text in CLI.items():
        add_forwarding(name, command_cli, text)

    sub = add("docs", command_docs, "build the site of the documentation; dead links are errors")
    sub.add_argument("--serve", action="store_true", help="show the site on this machine until Ctrl-C")
    sub.add_argument("--port", type=int, default=8000, metavar="PORT", help="of --serve (default: 8000; 0: any)")

    sub = add("lock", command_lock, "write the hashes of the pinned Python packages to wheels/*.txt, after a change of a version")
    sub.add_argument("files", nargs="*", metavar="FILE", help=f"without .txt (default: all: {', '.join(pin_hashes.FILES)})")

    sub = add("sbom", command_sbom, "write a bill of materials: all software of others, with versions, hashes and licences")
    sub.add_argument("--output", type=pathlib.Path, metavar="FILE", help="CycloneDX, JSON (default: the standard output)")

    for name, function, text in (("format", command_format, "format all C++ files"),
                                 ("lint", command_lint, "check formatting, Python and paths; with --tidy also run clang-tidy")):
        sub = add(name, function, text)
        sub.add_argument("--ros", choices=DISTRIBUTIONS, default=DEFAULT, help=argparse.SUPPRESS)
        if name == "lint":
            sub.add_argument("--tidy", action="store_true", help="also run clang-tidy (minutes)")

    sub = add("fuzz", command_fuzz, "feed random input to the parsers of the simulator and the driver; needs clang")
    sub.add_argument("names", nargs="*", metavar="TARGET", help=f"fuzz targets (default: all: {', '.join(fuzz.targets())})")
    sub.add_argument("--seconds", type=int, metavar="S", help="duration for each target (default: 60, or unlimited with --executions)")
    sub.add_argument("--executions", type=int, default=-1, metavar="N", help="end a target after N inputs, also before its time")
    sub.add_argument("--fast", action="store_true", help="without AddressSanitizer, with which the saved inputs run at the end")
    sub.add_argument("-j", "--jobs", type=int, default=2, metavar="N",
                     help="targets that run at the same time, and jobs of the build (default: %(default)s)")
    sub.add_argument("--ros", choices=DISTRIBUTIONS, default=DEFAULT, help=argparse.SUPPRESS)

    add_forwarding("doctor", command_doctor, "check this machine, or with --robot ADDRESS a robot, and give advice; status 1 if it "
                   "cannot work; --report FILE: write what a bug report needs")

    clean = add("clean", command_clean, "remove the build")
    clean.add_argument("--all", action="store_true", help="also remove the virtual environments and downloads")
    return parser, list(commands.choices)


def _parse(arguments: List[str]) -> argparse.Namespace:
    """Parses the arguments. The options of forwarded commands may have any order."""
    parser, names = _parser()
    if arguments and not arguments[0].startswith("-") and arguments[0] not in names:
        _fail_on_unknown_command(parser, arguments[0], names)
    if not arguments or arguments[0] not in FORWARDED:
        return parser.parse_args(arguments)
    options, unknown = parser.parse_known_args(arguments[:1] + _own_options_first(arguments[1:]))
    options.arguments = unknown + list(options.arguments)
    return options


def _fail_on_unknown_command(parser: argparse.ArgumentParser, command: str, names: List[str]) -> None:
    close = difflib.get_close_matches(command, names, 1)
    parser.error(f"there is no command {command}; " + (f"did you mean {close[0]}?" if close else f"there are: {', '.join(names)}"))


def _own_options_first(arguments: List[str]) -> List[str]:
    """Moves our options to the front, so that `./ur demo --model ur5e --debug` works in any order."""
    own: List[str] = []
    rest: List[str] = []
    index = 0
    while index < len(arguments):
        argument = arguments[index]
        if argument == "--":
            rest += arguments[index + 1:]
            break
        if argument in ("--ros", "--sanitize", "-j", "--jobs") and index + 1 < len(arguments):
            own += arguments[index:index + 2]
            index += 2
            continue
        is_own = argument == "--debug" or re.match(r"--(ros|sanitize|jobs)=|-j\d+$", argument)
        (own if is_own else rest).append(argument)
        index += 1
    return own + (["--", *rest] if rest else [])


def _message_of(error: OSError) -> str:
    if error.errno == errno.ENOSPC:
        return disk.full_message(STATE)
    if error.errno in (errno.EACCES, errno.EPERM, errno.EROFS):
        return f"{error.filename}: {error.strerror}. ./ur writes its files to {STATE}."
    return str(error)


def main(arguments: Optional[List[str]] = None) -> int:
    interrupt_on_termination()
    arguments = sys.argv[1:] if arguments is None else arguments
    if COMPLETION_VARIABLE in os.environ:
        _complete()
    options = _parse(arguments)
    if options.command is None:
        _parser()[0].print_help()
        return 2
    try:
        return options.function(options)
    except console.Failure as failure:
        print(f"\n{failure}", file=sys.stderr)
        return 1
    except subprocess.CalledProcessError as error:
        print(f"\n{' '.join(map(str, error.cmd))} failed with status {error.returncode}", file=sys.stderr)
        return 1
    except BrokenPipeError:  # `./ur doctor | head`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 141
    except OSError as error:
        print(f"\n{_message_of(error)}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("\ninterrupted", file=sys.stderr)
        return 130
