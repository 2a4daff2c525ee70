// What of the ur_rtde library deals with forces, hands and torques.
#include <ur_rtde/rtde_control_interface.h>
#include <ur_rtde/rtde_receive_interface.h>

#include <cmath>

#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

using Numbers = std::vector<double>;
using Control = ur_rtde::RTDEControlInterface;

double number(SimulatedController & controller, const char * field, std::size_t index)
{
  return controller.state()[field][index].get<double>();
}

/// So many seconds of simulated time.
void let_pass(SimulatedController & controller, double time)
{
  const double until = controller.state()["timestamp"].get<double>() + time;
  ASSERT_TRUE(controller.wait_until(
      [until](const json & state) { return state["timestamp"].get<double>() >= until; }, seconds(30)));
}

/// Asks the library until it answers so. (It asks the robot, so it cannot be asked in a condition of
/// wait_until.)
template <typename Condition>
bool eventually(SimulatedController & controller, Condition condition)
{
  for (int i = 0; i < 200; ++i) {
    if (condition()) {
      return true;
    }
    let_pass(controller, 0.05);
  }
  return false;
}

class UrRtdeForce : public SimulatorTest {
 protected:
  Control control{controller.address(), -1.0, Control::FLAGS_DEFAULT, 50002, -1};
  double height = number(controller, "actual_tcp_pose", 2);

  void place_table(double below) { place(height - below); }
  void place(double z) { controller.control({{"command", "place_surface"}, {"z", z}}); }
  bool press(double force)
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
  void push(const Numbers & force, double duration)
  {
    controller.control({{"command", "push"}, {"force", force}, {"duration", duration}});
  }
};

TEST_F(UrRtdeForce, presses_on_a_table_and_lets_go)
{
  place_table(0.01);
  ASSERT_TRUE(control.zeroFtSensor());
  ASSERT_TRUE(press(20.0));
  ASSERT_TRUE(wait_for_force(20.0, 1.5));
  let_pass(controller, 1.0);
  EXPECT_NEAR(number(controller, "contact_wrench", 2), 20.0, 2.0);
  EXPECT_TRUE(control.forceModeStop());
  EXPECT_TRUE(
      controller.wait_until([](const json & state) { return state["at_rest"].get<bool>(); }, seconds(5)));
  EXPECT_TRUE(control.isProgramRunning());
}

TEST_F(UrRtdeForce, changes_the_force_on_the_way)
{
  place_table(0.01);
  ASSERT_TRUE(control.zeroFtSensor());
  ASSERT_TRUE(press(10.0));
  ASSERT_TRUE(wait_for_force(10.0, 1.5));
  ASSERT_TRUE(press(30.0));
  EXPECT_TRUE(wait_for_force(30.0, 1.5));
  EXPECT_TRUE(control.forceModeStop());
}

TEST_F(UrRtdeForce, moves_while_it_presses)
{
  place_table(0.01);
  ASSERT_TRUE(control.zeroFtSensor());
  ASSERT_TRUE(press(20.0));
  ASSERT_TRUE(wait_for_force(20.0, 1.5));
  Numbers target = controller.state()["actual_tcp_pose"].get<Numbers>();
  target[1] += 0.1;
  ASSERT_TRUE(control.moveL(target, 0.1, 0.5));
  EXPECT_NEAR(number(controller, "actual_tcp_pose", 1), target[1], 2e-3);
  EXPECT_NEAR(number(controller, "actual_tcp_force", 2), 20.0, 3.0);
  EXPECT_TRUE(control.forceModeStop());
}

TEST_F(UrRtdeForce, changes_the_force_under_a_motion_which_ends)
{
  const auto running = [this] { return control.getAsyncOperationProgressEx().isAsyncOperationRunning(); };
  place_table(0.01);
  ASSERT_TRUE(control.zeroFtSensor());
  ASSERT_TRUE(press(15.0));
  ASSERT_TRUE(wait_for_force(15.0, 1.5));
  Numbers target = controller.state()["actual_tcp_pose"].get<Numbers>();
  target[1] += 0.1;
  ASSERT_TRUE(control.moveL(target, 0.05, 0.5, true));
  ASSERT_TRUE(eventually(controller, running));
  ASSERT_TRUE(press(60.0));
  ASSERT_TRUE(eventually(controller, [&] { return !running(); }));
  EXPECT_NEAR(number(controller, "actual_tcp_pose", 1), target[1], 2e-3);
  EXPECT_TRUE(wait_for_force(60.0, 1.5));
  EXPECT_TRUE(control.forceModeStop());
}

TEST_F(UrRtdeForce, sets_damping_and_gain)
{
  EXPECT_TRUE(control.forceModeSetDamping(0.1));
  EXPECT_TRUE(control.forceModeSetGainScaling(1.2));
  EXPECT_TRUE(control.isProgramRunning());
}

TEST_F(UrRtdeForce, ends_force_mode_with_its_script)
{
  ASSERT_TRUE(press(20.0));
  ASSERT_TRUE(controller.wait_until(
      [](const json & state) { return state["actual_tcp_speed"][2].get<double>() < -0.02; }, seconds(5)));
  control.stopScript();
  EXPECT_TRUE(
      controller.wait_until([](const json & state) { return state["at_rest"].get<bool>(); }, seconds(5)));
}

TEST_F(UrRtdeForce, guides_the_arm_by_hand_along_one_axis)
{
  const Numbers before = controller.state()["actual_tcp_pose"].get<Numbers>();
  ASSERT_TRUE(control.freedriveMode({0, 1, 0, 0, 0, 0}));
  EXPECT_EQ(control.getFreedriveStatus(), 0);
  push({40.0, 40.0, 0.0}, 1.0);
  let_pass(controller, 1.2);
  ASSERT_TRUE(control.endFreedriveMode());
  const Numbers after = controller.state()["actual_tcp_pose"].get<Numbers>();
  EXPECT_GT(after[1] - before[1], 0.02);
  EXPECT_NEAR(after[0], before[0], 2e-3);
}

TEST_F(UrRtdeForce, teaches)
{
  ASSERT_TRUE(control.teachMode());
  EXPECT_TRUE(
      controller.wait_until([](const json & state) { return state["freedrive"].get<bool>(); }, seconds(5)));
  ASSERT_TRUE(control.endTeachMode());
  EXPECT_TRUE(
      controller.wait_until([](const json & state) { return !state["freedrive"].get<bool>(); }, seconds(5)));
}

TEST_F(UrRtdeForce, moves_until_contact_and_back_to_where_it_began)
{
  place_table(0.05);
  ASSERT_TRUE(control.moveUntilContact({0, 0, -0.05, 0, 0, 0}));
  EXPECT_NEAR(number(controller, "actual_tcp_pose", 2), height - 0.05, 2e-3);
}

TEST_F(UrRtdeForce, watches_for_contact_while_something_else_moves)
{
  place_table(0.05);
  ASSERT_TRUE(control.startContactDetection({0, 0, -1, 0, 0, 0}));
  EXPECT_FALSE(control.readContactDetection());
  Numbers target = controller.state()["actual_tcp_pose"].get<Numbers>();
  target[2] -= 0.08;
  ASSERT_TRUE(control.moveL(target, 0.05, 0.5, true));
  ASSERT_TRUE(eventually(controller, [this] { return control.readContactDetection(); }));
  ASSERT_TRUE(
      controller.wait_until([](const json & state) { return state["at_rest"].get<bool>(); }, seconds(10)));
  EXPECT_NEAR(number(controller, "actual_tcp_pose", 2), height - 0.05, 2e-3);
  EXPECT_TRUE(control.stopContactDetection());
}

TEST_F(UrRtdeForce, asks_for_contact)
{
  place(height - 0.002);
  EXPECT_EQ(control.toolContact({0, 0, -1, 0, 0, 0}), 0);
  Numbers target = controller.state()["actual_tcp_pose"].get<Numbers>();
  target[2] -= 0.004;
  ASSERT_TRUE(control.moveL(target, 0.02, 0.5));
  // The library reads the register before the script has written it: asked again, it answers.
  EXPECT_TRUE(eventually(controller, [this] { return control.toolContact({0, 0, -1, 0, 0, 0}) > 0; }));
}

TEST_F(UrRtdeForce, jogs_and_stops)
{
  ASSERT_TRUE(control.jogStart({0, 0, 0.05, 0, 0, 0}, 0));
  EXPECT_TRUE(controller.wait_until(
      [](const json & state) { return std::abs(state["actual_tcp_speed"][2].get<double>() - 0.05) < 0.005; },
      seconds(5)));
  ASSERT_TRUE(control.jogStop());
  EXPECT_TRUE(
      controller.wait_until([](const json & state) { return state["at_rest"].get<bool>(); }, seconds(5)));
}

TEST_F(UrRtdeForce, reads_mass_matrix_jacobian_and_the_way_the_joints_came)
{
  EXPECT_EQ(control.getMassMatrix().size(), 36u);
  EXPECT_EQ(control.getJacobian().size(), 36u);
  const Numbers joints = controller.state()["actual"]["position"].get<Numbers>();
  EXPECT_TRUE(eventually(controller, [&] {
    return std::abs(control.getActualJointPositionsHistory(10).at(1) - joints[1]) < 1e-6;
  }));
  EXPECT_EQ(control.getTargetWaypoint().size(), 6u);
}

TEST_F(UrRtdeForce, sets_target_payload_and_gravity)
{
  EXPECT_TRUE(control.setTargetPayload(2.0, {0.0, 0.0, 0.1}, {0.01, 0.01, 0.01, 0.0, 0.0, 0.0}));
  EXPECT_TRUE(control.setGravity({0.0, 0.0, 9.82}));
  EXPECT_TRUE(
      controller.wait_until([](const json & state) { return state["payload"]["mass"] == 2.0; }, seconds(5)));
}

TEST_F(UrRtdeForce, lets_an_external_sensor_take_over)
{
  ASSERT_TRUE(control.ftRtdeInputEnable(true));
  EXPECT_TRUE(controller.wait_until([](const json & state) { return state["external_sensor"].get<bool>(); },
                                    seconds(5)));
  ASSERT_TRUE(control.setExternalForceTorque({0.0, 0.0, -12.0, 0.0, 0.0, 0.0}));
  EXPECT_TRUE(controller.wait_until(
      [](const json & state) {
        const auto force = state["actual_tcp_force"].get<Numbers>();
        return std::abs(std::hypot(force[0], force[1], force[2]) - 12.0) < 0.5;
      },
      seconds(5)));
  EXPECT_TRUE(control.ftRtdeInputEnable(false));
}

TEST(UrRtdeTorque, leads_the_joints_by_torques_from_5_26_on)
{
  SimulatorOptions options;
  options.polyscope_version = "5.26.0";
  SimulatedController controller(on_own_address(options));
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
