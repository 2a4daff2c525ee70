#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <rcl_cxx/node.hpp>
#include <rcl_cxx/server_goal_handle.hpp>
#include <stop_token>
#include <string>
#include <ur_ros_rtde_msgs/msg/goal_rejected.hpp>
#include <utility>
#include <vector>

#include "ur_ros_rtde/detail/goals.hpp"
#include "ur_ros_rtde/detail/startup_requests.hpp"
#include "ur_ros_rtde/frames.hpp"
#include "ur_ros_rtde_robot/motion/motion.hpp"
#include "ur_ros_rtde_trajectory/arm_limits.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

class CommandPlugin;
class DashboardConnection;
class Robot;

/// What a server provides to its plugins.
class PluginHost {
 public:
  // For the driver

  /// `servers_on_demand`: an action server is created for its first client.
  explicit PluginHost(rcl_cxx::Node & node, bool servers_on_demand = false);

  // For plugins

  /// For parameters, topics, services and timers of a plugin.
  rcl_cxx::Node & node() { return node_; }
  /// For their callbacks: the thread of this group is that of all plugins, and delays no goal. Without it,
  /// they run in the thread that accepts the goals of all commands.
  const rcl_cxx::CallbackGroup::SharedPtr & callbacks() const { return plugin_group_; }

  // For the driver

  Goals & goals() { return goals_; }
  /// The callbacks of stops, of cancel requests and of lost clients. Served by a thread of its own, which
  /// runs no other code of plugins than the check of a stop.
  const rcl_cxx::CallbackGroup::SharedPtr & stop_group() const { return stop_group_; }
  /// Creates action servers on demand, in a thread of its own: a new client must not delay the callbacks of
  /// this node. Empty: they are created at once.
  const rcl_cxx::CallbackGroup::SharedPtr & creation_group() const { return creation_group_; }
  /// The groups that need a thread of their own.
  std::vector<const rcl_cxx::CallbackGroup *> groups() const;
  /// Publishes on goal_rejections why a goal was rejected.
  void publish_rejection(const std::string & action, const rcl_cxx::GoalUUID & id, const Error & why);

 private:
  rcl_cxx::Node & node_;
  rcl_cxx::Publisher<ur_ros_rtde_msgs::msg::GoalRejected>::SharedPtr rejections_;
  const rcl_cxx::CallbackGroup::SharedPtr plugin_group_;
  const rcl_cxx::CallbackGroup::SharedPtr stop_group_;
  const rcl_cxx::CallbackGroup::SharedPtr creation_group_;
  Goals goals_;
};

/// What command_server provides to its plugins: see CommandPlugin::on_load().
class CommandHost : public PluginHost {
 public:
  /// The parameters of the node that concern all commands.
  struct Options {
    bool preempt_when_busy = false;
    std::string tf_prefix{};  ///< of the names of joints and frames
    bool stop_when_client_lost = true;
    bool servers_on_demand = false;
  };

  // For the driver

  CommandHost(rcl_cxx::Node & node, Robot & robot, const Options & options)
      : PluginHost(node, options.servers_on_demand),
        robot_(robot),
        options_(options),
        frames_(node, options.tf_prefix + "base", callbacks())
  {
  }

  // For plugins

  Robot & robot() { return robot_; }
  /// Its `tf_prefix` is that of the names of joints and frames.
  const Options & options() const { return options_; }
  /// Where the frames of TF are.
  Frames & frames() { return frames_; }
  /// The limits of the robot's model; see Robot::limits().
  ArmLimits limits() const;
  /// Robot::begin_stop(), after which no goal moves the arm that was received before.
  std::shared_future<Expected<StopReport>> begin_stop(const StopOptions & options, const Error & why);

  // For the driver

  /// For a command that stops the program through the dashboard server: ends the script that runs or is about
  /// to run, and no goal moves the arm that was received before. The control program is not started in its
  /// place while the returned object exists.
  std::shared_ptr<void> end_script(const Error & why);
  /// Number of calls of begin_stop() and end_script().
  std::uint32_t stops() const { return stops_; }
  /// For a request that brings the arm into operation, which is under way while the returned object exists.
  /// Null, and it must not be sent, if `stops` are not all stops.
  std::shared_ptr<void> begin_startup_request(std::uint32_t stops);
  /// After a stop has begun: whether a request is under way that would bring the arm into operation again, or
  /// has just ended.
  bool has_startup_requests() const { return startup_requests_.may_take_effect(); }
  /// Waits for them, but at most 3.5 s.
  void wait_for_startup_requests();
  /// For a goal that may switch a mode which outlasts it, until the returned object is destroyed.
  std::shared_ptr<void> begin_mode_switch();
  /// Number of their begins and ends. Goals that see it change leave the modes on when they succeed.
  std::uint32_t mode_switches() const { return mode_switches_; }
  /// The client of this goal keeps the modes on that outlast their goal: end_modes_of() stops the arm.
  /// Replaces the goal before; null: no client does.
  void set_mode_owner(std::shared_ptr<rcl_cxx::ServerGoalHandle> goal);
  /// A mode that is off has no owner.
  void forget_owner_of_ended_modes();
  /// The client of this goal has disappeared.
  void end_modes_of(const rcl_cxx::GoalUUID & goal);
  /// Why no goal may move the arm; empty: this supervision has no reason.
  void set_hindrance(const void * supervision, const std::optional<Error> & why);
  /// Fails with the first of these reasons.
  Status may_move() const;
  /// The commands that Run::call() finds, by name.
  void add_command(const std::string & name, CommandPlugin & command);
  void remove_command(const std::string & name);
  /// No command follows.
  void complete_commands();
  /// Waits while commands are still being added, at most 10 s. Null if there is none of that name.
  CommandPlugin * find_command(const std::string & name, const std::stop_token & stop) const;

 private:
  Robot & robot_;
  Options options_;
  Frames frames_;
  std::atomic<std::uint32_t> stops_ = 0;
  StartupRequests startup_requests_;
  std::atomic<std::uint32_t> mode_switches_ = 0;
  std::mutex mode_owner_mutex_;
  std::shared_ptr<rcl_cxx::ServerGoalHandle> mode_owner_;
  mutable std::mutex hindrances_mutex_;
  std::map<const void *, Error> hindrances_;  ///< by supervision
  mutable std::mutex commands_mutex_;
  mutable std::condition_variable_any commands_changed_;
  bool has_all_commands_ = false;
  std::map<std::string, CommandPlugin *> commands_;
};

/// What dashboard_server provides to its plugins: see DashboardPlugin::on_load().
class DashboardHost : public PluginHost {
 public:
  // For the driver

  /// `commands`: of the command server in this process; null if there is none.
  DashboardHost(rcl_cxx::Node & node, bool servers_on_demand, DashboardConnection & connection,
                CommandHost * commands)
      : PluginHost(node, servers_on_demand), connection_(connection), commands_(commands)
  {
  }

  // For plugins

  DashboardConnection & connection() { return connection_; }
  /// See ur_ros_rtde::has_dashboard_server().
  Status has_dashboard_server() const;

  // For the driver

  /// The same as of CommandHost; without command_server, none and zero.
  std::shared_ptr<void> end_script(const Error & why) const
  {
    return commands_ != nullptr ? commands_->end_script(why) : nullptr;
  }
  bool has_startup_requests() const { return commands_ != nullptr && commands_->has_startup_requests(); }
  void wait_for_startup_requests() const
  {
    if (commands_ != nullptr) {
      commands_->wait_for_startup_requests();
    }
  }
  std::uint32_t stops() const { return commands_ != nullptr ? commands_->stops() : 0; }
  /// Fails (preempted) if the request must not be sent. Null without command server.
  Expected<std::shared_ptr<void>> begin_startup_request(std::uint32_t stops) const;

 private:
  DashboardConnection & connection_;
  CommandHost * const commands_;
};

}  // namespace ur_ros_rtde
