#pragma once

#include <chrono>
#include <rcl_cxx/subscription.hpp>

namespace ur_ros_rtde {

/// Returns whether the publisher of `before` sent nothing for more than `timeout` s on average between it and
/// `next`, the following message that arrived. Messages that were late or lost on their way are no pause of
/// the publisher. True if `next` is from another publisher. Without numbers of messages, lost ones count as
/// not sent.
bool has_paused(const rcl_cxx::MessageInfo & before, const rcl_cxx::MessageInfo & next, double timeout);

/// Returns whether the publisher of both has published its first message after `time`, if it has a fixed
/// rate: the first messages are lost if they come before the discovery. False without numbers of messages.
bool has_begun_since(const rcl_cxx::MessageInfo & before, const rcl_cxx::MessageInfo & next,
                     std::chrono::system_clock::time_point time);

}  // namespace ur_ros_rtde
