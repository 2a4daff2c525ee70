#pragma once

#include <functional>

namespace ur_ros_rtde {

/// Publishes the feedback of a goal: an A::Feedback of its action.
using PublishFeedback = std::function<void(const void * feedback)>;

}  // namespace ur_ros_rtde
