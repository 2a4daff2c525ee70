#include "timing/time_parameterization.hpp"

#include "motion/verify.hpp"
#include "timing/segment_timing.hpp"

namespace ur_ros_rtde::trajectory {
namespace {

constexpr double search_time = 3.0;  // s of processor time

// Verifies the whole motion. Small violations are removed by slowing down.
Status verify_and_slow(Motion & motion, const Limits & limits)
{
  constexpr int rounds = 4;
  if (!motion.is_finite()) {
    return failure(
        ErrorCode::invalid_goal,
        "no motion through these waypoints was found: leave out waypoints that nearly coincide, or "
        "set blend_tolerance to 0");
  }
  if (Status possible = check_duration(motion); !possible) {
    return possible;
  }
  for (int round = 0;; ++round) {
    Utilization use;
    const auto excess = first_violation(motion, limits, verification_step, use);
    if (!excess) {
      return {};
    }
    if (round == rounds || excess->quantity == Quantity::position) {
      const auto shared = std::make_shared<const Motion>(motion);
      return failure(ErrorCode::invalid_goal,
                     describe(*excess, Trajectory(shared).waypoint_at(excess->time)));
    }
    slow_to_limits(motion, 0, limits);
  }
}

}  // namespace

Expected<std::shared_ptr<Motion>> parameterize_path(std::shared_ptr<const Path> path, const Limits & limits,
                                                    const std::stop_token & stop)
{
  auto motion = std::make_shared<Motion>();
  motion->path = std::move(path);
  const Limits inner = with_margin(limits);
  JerkSolver solver(inner, SearchLimit(stop, search_time));
  for (const auto & [first, last] : motion->path->segments()) {
    if (stop.stop_requested()) {
      break;
    }
    parameterize_segment(*motion, first, last, inner, solver);
  }
  if (stop.stop_requested()) {
    return failure(ErrorCode::canceled, "planning was canceled");
  }
  if (auto status = verify_and_slow(*motion, limits); !status) {
    return tl::unexpected(status.error());
  }
  return motion;
}

}  // namespace ur_ros_rtde::trajectory
