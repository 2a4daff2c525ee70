#pragma once

#include <chrono>

#include "ur_ros_rtde_robot/state/state_receiver.hpp"

namespace ur_ros_rtde {

/// Waits until `condition(sample)` holds, starting with the newest sample. False after `timeout` or if the
/// connection is lost.
template <class Condition>
bool wait_until(const StateReceiver & state, std::chrono::milliseconds timeout, Condition condition)
{
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  Sample sample = state.latest().value_or(Sample{});
  while (!condition(sample)) {
    if (!state.link().connected || std::chrono::steady_clock::now() > deadline) {
      return false;
    }
    state.wait_for_next(sample, std::chrono::milliseconds(20));
  }
  return true;
}

}  // namespace ur_ros_rtde
