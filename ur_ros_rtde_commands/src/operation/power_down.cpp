#include <chrono>
#include <tuple>
#include <ur_ros_rtde_msgs/action/dashboard_command.hpp>

#include "operation/dashboard_helpers.hpp"
#include "operation/run_steps.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

class PowerDown : public Command<ur_ros_rtde_msgs::action::DashboardCommand> {
  CommandTraits traits() const override { return {.preempts_all = true, .allowed_in_any_state = true}; }

  void check(const Goal & goal, Check & check) const override
  {
    check.above_zero("timeout", goal.timeout, 600.0, "s");
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    constexpr std::chrono::seconds stop_timeout{1}, power_off_timeout{10};  // PolyScope 5 answers after 1 s
    if (const auto stopped = run.wait_for_stop(); !stopped) {
      run.warn(stopped.error().message);  // all the more reason to power off
    }
    DashboardSession dashboard(run.robot().address());
    std::ignore = dashboard.request("stop", stop_timeout);  // the power off does not depend on it
    const Status off = command_dashboard(dashboard, "power off", "Powering off", power_off_timeout);
    if (!off) {
      return off;
    }
    return run_steps(run, goal.timeout, [&]() -> std::string {
      const std::string mode = query_dashboard(dashboard, "robotmode");
      return mode == "POWER_OFF" ? "" : "powering off (mode " + mode + ")";
    });
  }
};

UR_ROS_RTDE_EXPORT(PowerDown, "stand_down")

}  // namespace ur_ros_rtde
