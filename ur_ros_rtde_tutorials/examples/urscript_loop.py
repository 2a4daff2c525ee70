#!/usr/bin/env python3
"""Moves down until a force of 20 N, without a plugin: one URScript program with the loop, which runs on the controller. It returns its
values in output registers.

ros2 run ur_ros_rtde_tutorials urscript_loop.py
"""

from ur_ros_rtde import Robot

PROGRAM = """def move_down_until_force():
  zero_ftsensor()
  sleep(0.02)
  start = get_actual_tcp_pose()
  distance = 0.0
  force = 0.0
  while distance < 0.3 and norm(force) <= 20.0:
    speedl([0, 0, -0.1, 0, 0, 0], 0.1, get_steptime())
    force = get_tcp_force()[2]
    distance = start[2] - get_actual_tcp_pose()[2]
  end
  write_output_float_register(13, force)
  write_output_float_register(14, distance)
  stopj(5.0)
end
"""


def main():
    with Robot() as arm:
        arm.send_script(PROGRAM, timeout=60.0)
        force, distance = (arm.get_output_double_register(index).value for index in (13, 14))
        if abs(force) <= 20.0:
            raise SystemExit("no force of 20 N within 0.3 m")
        print(f"stopped at {force:.1f} N, {distance:.3f} m further down")


if __name__ == "__main__":
    main()
