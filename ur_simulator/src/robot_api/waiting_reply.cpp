#include "robot_api/waiting_reply.hpp"

#include <utility>

namespace ur_simulator::robot_api {
namespace {

constexpr double completion_limit = 60.0;  // s of simulated time

}  // namespace

PendingReply wait_for(const Pendant & pendant, std::function<bool(const Pendant &)> condition,
                      std::function<Reply(const Pendant &)> reply)
{
  const double started = pendant.state().timestamp;
  return [&pendant, started, condition = std::move(condition),
          reply = std::move(reply)]() -> std::optional<Reply> {
    const double elapsed = pendant.state().timestamp - started;
    if (condition(pendant)) {
      return reply(pendant);
    }
    if (elapsed > completion_limit) {
      return error_reply(504, "Gateway Timeout", "the robot did not reach the state in time");
    }
    return std::nullopt;
  };
}

}  // namespace ur_simulator::robot_api
