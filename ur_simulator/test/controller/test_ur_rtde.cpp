// The ur_rtde library as a client of the simulator.
#include <ur_rtde/dashboard_client.h>
#include <ur_rtde/rtde_control_interface.h>
#include <ur_rtde/rtde_io_interface.h>
#include <ur_rtde/rtde_receive_interface.h>

#include <cmath>
#include <numbers>

#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

using Joints = std::vector<double>;

double max_difference(const Joints & a, const Joints & b)
{
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, std::abs(a[i] - b.at(i)));
  }
  return largest;
}

Joints actual_joint_positions(SimulatedController & controller)
{
  return controller.state()["actual"]["position"].get<Joints>();
}

bool wait_for_tcp_speed(SimulatedController & controller, std::size_t axis, double speed, double tolerance)
{
  return controller.wait_until(
      [=](const json & state) {
        return std::abs(state["actual_tcp_speed"][axis].get<double>() - speed) < tolerance;
      },
      seconds(10));
}

TEST(UrRtdeReceiveTest, ReadsState)
{
  SimulatedController controller(with_unique_address());
  ur_rtde::RTDEReceiveInterface receive(controller.address());
  ASSERT_TRUE(receive.isConnected());
  EXPECT_EQ(receive.getRobotMode(), 7);
  EXPECT_EQ(receive.getSafetyMode(), 1);
  EXPECT_LT(max_difference(receive.getActualQ(), actual_joint_positions(controller)), reading_noise);
  EXPECT_EQ(receive.getActualTCPPose().size(), 6u);
  EXPECT_GT(receive.getTimestamp(), 0.0);
  EXPECT_EQ(receive.getFtRawWrench().size(), 6u);
}

TEST(UrRtdeReceiveTest, ConnectsToCb3Controller)
{
  SimulatorOptions options;
  options.model = "ur5";
  SimulatedController controller(with_unique_address(options));
  ur_rtde::RTDEReceiveInterface receive(controller.address());
  EXPECT_EQ(receive.getRobotMode(), 7);
}

TEST(UrRtdeIoTest, SetsOutputsSpeedSliderAndRegisters)
{
  SimulatedController controller(with_unique_address());
  ur_rtde::RTDEIOInterface io(controller.address());
  EXPECT_TRUE(io.setStandardDigitalOut(3, true));
  EXPECT_TRUE(io.setConfigurableDigitalOut(1, true));
  EXPECT_TRUE(io.setToolDigitalOut(0, true));
  EXPECT_TRUE(io.setSpeedSlider(0.5));
  EXPECT_TRUE(io.setAnalogOutputVoltage(0, 0.25));
  EXPECT_TRUE(io.setInputIntRegister(18, 42));
  EXPECT_TRUE(controller.wait_until(
      [](const json & state) {
        return state["io"]["digital_outputs"] == (1u << 3 | 1u << 9 | 1u << 16) &&
               state["speed_slider"] == 0.5 && state["io"]["analog_outputs"][0] == 2.5;
      },
      seconds(5)))
      << controller.state().dump(2);
  EXPECT_EQ(controller.control({{"command", "registers"}})["inputs"]["integers"][18], 42);
}

TEST(UrRtdeDashboardTest, PowersRobotOn)
{
  SimulatorOptions options;
  options.start_running = false;
  SimulatedController controller(with_unique_address(options));
  ur_rtde::DashboardClient dashboard(controller.address());
  dashboard.connect();
  EXPECT_EQ(dashboard.polyscopeVersion(), "5.25.1.0");
  EXPECT_EQ(dashboard.robotmode(), "Robotmode: POWER_OFF");
  dashboard.powerOn();
  dashboard.brakeRelease();
  EXPECT_TRUE(wait_for_robot_mode(controller, "RUNNING", seconds(20)));
  EXPECT_TRUE(dashboard.isInRemoteControl());
  EXPECT_FALSE(dashboard.running());
  EXPECT_NO_THROW(dashboard.stop());
  EXPECT_THROW(dashboard.play(), std::runtime_error);
}

/// A control interface whose control script is running.
class UrRtdeControlTest : public SimulatorTest {
 protected:
  ur_rtde::RTDEControlInterface control{controller.address(), -1.0,
                                        ur_rtde::RTDEControlInterface::FLAGS_DEFAULT, 50002, -1};
  Joints start = actual_joint_positions(controller);

  Joints start_plus(double offset) const
  {
    Joints joints = start;
    for (double & joint : joints) {
      joint += offset;
    }
    return joints;
  }
};

TEST_F(UrRtdeControlTest, UploadsAndRunsControlScript)
{
  EXPECT_TRUE(control.isConnected());
  EXPECT_TRUE(control.isProgramRunning());
  EXPECT_EQ(controller.state()["program"]["state"], "PLAYING");
}

TEST_F(UrRtdeControlTest, MovesToJointPositions)
{
  const Joints target = start_plus(0.2);
  EXPECT_TRUE(control.moveJ(target, 1.0, 2.0));
  EXPECT_LT(max_difference(actual_joint_positions(controller), target), 1e-3);
  EXPECT_TRUE(control.moveJ(start, 1.0, 2.0));
  EXPECT_LT(max_difference(actual_joint_positions(controller), start), 1e-3);
}

TEST_F(UrRtdeControlTest, MovesLinearlyAndStopsOnRequest)
{
  Joints pose = controller.state()["actual_tcp_pose"].get<Joints>();
  const double height = pose[2];
  pose[2] -= 0.3;
  ASSERT_TRUE(control.moveL(pose, 0.2, 0.5, true));
  ASSERT_TRUE(wait_for_tcp_speed(controller, 2, -0.2, 0.01));
  control.stopL(2.0);
  ASSERT_TRUE(wait_until_at_rest(controller, seconds(10)));
  const double reached = controller.state()["actual_tcp_pose"][2];
  EXPECT_LT(reached, height - 0.01);
  EXPECT_GT(reached, height - 0.25);
}

TEST_F(UrRtdeControlTest, ReportsProgressOfAsynchronousMotions)
{
  ASSERT_TRUE(control.moveJ(start_plus(0.3), 1.0, 2.0, true));
  ASSERT_TRUE(wait_until_moving(controller, seconds(5)));
  EXPECT_GE(control.getAsyncOperationProgress(), 0);
  ASSERT_TRUE(wait_until_at_rest(controller, seconds(10)));
  EXPECT_LT(max_difference(actual_joint_positions(controller), start_plus(0.3)), 1e-3);
}

TEST_F(UrRtdeControlTest, ServoJFollowsTargets)
{
  Joints target = start;
  for (int i = 0; i < 250; ++i) {
    const auto begin = control.initPeriod();
    target[5] = start[5] + 0.1 * std::sin(0.002 * i * std::numbers::pi);
    ASSERT_TRUE(control.servoJ(target, 0.5, 0.5, 0.002, 0.1, 300));
    control.waitPeriod(begin);
  }
  control.servoStop();
  ASSERT_TRUE(wait_until_at_rest(controller, seconds(10)));
  EXPECT_NEAR(actual_joint_positions(controller)[5], target[5], 0.01);
}

TEST_F(UrRtdeControlTest, SpeedLMovesUntilSpeedStop)
{
  ASSERT_TRUE(control.speedL({0.0, 0.0, -0.1, 0.0, 0.0, 0.0}, 0.5));
  EXPECT_TRUE(wait_for_tcp_speed(controller, 2, -0.1, 0.005));
  EXPECT_TRUE(control.speedStop());
  EXPECT_TRUE(wait_until_at_rest(controller, seconds(10)));
}

TEST_F(UrRtdeControlTest, ForwardAndInverseKinematicsAgree)
{
  const Joints pose = control.getForwardKinematics(start, {0.0, 0.0, 0.0, 0.0, 0.0, 0.0});
  EXPECT_LT(max_difference(pose, controller.state()["actual_tcp_pose"].get<Joints>()), 1e-6);
  EXPECT_LT(max_difference(control.getInverseKinematics(pose), start), 1e-6);
}

TEST_F(UrRtdeControlTest, ZeroesForceSensorAndSetsPayloadAndTcp)
{
  EXPECT_TRUE(control.zeroFtSensor());
  EXPECT_TRUE(control.setPayload(1.5, {0.0, 0.0, 0.05}));
  EXPECT_TRUE(control.setTcp({0.0, 0.0, 0.1, 0.0, 0.0, 0.0}));
  EXPECT_TRUE(controller.wait_until(
      [](const json & state) {
        return state["payload"]["mass"] == 1.5 && std::abs(state["tcp_offset"][2].get<double>() - 0.1) < 1e-7;
      },
      seconds(5)));
}

TEST_F(UrRtdeControlTest, ProtectiveStopEndsMotion)
{
  ASSERT_TRUE(control.moveJ(start_plus(0.5), 0.5, 1.0, true));
  ASSERT_TRUE(wait_until_moving(controller, seconds(5)));
  controller.control({{"command", "protective_stop"}});
  ASSERT_TRUE(wait_until_at_rest(controller, seconds(10)));
  EXPECT_EQ(controller.state()["safety_mode"], "PROTECTIVE_STOP");
  EXPECT_GT(max_difference(actual_joint_positions(controller), start_plus(0.5)), 0.05);
}

TEST_F(UrRtdeControlTest, MeasuresContactForceAndStopsOnSurface)
{
  const double height = controller.state()["actual_tcp_pose"][2];
  controller.control({{"command", "place_surface"}, {"z", height - 0.1}});
  ur_rtde::RTDEReceiveInterface receive(controller.address());
  ASSERT_TRUE(control.zeroFtSensor());
  Joints pose = receive.getActualTCPPose();
  pose[2] -= 0.2;
  ASSERT_TRUE(control.moveL(pose, 0.05, 0.5, true));
  ASSERT_TRUE(controller.wait_until(
      [](const json & state) { return state["actual_tcp_force"][2].get<double>() > 20.0; }, seconds(10)));
  control.stopL(10.0);
  ASSERT_TRUE(wait_until_at_rest(controller, seconds(10)));
  EXPECT_NEAR(controller.state()["actual_tcp_pose"][2].get<double>(), height - 0.1, 0.01);
  EXPECT_GT(receive.getActualTCPForce()[2], 10.0);
  EXPECT_TRUE(control.isProgramRunning());
}

TEST_F(UrRtdeControlTest, WatchdogStopsProgramWithoutCommands)
{
  ASSERT_TRUE(control.setWatchdog(10.0));
  EXPECT_TRUE(wait_for_program_state(controller, "STOPPED"));
  EXPECT_TRUE(log_contains(controller, "RTDE watchdog"));
}

TEST_F(UrRtdeControlTest, ReuploadsScriptAfterStop)
{
  control.stopScript();
  ASSERT_TRUE(wait_for_program_state(controller, "STOPPED"));
  ASSERT_TRUE(control.reuploadScript());
  // reuploadScript() does not wait until the library's copy of the state shows the program.
  ASSERT_TRUE(controller.wait_until([this](const json &) { return control.isProgramRunning(); }, seconds(5)));
  EXPECT_TRUE(control.moveJ(start_plus(0.05), 1.0, 2.0));
}

TEST_F(UrRtdeControlTest, MoveJFollowsPath)
{
  Joints first = start_plus(0.1);
  Joints last = start_plus(0.2);
  for (Joints * waypoint : {&first, &last}) {
    waypoint->insert(waypoint->end(), {1.0, 2.0, 0.0});  // speed, acceleration, blend radius
  }
  ASSERT_TRUE(control.moveJ({first, last}));
  EXPECT_LT(max_difference(actual_joint_positions(controller), start_plus(0.2)), 1e-3);
}

TEST_F(UrRtdeControlTest, StopsScript)
{
  control.stopScript();
  EXPECT_TRUE(wait_for_program_state(controller, "STOPPED"));
}

TEST_F(UrRtdeControlTest, SharesControllerWithReceiveAndIoInterfaces)
{
  ur_rtde::RTDEReceiveInterface receive(controller.address());
  ur_rtde::RTDEIOInterface io(controller.address());
  ASSERT_TRUE(io.setSpeedSlider(0.5));
  EXPECT_TRUE(control.moveJ(start_plus(0.1), 1.0, 2.0));
  EXPECT_LT(max_difference(receive.getActualQ(), start_plus(0.1)), 1e-2);
}

TEST_F(UrRtdeControlTest, SecondControlInterfaceIsRejected)
{
  EXPECT_THROW(ur_rtde::RTDEControlInterface(controller.address(), -1.0,
                                             ur_rtde::RTDEControlInterface::FLAGS_DEFAULT, 50002, -1),
               std::runtime_error);
}

}  // namespace
}  // namespace ur_simulator::testing
