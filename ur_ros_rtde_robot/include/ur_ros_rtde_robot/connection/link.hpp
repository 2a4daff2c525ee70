#pragma once

#include <string>

#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// One connection to the controller, looked after in the background.
struct LinkStatus {
  bool connected = false;
  /// Why not: what happened, with the address; empty while connected or before the first try has ended.
  Error error;
};

/// What a controller says of itself over RTDE.
struct ControllerVersion {
  unsigned major = 0;  ///< 3: CB3, 5: e-Series and UR-Series, 10: PolyScope X
  unsigned minor = 0;
  unsigned bugfix = 0;
  unsigned build = 0;

  bool cb3() const { return major == 3; }
  /// Hz, of the control cycle and therefore of RTDE.
  double frequency() const { return cb3() ? 125.0 : 500.0; }
};

std::string to_string(const ControllerVersion & version);

}  // namespace ur_ros_rtde
