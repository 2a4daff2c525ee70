#include <ur_rtde/rtde_receive_interface.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <stdexcept>

#include "state_receiver_fixture.hpp"

namespace ur_ros_rtde::test {
namespace {

using Clock = std::chrono::steady_clock;

TEST_F(StateReceiverTest, ReceivesEveryPackageInControllerTime)
{
  controller.start();
  std::mutex mutex;
  std::vector<double> times;
  StateReceiver receiver(receiver_options(), log.function());
  receiver.on_sample([&](const Sample & sample) {
    const std::lock_guard lock(mutex);
    times.push_back(sample.controller_time);
  });
  receiver.start();
  ASSERT_TRUE(eventually([&] {
    const std::lock_guard lock(mutex);
    return times.size() > 500;
  }));
  const std::lock_guard lock(mutex);
  std::vector<double> intervals;
  for (std::size_t i = 1; i < times.size(); ++i) {
    ASSERT_GT(times[i], times[i - 1]);
    intervals.push_back(times[i] - times[i - 1]);
  }
  // If the host is late, ur_rtde uses the newest of several packages, so that some intervals exceed one
  // cycle.
  std::nth_element(intervals.begin(), intervals.begin() + 250, intervals.end());
  EXPECT_NEAR(intervals[250], 0.002, 1e-9);
}

TEST_F(StateReceiverTest, FillsASampleWithTheRobotsState)
{
  controller.start();
  const auto receiver = this->receiver();
  ASSERT_TRUE(connected(*receiver));
  const auto sample = *receiver->latest();
  const auto state = controller.state();
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(sample.actual_q[i], state.at("actual").at("position").at(i).get<double>(), 1e-3);
    EXPECT_NEAR(sample.actual_tcp_pose[i], state.at("actual_tcp_pose").at(i).get<double>(), 1e-3);
    EXPECT_TRUE(std::isfinite(sample.joint_temperatures[i]));
    EXPECT_TRUE(std::isfinite(sample.ft_raw_wrench[i]));
  }
  EXPECT_EQ(sample.robot_mode, RobotMode::running);
  EXPECT_EQ(sample.safety_mode, SafetyMode::normal);
  EXPECT_TRUE(sample.safety().normal_mode);
  EXPECT_TRUE(sample.is_powered_on());
  EXPECT_TRUE(std::isfinite(sample.payload));
  const auto age = std::chrono::system_clock::now() - sample.stamp;
  EXPECT_LT(std::abs(std::chrono::duration<double>(age).count()), 1.0);
}

/// A push at the TCP has no moment about it, but RTDE's actual_TCP_force of an e-Series is that at the
/// flange.
TEST_F(StateReceiverTest, MovesTheWrenchOfAnESeriesToTheTcp)
{
  for (const auto & [model, version] : {std::pair{"ur10e", "5.12.0"}, std::pair{"ur10", "3.15.8"}}) {
    auto simulator = Controller::options();
    simulator.model = model;
    simulator.polyscope_version = version;
    controller.start(simulator);
    controller.control(
        {{"command", "run_script"}, {"script", "def tool():\n  set_tcp(p[0, 0, 0.2, 0, 0, 0])\nend"}});
    auto robot = receiver();
    ASSERT_TRUE(connected(*robot));
    controller.control({{"command", "push"}, {"force", {0.0, 40.0, 0.0}}, {"duration", 8.0}});
    ASSERT_TRUE(eventually([&] { return robot->latest()->actual_tcp_force[1] > 20.0; })) << model;
    const auto sample = *robot->latest();
    EXPECT_NEAR(sample.tcp_offset[2], 0.2, 1e-9);
    for (const int axis : {3, 4, 5}) {
      EXPECT_NEAR(sample.actual_tcp_force[static_cast<std::size_t>(axis)], 0.0, 1.0)
          << model << ": of 4 Nm at the flange";
    }
    robot.reset();
    controller.stop();
  }
}

TEST_F(StateReceiverTest, ReceivesAtTheRequestedFrequency)
{
  controller.start();
  auto options = receiver_options();
  options.frequency = 50.0;
  const auto receiver = this->receiver(options);
  ASSERT_TRUE(connected(*receiver));
  EXPECT_DOUBLE_EQ(receiver->frequency(), 50.0);
  Sample sample = *receiver->latest();
  double shortest = 1.0;
  for (int i = 0; i < 20; ++i) {
    const double before = sample.controller_time;
    ASSERT_TRUE(receiver->wait_for_next(sample, 5s));
    shortest = std::min(shortest, sample.controller_time - before);
  }
  EXPECT_NEAR(shortest, 0.02, 1e-9);
}

TEST_F(StateReceiverTest, DoesNotMistakeALowFrequencyForSilence)
{
  controller.start();
  auto options = receiver_options();
  options.frequency = 5.0;
  const auto receiver = this->receiver(options);
  ASSERT_TRUE(connected(*receiver));
  Sample sample = *receiver->latest();
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(receiver->wait_for_next(sample, 5s)) << log.text();
  }
  EXPECT_EQ(sample.link, 1U) << log.text();
}

TEST_F(StateReceiverTest, ReducesAFrequencyAboveThatOfACb3WithOneWarning)
{
  auto simulator = Controller::options();
  simulator.model = "ur5";
  simulator.polyscope_version = "3.15.8";
  controller.start(simulator);
  auto options = receiver_options();
  options.frequency = 500.0;
  const auto receiver = this->receiver(options);
  ASSERT_TRUE(connected(*receiver)) << log.text();
  EXPECT_DOUBLE_EQ(receiver->frequency(), 125.0);
  EXPECT_EQ(log.count("using 125 Hz"), 1U) << log.text();
  EXPECT_TRUE(std::isnan(receiver->latest()->ft_raw_wrench[0])) << "a CB3 has no force/torque sensor";
}

TEST_F(StateReceiverTest, RejectsInvalidOptions)
{
  for (const int priority : {-1, 100}) {
    auto options = receiver_options();
    options.realtime_priority = priority;
    EXPECT_THROW(StateReceiver{options}, std::invalid_argument);
  }
  for (const double frequency : {-1.0, 0.5, 501.0, std::nan("")}) {
    auto options = receiver_options();
    options.frequency = frequency;
    EXPECT_THROW(StateReceiver{options}, std::invalid_argument);
  }
  EXPECT_THROW(StateReceiver{StateReceiverOptions{}}, std::invalid_argument);
}

/// The shortest of several reconnections, because a busy host delays some of them.
TEST_F(StateReceiverTest, EndsAWaitWhenStopped)
{
  const auto receiver = this->receiver();
  std::stop_source source;
  std::jthread stopper([&] { source.request_stop(); });
  Sample none{};
  const auto begin = Clock::now();
  EXPECT_FALSE(receiver->wait_for_next(none, 60s, source.get_token()));
  EXPECT_LT(Clock::now() - begin, 10s);
}

TEST_F(StateReceiverTest, RejectsAccessToTheInterfaceWithTheCauseWhileDisconnected)
{
  const auto receiver = this->receiver();
  ASSERT_TRUE(eventually([&] { return log.count("no connection") > 0; }));
  try {
    receiver->receive()->getActualQ();
    FAIL() << "there is no connection";
  } catch (const RobotError & error) {
    EXPECT_EQ(error.error().code, ErrorCode::link_lost);
  }
  controller.start();
  ASSERT_TRUE(connected(*receiver));
  EXPECT_EQ(receiver->receive()->getActualQ().size(), 6U);
}

TEST_F(StateReceiverTest, SupportsTenReceiversOnOneController)
{
  controller.start();
  std::vector<std::unique_ptr<StateReceiver>> receivers;
  for (int i = 0; i < 10; ++i) {
    receivers.push_back(this->receiver());
  }
  for (const auto & receiver : receivers) {
    EXPECT_TRUE(connected(*receiver)) << log.text();
  }
}

}  // namespace
}  // namespace ur_ros_rtde::test
