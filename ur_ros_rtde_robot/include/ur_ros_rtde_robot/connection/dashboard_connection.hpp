#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "ur_ros_rtde_robot/connection/link.hpp"
#include "ur_ros_rtde_robot/connection/locked.hpp"
#include "ur_ros_rtde_robot/connection/log.hpp"

namespace ur_rtde {
class DashboardClient;
}

namespace ur_ros_rtde {

// For the driver

/// Address and times of a DashboardConnection.
struct DashboardConnectionOptions {
  std::string address;
  std::chrono::milliseconds connect_timeout{500};
  std::chrono::milliseconds retry_interval{500};
  /// Interval at which the connection is checked with a query.
  std::chrono::milliseconds heartbeat{1000};
};

// For plugins

/// A connection to the dashboard server that reconnects by itself. All methods are thread-safe.
class DashboardConnection {
 public:
  // For the driver

  /// Throws std::invalid_argument for an empty address. Network problems do not throw.
  explicit DashboardConnection(DashboardConnectionOptions options, LogFunction log = {});
  ~DashboardConnection();
  DashboardConnection(const DashboardConnection &) = delete;
  DashboardConnection & operator=(const DashboardConnection &) = delete;

  /// Called on the background thread when the connection is established or lost. Must not throw. Set before
  /// start().
  void on_link(std::function<void(const LinkStatus &)> function);
  /// Connects in the background.
  void start();
  /// Joins the background thread; no callback runs afterwards. Takes at most as long as one
  /// connection attempt. Called by the destructor.
  void stop();

  // For plugins

  LinkStatus link() const;
  /// Updated with each heartbeat. None if unknown or if the controller has no such setting (before PolyScope
  /// 5.6).
  std::optional<bool> in_remote_control() const;
  /// PolyScope version of the last connected controller.
  std::optional<ControllerVersion> version() const;

  /// Throws RobotError (link_lost, with the cause) without a connection.
  Locked<ur_rtde::DashboardClient> dashboard() const;
  /// Runs `function`. An exception becomes the error: rejected_by_robot with the robot's answer, or link_lost
  /// after which the connection is re-established.
  Status call(const std::function<void(ur_rtde::DashboardClient &)> & function);
  /// Sends a line on a separate connection and returns the answer, so that requests which take long (loading
  /// a program, a report) do not block others. Errors: link_lost; timeout after `timeout`; canceled if a stop
  /// is requested.
  Expected<std::string> request(const std::string & line, std::chrono::milliseconds timeout,
                                const std::stop_token & stop = {}) const;
  /// Of the dashboard server.
  const std::string & address() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ur_ros_rtde
