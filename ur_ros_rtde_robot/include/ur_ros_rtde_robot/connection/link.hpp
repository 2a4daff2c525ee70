#pragma once

#include <optional>
#include <string>

#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// Message of an operation that was interrupted by a lost connection when the connection exists again.
inline constexpr const char * connection_replaced =
    "the connection to the controller was lost; it has been re-established";

/// Status of a connection to the controller that is kept up in the background.
struct LinkStatus {
  bool connected = false;
  /// Reason for the missing connection, with the address; empty while connected.
  Error error;
};

/// Version of the controller software, as reported over RTDE.
struct ControllerVersion {
  unsigned major = 0;  ///< 3: CB3, 5: e-Series and UR-Series, 10: PolyScope X
  unsigned minor = 0;
  unsigned bugfix = 0;
  unsigned build = 0;

  bool cb3() const { return major == 3; }
  bool is_polyscope_x() const { return major >= 10; }
  /// Hz, rate of the control cycle, which is the highest RTDE rate.
  double frequency() const { return cb3() ? 125.0 : 500.0; }
};

std::string to_string(const ControllerVersion & version);

/// PolyScope X has none (not_supported). Success while the version is unknown.
Status has_dashboard_server(const std::optional<ControllerVersion> & version);

}  // namespace ur_ros_rtde
