// All functions that use registers, in the upper range, while a fieldbus uses the lower range.
#include <algorithm>
#include <cmath>

#include "robot_fixture.hpp"

namespace ur_ros_rtde::test {
namespace {

struct RangeCase {
  const char * model;
  const char * polyscope;
};

struct UpperRangeTest : RobotFixture, testing::WithParamInterface<RangeCase> {
  void SetUp() override
  {
    auto simulator = Controller::options();
    simulator.model = GetParam().model;
    simulator.polyscope_version = GetParam().polyscope;
    controller.start(simulator);
    controller.control({{"command", "fieldbus"}});
    auto options = robot_options();
    options.upper_range_registers = true;
    robot = std::make_unique<Robot>(options, log.function());
    ScriptExtension adds;
    adds.name = "adds";
    adds.snippet = "$out13i($in19i + 1)\n$out14f($in20f * 2.0)\n";
    ScriptExtension turns;
    turns.name = "turns";
    turns.snippet = "speedj([0.5, 0, 0, 0, 0, 0], 2.0, 5.0)\n";
    ASSERT_EQ(robot->set_extensions({adds, turns}), std::vector<std::string>());
    robot->start();
    ASSERT_TRUE(becomes_ready());
  }

  double robot_time() { return controller.state().at("timestamp").get<double>(); }
  bool turning() { return std::abs(robot->latest()->actual_qd[0]) > 0.4; }
};

TEST_P(UpperRangeTest, SupportsMotionsAndStops)
{
  const auto mark = robot->mark_motion();
  auto q = robot->receive()->getActualQ();
  q[5] += 0.1;
  ASSERT_TRUE(control()->moveJ(q, 1.0, 3.0, true));
  ASSERT_TRUE(eventually([&] { return robot->motion_progress(mark).finished(); }));
  EXPECT_NEAR(robot->latest()->actual_q[5], q[5], 1e-3);
  move_joints();
  EXPECT_TRUE(robot->stop_motion());
  EXPECT_EQ(robot->control_for_queries()->getTCPOffset().size(), 6U);
  EXPECT_THROW(robot->control_for_queries()->getMassMatrix(), std::logic_error)
      << "the mass matrix needs both ranges";
}

TEST_P(UpperRangeTest, SupportsExtensionsWithParametersAndResults)
{
  ASSERT_TRUE(robot->set_input_register(19, 41));
  ASSERT_TRUE(robot->set_input_register(20, 1.25));
  const auto ran = run_extension("adds");
  ASSERT_TRUE(ran) << ran.error().message;
  EXPECT_EQ(robot->latest()->output_int_registers[1], 42);
  EXPECT_EQ(robot->latest()->output_double_registers[2], 2.5);
}

TEST_P(UpperRangeTest, EndsAnExtensionThatMovesTheArm)
{
  ExtensionOptions options;
  options.stop_reason = [&]() -> std::optional<Error> {
    return turning() ? std::optional(Error{ErrorCode::canceled, "enough"}) : std::nullopt;
  };
  EXPECT_EQ(run_extension("turns", options).error().code, ErrorCode::canceled);
  EXPECT_TRUE(eventually([&] { return at_rest(); }));
}

TEST_P(UpperRangeTest, SupportsScriptsWithTheirWatchdog)
{
  EXPECT_TRUE(run_script("textmsg(\"here\")"));
  EXPECT_TRUE(becomes_ready());
}

TEST_P(UpperRangeTest, SupportsTheWatchdog)
{
  ASSERT_TRUE(control()->speedJ({0.5, 0.0, 0.0, 0.0, 0.0, 0.0}, 2.0, 0.0));
  ASSERT_TRUE(eventually([&] { return turning(); }));
  const double begin = robot_time();
  ASSERT_TRUE(eventually([&] { return robot_time() > begin + 1.5; })) << "longer than the watchdog's timeout";
  ASSERT_TRUE(turning()) << log.text();
  controller.control({{"command", "stall_links"}});  // ends the heartbeat without closing a connection
  const auto speed = [&] {
    return std::abs(controller.state().at("actual").at("velocity").at(0).get<double>());
  };
  EXPECT_TRUE(eventually([&] { return speed() < 0.01; }));
  EXPECT_TRUE(eventually([&] { return controller.state().at("program").at("state") == "STOPPED"; }));
  controller.control({{"command", "stall_links"}, {"stalled", false}});
}

TEST_P(UpperRangeTest, DoesNotWriteTheLowerRegisters)
{
  move_joints();
  ASSERT_TRUE(robot->stop_motion());
  ASSERT_TRUE(run_extension("adds"));
  const auto all = controller.control({{"command", "registers"}});
  for (const char * direction : {"inputs", "outputs"}) {
    for (const char * kind : {"integers", "doubles"}) {
      const auto & values = all.at(direction).at(kind);
      for (std::size_t number = 0; number < 24; ++number) {
        EXPECT_EQ(values.at(number), 0) << direction << " " << kind << " " << number;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(OfVersions, UpperRangeTest,
                         testing::Values(RangeCase{"ur10", "3.15.8"}, RangeCase{"ur10e", "5.13.0"},
                                         RangeCase{"ur10e", "5.21.0"}, RangeCase{"ur10e", "5.25.1"}),
                         [](const auto & one) {
                           std::string name = one.param.polyscope;
                           std::replace(name.begin(), name.end(), '.', '_');
                           return name;
                         });

}  // namespace
}  // namespace ur_ros_rtde::test
