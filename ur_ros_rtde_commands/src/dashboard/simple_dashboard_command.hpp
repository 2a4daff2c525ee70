#pragma once

#include <string>
#include <utility>

#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

/// A dashboard command that is described by one request and by the controllers that support it. If the goal
/// has a field `text`, the text is appended to the line.
template <typename A>
class SimpleDashboardCommand : public DashboardCommand<A> {
 public:
  explicit SimpleDashboardCommand(DashboardRequest request, DashboardLimits limits = {})
      : request_(std::move(request)), limits_(std::move(limits))
  {
  }

  DashboardLimits limits() const override { return limits_; }
  DashboardRequest request([[maybe_unused]] const typename A::Goal & goal) const override
  {
    DashboardRequest request = request_;
    if constexpr (requires { goal.text; }) {
      request.line += " " + goal.text;
    }
    return request;
  }

 private:
  const DashboardRequest request_;
  const DashboardLimits limits_;
};

}  // namespace ur_ros_rtde

/// Defines and exports `Class` as the plugin `action_name`, an action of the type
/// ur_ros_rtde_msgs/action/Type. The other arguments are those of SimpleDashboardCommand: the request and the
/// limits.
#define EXPORT_DASHBOARD_COMMAND(Class, action_name, Type, ...)                        \
  class Class : public SimpleDashboardCommand<::ur_ros_rtde_msgs::action::Type> {      \
   public:                                                                             \
    Class() : SimpleDashboardCommand<::ur_ros_rtde_msgs::action::Type>(__VA_ARGS__) {} \
  };                                                                                   \
  UR_ROS_RTDE_EXPORT(Class, action_name)
