#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "support.hpp"
#include "ur_ros_rtde_robot/state/state_receiver.hpp"

namespace ur_ros_rtde::test {

/// A controller, not started, and receivers of its state.
struct StateReceiverTest : testing::Test {
  Log log;
  Controller controller;

  std::unique_ptr<StateReceiver> receiver(StateReceiverOptions options = receiver_options())
  {
    auto result = std::make_unique<StateReceiver>(std::move(options), log.function());
    result->start();
    return result;
  }
  static bool connected(const StateReceiver & receiver, std::chrono::milliseconds timeout = 15s)
  {
    return eventually([&] { return receiver.link().connected && receiver.latest(); }, timeout);
  }
};

}  // namespace ur_ros_rtde::test
