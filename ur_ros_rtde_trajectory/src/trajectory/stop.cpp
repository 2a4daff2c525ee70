#include <algorithm>
#include <optional>

#include "motion/motion.hpp"
#include "motion/verify.hpp"
#include "trajectory/braking_time_scaling.hpp"

namespace ur_ros_rtde::trajectory {
namespace {

// State on piece `index` of the plan under a time scaling with the given r''.
PathState scaled_state(const Motion & plan, std::size_t index, const TimeScalingState & scaling,
                       double rate_ddot)
{
  const TimingLawPiece & piece = plan.timing[index];
  const PathState path_state = piece.at(std::clamp(scaling.plan_time, piece.start, piece.end()));
  const double r = scaling.rate;
  return {path_state.u, path_state.v * r, path_state.a * r * r + path_state.v * scaling.rate_dot,
          path_state.j * r * r * r + 3.0 * path_state.a * r * scaling.rate_dot + path_state.v * rate_ddot};
}

// Ends of the intervals in which both the plan and the time scaling are smooth.
std::vector<double> smooth_interval_ends(const Motion & plan, const BrakingTimeScaling & scaling)
{
  std::vector<double> ends;
  for (std::size_t k = 1; k < scaling.phases.size(); ++k) {
    ends.push_back(scaling.phases[k].begin);
  }
  const double final_phase = scaling.phases.back().begin;
  constexpr int final_phase_parts = 16;
  for (int k = 1; k <= final_phase_parts; ++k) {
    ends.push_back(final_phase + (scaling.end - final_phase) * k / final_phase_parts);
  }
  const double last = scaling.at(scaling.end).plan_time;
  for (std::size_t i = plan.piece_at(scaling.phases.front().state.plan_time); plan.timing[i].end() < last;
       ++i) {
    ends.push_back(scaling.time_at(plan.timing[i].end()));
  }
  std::sort(ends.begin(), ends.end());
  return ends;
}

// The braking motion alone; its time starts at 0.
Motion braking_motion(const Motion & plan, const BrakingTimeScaling & scaling)
{
  constexpr double shortest = 1e-9;  // s; shorter intervals are merged with the next
  Motion result;
  result.path = plan.path;
  double from = 0.0;
  for (const double to : smooth_interval_ends(plan, scaling)) {
    if (to - from < shortest) {
      continue;
    }
    const double middle = 0.5 * (from + to);
    const double rate_ddot = scaling.rate_ddot_at(middle);
    const std::size_t index = plan.piece_at(scaling.at(middle).plan_time);
    const PathState begin = scaled_state(plan, index, scaling.at(from), rate_ddot);
    result.append(plan.timing[index].piece, to - from, begin,
                  scaled_state(plan, index, scaling.at(to), rate_ddot));
    from = to;
  }
  return result;
}

// After the deadline: false.
bool is_within(const Limits & limits, const Motion & motion, std::chrono::steady_clock::time_point deadline)
{
  Utilization use;
  return std::none_of(motion.timing.begin(), motion.timing.end(), [&](const TimingLawPiece & piece) {
    return std::chrono::steady_clock::now() > deadline ||
           first_violation(motion, piece, limits, verification_step, use);
  });
}

// Finds the fastest braking that keeps the limits everywhere. A larger reserve reduces violations between the
// moments that the search checks.
std::optional<Motion> find_braking(const Motion & plan, double plan_time, const Limits & limits,
                                   std::chrono::steady_clock::time_point deadline)
{
  for (const double reserve : {0.0, 0.02, 0.06, 0.15, 0.3, 0.5, 0.7, 0.85}) {
    const auto scaling = find_braking_time_scaling(plan, plan_time, limits, reserve, deadline);
    if (!scaling) {
      continue;
    }
    Motion motion = braking_motion(plan, *scaling);
    if (is_within(limits, motion, deadline)) {
      return motion;
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<Trajectory> Trajectory::stop_from(double time, const Limits & limits,
                                                std::chrono::steady_clock::time_point deadline) const
{
  if (motion_->timing.empty() || !(time < duration())) {
    return *this;
  }
  const double now = std::max(time, 0.0);
  auto result = std::make_shared<Motion>();
  result->path = motion_->path;
  if (now <= 0.0) {
    result->append(motion_->timing.front().piece, 1e-3, PathState{});  // not started yet: stay
    return Trajectory(std::move(result));
  }
  // If no braking from this moment passes verification, a later one does.
  constexpr double delay = 0.025;  // s
  std::optional<Motion> brake;
  double begin = now;
  for (; begin < duration(); begin += delay) {
    brake = find_braking(*motion_, begin, with_margin(limits, 5e-5), deadline);
    if (brake) {
      break;
    }
    if (std::chrono::steady_clock::now() > deadline) {
      return std::nullopt;
    }
  }
  if (!brake) {
    return *this;
  }
  const std::size_t index = motion_->piece_at(begin);
  result->timing.assign(motion_->timing.begin(),
                        motion_->timing.begin() + static_cast<std::ptrdiff_t>(index) + 1);
  result->timing.back().duration = begin - result->timing.back().start;
  for (TimingLawPiece piece : brake->timing) {
    piece.start = result->duration();
    result->timing.push_back(piece);
  }
  return Trajectory(std::move(result));
}

}  // namespace ur_ros_rtde::trajectory
