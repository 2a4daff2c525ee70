#include "timing/time_path.hpp"

#include <cmath>

#include "timing/timing.hpp"
#include "trajectory/verify.hpp"

namespace ur_ros_rtde::trajectory {
namespace {

// Nothing leaves without having been looked at everywhere; what little is too much is taken away by slowing
// down.
Status verify_or_slow(Motion & motion, const Limits & limits)
{
  constexpr int rounds = 4;
  for (int round = 0;; ++round) {
    Utilisation use;
    const auto excess = first_excess(motion, limits, verification_step, use);
    if (!excess) {
      return {};
    }
    if (round == rounds || excess->quantity == Quantity::position || !std::isfinite(motion.duration())) {
      const auto shared = std::make_shared<const Motion>(motion);
      return failure(ErrorCode::invalid_goal,
                     describe(*excess, Trajectory(shared).waypoint_at(excess->time)));
    }
    slow_to_limits(motion, 0, limits);
  }
}

}  // namespace

Expected<std::shared_ptr<Motion>> time_path(std::shared_ptr<const Path> path, const Limits & limits,
                                            const std::stop_token & stop)
{
  auto motion = std::make_shared<Motion>();
  motion->path = std::move(path);
  for (const auto & [first, last] : motion->path->blocks()) {
    if (stop.stop_requested()) {
      return failure(ErrorCode::canceled, "the plan is not wanted any more");
    }
    time_block(*motion, first, last, limits);
  }
  if (auto status = verify_or_slow(*motion, limits); !status) {
    return tl::unexpected(status.error());
  }
  return motion;
}

}  // namespace ur_ros_rtde::trajectory
