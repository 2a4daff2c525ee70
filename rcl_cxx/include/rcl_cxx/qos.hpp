#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rcl_cxx {
enum class ReliabilityPolicy { reliable, best_effort, system_default };
enum class DurabilityPolicy { is_volatile, transient_local, system_default };
enum class HistoryPolicy { keep_last, keep_all, system_default };

/// Quality of service of a topic or service, the part of rmw_qos_profile_t that drivers use. A value type:
/// `QoS::reliable(10)`, `QoS::sensor_data().keep_last(1)`.
struct QoS {
  HistoryPolicy history = HistoryPolicy::keep_last;
  std::size_t depth = 10;
  ReliabilityPolicy reliability = ReliabilityPolicy::reliable;
  DurabilityPolicy durability = DurabilityPolicy::is_volatile;
  /// Longest time between two messages; unset: no deadline.
  std::optional<std::chrono::nanoseconds> deadline;
  /// Age at which a message is no longer delivered; unset: never.
  std::optional<std::chrono::nanoseconds> lifespan;

  /// rmw_qos_profile_default with this depth.
  static QoS reliable(std::size_t depth = 10);
  static QoS best_effort(std::size_t depth = 5);
  /// rmw_qos_profile_sensor_data: best effort, keep last 5.
  static QoS sensor_data();
  /// Reliable and transient local: a late subscriber gets the last `depth` messages.
  static QoS transient_local(std::size_t depth = 1);
  /// rmw_qos_profile_services_default.
  static QoS services_default();
  /// rmw_qos_profile_parameters: reliable, keep last 1000.
  static QoS parameters();
  /// Whatever the middleware's configuration says.
  static QoS system_default();

  /// By name, for parameters: "default", "reliable", "best_effort", "sensor_data", "latched",
  /// "transient_local", "services_default", "parameters", "system_default".
  /// @throws Error that lists the known names.
  static QoS from_name(std::string_view name);
  static const std::vector<std::string> & names();

  QoS keep_last(std::size_t new_depth) const;

  bool operator==(const QoS &) const = default;
};

}  // namespace rcl_cxx
