#pragma once

#include <optional>
#include <rcl_cxx/subscription.hpp>

namespace ur_ros_rtde {

/// Returns whether the publisher of `before` sent nothing for more than `timeout` s on average between it and
/// `next`, the following message that arrived. Messages that were late or lost on their way are no pause of
/// the publisher. True if `next` is from another publisher. Without numbers of messages, lost ones count as
/// not sent.
bool has_paused(const rcl_cxx::MessageInfo & before, const rcl_cxx::MessageInfo & next, double timeout);

/// Returns for how long, in s, the publisher of both has published when it published `next`, if it has had
/// the mean rate between them all the time: its first messages are lost if they come before the discovery.
/// Empty if they are less than `shortest_time` s apart, so that two messages of a burst do not give the rate,
/// and without numbers of messages.
std::optional<double> age_of_publisher(const rcl_cxx::MessageInfo & before, const rcl_cxx::MessageInfo & next,
                                       double shortest_time);

}  // namespace ur_ros_rtde
