// Measures the time from sending a goal to its first RTDE command, and from a cancel request to the start of
// the deceleration. The client is another process.
//
//     bench_goals <address of a simulator or a robot whose arm may move> [repetitions]
//
// The client is forked before ROS is initialized. Times are those of CLOCK_MONOTONIC, which both processes
// share. A field of the goal contains the time at which it was sent.

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <mutex>
#include <rcl_cxx/rcl_cxx.hpp>
#include <rcl_cxx_test/action_client.hpp>
#include <thread>
#include <ur_ros_rtde_msgs/action/move_j.hpp>
#include <ur_ros_rtde_msgs/action/set_speed_slider.hpp>

#include "ur_ros_rtde/command.hpp"

namespace {

using std::chrono_literals::operator""s;
using std::chrono_literals::operator""ms;
using ur_ros_rtde::Outcome;
using ur_ros_rtde_msgs::action::MoveJ;
using ur_ros_rtde_msgs::action::SetSpeedSlider;

double now()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void print(const char * what, std::vector<double> seconds)
{
  if (seconds.empty()) {
    fmt::print("{:36} nothing measured\n", what);
    return;
  }
  std::sort(seconds.begin(), seconds.end());
  const auto at = [&](double part) {
    return 1e3 * seconds[static_cast<std::size_t>(part * double(seconds.size() - 1))];
  };
  fmt::print("{:36} p50 {:7.3f} ms   p99 {:7.3f} ms   worst {:7.3f} ms   of {}\n", what, at(0.5), at(0.99),
             at(1.0), seconds.size());
}

/// `fraction` is the time at which the client sent the goal.
class Timed : public ur_ros_rtde::Command<SetSpeedSlider> {
 public:
  std::vector<double> seconds;

 private:
  ur_ros_rtde::CommandTraits traits() const override { return {.resource = ur_ros_rtde::Resource::none}; }
  Outcome run(const Goal & goal, Run & run) override
  {
    const auto io = run.io();
    seconds.push_back(now() - goal.fraction);
    io->setSpeedSlider(1.0);
    return Outcome::success();
  }
};

/// Swings the base until it is canceled.
class Swing : public ur_ros_rtde::Command<MoveJ> {
  Outcome run(const Goal & goal, Run & run) override
  {
    auto target = run.receive()->getActualQ();
    target[0] += target[0] > 0.0 ? -3.0 : 3.0;
    run.control()->moveJ(target, goal.speed, 2.0, true);
    return run.until_motion_ends();
  }
};

/// The highest target speed of all joints, with the time at which the package was received.
class Speeds {
 public:
  void add(const ur_ros_rtde::Sample & sample)
  {
    double speed = 0.0;
    for (const double joint : sample.target_qd) {
      speed = std::max(speed, std::abs(joint));
    }
    const std::lock_guard lock(mutex_);
    all_.emplace_back(std::chrono::duration<double>(sample.received.time_since_epoch()).count(), speed);
  }

  /// s from `begin` until the speed first decreases. NaN if it does not.
  double time_to_deceleration(double begin) const
  {
    const std::lock_guard lock(mutex_);
    for (std::size_t i = 1; i < all_.size(); ++i) {
      if (all_[i].first > begin && all_[i].second < all_[i - 1].second - 1e-4) {
        return all_[i].first - begin;
      }
    }
    return NAN;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::pair<double, double>> all_;
};

/// The client process. Sends goals one after the other, and writes the times of its cancel requests to
/// `pipe`.
int client(int repetitions, int pipe)
{
  auto context = std::make_shared<rcl_cxx::Context>(std::vector<std::string>{"bench_client"});
  rcl_cxx::Node node(context, "bench_client");
  rcl_cxx::Executor executor(context);
  executor.add_node(node);
  std::jthread spinner([&executor] { executor.spin(); });
  {
    auto timed = rcl_cxx::create_action_client<SetSpeedSlider>(node, "bench_timed");
    auto swing = rcl_cxx::create_action_client<MoveJ>(node, "bench_swing");
    if (!timed->wait_for_action_server(20s) || !swing->wait_for_action_server(20s)) {
      fmt::print(stderr, "the action servers were not discovered\n");
      std::_Exit(1);
    }
    for (int i = 0; i < repetitions; ++i) {
      SetSpeedSlider::Goal goal;
      goal.fraction = now();
      timed->send_goal(goal, 5s);
      std::this_thread::sleep_for(5ms);
    }
    for (int i = 0; i < std::max(repetitions / 20, 3); ++i) {
      MoveJ::Goal goal;
      goal.speed = 0.8;
      const auto handle = swing->async_send_goal(goal).get();
      if (!handle) {
        continue;
      }
      std::this_thread::sleep_for(900ms);  // the arm is at its speed
      const double canceled = now();
      handle->async_cancel();
      handle->async_get_result().wait_for(10s);
      if (::write(pipe, &canceled, sizeof(canceled)) != sizeof(canceled)) {
        break;
      }
    }
  }
  context->shutdown("done");
  return 0;
}

int serve(const std::string & address, int pipe)
{
  auto context = std::make_shared<rcl_cxx::Context>(std::vector<std::string>{"bench_server"});
  rcl_cxx::Node node(context, "bench_server");
  Speeds speeds;
  ur_ros_rtde::RobotOptions options;
  options.address = address;
  ur_ros_rtde::Robot robot(options);
  robot.on_sample([&speeds](const ur_ros_rtde::Sample & sample) { speeds.add(sample); });
  robot.start();
  const auto ready = robot.wait_until_ready(20s);
  if (!ready) {
    fmt::print(stderr, "{}\n", ready.error().message);
    return 1;
  }
  ur_ros_rtde::CommandHost host(node, robot, {});
  Timed timed;
  Swing swing;
  timed.start_action_server(host, "bench_timed");
  swing.start_action_server(host, "bench_swing");
  rcl_cxx::Executor executor(context);
  executor.add_node(node);
  std::jthread spinner([&executor] { executor.spin(); });

  std::vector<double> cancels;
  for (double canceled = 0.0; ::read(pipe, &canceled, sizeof(canceled)) == sizeof(canceled);) {
    cancels.push_back(speeds.time_to_deceleration(canceled));
  }
  print("goal sent -> first RTDE command", timed.seconds);
  print("cancel sent -> the arm decelerates", cancels);
  host.goal_threads().close(ur_ros_rtde::Error{ur_ros_rtde::ErrorCode::shutdown, "done"}, 5s);
  timed.stop_action_server();
  swing.stop_action_server();
  context->shutdown("done");
  return 0;
}

}  // namespace

int main(int argc, char ** argv)
{
  if (argc < 2) {
    fmt::print(stderr, "usage: {} <address> [repetitions]\n", argv[0]);
    return 2;
  }
  const int repetitions = argc > 2 ? std::atoi(argv[2]) : 200;
  int ends[2];
  if (::pipe(ends) != 0) {
    return 1;
  }
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(ends[0]);
    return client(repetitions, ends[1]);
  }
  ::close(ends[1]);
  const int result = serve(argv[1], ends[0]);
  ::waitpid(child, nullptr, 0);
  return result;
}
