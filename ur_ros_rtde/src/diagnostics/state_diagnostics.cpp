#include "diagnostics/state_diagnostics.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ur_ros_rtde {
namespace {
using Level = Diagnosis::Status;

// Fractions of the agreed rate.
constexpr double warn_rate = 0.95;
constexpr double error_rate = 0.5;
/// Joints in use stay below this temperature. UR publishes no limit.
constexpr double hot_joint = 75.0;  // degrees Celsius

std::uint8_t level(SafetyMode mode)
{
  switch (mode) {
    case SafetyMode::normal:
    case SafetyMode::reduced:
      return Level::OK;
    case SafetyMode::protective_stop:
    case SafetyMode::recovery:
    case SafetyMode::safeguard_stop:
    case SafetyMode::validate_joint_id:
      return Level::WARN;
    default:
      return Level::ERROR;
  }
}

std::string milliseconds(double seconds)
{
  return fmt::format("{:.3f} ms", 1000.0 * seconds);
}
}  // namespace

Diagnosis diagnose_link(const StateSource & source, const std::string & address)
{
  Diagnosis diagnosis("link");
  if (source.link.connected) {
    diagnosis.ok("connected");
  } else {
    diagnosis.add(source.version ? Level::ERROR : Level::STALE,
                  source.link.error.message.empty() ? "not connected" : source.link.error.message);
  }
  return diagnosis.value("connected", source.link.connected)
      .value("address", address)
      .value("PolyScope", source.version ? to_string(*source.version) : "unknown");
}

Diagnosis diagnose_packages(const StateSource & source, const PackageStatistics::Report & packages)
{
  Diagnosis diagnosis("packages");
  if (!source.link.connected) {
    diagnosis.add(Level::STALE, "no connection");
  } else {
    const std::string rate = fmt::format("{:.1f} of {:.0f} packages/s", packages.rate, source.frequency);
    diagnosis.ok(rate)
        .warn_if(packages.lost > 0, fmt::format("{} packages lost in the last second", packages.lost))
        .warn_if(packages.rate < warn_rate * source.frequency, rate)
        .error_if(packages.rate < error_rate * source.frequency, rate);
  }
  return diagnosis.value("rate", fmt::format("{:.1f} Hz", packages.rate))
      .value("agreed rate", fmt::format("{:.1f} Hz", source.frequency))
      .value("interval, mean", milliseconds(packages.mean_interval))
      .value("interval, 99 %", milliseconds(packages.p99_interval))
      .value("interval, longest", milliseconds(packages.longest))
      .value("lost in the last second", packages.lost)
      .value("lost", packages.lost_total)
      .value("received", packages.received_total);
}

Diagnosis diagnose_robot(const StateSource & source, const std::optional<Sample> & sample)
{
  Diagnosis diagnosis("robot");
  if (!source.link.connected || !sample) {
    diagnosis.add(Level::STALE, "no connection");
  }
  if (!sample) {
    return diagnosis;
  }
  const double hottest = *std::ranges::max_element(sample->joint_temperatures);
  if (source.link.connected) {
    diagnosis.add(level(sample->safety_mode), fmt::format("safety mode {}", to_string(sample->safety_mode)))
        .warn_if(sample->robot_mode != RobotMode::running,
                 fmt::format("robot mode {}", to_string(sample->robot_mode)))
        .warn_if(hottest > hot_joint, fmt::format("a joint has {:.1f} degrees Celsius", hottest));
  }
  return diagnosis.value("safety mode", to_string(sample->safety_mode))
      .value("robot mode", to_string(sample->robot_mode))
      .value("program", to_string(sample->runtime_state))
      .value("speed scaling", fmt::format("{:.3f}", sample->speed_scaling))
      .value("hottest joint", fmt::format("{:.1f} degrees Celsius", hottest));
}

}  // namespace ur_ros_rtde
