"""./ur chaos: sends random goals from several clients while random faults happen to a simulated robot, its connections and its operators.

These invariants are checked: every accepted goal has exactly one result; the arm moves only while a goal is executed; the driver
does not exit; its descriptors, threads and memory do not grow after the first quarter of the run; after each fault it accepts
motions again. The same seed gives the same goals and faults in the same order. --faults 0 is a soak test: goals only.

--stops N runs N cases of the stop property test instead: a goal of any kind, an event that ends it (cancel, stop, safety stops, lost
programs, connections and clients, the end of the driver), and in 40 % of the cases threads of the driver that are held for up to 0.4 s.
Checked: the deceleration begins in time and is the one that was asked for; the arm comes to rest and does not move again; the goal has one
result within 1 s; the next goal works. Case number n has the seed S + n; --case SEED repeats it. Kinds of goals whose plugins are built
with the tests need `./ur build --tests` first.
"""

import argparse
import ipaddress
import pathlib
import random
import sys
from typing import List

from . import console, isolation, ports, simulation
from .environment import run_environment
from .layout import PROGRAM, ROOT, SANITIZERS, Layout
from .processes import Programs

SOAK_MINUTES = 30.0
LATE_THREADS = 8  # cases of the stop property test with the seeds -1, -2, ...: see stops/cases.py
FAULT_SECONDS = 60.0  # upper bound of one fault with its recovery and the results of its goals


def parse(arguments: List[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog=f"{PROGRAM} chaos", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--faults", type=int, default=100, metavar="N", help="number of faults; 0: a soak test (default: 100)")
    parser.add_argument("--seed", type=int, metavar="S", help="seed of the goals and faults (default: a random one)")
    parser.add_argument("--minutes", type=float, default=0.0, metavar="M",
                        help=f"time limit of the run (default: none; {SOAK_MINUTES:g} for a soak test)")
    parser.add_argument("--clients", type=int, default=3, metavar="N", help="number of nodes that send goals, 1 to 20 (default: 3)")
    parser.add_argument("--address", default="127.0.0.1", help="loopback address of the simulator (default: 127.0.0.1)")
    parser.add_argument("--stops", type=int, default=0, metavar="N", help="run N cases of the stop property test")
    parser.add_argument("--lanes", type=int, default=3, metavar="K",
                        help="with --stops: pairs of simulator and driver that run cases at the same time, 1 to 16, on the addresses "
                             "127.0.0.1, 127.1.0.1, 127.2.0.1, ... if --address is 127.0.0.1 (default: 3; two idle cores serve 7)")
    parser.add_argument("--case", type=int, nargs="+", default=[], metavar="SEED", help="run these cases of the stop property test")
    parser.add_argument("--log", type=pathlib.Path, metavar="FOLDER",
                        help="folder for the logs (default: a folder in .ur, named after the seed)")
    options = parser.parse_args(arguments)
    if options.faults < 0 or options.minutes < 0.0 or not 1 <= options.clients <= 20:
        parser.error("--faults and --minutes cannot be negative, --clients is 1 to 20")
    if options.stops < 0 or not 1 <= options.lanes <= 16 or any(seed < -LATE_THREADS for seed in options.case):
        parser.error(f"--stops cannot be negative, --case not below -{LATE_THREADS}, --lanes is 1 to 16")
    if options.seed is None:
        options.seed = random.SystemRandom().randrange(10**6)
    if options.faults == 0 and options.minutes == 0.0 and not _is_stop_test(options):
        options.minutes = SOAK_MINUTES
    return options


def _is_stop_test(options: argparse.Namespace) -> bool:
    return options.stops > 0 or bool(options.case)


def _addresses(options: argparse.Namespace) -> List[str]:
    """Returns one address for each lane, or the only one. An invalid address is returned as it is."""
    lanes = min(options.lanes, len(options.case) or options.lanes) if _is_stop_test(options) else 1
    try:
        return [options.address, *(str(ipaddress.IPv4Address(options.address) + (lane << 16)) for lane in range(1, lanes))]
    except ValueError:
        return [options.address]


def check(options: argparse.Namespace) -> None:
    """Raises Failure if an address is invalid or in use."""
    for address in _addresses(options):
        ports.check(address)


def run(options: argparse.Namespace, layout: Layout) -> int:
    return _run_stops(options, layout) if _is_stop_test(options) else _run_faults(options, layout)


def _run_stops(options: argparse.Namespace, layout: Layout) -> int:
    seeds = options.case or range(options.seed, options.seed + options.stops)
    addresses = _addresses(options)
    console.step(f"{len(seeds)} cases, seeds {seeds[0]} to {seeds[-1]}, {len(addresses)} lanes")
    log = options.log or layout.log / "chaos" / f"stops_{seeds[0]}"
    command = [str(layout.python), str(ROOT / "chaos" / "stop_cases.py"), "--log", str(log), "--minutes", str(options.minutes),
               "--addresses", *addresses]
    command += ["--seeds", *map(str, options.case)] if options.case else ["--first", str(options.seed), "--count", str(options.stops)]
    env = {**run_environment(layout), "PYTHONDONTWRITEBYTECODE": "1"}
    with Programs(log) as programs:
        return programs.run(command, env, 300.0 + 60.0 * len(seeds))


def _run_faults(options: argparse.Namespace, layout: Layout) -> int:
    what = f"{options.faults} faults" if options.faults else f"{options.minutes:g} minutes without faults"
    console.step(f"Seed {options.seed}: {what}, {options.clients} clients")
    log = options.log or layout.log / "chaos" / str(options.seed)
    command = [str(layout.python), str(ROOT / "chaos" / "main.py"), "--log", str(log)]
    for name in ("address", "faults", "minutes", "seed", "clients"):
        command += [f"--{name}", str(getattr(options, name))]
    if layout.variant in SANITIZERS:
        command.append("--sanitizer")
    limit = 120.0 + max(FAULT_SECONDS * options.faults, 120.0 * options.minutes)
    with isolation.Domain() as domain, Programs(log) as programs:  # several runs, and a driver of the user, may run beside it
        env = {**run_environment(layout), "PYTHONDONTWRITEBYTECODE": "1"}
        domain.isolate(env)
        code = programs.run(command, env, limit)
    if code != 0:
        console.line(f"To repeat these goals and faults: ./ur chaos --faults {options.faults} --seed {options.seed} "
                     f"--minutes {options.minutes:g} --clients {options.clients}")
    return code


if __name__ == "__main__":
    sys.exit(simulation.main(parse, run, check))
