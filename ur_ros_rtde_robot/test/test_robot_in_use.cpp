#include "robot_fixture.hpp"

namespace ur_ros_rtde::test {
namespace {

/// A driver that has the robot, and a second one that starts later.
struct SecondDriverTest : RobotFixture {
  Log log_of_second;
  std::unique_ptr<Robot> second;

  void make_second(bool upper_range = false)
  {
    auto options = robot_options();
    options.upper_range_registers = upper_range;
    second = std::make_unique<Robot>(options, log_of_second.function());
    second->start();
  }
  bool second_is(RobotState state, ErrorCode cause = ErrorCode::none)
  {
    return eventually([&] { return second->status().state == state && second->status().cause == cause; },
                      10s);
  }
  std::string told() const { return second->status().message + "\n" + log_of_second.text(); }
};

TEST_F(SecondDriverTest, IsRejectedWithTheInputsInUseUntilTheFirstEnds)
{
  make_both();
  move_joints();
  make_second();
  ASSERT_TRUE(second_is(RobotState::stopped, ErrorCode::robot_in_use)) << told();
  const auto message = second->status().message;
  for (const auto & part :
       std::vector<std::string>{own_address(), "input_int_register_23", "another driver"}) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  }
  EXPECT_EQ(second->ready_to_move().error().code, ErrorCode::robot_in_use);
  EXPECT_THROW(second->control_for_queries(), RobotError);
  EXPECT_GT(std::abs(robot->latest()->actual_qd[0]), 0.7) << "the first one's motion goes on";
  EXPECT_TRUE(eventually([&] { return log_of_second.count("are in use") > 0; })) << told();
  ASSERT_TRUE(robot->stop_motion());
  EXPECT_EQ(log_of_second.count("are in use"), 1U) << told();
  robot.reset();
  EXPECT_TRUE(second_is(RobotState::ready)) << told();
}

TEST_F(SecondDriverTest, IsRejectedInTheOtherRegisterRange)
{
  make_both();
  make_second(true);
  ASSERT_TRUE(second_is(RobotState::stopped, ErrorCode::robot_in_use)) << told();
  EXPECT_NE(told().find("standard_digital_output"), std::string::npos) << told();
  EXPECT_EQ(told().find("register_range"), std::string::npos) << "that would not help: " << told();
}

TEST_F(SecondDriverTest, StopsTheProgramOfTheFirstIfAsked)
{
  make_both();
  make_second();
  ASSERT_TRUE(second_is(RobotState::stopped, ErrorCode::robot_in_use)) << told();
  EXPECT_TRUE(second->stop_motion()) << "the end of a goal or of the driver leaves it alone";
  EXPECT_EQ(controller.state().at("program").at("state"), "PLAYING");
  StopOptions options;
  options.ends_foreign_program = true;
  const auto report = second->stop_motion(options);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->means, StopMeans::program_stopped);
  EXPECT_TRUE(becomes_ready()) << "the first driver starts its program again";
}

TEST_F(SecondDriverTest, DoesNotStopTheFirstWhenThatLosesAConnection)
{
  make_both();
  make_second();
  ASSERT_TRUE(second_is(RobotState::stopped, ErrorCode::robot_in_use)) << told();
  move_joints();
  for (int i = 0; i < 5; ++i) {
    controller.control({{"command", "drop_links"}, {"which", "rtde"}, {"clients", "io"}});
    ASSERT_TRUE(becomes_ready());
  }
  EXPECT_GT(std::abs(robot->latest()->actual_qd[0]), 0.7) << log.text();
  EXPECT_NE(second->status().state, RobotState::ready);
  EXPECT_EQ(controller.state().at("program").at("state"), "PLAYING");
}

TEST_F(SecondDriverTest, LeavesTheProgramOfTheFirstAlone)
{
  controller.start();
  controller.control({{"command", "fieldbus"}});
  make_robot();
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::robot_in_use));
  controller.control(
      {{"command", "run_script"}, {"script", "def others():\n  while True:\n    sync()\n  end\nend\n"}});
  ASSERT_TRUE(eventually([&] { return robot->latest() && robot->latest()->is_program_running(); }));
  controller.control({{"command", "fieldbus"}, {"on", false}});
  ASSERT_TRUE(eventually([&] {
    return robot->status().message.find("but not its program") != std::string::npos;
  })) << log.text();
  EXPECT_EQ(controller.state().at("program").at("state"), "PLAYING");
  controller.control({{"command", "stop_program"}});
  EXPECT_TRUE(becomes_ready());
}

using FieldbusTest = RobotFixture;

TEST_F(FieldbusTest, IsReportedWithARemedyWhenItHasTheLowerRegisters)
{
  controller.start();
  controller.control({{"command", "fieldbus"}});
  make_robot();
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::robot_in_use));
  const auto message = robot->status().message;
  for (const char * part : {"input_int_register_18", "EtherNet/IP", "register_range:=upper (now lower)"}) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  }
  EXPECT_EQ(log.count("are in use"), 1U) << log.text();
  controller.control({{"command", "fieldbus"}, {"on", false}});
  EXPECT_TRUE(becomes_ready());
}

TEST_F(FieldbusTest, LeavesTheUpperRegistersToTheDriver)
{
  controller.start();
  controller.control({{"command", "fieldbus"}});
  auto options = robot_options();
  options.upper_range_registers = true;
  make_robot(options);
  ASSERT_TRUE(becomes_ready());
  move_joints();
  EXPECT_TRUE(robot->stop_motion());
}

}  // namespace
}  // namespace ur_ros_rtde::test
