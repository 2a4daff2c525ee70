// Runs the control script of the installed ur_rtde against the simulated arm.
#include <chrono>
#include <iostream>
#include <utility>

#include "control_script_fixture.hpp"

namespace ur_simulator {
namespace {

TEST_F(ControlScriptTest, ReportsItsStateAndIdleProgress)
{
  EXPECT_EQ(output(2), 65536);
  EXPECT_NE(std::find(fixture.host.messages.begin(), fixture.host.messages.end(),
                      "RTDE Control Script Loaded (14.02.2024-12:23)"),
            fixture.host.messages.end());
}

TEST_F(ControlScriptTest, MovesJoints)
{
  Vector6 target = fixture.state.target.position;
  target[0] += 0.4;
  parameters(target, {1.0, 2.0});
  fixture.state.inputs.integers[1] = 0;
  EXPECT_GT(command(1), 0.4);
  EXPECT_LT((fixture.state.target.position - target).norm(), 1e-6);
  expect_running();
}

TEST_F(ControlScriptTest, MovesLinearlyInTheBackgroundAndStops)
{
  Vector6 target = fixture.state.target_tcp_pose;
  const double start = target[2];
  target[2] -= 0.3;
  parameters(target, {0.1, 0.5});
  fixture.state.inputs.integers[1] = 1;
  EXPECT_LT(command(3), 0.02);
  fixture.cycles(10);
  EXPECT_NE(output(2) & 32768, 0) << "the operation is reported as running";
  fixture.cycles(300);
  EXPECT_LT(fixture.state.target_tcp_speed[2], -0.05);
  parameters(Vector6::Constant(2.0));
  fixture.state.inputs.integers[1] = 0;
  const double time = command(33);
  EXPECT_LT(time, 0.5);
  EXPECT_LT(fixture.state.target_tcp_speed.norm(), 1e-9);
  EXPECT_EQ(output(2) & 32768, 0);
  EXPECT_GT(fixture.state.target_tcp_pose[2], start - 0.2);
  expect_running();
}

TEST_F(ControlScriptTest, ReportsTheEndOfAMotionInTheBackground)
{
  Vector6 target = fixture.state.target.position;
  target[5] += 0.2;
  parameters(target, {1.0, 2.0});
  fixture.state.inputs.integers[1] = 1;
  command(1);
  const std::int32_t operation = output(2) >> 24;
  fixture.until([&] { return (output(2) & 32768) == 0; });
  EXPECT_EQ(output(2) >> 24, operation);
  EXPECT_LT((fixture.state.target.position - target).norm(), 1e-6);
}

TEST_F(ControlScriptTest, FollowsAServoStreamAndStops)
{
  Vector6 target = fixture.state.target.position;
  for (int i = 0; i < 200; ++i) {
    target[5] += 0.001;
    parameters(target, {0.5, 0.5, 0.002, 0.1, 300.0});
    fixture.state.inputs.integers[0] = 11;
    fixture.cycle();
    EXPECT_EQ(output(0), 1);
  }
  EXPECT_GT(fixture.state.target.velocity[5], 0.3);
  fixture.state.inputs.integers[0] = 0;
  fixture.cycle();
  parameters(Vector6::Constant(10.0));
  command(16);
  EXPECT_LT(fixture.state.target.velocity.norm(), 1e-9);
  expect_running();
}

TEST_F(ControlScriptTest, MovesAtJointAndAtToolSpeed)
{
  Vector6 speed = Vector6::Zero();
  speed[2] = -0.05;
  parameters(speed, {0.5, 0.0});
  fixture.state.inputs.integers[0] = 10;
  fixture.cycles(300);
  EXPECT_NEAR(fixture.state.target_tcp_speed[2], -0.05, 1e-4);
  fixture.state.inputs.integers[0] = 0;
  fixture.cycle();
  parameters(Vector6::Constant(10.0));
  command(15);
  EXPECT_LT(fixture.state.target_tcp_speed.norm(), 1e-9);

  speed.setZero();
  speed[0] = 0.2;
  parameters(speed, {1.0, 0.0});
  fixture.state.inputs.integers[0] = 9;
  fixture.cycles(300);
  EXPECT_NEAR(fixture.state.target.velocity[0], 0.2, 1e-6);
  fixture.state.inputs.integers[0] = 0;
  fixture.cycle();
  parameters(Vector6::Constant(10.0));
  command(15);
  EXPECT_LT(fixture.state.target.velocity.norm(), 1e-9);
  expect_running();
}

TEST_F(ControlScriptTest, JogsInTheToolFrame)
{
  Vector6 speed = Vector6::Zero();
  speed[2] = 0.05;
  parameters(speed, {1.0, 0.5, 0, 0, 0, 0, 0, 0});
  command(41);
  fixture.cycles(200);
  EXPECT_NEAR(fixture.state.target_tcp_speed.head<3>().norm(), 0.05, 1e-3);
  command(42);
  EXPECT_LT(fixture.state.target_tcp_speed.norm(), 1e-9);
}

TEST_F(ControlScriptTest, AnswersQueries)
{
  parameters(fixture.state.target_tcp_pose);
  command(46);
  for (Eigen::Index i = 0; i < 6; ++i) {
    EXPECT_NEAR(fixture.state.outputs.floats[static_cast<std::size_t>(i)], fixture.state.target.position[i],
                1e-6);
  }
  command(43);
  EXPECT_NEAR(fixture.state.outputs.floats[2], fixture.state.actual_tcp_pose[2], 1e-7);
  parameters(fixture.state.target_tcp_pose);
  command(60);
  EXPECT_EQ(output(1), 1);
  command(36);
  EXPECT_EQ(output(1), 1);
  command(47);
  EXPECT_EQ(output(1), 1);
  parameters(Vector6::Constant(0.0));
  fixture.state.inputs.floats[0] = 1.5F;
  command(17);
  EXPECT_EQ(fixture.state.payload.mass, 1.5);
  command(8);
  expect_running();
}

// Commands that are processed in every cycle leave the script ready; each must run at least once without an
// error.
TEST_F(ControlScriptTest, ProcessesTheCommandsOfNewerControllers)
{
  for (const std::int32_t id : {26, 27, 38, 58, 67, 68, 69, 70, 71}) {
    fixture.state.inputs.integers[0] = id;
    fixture.cycles(3);
    EXPECT_EQ(fixture.machine->status(), urscript::MachineStatus::running)
        << id << ": " << fixture.machine->error().message;
    fixture.state.inputs.integers[0] = 0;
    fixture.cycles(2);
  }
  EXPECT_EQ(output(0), 1);
}

TEST_F(ControlScriptTest, EndsOnCommand)
{
  fixture.state.inputs.integers[0] = 255;
  fixture.finish(0.1);
  EXPECT_EQ(fixture.machine->status(), urscript::MachineStatus::finished);
}

TEST_F(ControlScriptTest, ARejectedCommandEndsItWithAReason)
{
  for (const std::int32_t command : {18, 0, 1}) {  // teach mode, end of teach mode, movej
    fixture.state.inputs.integers[0] = command;
    fixture.cycles(10);
  }
  EXPECT_EQ(fixture.machine->status(), urscript::MachineStatus::failed);
  EXPECT_NE(fixture.machine->error().message.find("freedrive"), std::string::npos)
      << fixture.machine->error().message;
}

TEST_F(ControlScriptTest, RunsWithInjectedOffsetsOfAnEarlierUploadToo)
{
  // After two uploads "0" becomes "00"; the upper register range inserts 24.
  fixture.run(uploaded_script("00"));
  fixture.cycles(3);
  expect_running();
}

TEST_F(ControlScriptTest, UsesFewInstructions)
{
  Vector6 target = fixture.state.target.position;
  parameters(target, {0.5, 0.5, 0.002, 0.1, 300.0});
  fixture.state.inputs.integers[0] = 11;
  fixture.cycles(10);
  EXPECT_LT(fixture.machine->instructions(), 2500U);
  RecordProperty("instructions", static_cast<int>(fixture.machine->instructions()));
}

TEST_F(ControlScriptTest, TakesTheLimitsOfTheLookaheadTime)
{
  for (const double limit : {0.03, 0.2}) {
    parameters(fixture.state.target.position, {0.5, 0.5, 0.002, limit, 300.0, 0.0});
    fixture.state.inputs.integers[0] = 11;
    fixture.cycles(10);
    expect_running();
  }
}

TEST_F(ControlScriptTest, ReportsNoCommandAsDoneThatReplacesAnother)
{
  constexpr std::int32_t get_step_time = 26;
  constexpr std::int32_t move_l = 3;
  Vector6 target = fixture.state.target_tcp_pose;
  target[2] -= 0.1;
  fixture.state.inputs.integers[0] = get_step_time;
  fixture.cycle();
  EXPECT_EQ(output(0), 2);
  parameters(target, {0.1, 0.5});
  fixture.state.inputs.integers[1] = 0;
  fixture.state.inputs.integers[0] = move_l;  // its caller did not wait
  fixture.until([&] { return output(0) == 2 && output(3) % 256 == move_l; });
  EXPECT_LT((fixture.state.target_tcp_pose - target).norm(), 1e-4) << "done before its end";
  expect_running();
}

TEST_F(ControlScriptTest, MovesDuringAStop)
{
  constexpr std::int32_t move_j = 1;
  constexpr std::int32_t stop_j = 34;
  Vector6 target = fixture.state.target.position;
  target[0] += 1.0;
  const auto begin_to_stop = [&](double deceleration) {
    parameters(Vector6::Constant(deceleration));
    fixture.state.inputs.integers[1] = 1;
    command(stop_j);
  };
  const auto begin_to_move = [&] {
    parameters(target, {0.5, 2.0});
    fixture.state.inputs.integers[1] = 1;
    command(move_j);
    fixture.cycles(250);
    EXPECT_GT(fixture.state.target.velocity[0], 0.3);
  };
  begin_to_move();
  begin_to_stop(0.1);
  begin_to_move();
  begin_to_stop(5.0);
  fixture.cycles(100);
  EXPECT_LT(fixture.state.target.velocity.norm(), 1e-9) << "the move goes on";
  expect_running();
}

struct ContactDuringMotionTest : ControlScriptTest {
  double contact_height = 0.0;

  /// Puts a table below the tool and starts the contact detection.
  void SetUp() override
  {
    constexpr std::int32_t start_contact_detection = 62;
    constexpr double distance = 0.02;
    ControlScriptTest::SetUp();
    Surface table;
    table.point = fixture.state.actual_tcp_pose.head<3>() - distance * Vector3::UnitZ();
    fixture.world.surfaces().add(table);
    contact_height = fixture.state.actual_tcp_pose[2] - distance;
    parameters((Vector6() << 0.0, 0.0, -1.0, 0.0, 0.0, 0.0).finished());
    command(start_contact_detection);
  }

  void begin_to_move_into_the_table()
  {
    constexpr std::int32_t move_l = 3;
    Vector6 target = fixture.state.target_tcp_pose;
    target[2] -= 0.06;
    parameters(target, {0.05, 0.5});
    fixture.state.inputs.integers[1] = 1;
    command(move_l);
  }

  void wait_for_contact()
  {
    const auto & messages = fixture.host.messages;
    fixture.until([&] { return std::count(messages.begin(), messages.end(), "contact_thread finished") > 0; },
                  5.0);
  }
};

TEST_F(ContactDuringMotionTest, EndsAStream)
{
  constexpr std::int32_t speed_l = 10;
  constexpr std::int32_t speed_stop = 15;
  constexpr std::int32_t get_step_time = 26;
  const Vector6 down = (Vector6() << 0.0, 0.0, -0.05, 0.0, 0.0, 0.0).finished();
  parameters(down, {0.5, 0.0});
  fixture.state.inputs.integers[0] = speed_l;
  wait_for_contact();
  fixture.cycles(1500);  // the command stays in the register
  EXPECT_NEAR(fixture.state.target_tcp_pose[2], contact_height, 2e-3);
  EXPECT_LT(fixture.state.target_tcp_speed.norm(), 1e-9);

  command(get_step_time);
  parameters(down, {0.5, 0.0});
  fixture.state.inputs.integers[0] = speed_l;
  fixture.cycles(200);
  EXPECT_LT(fixture.state.target_tcp_speed.norm(), 1e-9) << "another command does not revive the stream";

  parameters(Vector6::Constant(2.0));  // its deceleration
  command(speed_stop);
  parameters(-down, {0.5, 0.0});
  fixture.state.inputs.integers[0] = speed_l;
  fixture.cycles(200);
  EXPECT_NEAR(fixture.state.target_tcp_speed[2], 0.05, 1e-3) << "the next stream";
  expect_running();
}

TEST_F(ContactDuringMotionTest, IsNoticedDuringACommand)
{
  constexpr std::int32_t read_contact_detection = 64;
  begin_to_move_into_the_table();

  // A late host clears its command only long after the contact.
  fixture.state.inputs.integers[0] = read_contact_detection;
  wait_for_contact();
  fixture.cycles(100);
  EXPECT_GT(fixture.state.target_tcp_pose[2], contact_height - 4e-3) << "the arm waits for the host";
  fixture.state.inputs.integers[0] = 0;
  fixture.cycles(1500);
  EXPECT_NEAR(fixture.state.target_tcp_pose[2], contact_height, 1e-3);
  expect_running();
}

TEST_F(ContactDuringMotionTest, IsNoticedInForceMode)
{
  constexpr std::int32_t force_mode = 6;
  parameters(Vector6::Zero(), {0.0, 0.0, -20.0, 0.0, 0.0, 0.0, 0.1, 0.1, 0.05, 0.2, 0.2, 0.2});
  fixture.state.inputs.integers = {force_mode, 2, 0, 0, 1, 0, 0, 0};
  wait_for_contact();
  fixture.cycles(2);
  EXPECT_EQ(
      std::count(fixture.host.messages.begin(), fixture.host.messages.end(), "cmd == 254 - contact detected"),
      1);
  expect_running();
}

TEST_F(ContactDuringMotionTest, KeepsTheScriptResponsive)
{
  constexpr std::int32_t stop_l = 33;
  begin_to_move_into_the_table();
  wait_for_contact();
  const auto moving = [&] { return fixture.state.target_tcp_speed.norm() > 1e-4; };
  int heartbeat = output(3) / 256;
  for (int cycle = 0; cycle < 20; ++cycle) {
    fixture.cycle();
    EXPECT_NE(output(3) / 256, std::exchange(heartbeat, output(3) / 256));
    EXPECT_EQ(output(0), 1) << "the contact is no command whose caller waits";
  }
  EXPECT_TRUE(moving()) << "back to the contact";
  EXPECT_NE(output(2) & 32768, 0) << "as an asynchronous operation";
  parameters(Vector6::Constant(2.0));
  fixture.state.inputs.integers[1] = 1;
  command(stop_l);
  fixture.cycles(50);
  EXPECT_FALSE(moving());
  expect_running();
}

}  // namespace
}  // namespace ur_simulator
