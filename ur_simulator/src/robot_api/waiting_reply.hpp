#pragma once

#include <functional>

#include "polyscope/pendant.hpp"
#include "robot_api/reply.hpp"

namespace ur_simulator::robot_api {

/// Waits for the condition, and replies with what `reply` returns then. After 60 s of simulated time the
/// reply is 504 (Gateway Timeout).
PendingReply wait_for(const Pendant & pendant, std::function<bool(const Pendant &)> condition,
                      std::function<Reply(const Pendant &)> reply);

}  // namespace ur_simulator::robot_api
