#pragma once

#include <rmw/types.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace rcl_cxx {
/// The quality of service of a topic or service: `QoS::reliable(10)`, `QoS::sensor_data().keep_last(1)`.
class QoS {
 public:
  /// rmw_qos_profile_default with this depth.
  static QoS reliable(std::size_t depth = 10);
  static QoS best_effort(std::size_t depth = 5);
  /// rmw_qos_profile_sensor_data: best effort, keep last 5.
  static QoS sensor_data();
  /// Reliable and transient local: late subscribers receive the last `depth` messages.
  static QoS transient_local(std::size_t depth = 1);
  /// rmw_qos_profile_services_default.
  static QoS services_default();
  /// rmw_qos_profile_parameters: reliable, keep last 1000.
  static QoS parameters();
  /// rmw_qos_profile_system_default: the middleware's configuration.
  static QoS system_default();

  /// By name, for parameters. @throws Error that lists the known names.
  static QoS from_name(std::string_view name);
  static const std::vector<std::string> & names();

  /// A copy with this depth.
  QoS keep_last(std::size_t depth) const;

  const rmw_qos_profile_t & get_rmw_qos_profile() const noexcept { return profile_; }

  friend bool operator==(const QoS & a, const QoS & b) noexcept;

 private:
  explicit QoS(const rmw_qos_profile_t & profile) : profile_(profile) {}

  rmw_qos_profile_t profile_;
};

}  // namespace rcl_cxx
