#pragma once

#include <optional>
#include <string>

#include "diagnostics/diagnostics.hpp"
#include "diagnostics/package_statistics.hpp"
#include "ur_ros_rtde_robot/connection/link.hpp"
#include "ur_ros_rtde_robot/state/sample.hpp"

namespace ur_ros_rtde {

/// The source of the samples and its current state.
struct StateSource {
  LinkStatus link;
  std::optional<ControllerVersion> version;
  double frequency = 0.0;  ///< Hz, agreed with the controller; 0: not yet
};

/// STALE before the first connection, ERROR after the connection was lost.
Diagnosis diagnose_link(const StateSource & source, const std::string & address);
/// WARN below 95 % of the agreed rate or if packages were lost, ERROR below 50 %.
Diagnosis diagnose_packages(const StateSource & source, const PackageStatistics::Report & packages);
/// WARN if the robot cannot move or a joint is hot. ERROR for states that need more than an acknowledgement:
/// emergency stop, violation, fault. STALE without a connection, with the last values.
Diagnosis diagnose_robot(const StateSource & source, const std::optional<Sample> & sample);

}  // namespace ur_ros_rtde
