// ur_rtde's own control script, as the library uploads it, against the arm. The script's path comes from the
// build.
#include <chrono>
#include <fstream>
#include <iostream>
#include <sstream>

#include "robot_rig.hpp"

namespace ur_simulator {
namespace {

using urscript::MachineStatus;

// What ScriptClient does to the script for a controller 5.25: keeps what the version has, fills in the
// register offset.
std::string uploaded_script(const std::string & offset)
{
  std::ifstream file(UR_RTDE_CONTROL_SCRIPT);
  std::stringstream result;
  result << "def rtde_control():\n";
  std::string line;
  while (std::getline(file, line)) {
    if (!line.empty() && line[0] == '$') {
      const bool alternative = line.size() > 9 && line[5] == '|';
      const std::size_t marker = alternative ? 10 : 5;
      const int minor = std::stoi(line.substr(3, 2));
      if (line[1] == '5' && minor > 25) {
        continue;
      }
      line.replace(0, marker, std::string(marker, ' '));
    }
    result << line << "\n";
    if (line.find("# float register offset") != std::string::npos ||
        line.find("# int register offset") != std::string::npos) {
      result << offset;
    }
  }
  result << "end\n";
  return result.str();
}

class ControlScript : public ::testing::Test {
 protected:
  void SetUp() override
  {
    rig.run(uploaded_script("0"));
    rig.until([&] { return output(0) == 1; }, 0.1);
  }

  std::int32_t output(std::size_t i) const { return rig.state.outputs.integers[i]; }

  void parameters(const Vector6 & six, std::initializer_list<double> more = {})
  {
    for (std::size_t i = 0; i < 6; ++i) {
      rig.state.inputs.doubles[i] = six[static_cast<Eigen::Index>(i)];
    }
    std::copy(more.begin(), more.end(), rig.state.inputs.doubles.begin() + 6);
  }

  /// One command as the library sends it: until the script says done, then back to ready.
  double command(std::int32_t id, double limit = 30.0)
  {
    rig.state.inputs.integers[0] = id;
    const double time = rig.until([&] { return output(0) == 2; }, limit);
    rig.state.inputs.integers[0] = 0;
    rig.until([&] { return output(0) == 1; }, 0.1);
    return time;
  }

  void expect_running()
  {
    EXPECT_EQ(rig.machine->status(), MachineStatus::running) << rig.machine->error().message;
  }

  RobotRig rig;
};

TEST_F(ControlScript, announces_itself_and_the_idle_progress)
{
  EXPECT_EQ(output(2), 65536);
  EXPECT_NE(std::find(rig.host.messages.begin(), rig.host.messages.end(),
                      "RTDE Control Script Loaded (14.02.2024-12:23)"),
            rig.host.messages.end());
}

TEST_F(ControlScript, moves_joints)
{
  Vector6 target = rig.state.target.position;
  target[0] += 0.4;
  parameters(target, {1.0, 2.0});
  rig.state.inputs.integers[1] = 0;
  EXPECT_GT(command(1), 0.4);
  EXPECT_LT((rig.state.target.position - target).norm(), 1e-6);
  expect_running();
}

TEST_F(ControlScript, moves_linearly_in_the_background_and_stops)
{
  Vector6 target = rig.state.target_tcp_pose;
  const double start = target[2];
  target[2] -= 0.3;
  parameters(target, {0.1, 0.5});
  rig.state.inputs.integers[1] = 1;
  EXPECT_LT(command(3), 0.02);
  rig.cycles(10);
  EXPECT_NE(output(2) & 32768, 0) << "the operation is reported as running";
  rig.cycles(300);
  EXPECT_LT(rig.state.target_tcp_speed[2], -0.05);
  parameters(Vector6::Constant(2.0));
  rig.state.inputs.integers[1] = 0;
  const double time = command(33);
  EXPECT_LT(time, 0.5);
  EXPECT_LT(rig.state.target_tcp_speed.norm(), 1e-9);
  EXPECT_EQ(output(2) & 32768, 0);
  EXPECT_GT(rig.state.target_tcp_pose[2], start - 0.2);
  expect_running();
}

TEST_F(ControlScript, reports_the_end_of_a_motion_in_the_background)
{
  Vector6 target = rig.state.target.position;
  target[5] += 0.2;
  parameters(target, {1.0, 2.0});
  rig.state.inputs.integers[1] = 1;
  command(1);
  const std::int32_t operation = output(2) >> 24;
  rig.until([&] { return (output(2) & 32768) == 0; });
  EXPECT_EQ(output(2) >> 24, operation);
  EXPECT_LT((rig.state.target.position - target).norm(), 1e-6);
}

TEST_F(ControlScript, follows_a_servo_stream_and_stops)
{
  Vector6 target = rig.state.target.position;
  for (int i = 0; i < 200; ++i) {
    target[5] += 0.001;
    parameters(target, {0.5, 0.5, 0.002, 0.1, 300.0});
    rig.state.inputs.integers[0] = 11;
    rig.cycle();
    EXPECT_EQ(output(0), 1);
  }
  EXPECT_GT(rig.state.target.velocity[5], 0.3);
  rig.state.inputs.integers[0] = 0;
  rig.cycle();
  parameters(Vector6::Constant(10.0));
  command(16);
  EXPECT_LT(rig.state.target.velocity.norm(), 1e-9);
  expect_running();
}

TEST_F(ControlScript, moves_at_joint_and_at_tool_speed)
{
  Vector6 speed = Vector6::Zero();
  speed[2] = -0.05;
  parameters(speed, {0.5, 0.0});
  rig.state.inputs.integers[0] = 10;
  rig.cycles(300);
  EXPECT_NEAR(rig.state.target_tcp_speed[2], -0.05, 1e-4);
  rig.state.inputs.integers[0] = 0;
  rig.cycle();
  parameters(Vector6::Constant(10.0));
  command(15);
  EXPECT_LT(rig.state.target_tcp_speed.norm(), 1e-9);

  speed.setZero();
  speed[0] = 0.2;
  parameters(speed, {1.0, 0.0});
  rig.state.inputs.integers[0] = 9;
  rig.cycles(300);
  EXPECT_NEAR(rig.state.target.velocity[0], 0.2, 1e-6);
  rig.state.inputs.integers[0] = 0;
  rig.cycle();
  parameters(Vector6::Constant(10.0));
  command(15);
  EXPECT_LT(rig.state.target.velocity.norm(), 1e-9);
  expect_running();
}

TEST_F(ControlScript, jogs_in_the_tool_frame)
{
  Vector6 speed = Vector6::Zero();
  speed[2] = 0.05;
  parameters(speed, {1.0, 0.5, 0, 0, 0, 0, 0, 0});
  command(41);
  rig.cycles(200);
  EXPECT_NEAR(rig.state.target_tcp_speed.head<3>().norm(), 0.05, 1e-3);
  command(42);
  EXPECT_LT(rig.state.target_tcp_speed.norm(), 1e-9);
}

TEST_F(ControlScript, answers_questions)
{
  parameters(rig.state.target_tcp_pose);
  command(46);
  for (Eigen::Index i = 0; i < 6; ++i) {
    EXPECT_NEAR(rig.state.outputs.doubles[static_cast<std::size_t>(i)], rig.state.target.position[i], 1e-8);
  }
  command(43);
  EXPECT_NEAR(rig.state.outputs.doubles[2], rig.state.actual_tcp_pose[2], 1e-9);
  parameters(rig.state.target_tcp_pose);
  command(60);
  EXPECT_EQ(output(1), 1);
  command(36);
  EXPECT_EQ(output(1), 1);
  command(47);
  EXPECT_EQ(output(1), 1);
  parameters(Vector6::Constant(0.0));
  rig.state.inputs.doubles[0] = 1.5;
  command(17);
  EXPECT_EQ(rig.state.payload.mass, 1.5);
  command(8);
  expect_running();
}

// Commands that are processed in every cycle leave the script ready; each must have run at least once without
// an error.
TEST_F(ControlScript, processes_the_commands_of_newer_controllers)
{
  for (const std::int32_t id : {26, 27, 38, 58, 67, 68, 69, 70, 71}) {
    rig.state.inputs.integers[0] = id;
    rig.cycles(3);
    EXPECT_EQ(rig.machine->status(), MachineStatus::running) << id << ": " << rig.machine->error().message;
    rig.state.inputs.integers[0] = 0;
    rig.cycles(2);
  }
  EXPECT_EQ(output(0), 1);
}

TEST_F(ControlScript, ends_on_command)
{
  rig.state.inputs.integers[0] = 255;
  rig.finish(0.1);
  EXPECT_EQ(rig.machine->status(), MachineStatus::finished);
}

TEST_F(ControlScript, a_command_that_the_robot_refuses_ends_it_with_a_reason)
{
  for (const std::int32_t command : {18, 0, 1}) {  // teach mode, done with it, movej
    rig.state.inputs.integers[0] = command;
    rig.cycles(10);
  }
  EXPECT_EQ(rig.machine->status(), MachineStatus::failed);
  EXPECT_NE(rig.machine->error().message.find("freedrive"), std::string::npos)
      << rig.machine->error().message;
}

TEST_F(ControlScript, runs_with_injected_offsets_of_an_earlier_upload_too)
{
  // Uploaded twice, "0" becomes "00"; the upper range injects 24.
  rig.run(uploaded_script("00"));
  rig.cycles(3);
  expect_running();
}

TEST_F(ControlScript, computes_little)
{
  Vector6 target = rig.state.target.position;
  parameters(target, {0.5, 0.5, 0.002, 0.1, 300.0});
  rig.state.inputs.integers[0] = 11;
  rig.cycles(10);
  EXPECT_LT(rig.machine->instructions(), 2500U);
  RecordProperty("instructions", static_cast<int>(rig.machine->instructions()));
}

}  // namespace
}  // namespace ur_simulator
