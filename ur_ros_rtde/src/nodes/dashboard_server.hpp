#pragma once

#include <memory>

#include "nodes/parameters.hpp"
#include "nodes/server.hpp"
#include "plugins/plugin_set.hpp"
#include "ur_ros_rtde/plugin_host.hpp"
#include "ur_ros_rtde_robot/connection/dashboard_connection.hpp"

namespace ur_ros_rtde {

/// The node dashboard_server: the connection to the dashboard server, and the dashboard plugins.
class DashboardServer : public Server {
 public:
  /// `commands`: of the command server in the same process; null if there is none.
  explicit DashboardServer(const rcl_cxx::Context::SharedPtr & context, CommandHost * commands = nullptr);
  ~DashboardServer() override;

  rcl_cxx::Node & node() override { return *node_; }
  std::vector<const rcl_cxx::CallbackGroup *> groups() override { return host_->groups(); }
  void load_plugins() override;
  void create_actions() override;
  void start() override { connection_->start(); }
  void end_goals() override { host_->goals().end(shutdown_error()); }
  std::vector<std::string> close() override;

 private:
  PluginSet<DashboardPlugin, DashboardHost> plugins_;  // destroyed last, because it unloads the libraries
  rcl_cxx::Node::SharedPtr node_;
  std::unique_ptr<DashboardConnection> connection_;
  std::unique_ptr<DashboardHost> host_;
  PluginChoice choice_;
};

}  // namespace ur_ros_rtde
