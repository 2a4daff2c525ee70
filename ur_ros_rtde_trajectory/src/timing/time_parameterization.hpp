#pragma once

#include <memory>
#include <stop_token>

#include "trajectory/motion.hpp"

namespace ur_ros_rtde::trajectory {

/// The fastest motion along a path, verified. Refused: what remains beyond a limit, a position above all;
/// canceled by `stop` between two blocks.
Expected<std::shared_ptr<Motion>> parameterize_path(std::shared_ptr<const Path> path, const Limits & limits,
                                                    const std::stop_token & stop);

}  // namespace ur_ros_rtde::trajectory
