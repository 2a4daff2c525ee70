"""The stop property test: goals of every kind, interrupted by events of every kind, while threads of the driver are held.

cases.py       draws a case from its seed: goal, event, moment, holds
goal_kinds.py  what moves the arm
events.py      what ends it
holds.py       delays threads of the driver, with ptrace
motion.py      what the arm did, from the trace of the simulator
stalls.py      for how long the host did not let programs run
robot.py       a robot with its driver and clients
lane.py        executes cases
report.py      what a case has shown
properties.py  what has to hold
campaign.py    distributes cases to lanes, and sums their results up
"""

import pathlib
import sys

SYSTEM = pathlib.Path(__file__).resolve().parents[1]
for _folder in (SYSTEM.parent / "every_command", SYSTEM):
    if str(_folder) not in sys.path:
        sys.path.insert(0, str(_folder))
