"""The disturbances that the tests cause during the execution of a goal."""

from scenarios import Disturbance

from ur_ros_rtde_msgs.msg import ErrorCode


def _release_emergency_stop(cell):
    cell.simulator.control("emergency_stop", pressed=False)
    cell.power_up()


def _interrupt(cell):
    cell.driver.interrupt()


def _start_driver(cell):
    assert cell.driver.wait(10.0) == 0, cell.driver.output()
    cell.start_driver()


PROTECTIVE_STOP = Disturbance("protective stop", lambda cell: cell.simulator.control("protective_stop", reason="a test"),
                              (ErrorCode.PROTECTIVE_STOP,), lambda cell: cell.unlock_protective_stop(), repeat=True)
EMERGENCY_STOP = Disturbance("emergency stop", lambda cell: cell.simulator.control("emergency_stop"),
                             (ErrorCode.EMERGENCY_STOP,), _release_emergency_stop)
LINK_LOSS = Disturbance("link loss", lambda cell: cell.simulator.control("drop_links"),
                        (ErrorCode.LINK_LOST,), lambda cell: None)
CONTROLLER_DEATH = Disturbance("controller death", lambda cell: cell.simulator.kill(),
                               (ErrorCode.LINK_LOST,), lambda cell: cell.simulator.start())
SHUTDOWN = Disturbance("shutdown", _interrupt, (ErrorCode.SHUTDOWN,), _start_driver)
ALL = (PROTECTIVE_STOP, EMERGENCY_STOP, LINK_LOSS, CONTROLLER_DEATH, SHUTDOWN)
