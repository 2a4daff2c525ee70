#include "dashboard/simple_dashboard_command.hpp"

namespace ur_ros_rtde {

class Load : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardText> {
  Request request(const Goal & goal) const override
  {
    // The answer to programState contains the name of the program without its directory.
    const std::string file_name = goal.text.substr(goal.text.find_last_of('/') + 1);
    // The driver may start its own program at once.
    return {"load " + goal.text,
            "Loading program: ",
            {"programState", {"STOPPED " + file_name, "PLAYING " + file_name}, true}};
  }
};

UR_ROS_RTDE_EXPORT(Load, "dashboard/load")

class Raw : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardText> {
  Outcome run(const Goal & goal, Run & run) override { return run.raw(goal.text); }
};

UR_ROS_RTDE_EXPORT(Raw, "dashboard/raw")

EXPORT_DASHBOARD_COMMAND(LoadInstallation, "dashboard/load_installation", DashboardText,
                         {"load installation", "Loading installation: "}, {.e_series = {5, 0}, .cb3 = {3, 2}})
EXPORT_DASHBOARD_COMMAND(Popup, "dashboard/popup", DashboardText, {"popup", "showing popup"})
EXPORT_DASHBOARD_COMMAND(AddToLog, "dashboard/add_to_log", DashboardText, {"addToLog", "Added log message"})
EXPORT_DASHBOARD_COMMAND(SetOperationalMode, "dashboard/set_operational_mode", DashboardText,
                         {"set operational mode", "Operational mode"},
                         {.e_series = {5, 0}, .cb3 = never, .texts = {"manual", "automatic"}})
EXPORT_DASHBOARD_COMMAND(
    SetUserRole, "dashboard/set_user_role", DashboardText, {"setUserRole", "Setting user role"},
    {.e_series = never, .cb3 = {3, 1}, .texts = {"programmer", "operator", "none", "locked", "restricted"}})
EXPORT_DASHBOARD_COMMAND(GenerateFlightReport, "dashboard/generate_flight_report", DashboardText,
                         {"generate flight report", "Flight Report generated with id", {}, 180.0},
                         {.e_series = {5, 8}, .cb3 = {3, 13}, .texts = {"controller", "software", "system"}})
EXPORT_DASHBOARD_COMMAND(GenerateSupportFile, "dashboard/generate_support_file", DashboardText,
                         {"generate support file", "Completed successfully", {}, 600.0},
                         {.e_series = {5, 8}, .cb3 = {3, 13}})

}  // namespace ur_ros_rtde
