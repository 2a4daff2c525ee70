// Force, freedrive and torque functions of the ur_rtde library.
#include <ur_rtde/rtde_control_interface.h>
#include <ur_rtde/rtde_receive_interface.h>

#include <cmath>

#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

using Vector = std::vector<double>;
using Control = ur_rtde::RTDEControlInterface;

double state_value(SimulatedController & controller, const char * field, std::size_t index)
{
  return controller.state()[field][index].get<double>();
}

/// Polls a condition that calls the library. Such a condition cannot be passed to wait_until(), because the
/// library waits for the controller.
template <typename Condition>
bool poll_until(SimulatedController & controller, Condition condition)
{
  for (int i = 0; i < 200; ++i) {
    if (condition()) {
      return true;
    }
    EXPECT_TRUE(wait_simulated_time(controller, 0.05, seconds(30)));
  }
  return false;
}

class UrRtdeForceTest : public SimulatorTest {
 protected:
  Control control{controller.address(), -1.0, Control::FLAGS_DEFAULT, 50002, -1};
  double height = state_value(controller, "actual_tcp_pose", 2);

  void place_table_below_tcp(double distance) { place_surface(height - distance); }
  void place_surface(double z) { controller.control({{"command", "place_surface"}, {"z", z}}); }
  bool press_down(double force)
  {
    return control.forceMode({0, 0, 0, 0, 0, 0}, {0, 0, 1, 0, 0, 0}, {0, 0, -force, 0, 0, 0}, 2,
                             {0.1, 0.1, 0.05, 0.2, 0.2, 0.2});
  }
  bool wait_for_force(double force, double tolerance)
  {
    return controller.wait_until(
        [=](const json & state) {
          return std::abs(state["actual_tcp_force"][2].get<double>() - force) < tolerance;
        },
        seconds(10));
  }
  void push(const Vector & force, double duration)
  {
    controller.control({{"command", "push"}, {"force", force}, {"duration", duration}});
  }
};

TEST_F(UrRtdeForceTest, PressesOnTableAndReleases)
{
  place_table_below_tcp(0.01);
  ASSERT_TRUE(control.zeroFtSensor());
  ASSERT_TRUE(press_down(20.0));
  ASSERT_TRUE(wait_for_force(20.0, 1.5));
  ASSERT_TRUE(wait_simulated_time(controller, 1.0, seconds(30)));
  EXPECT_NEAR(state_value(controller, "contact_wrench", 2), 20.0, 2.0);
  EXPECT_TRUE(control.forceModeStop());
  EXPECT_TRUE(wait_until_at_rest(controller, seconds(5)));
  EXPECT_TRUE(control.isProgramRunning());
}

TEST_F(UrRtdeForceTest, ChangesForceDuringForceMode)
{
  place_table_below_tcp(0.01);
  ASSERT_TRUE(control.zeroFtSensor());
  ASSERT_TRUE(press_down(10.0));
  ASSERT_TRUE(wait_for_force(10.0, 1.5));
  ASSERT_TRUE(press_down(30.0));
  EXPECT_TRUE(wait_for_force(30.0, 1.5));
  EXPECT_TRUE(control.forceModeStop());
}

TEST_F(UrRtdeForceTest, MovesDuringForceMode)
{
  place_table_below_tcp(0.01);
  ASSERT_TRUE(control.zeroFtSensor());
  ASSERT_TRUE(press_down(20.0));
  ASSERT_TRUE(wait_for_force(20.0, 1.5));
  Vector target = controller.state()["actual_tcp_pose"].get<Vector>();
  target[1] += 0.1;
  ASSERT_TRUE(control.moveL(target, 0.1, 0.5));
  EXPECT_NEAR(state_value(controller, "actual_tcp_pose", 1), target[1], 2e-3);
  EXPECT_NEAR(state_value(controller, "actual_tcp_force", 2), 20.0, 3.0);
  EXPECT_TRUE(control.forceModeStop());
}

TEST_F(UrRtdeForceTest, ChangesForceDuringMotion)
{
  const auto running = [this] { return control.getAsyncOperationProgressEx().isAsyncOperationRunning(); };
  place_table_below_tcp(0.01);
  ASSERT_TRUE(control.zeroFtSensor());
  ASSERT_TRUE(press_down(15.0));
  ASSERT_TRUE(wait_for_force(15.0, 1.5));
  Vector target = controller.state()["actual_tcp_pose"].get<Vector>();
  target[1] += 0.1;
  ASSERT_TRUE(control.moveL(target, 0.05, 0.5, true));
  ASSERT_TRUE(poll_until(controller, running));
  ASSERT_TRUE(press_down(60.0));
  ASSERT_TRUE(poll_until(controller, [&] { return !running(); }));
  EXPECT_NEAR(state_value(controller, "actual_tcp_pose", 1), target[1], 2e-3);
  EXPECT_TRUE(wait_for_force(60.0, 1.5));
  EXPECT_TRUE(control.forceModeStop());
}

TEST_F(UrRtdeForceTest, SetsDampingAndGain)
{
  EXPECT_TRUE(control.forceModeSetDamping(0.1));
  EXPECT_TRUE(control.forceModeSetGainScaling(1.2));
  EXPECT_TRUE(control.isProgramRunning());
}

TEST_F(UrRtdeForceTest, EndsForceModeWithScript)
{
  ASSERT_TRUE(press_down(20.0));
  ASSERT_TRUE(controller.wait_until(
      [](const json & state) { return state["actual_tcp_speed"][2].get<double>() < -0.02; }, seconds(5)));
  control.stopScript();
  EXPECT_TRUE(wait_until_at_rest(controller, seconds(5)));
}

TEST_F(UrRtdeForceTest, FreedriveMovesAlongFreeAxisOnly)
{
  const Vector before = controller.state()["actual_tcp_pose"].get<Vector>();
  ASSERT_TRUE(control.freedriveMode({0, 1, 0, 0, 0, 0}));
  EXPECT_EQ(control.getFreedriveStatus(), 0);
  push({40.0, 40.0, 0.0}, 1.0);
  ASSERT_TRUE(wait_simulated_time(controller, 1.2, seconds(30)));
  ASSERT_TRUE(control.endFreedriveMode());
  const Vector after = controller.state()["actual_tcp_pose"].get<Vector>();
  EXPECT_GT(after[1] - before[1], 0.02);
  EXPECT_NEAR(after[0], before[0], 2e-3);
}

TEST_F(UrRtdeForceTest, TeachModeEnablesFreedrive)
{
  ASSERT_TRUE(control.teachMode());
  EXPECT_TRUE(
      controller.wait_until([](const json & state) { return state["freedrive"].get<bool>(); }, seconds(5)));
  ASSERT_TRUE(control.endTeachMode());
  EXPECT_TRUE(
      controller.wait_until([](const json & state) { return !state["freedrive"].get<bool>(); }, seconds(5)));
}

TEST_F(UrRtdeForceTest, MovesUntilContactAndRetracts)
{
  place_table_below_tcp(0.05);
  ASSERT_TRUE(control.moveUntilContact({0, 0, -0.05, 0, 0, 0}));
  EXPECT_NEAR(state_value(controller, "actual_tcp_pose", 2), height - 0.05, 2e-3);
}

TEST_F(UrRtdeForceTest, DetectsContactDuringMotion)
{
  place_table_below_tcp(0.05);
  ASSERT_TRUE(control.startContactDetection({0, 0, -1, 0, 0, 0}));
  EXPECT_FALSE(control.readContactDetection());
  Vector target = controller.state()["actual_tcp_pose"].get<Vector>();
  target[2] -= 0.08;
  ASSERT_TRUE(control.moveL(target, 0.05, 0.5, true));
  ASSERT_TRUE(poll_until(controller, [this] { return control.readContactDetection(); }));
  ASSERT_TRUE(wait_until_at_rest(controller, seconds(10)));
  EXPECT_NEAR(state_value(controller, "actual_tcp_pose", 2), height - 0.05, 2e-3);
  EXPECT_TRUE(control.stopContactDetection());
}

TEST_F(UrRtdeForceTest, ReportsToolContact)
{
  place_surface(height - 0.002);
  EXPECT_EQ(control.toolContact({0, 0, -1, 0, 0, 0}), 0);
  Vector target = controller.state()["actual_tcp_pose"].get<Vector>();
  target[2] -= 0.004;
  ASSERT_TRUE(control.moveL(target, 0.02, 0.5));
  // The library reads the register before the script has written it: the next call returns the result.
  EXPECT_TRUE(poll_until(controller, [this] { return control.toolContact({0, 0, -1, 0, 0, 0}) > 0; }));
}

TEST_F(UrRtdeForceTest, JogsAndStops)
{
  ASSERT_TRUE(control.jogStart({0, 0, 0.05, 0, 0, 0}, 0));
  EXPECT_TRUE(controller.wait_until(
      [](const json & state) { return std::abs(state["actual_tcp_speed"][2].get<double>() - 0.05) < 0.005; },
      seconds(5)));
  ASSERT_TRUE(control.jogStop());
  EXPECT_TRUE(wait_until_at_rest(controller, seconds(5)));
}

TEST_F(UrRtdeForceTest, ReadsMassMatrixJacobianAndJointHistory)
{
  EXPECT_EQ(control.getMassMatrix().size(), 36u);
  EXPECT_EQ(control.getJacobian().size(), 36u);
  const Vector joints = controller.state()["actual"]["position"].get<Vector>();
  EXPECT_TRUE(poll_until(controller, [&] {
    return std::abs(control.getActualJointPositionsHistory(10).at(1) - joints[1]) < reading_noise;
  }));
  EXPECT_EQ(control.getTargetWaypoint().size(), 6u);
}

TEST_F(UrRtdeForceTest, SetsTargetPayloadAndGravity)
{
  EXPECT_TRUE(control.setTargetPayload(2.0, {0.0, 0.0, 0.1}, {0.01, 0.01, 0.01, 0.0, 0.0, 0.0}));
  EXPECT_TRUE(control.setGravity({0.0, 0.0, 9.82}));
  EXPECT_TRUE(
      controller.wait_until([](const json & state) { return state["payload"]["mass"] == 2.0; }, seconds(5)));
}

TEST_F(UrRtdeForceTest, UsesExternalSensor)
{
  ASSERT_TRUE(control.ftRtdeInputEnable(true));
  EXPECT_TRUE(controller.wait_until([](const json & state) { return state["external_sensor"].get<bool>(); },
                                    seconds(5)));
  ASSERT_TRUE(control.setExternalForceTorque({0.0, 0.0, -12.0, 0.0, 0.0, 0.0}));
  EXPECT_TRUE(controller.wait_until(
      [](const json & state) {
        const auto force = state["actual_tcp_force"].get<Vector>();
        return std::abs(std::hypot(force[0], force[1], force[2]) - 12.0) < 0.5;
      },
      seconds(5)));
  EXPECT_TRUE(control.ftRtdeInputEnable(false));
}

TEST(UrRtdeTorqueTest, DirectTorqueMovesJointOnPolyscope526)
{
  SimulatorOptions options;
  options.polyscope_version = "5.26.0";
  SimulatedController controller(with_unique_address(options));
  Control control(controller.address(), -1.0, Control::FLAGS_DEFAULT, 50002, -1);
  const double before = controller.state()["actual"]["position"][0].get<double>();
  for (int i = 0; i < 250; ++i) {
    const auto begin = control.initPeriod();
    ASSERT_TRUE(control.directTorque({5.0, 0, 0, 0, 0, 0}));
    control.waitPeriod(begin);
  }
  EXPECT_GT(controller.state()["actual"]["position"][0].get<double>(), before + 0.02);
  EXPECT_TRUE(control.isProgramRunning());
}

}  // namespace
}  // namespace ur_simulator::testing
