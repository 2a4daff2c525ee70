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

struct DashboardLinkOptions {
  std::string address;
  std::chrono::milliseconds connect_timeout{500};
  std::chrono::milliseconds retry_interval{500};
  /// How often an idle connection is asked for a sign of life.
  std::chrono::milliseconds heartbeat{1000};
};

/// A connection to the dashboard server that comes back by itself. All methods are thread-safe.
class DashboardLink {
 public:
  /// Throws std::invalid_argument for an empty address; never for the network's sake.
  explicit DashboardLink(DashboardLinkOptions options, LogFunction log = {});
  ~DashboardLink();
  DashboardLink(const DashboardLink &) = delete;
  DashboardLink & operator=(const DashboardLink &) = delete;

  /// Called on the link's thread when the connection comes or goes. Set before start().
  void on_link(std::function<void(const LinkStatus &)> function);
  void start();
  /// Ends the thread and with it all callbacks; takes as long as a step of connecting at most. The destructor
  /// does it, too.
  void stop();

  LinkStatus link() const;
  /// From PolyScope 5.6 on; refreshed with each heartbeat. None: unknown, or the controller has no such
  /// setting.
  std::optional<bool> in_remote_control() const;
  /// PolyScope's; of the controller last connected to.
  std::optional<ControllerVersion> version() const;

  /// Throws RobotError (link_lost, with the cause) without a connection.
  Locked<ur_rtde::DashboardClient> dashboard() const;
  /// Runs `function`; whatever it throws becomes the error: rejected_by_robot with the robot's answer, or
  /// link_lost (and the connection is made anew).
  Status call(const std::function<void(ur_rtde::DashboardClient &)> & function);
  /// Sends a line and returns the answer, on a connection of its own: for what takes the robot its time
  /// (loading a program, a report) while others ask on. Errors: link_lost; timeout, when `limit` has passed;
  /// canceled, when stop is requested.
  Expected<std::string> request(const std::string & line, std::chrono::milliseconds limit,
                                const std::stop_token & stop = {}) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ur_ros_rtde
