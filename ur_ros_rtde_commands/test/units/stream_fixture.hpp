#pragma once

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <ur_simulator/simulated_controller.hpp>
#include <utility>

#include "ur_ros_rtde/run.hpp"

namespace ur_ros_rtde::test {

using namespace std::chrono_literals;

/// Of the simulated robot, so that delays of a busy host are short in its time.
constexpr double slowness = 5.0;

/// The loopback address of this test.
inline std::string address()
{
  const char * given = std::getenv("UR_TEST_ADDRESS");
  return given != nullptr ? given : "127.14.3.8";
}

inline ur_simulator::SimulatorOptions simulator_options()
{
  ur_simulator::SimulatorOptions options;
  options.address = address();
  options.initial_joints = std::array<double, 6>{0.0, -1.57, 1.57, -1.57, -1.57, 0.0};
  if (const char * factor = std::getenv("UR_TEST_REAL_TIME_FACTOR")) {
    options.real_time_factor = std::strtod(factor, nullptr);
  }
  options.real_time_factor /= slowness;
  return options;
}

inline RobotOptions robot_options()
{
  RobotOptions options;
  options.address = address();
  options.silence_limit = 2000ms;
  options.watchdog_frequency = 1.0;
  return options;
}

inline bool eventually(const std::function<bool()> & condition)
{
  const auto deadline = std::chrono::steady_clock::now() + 30s;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) {
      return false;
    }
    std::this_thread::sleep_for(1ms);
  }
  return true;
}

/// A goal that holds the arm of a simulated robot.
struct StreamFixture : testing::Test {
  void SetUp() override
  {
    robot.start();
    const Status ready = robot.wait_until_ready(30s);
    ASSERT_TRUE(ready) << ready.error().message;
    auto granted = robot.acquire({.resource = Resource::motion, .owner = "/test", .id = "1"});
    ASSERT_TRUE(granted) << granted.error().message;
    lease = std::move(*granted);
    run.emplace(RunContext{robot, stop_request, &lease});
  }

  ur_simulator::SimulatedController controller{simulator_options()};
  Robot robot{robot_options()};
  std::shared_ptr<StopRequest> stop_request = std::make_shared<StopRequest>();
  Lease lease;
  std::optional<ur_ros_rtde::Run> run;
};

}  // namespace ur_ros_rtde::test
