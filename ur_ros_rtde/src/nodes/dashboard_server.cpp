#include "nodes/dashboard_server.hpp"

#include "diagnostics/plugin_problems.hpp"
#include "nodes/node_log.hpp"
#include "plugins/plugin_selection.hpp"

namespace ur_ros_rtde {

DashboardServer::DashboardServer(const rcl_cxx::Context::SharedPtr & context, CommandHost * commands)
    : node_(std::make_shared<rcl_cxx::Node>(context, "dashboard_server"))
{
  DashboardConnectionOptions options;
  options.address = declare_robot_ip(*node_);
  choice_ = declare_plugin_choice(*node_);
  connection_ = std::make_unique<DashboardConnection>(options, log_connection(*node_));
  host_ = std::make_unique<DashboardHost>(*node_, declare_servers_on_demand(*node_), *connection_, commands);
}

DashboardServer::~DashboardServer()
{
  exit_without(close(), *node_);
  plugins_.stop();
}

void DashboardServer::load_plugins()
{
  const ReportProblem report = log_plugin_problems(node_);
  plugins_.load(
      select_plugins(find_plugins(report), dashboard_base, choice_.plugins, choice_.blacklist, report),
      report);
  plugins_.initialize(*host_, report);
}

void DashboardServer::create_actions()
{
  plugins_.start(*host_, log_plugin_problems(node_));
  log_commands(node_->get_logger(), "dashboard commands", plugins_.names());
}

std::vector<std::string> DashboardServer::close()
{
  return host_->goals().close(shutdown_error(), close_timeout);
}

}  // namespace ur_ros_rtde
