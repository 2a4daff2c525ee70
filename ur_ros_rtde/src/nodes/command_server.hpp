#pragma once

#include <memory>

#include "diagnostics/diagnostics.hpp"
#include "nodes/parameters.hpp"
#include "nodes/server.hpp"
#include "plugins/plugin_set.hpp"
#include "state/active_modes.hpp"
#include "state/description_check.hpp"
#include "state/driver_state.hpp"
#include "teleoperation/teleoperation.hpp"
#include "ur_ros_rtde/plugin_host.hpp"
#include "ur_ros_rtde_robot/robot.hpp"

namespace ur_ros_rtde {

/// The node command_server: the robot, the command plugins, and the teleoperation topics.
class CommandServer : public Server {
 public:
  explicit CommandServer(const rcl_cxx::Context::SharedPtr & context);
  ~CommandServer() override;

  rcl_cxx::Node & node() override { return *node_; }
  std::vector<const rcl_cxx::CallbackGroup *> groups() override;
  Robot & robot() { return *robot_; }
  CommandHost & host() { return *host_; }
  void load_plugins() override;
  void create_actions() override;
  void start() override { robot_->start(); }
  void end_goals() override;
  std::vector<std::string> close() override;

 private:
  std::vector<Diagnosis> diagnose();
  void add_extensions(const ReportProblem & report);

  PluginSet<CommandPlugin, CommandHost> plugins_;  // destroyed last, because it unloads the libraries
  rcl_cxx::Node::SharedPtr node_;
  std::unique_ptr<DriverStateTopic> driver_state_;  // outlives the robot, which calls it
  std::unique_ptr<Robot> robot_;
  std::unique_ptr<ActiveModesTopic> active_modes_;
  std::unique_ptr<CommandHost> host_;
  std::unique_ptr<Teleoperation> teleoperation_;
  std::unique_ptr<DescriptionCheck> description_check_;
  std::unique_ptr<Diagnostics> diagnostics_;
  std::shared_future<Expected<StopReport>> stopping_;  // of a mode, at the end of the node
  PluginChoice choice_;
};

}  // namespace ur_ros_rtde
