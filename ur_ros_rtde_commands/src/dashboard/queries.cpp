#include "dashboard/simple_dashboard_command.hpp"

namespace ur_ros_rtde {

// Program
EXPORT_DASHBOARD_COMMAND(Running, "dashboard/running", DashboardQuery, {"running"})
EXPORT_DASHBOARD_COMMAND(GetProgramState, "dashboard/program_state", DashboardQuery, {"programState"})
EXPORT_DASHBOARD_COMMAND(GetLoadedProgram, "dashboard/get_loaded_program", DashboardQuery,
                         {"get loaded program"})
EXPORT_DASHBOARD_COMMAND(IsProgramSaved, "dashboard/is_program_saved", DashboardQuery, {"isProgramSaved"})

// Robot
EXPORT_DASHBOARD_COMMAND(GetRobotMode, "dashboard/robot_mode", DashboardQuery, {"robotmode"})
EXPORT_DASHBOARD_COMMAND(GetSafetyMode, "dashboard/safety_mode", DashboardQuery, {"safetymode"})
EXPORT_DASHBOARD_COMMAND(GetSafetyStatus, "dashboard/safety_status", DashboardQuery, {"safetystatus"},
                         {.e_series = {5, 4}, .cb3 = {3, 11}})
EXPORT_DASHBOARD_COMMAND(GetRobotModel, "dashboard/get_robot_model", DashboardQuery, {"get robot model"},
                         {.e_series = {5, 6}, .cb3 = {3, 12}})
EXPORT_DASHBOARD_COMMAND(GetSerialNumber, "dashboard/get_serial_number", DashboardQuery,
                         {"get serial number"}, {.e_series = {5, 6}, .cb3 = {3, 12}})

// PolyScope
EXPORT_DASHBOARD_COMMAND(PolyscopeVersion, "dashboard/polyscope_version", DashboardQuery,
                         {"PolyscopeVersion"})
EXPORT_DASHBOARD_COMMAND(GetVersion, "dashboard/version", DashboardQuery, {"version"},
                         {.e_series = {5, 0}, .cb3 = never})
EXPORT_DASHBOARD_COMMAND(GetOperationalMode, "dashboard/get_operational_mode", DashboardQuery,
                         {"get operational mode"}, {.e_series = {5, 6}, .cb3 = never})
EXPORT_DASHBOARD_COMMAND(GetUserRole, "dashboard/get_user_role", DashboardQuery, {"getUserRole"},
                         {.e_series = never, .cb3 = {3, 1}})
EXPORT_DASHBOARD_COMMAND(IsInRemoteControl, "dashboard/is_in_remote_control", DashboardQuery,
                         {"is in remote control"}, {.e_series = {5, 6}, .cb3 = never})

}  // namespace ur_ros_rtde
