"""Modes as context managers: they always end."""

import numpy as np
import pytest
from support import HOME, wait_for
from ur_ros_rtde import CommandFailed, Rejected

PLUGINS = ("plugins:=[move_j,move_l,stop,freedrive,teach_mode,force_mode,force_mode_start,force_mode_stop,jog,make_ready,zero_ft_sensor,"
           "trigger_protective_stop]")
AWAY = [0.5, *HOME[1:]]
COMPLIANT = {"compliant": [False, False, True, False, False, False]}


def is_in_freedrive(arm):
    """Returns whether motions are rejected because the arm may be moved by hand."""
    try:
        arm.move_j(HOME, speed=3.0)
    except Rejected as rejected:
        assert rejected.name == "BUSY"
        return True
    return False


@pytest.mark.parametrize("mode", ["freedrive", "teach_mode"])
def test_hand_guiding_lasts_for_the_block(arm, mode):
    with getattr(arm.modes, mode)():
        assert is_in_freedrive(arm)
    assert not is_in_freedrive(arm)


@pytest.mark.parametrize("error", [KeyError, KeyboardInterrupt])
def test_hand_guiding_ends_with_an_exception(arm, error):
    with pytest.raises(error), arm.modes.freedrive(free_axes=[True, True, False, False, False, False]):
        assert is_in_freedrive(arm)
        raise error
    assert not is_in_freedrive(arm)


def is_compliant(simulator):
    return simulator.state()["force_mode"]


def test_the_arm_moves_in_force_mode(arm, simulator):
    arm.zero_ft_sensor()
    simulator.control("place_surface", z=arm.state.tcp_pose[2] - 0.005, stiffness=20000.0)
    try:
        with arm.modes.force_mode(**COMPLIANT, wrench=[0.0, 0.0, -15.0, 0.0, 0.0, 0.0], limits=[0.1, 0.1, 0.03, 0.5, 0.5, 0.5]):
            assert arm.state.wait_until(lambda state: abs(state.wrench[2]) > 13.0, 10.0)
            target = arm.state.tcp_pose + [0.0, 0.05, 0.0, 0.0, 0.0, 0.0, 0.0]
            arm.move_l(target, speed=0.05)
            assert arm.state.tcp_pose[1] == pytest.approx(target[1], abs=0.002) and abs(arm.state.wrench[2]) > 10.0
        assert not is_compliant(simulator) and simulator.is_at_rest()
    finally:
        simulator.control("clear_surfaces")


@pytest.mark.parametrize("error", [KeyError, KeyboardInterrupt])
def test_force_mode_ends_with_an_exception(arm, simulator, error):
    with pytest.raises(error), arm.modes.force_mode(**COMPLIANT):
        wait_for(lambda: is_compliant(simulator), 10.0, "force mode")
        raise error
    assert not is_compliant(simulator)


def test_force_mode_ends_while_a_motion_is_running(arm, simulator):
    with arm.modes.force_mode(**COMPLIANT):
        goal = arm.start.move_j(AWAY, 0.1)
    assert goal.wait(10.0) and simulator.is_at_rest() and not is_compliant(simulator)


def test_a_mode_that_cannot_begin_raises_the_reason(arm):
    with pytest.raises(Rejected, match="compliant"), arm.modes.force_mode(compliant=[False] * 6):
        pytest.fail("the block was executed")


def test_any_goal_can_be_a_mode(arm, simulator):
    with arm.start.jog([0.0, 0.0, 0.02, 0.0, 0.0, 0.0]):
        assert arm.state.wait_until(lambda state: np.abs(state.joint_velocities).max() > 0.01, 10.0)
    assert simulator.is_at_rest()


def test_a_mode_that_has_failed_raises_the_failure_at_its_end(arm):
    with pytest.raises(CommandFailed, match="protective stop"), arm.modes.freedrive() as goal:
        arm.trigger_protective_stop()
        assert goal.wait(10.0)
    arm.make_ready()
