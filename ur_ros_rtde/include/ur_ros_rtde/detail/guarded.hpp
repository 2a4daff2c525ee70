#pragma once

#include <functional>

#include "ur_ros_rtde/detail/stop_request.hpp"

namespace ur_ros_rtde {

/// The outcome of `body`. An exception becomes a failure, so that none leaves a goal's thread.
Outcome guarded(const std::function<Outcome()> & body);
/// The same for a goal that can be asked to stop: if `body` fails after a request to stop, the outcome is the
/// reason of the request.
Outcome guarded(const StopRequest & stop_request, const std::function<Outcome()> & body);

}  // namespace ur_ros_rtde
