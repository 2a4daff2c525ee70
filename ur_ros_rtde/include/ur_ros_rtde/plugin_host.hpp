#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <rcl_cxx/node.hpp>
#include <string>
#include <ur_ros_rtde_msgs/msg/goal_refused.hpp>

#include "ur_ros_rtde/detail/goal_threads.hpp"
#include "ur_ros_rtde_robot/motion/motion.hpp"
#include "ur_ros_rtde_trajectory/arm_limits.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

class DashboardConnection;
class Robot;

/// What a server provides to its plugins.
class PluginHost {
 public:
  explicit PluginHost(rcl_cxx::Node & node);

  rcl_cxx::Node & node() { return node_; }
  GoalThreads & goal_threads() { return goal_threads_; }
  /// Publishes on goal_refusals why a goal was rejected.
  void publish_refusal(const std::string & action, const rcl_cxx::GoalUUID & id, const Error & why);

 private:
  rcl_cxx::Node & node_;
  rcl_cxx::Publisher<ur_ros_rtde_msgs::msg::GoalRefused>::SharedPtr refusals_;
  GoalThreads goal_threads_;
};

class CommandHost : public PluginHost {
 public:
  struct Options {
    bool preempt_when_busy = false;
    bool stop_when_client_lost = true;
  };

  CommandHost(rcl_cxx::Node & node, Robot & robot, const Options & options)
      : PluginHost(node), robot_(robot), options_(options)
  {
  }

  Robot & robot() { return robot_; }
  const Options & options() const { return options_; }
  /// The limits of the robot's model; see Robot::limits().
  ArmLimits limits() const;

  /// How a preempted goal has to decelerate, set while a goal with CommandTraits::preempts_all waits for the
  /// resource. Empty: as the preempted goal says.
  void set_preemption_stop(std::optional<StopOptions> options);
  std::optional<StopOptions> preemption_stop() const;

 private:
  Robot & robot_;
  Options options_;
  mutable std::mutex mutex_;
  std::optional<StopOptions> preemption_stop_;
};

class DashboardHost : public PluginHost {
 public:
  DashboardHost(rcl_cxx::Node & node, DashboardConnection & connection)
      : PluginHost(node), connection_(connection)
  {
  }
  DashboardConnection & connection() { return connection_; }

 private:
  DashboardConnection & connection_;
};

}  // namespace ur_ros_rtde
