#pragma once

#include <rcl_cxx/subscription.hpp>

namespace ur_ros_rtde {

/// Returns whether the publisher of `before` sent nothing for more than `timeout` s on average between it and
/// `next`, the following message that arrived. Messages that were late or lost on their way are no pause of
/// the publisher. True if `next` is from another publisher. Without numbers of messages, lost ones count as
/// not sent.
bool has_paused(const rcl_cxx::MessageInfo & before, const rcl_cxx::MessageInfo & next, double timeout);

}  // namespace ur_ros_rtde
