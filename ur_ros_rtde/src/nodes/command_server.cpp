#include "nodes/command_server.hpp"

#include "diagnostics/plugin_problems.hpp"
#include "nodes/node_log.hpp"
#include "plugins/plugin_selection.hpp"

namespace ur_ros_rtde {

CommandServer::CommandServer(const rcl_cxx::Context::SharedPtr & context)
    : node_(std::make_shared<rcl_cxx::Node>(context, "command_server"))
{
  const CommandServerParameters parameters = declare_command_server(*node_);
  choice_ = declare_plugin_choice(*node_);
  driver_state_ = std::make_unique<DriverStateTopic>(*node_);
  robot_ = std::make_unique<Robot>(parameters.robot, log_connection(*node_));
  robot_->on_status([this](const RobotStatus & status) { driver_state_->publish(status); });
  active_modes_ = std::make_unique<ActiveModesTopic>(*node_, *robot_);
  description_check_ = std::make_unique<DescriptionCheck>(*node_, *robot_, parameters.tf_prefix);
  diagnostics_ =
      std::make_unique<Diagnostics>(*node_, parameters.robot.address, [this] { return diagnose(); });
  host_ = std::make_unique<CommandHost>(*node_, *robot_, parameters.goals);
  teleoperation_ =
      std::make_unique<Teleoperation>(*host_, parameters.teleoperation, log_to(node_->get_logger()));
}

CommandServer::~CommandServer()
{
  exit_without(close(), *node_);
  plugins_.stop();
}

std::vector<Diagnosis> CommandServer::diagnose()
{
  auto findings = diagnose_driver(*robot_);
  if (auto description = description_check_->diagnose()) {
    findings.push_back(std::move(*description));
  }
  return findings;
}

void CommandServer::load_plugins()
{
  const ReportProblem report = log_plugin_problems(node_);
  plugins_.load(
      select_plugins(find_plugins(report), command_base, choice_.plugins, choice_.blacklist, report), report);
  plugins_.initialize(*host_, report);
  add_extensions(report);
  robot_->connect();
}

std::vector<const rcl_cxx::CallbackGroup *> CommandServer::groups()
{
  auto groups = host_->groups();
  groups.push_back(&teleoperation_->group());
  return groups;
}

void CommandServer::create_actions()
{
  plugins_.start(*host_, log_plugin_problems(node_));
  host_->complete_commands();
  log_commands(node_->get_logger(), "commands", plugins_.names());
}

void CommandServer::add_extensions(const ReportProblem & report)
{
  std::vector<ScriptExtension> extensions;
  const auto add = [&extensions](const PluginEntry & entry, const CommandPlugin & plugin) {
    if (auto extension = plugin.script_extension()) {
      extension->name = entry.name;
      extensions.push_back(std::move(*extension));
    }
  };
  plugins_.with_each("script_extension() threw", report, add);
  for (const std::string & problem : robot_->set_extensions(extensions)) {
    report(problem);
  }
}

void CommandServer::end_goals()
{
  teleoperation_->stop(shutdown_error());
  host_->goals().end(shutdown_error());
  if (!robot_->holder(Resource::motion) && robot_->activities().contains_any(outlasting_modes)) {
    stopping_ = robot_->begin_stop({}, shutdown_error());  // no goal owns a mode that has outlasted its goal
  }
}

std::vector<std::string> CommandServer::close()
{
  const auto deadline = std::chrono::steady_clock::now() + close_timeout;
  end_goals();  // nothing waits for the end of a session before the goals are told to end
  auto left = host_->goals().close(shutdown_error(), close_timeout);
  teleoperation_->close();
  if (stopping_.valid()) {
    stopping_.wait_until(deadline);
  }
  return left;
}

}  // namespace ur_ros_rtde
