#include "ur_ros_rtde_robot/motion/motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ur_ros_rtde {

const char * to_string(StopMeans means)
{
  switch (means) {
    case StopMeans::nothing_moved:
      return "nothing moved";
    case StopMeans::stopped_by_robot:
      return "stopped by the robot";
    case StopMeans::stop_command:
      return "stop command";
    case StopMeans::program_stopped:
      return "program stopped";
    case StopMeans::watchdog:
      return "program stopped by its watchdog";
  }
  return "unknown";
}

Error standstill_not_confirmed(const Error & stop)
{
  return {stop.code, fmt::format("standstill is not confirmed: {}", stop.message)};
}

Error standstill_not_confirmed(const Error & why, const Error & stop)
{
  const bool names_cause = stop.message.find(why.message) != std::string::npos;
  const std::string cause = names_cause ? "" : why.message + "; ";
  return {why.code, cause + standstill_not_confirmed(stop).message};
}

void StandstillDetector::add(const Sample & sample)
{
  // This comparison makes NaN count as motion.
  const bool quiet = std::all_of(sample.actual_qd.begin(), sample.actual_qd.end(),
                                 [](double joint_velocity) { return std::abs(joint_velocity) < velocity; });
  if (!quiet || sample.link != link_) {
    quiet_since_.reset();
  }
  link_ = sample.link;
  if (quiet && !quiet_since_) {
    quiet_since_ = sample.controller_time;
  }
  at_rest_ = quiet_since_ && sample.controller_time - *quiet_since_ >= duration;
}

}  // namespace ur_ros_rtde
