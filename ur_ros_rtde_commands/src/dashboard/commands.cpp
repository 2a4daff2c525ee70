#include "dashboard/simple_dashboard_command.hpp"

namespace ur_ros_rtde {

/// Ends the program of the robot, and with it every motion.
class StoppingCommand : public SimpleDashboardCommand<ur_ros_rtde_msgs::action::DashboardCommand> {
 public:
  using SimpleDashboardCommand::SimpleDashboardCommand;
  bool stops_program() const override { return true; }
};

// Arm power
EXPORT_DASHBOARD_COMMAND(PowerOn, "dashboard/power_on", DashboardCommand,
                         {.line = "power on",
                          .reply = "Powering on",
                          .expected = {"robotmode", {"IDLE", "RUNNING"}},
                          .starts = Starts::power})
class PowerOff : public StoppingCommand {
 public:
  PowerOff() : StoppingCommand({"power off", "Powering off", {"robotmode", {"POWER_OFF"}}}) {}
  bool powers_off() const override { return true; }
};
UR_ROS_RTDE_EXPORT(PowerOff, "dashboard/power_off")
EXPORT_DASHBOARD_COMMAND(BrakeRelease, "dashboard/brake_release", DashboardCommand,
                         {.line = "brake release",
                          .reply = "Brake releasing",
                          .expected = {"robotmode", {"RUNNING"}},
                          .starts = Starts::power})
class Shutdown : public StoppingCommand {
 public:
  Shutdown() : StoppingCommand({"shutdown", "Shutting down"}) {}
  bool powers_off() const override { return true; }
};
UR_ROS_RTDE_EXPORT(Shutdown, "dashboard/shutdown")

// Program
EXPORT_DASHBOARD_COMMAND(Play, "dashboard/play", DashboardCommand,
                         {.line = "play",
                          .reply = "Starting program",
                          .expected = {"programState", {"PLAYING"}},
                          .starts = Starts::program})
class Pause : public SimpleDashboardCommand<ur_ros_rtde_msgs::action::DashboardCommand> {
 public:
  // The driver ends its own program as soon as it is paused, and may start it again.
  Pause()
      : SimpleDashboardCommand({"pause", "Pausing program", {"programState", {"PAUSED", "STOPPED"}, true}})
  {
  }
  bool stops_arm() const override { return true; }  // but not the program, which can go on
};
UR_ROS_RTDE_EXPORT(Pause, "dashboard/pause")
class StopProgram : public StoppingCommand {
 public:
  StopProgram() : StoppingCommand({"stop", "Stopped", {"programState", {"STOPPED"}, true}}) {}
};
UR_ROS_RTDE_EXPORT(StopProgram, "dashboard/stop")

// Safety
EXPORT_DASHBOARD_COMMAND(UnlockProtectiveStop, "dashboard/unlock_protective_stop", DashboardCommand,
                         {"unlock protective stop",
                          "Protective stop releasing",
                          {"safetymode", {"NORMAL", "REDUCED"}}},
                         {.e_series = {5, 0}, .cb3 = {3, 1}})
EXPORT_DASHBOARD_COMMAND(RestartSafety, "dashboard/restart_safety", DashboardCommand,
                         {"restart safety", "Restarting safety", {"safetymode", {"NORMAL", "REDUCED"}}},
                         {.e_series = {5, 1}, .cb3 = {3, 7}})
EXPORT_DASHBOARD_COMMAND(ClearOperationalMode, "dashboard/clear_operational_mode", DashboardCommand,
                         {"clear operational mode", "No longer controlling the operational mode"},
                         {.e_series = {5, 0}, .cb3 = never})

// Popups and log
EXPORT_DASHBOARD_COMMAND(ClosePopup, "dashboard/close_popup", DashboardCommand,
                         {"close popup", "closing popup"})
EXPORT_DASHBOARD_COMMAND(CloseSafetyPopup, "dashboard/close_safety_popup", DashboardCommand,
                         {"close safety popup", "closing safety popup"}, {.e_series = {5, 0}, .cb3 = {3, 1}})
EXPORT_DASHBOARD_COMMAND(SaveLog, "dashboard/save_log", DashboardCommand, {"saveLog", "Log saved to disk"},
                         {.e_series = {5, 8}, .cb3 = {3, 13}})

}  // namespace ur_ros_rtde
