#include "robot_fixture.hpp"

#include <algorithm>
#include <cmath>

namespace ur_ros_rtde::test {

void RobotFixture::make_robot(RobotOptions options)
{
  robot = std::make_unique<Robot>(std::move(options), log.function());
  robot->on_status([this](const RobotStatus & status) {
    const std::lock_guard lock(mutex);
    statuses.push_back(status);
    status_times.push_back(std::chrono::steady_clock::now());
  });
  robot->on_sample([this](const Sample & sample) {
    if (on_sample) {
      on_sample(sample);
    }
    if (recording) {
      const std::lock_guard lock(mutex);
      samples.push_back(sample);
    }
  });
  robot->start();
}

void RobotFixture::make_both(const RobotOptions & options)
{
  controller.start();
  make_robot(options);
  ASSERT_TRUE(becomes_ready());
}

void RobotFixture::make_both_slow(const RobotOptions & options)
{
  controller.start(Controller::slow_options());
  make_robot(options);
  ASSERT_TRUE(becomes_ready());
}

testing::AssertionResult RobotFixture::comes_to(RobotState state, ErrorCode cause,
                                                std::chrono::milliseconds timeout)
{
  const auto there = [&] {
    const auto now = robot->status();
    return now.state == state && (cause == ErrorCode::none || now.cause == cause);
  };
  if (eventually(there, timeout)) {
    return testing::AssertionSuccess();
  }
  const auto now = robot->status();
  return testing::AssertionFailure() << "the robot is " << to_string(now.state) << " ("
                                     << to_string(now.cause) << ": " << now.message << "), not "
                                     << to_string(state) << ". It said:\n"
                                     << log.text();
}

testing::AssertionResult RobotFixture::becomes_ready_again(std::size_t times)
{
  const auto count = [this] {
    const std::lock_guard lock(mutex);
    return std::count_if(statuses.begin(), statuses.end(),
                         [](const RobotStatus & status) { return status.state == RobotState::ready; });
  };
  if (!eventually([&] { return static_cast<std::size_t>(count()) >= times; }, 20s)) {
    return testing::AssertionFailure() << "it was ready " << count() << " times. It said:\n" << log.text();
  }
  return becomes_ready();
}

Locked<ur_rtde::RTDEControlInterface> RobotFixture::control()
{
  holder_ = acquire();
  return robot->control(holder_);
}

Lease RobotFixture::acquire(Resource resource)
{
  holder_ = {};
  auto lease = robot->acquire(claim(resource));
  EXPECT_TRUE(lease) << lease.error().message << "\n" << log.text();
  return lease ? std::move(*lease) : Lease();
}

/// The robot, not the arbiter, decides whether a script can run.
ScriptReport RobotFixture::run_script(const std::string & script, const ScriptOptions & options)
{
  holder_ = {};
  const auto lease =
      robot->acquire(claim(options.kind == ScriptKind::secondary ? Resource::none : Resource::script));
  ScriptReport rejected;
  if (!lease) {
    rejected.error = lease.error();
  }
  return lease ? robot->run_script(*lease, script, options) : rejected;
}

Status RobotFixture::run_extension(const std::string & name, const ExtensionOptions & options)
{
  Lease lease = acquire();
  return robot->run_extension(lease, name, options);
}

void RobotFixture::move_joints()
{
  auto q = robot->receive()->getActualQ();
  q[0] += 3.0;
  ASSERT_TRUE(control()->moveJ(q, 0.8, 2.0, true)) << log.text();
  ASSERT_TRUE(eventually([&] { return std::abs(robot->latest()->actual_qd[0]) > 0.7; })) << log.text();
}

void RobotFixture::move_linear()
{
  auto pose = robot->receive()->getActualTCPPose();
  pose[2] += 0.2;
  ASSERT_TRUE(control()->moveL(pose, 0.1, 1.0, true)) << log.text();
  ASSERT_TRUE(eventually([&] { return robot->latest()->actual_tcp_speed[2] > 0.09; })) << log.text();
}

std::vector<Sample> RobotFixture::recorded()
{
  const std::lock_guard lock(mutex);
  return samples;
}

double RobotFixture::recorded_rest()
{
  const auto is_at_rest = [](const Sample & sample) {
    return std::ranges::all_of(sample.target_qd, [](double velocity) { return std::abs(velocity) < 1e-6; });
  };
  double time = 0.0;
  EXPECT_TRUE(eventually([&] {
    const auto all = recorded();
    const auto found = std::ranges::find_if(all, is_at_rest);
    time = found != all.end() ? found->controller_time : 0.0;
    return found != all.end();
  }));
  return time;
}

double RobotFixture::highest_deceleration(std::size_t index)
{
  const auto all = recorded();
  double highest = 0.0;
  for (std::size_t begin = 0, end = 0; end < all.size(); ++end) {
    while (all[end].controller_time - all[begin].controller_time > 0.0105) {
      ++begin;
    }
    const double duration = all[end].controller_time - all[begin].controller_time;
    if (duration > 0.0095) {
      const double slower = std::abs(all[begin].target_qd[index]) - std::abs(all[end].target_qd[index]);
      highest = std::max(highest, slower / duration);
    }
  }
  return highest;
}

}  // namespace ur_ros_rtde::test
