#include "ur_ros_rtde/plugin_host.hpp"

#include "ur_ros_rtde_robot/robot.hpp"

namespace ur_ros_rtde {
namespace {

/// Longer than a request that starts something is under way.
constexpr std::chrono::milliseconds startup_request_timeout{3500};
/// Longer than the action servers of all plugins take to start.
constexpr std::chrono::seconds commands_timeout{10};

}  // namespace

PluginHost::PluginHost(rcl_cxx::Node & node, bool servers_on_demand)
    : node_(node),
      // Transient local: a client may be rejected before its subscription has been matched.
      rejections_(node.create_publisher<ur_ros_rtde_msgs::msg::GoalRejected>(
          "goal_rejections", rcl_cxx::QoS::transient_local(100))),
      plugin_group_(node.create_callback_group()),
      stop_group_(node.create_callback_group()),
      creation_group_(servers_on_demand ? node.create_callback_group() : nullptr)
{
}

std::vector<const rcl_cxx::CallbackGroup *> PluginHost::groups() const
{
  std::vector<const rcl_cxx::CallbackGroup *> groups{stop_group_.get(), plugin_group_.get()};
  if (creation_group_) {
    groups.push_back(creation_group_.get());
  }
  return groups;
}

void PluginHost::publish_rejection(const std::string & action, const rcl_cxx::GoalUUID & id,
                                   const Error & why)
{
  ur_ros_rtde_msgs::msg::GoalRejected rejection;
  rejection.stamp = node_.now();
  rejection.action = action;
  rejection.goal_id.uuid = id.bytes;
  rejection.error_code = static_cast<std::uint16_t>(why.code);
  rejection.message = why.message;
  rejections_->publish(rejection);
}

std::shared_future<Expected<StopReport>> CommandHost::begin_stop(const StopOptions & options,
                                                                 const Error & why)
{
  ++stops_;
  return robot_.begin_stop(options, why);
}

std::shared_ptr<void> CommandHost::end_script(const Error & why)
{
  ++stops_;
  auto hold = robot_.hold_program();
  const auto holder = robot_.holder(Resource::mode);  // conflicts with a script
  if (holder && holder->resource == Resource::script) {
    robot_.begin_stop({}, why);
  }
  return hold;
}

std::shared_ptr<void> CommandHost::begin_startup_request(std::uint32_t stops)
{
  return startup_requests_.begin([&] { return stops_ == stops; });
}

void CommandHost::wait_for_startup_requests()
{
  if (!startup_requests_.wait_until_none(startup_request_timeout)) {
    RCL_CXX_WARN(node().get_logger(),
                 "a request that brings the arm into operation is still under way: check the arm");
  }
}

Status DashboardHost::has_dashboard_server() const
{
  return ur_ros_rtde::has_dashboard_server(commands_ != nullptr ? commands_->robot().version()
                                                                : std::nullopt);
}

Expected<std::shared_ptr<void>> DashboardHost::begin_startup_request(std::uint32_t stops) const
{
  if (commands_ == nullptr) {
    return nullptr;
  }
  auto request = commands_->begin_startup_request(stops);
  return request ? Expected<std::shared_ptr<void>>(std::move(request))
                 : tl::unexpected(stopped_by_the_driver());
}

std::shared_ptr<void> CommandHost::begin_mode_switch()
{
  ++mode_switches_;
  return {nullptr, [this](void *) { ++mode_switches_; }};
}

void CommandHost::set_mode_owner(std::shared_ptr<rcl_cxx::ServerGoalHandle> goal)
{
  const std::lock_guard lock(mode_owner_mutex_);
  mode_owner_ = std::move(goal);
}

void CommandHost::forget_owner_of_ended_modes()
{
  const std::lock_guard lock(mode_owner_mutex_);
  if (!robot_.activities().contains_any(outlasting_modes)) {
    mode_owner_.reset();
  }
}

void CommandHost::end_modes_of(const rcl_cxx::GoalUUID & goal)
{
  forget_owner_of_ended_modes();
  {
    const std::lock_guard lock(mode_owner_mutex_);
    if (!mode_owner_ || mode_owner_->get_goal_id() != goal) {
      return;
    }
    mode_owner_.reset();
  }
  const Error why{
      ErrorCode::client_lost,
      "the client that switched on the mode of the arm has disappeared: keep its action client alive, "
      "or set outlives_client"};
  begin_stop({}, why);
  RCL_CXX_WARN(node().get_logger(), "the arm is stopped: {}", why.message);
}

void CommandHost::set_hindrance(const void * supervision, const std::optional<Error> & why)
{
  const std::lock_guard lock(hindrances_mutex_);
  if (why) {
    hindrances_[supervision] = *why;
  } else {
    hindrances_.erase(supervision);
  }
}

Status CommandHost::may_move() const
{
  const std::lock_guard lock(hindrances_mutex_);
  return hindrances_.empty() ? Status() : tl::unexpected(hindrances_.begin()->second);
}

void CommandHost::add_command(const std::string & name, CommandPlugin & command)
{
  {
    const std::lock_guard lock(commands_mutex_);
    commands_[name] = &command;
  }
  commands_changed_.notify_all();
}

void CommandHost::complete_commands()
{
  {
    const std::lock_guard lock(commands_mutex_);
    has_all_commands_ = true;
  }
  commands_changed_.notify_all();
}

void CommandHost::remove_command(const std::string & name)
{
  const std::lock_guard lock(commands_mutex_);
  commands_.erase(name);
}

CommandPlugin * CommandHost::find_command(const std::string & name, const std::stop_token & stop) const
{
  std::unique_lock lock(commands_mutex_);
  commands_changed_.wait_for(lock, stop, commands_timeout,
                             [&] { return has_all_commands_ || commands_.contains(name); });
  const auto found = commands_.find(name);
  return found == commands_.end() ? nullptr : found->second;
}

ArmLimits CommandHost::limits() const
{
  return robot_.limits();
}

}  // namespace ur_ros_rtde
