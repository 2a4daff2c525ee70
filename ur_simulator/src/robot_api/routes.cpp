#include "robot_api/routes.hpp"

#include "robot_api/handlers.hpp"

namespace ur_simulator::robot_api {
namespace {

constexpr PolyscopeVersion v10(std::uint32_t minor)
{
  return {10, minor, 0, 0};
}

constexpr std::string_view robot_actions =
    "POWER_ON|POWER_OFF|BRAKE_RELEASE|UNLOCK_PROTECTIVE_STOP|RESTART_SAFETY";
constexpr std::string_view program_actions = "play|pause|resume|stop";

constexpr auto with_json = BodyType::json;
constexpr auto with_file = BodyType::file;

// The columns: method, path, first version, whether remote control is required, handler, body.
constexpr std::array route_table{
    Route{"GET", "/openapi.json", v10(11), false, get_openapi},

    Route{"PUT",
          "/robotstate/v1/state",
          v10(11),
          true,
          change_robot_state,
          with_json,
          {{{"action", robot_actions}}}},
    Route{"GET", "/robotstate/v1/robotmode", v10(12), false, get_robot_mode},
    Route{"GET", "/robotstate/v1/safetymode", v10(12), false, get_safety_mode},

    Route{"GET", "/program/v1/state", v10(11), false, get_program_state},
    Route{"PUT",
          "/program/v1/state",
          v10(11),
          true,
          change_program_state,
          with_json,
          {{{"action", program_actions}}}},
    Route{"PUT",
          "/program/v1/load",
          v10(11),
          true,
          load_program_by_program_name,
          with_json,
          {{{"programName"}}}},
    Route{"GET", "/program/v1/loaded", v10(12), false, get_loaded_program},
    Route{"PUT", "/program/v1/loaded", v10(12), true, load_program, with_json, {{{"name"}}}},

    Route{"GET", "/programs/v1/", v10(12), false, list_programs},
    Route{"GET", "/programs/v1/{name}", v10(12), false, download_program},
    Route{"POST", "/programs/v1/", v10(12), false, upload_program, with_file},
    Route{"PUT", "/programs/v1/", v10(12), false, update_program, with_file},

    Route{"GET", "/system/v1/system-time", v10(11), false, get_system_time},
    Route{"GET", "/system/v1/controlmode", v10(12), false, get_control_mode},
    Route{"GET", "/system/v1/operationalmode", v10(12), false, get_operational_mode},
    Route{"GET", "/system/v1/information", v10(14), false, get_information},
    Route{"POST", "/system/v1/log", v10(14), true, add_to_log, with_json, {{{"message"}}}},
    Route{"PUT", "/system/v1/shutdown", v10(14), true, shut_down},
    Route{"GET", "/versions/v1", v10(14), false, get_versions},

    Route{"POST", "/popup/v1", v10(14), true, open_popup, with_json, {{{"message"}, {"title", "", false}}}},
    Route{"DELETE", "/popup/v1", v10(14), true, close_popup},
    Route{"DELETE", "/popup/v1/safety", v10(14), true, close_safety_popup},

    Route{"POST", "/supportfiles/v1", v10(14), true, generate_flight_report},
    Route{"GET", "/supportfiles/v1", v10(14), false, download_support_files},
};

}  // namespace

std::string_view api_version(const PolyscopeVersion & version)
{
  if (version >= v10(14)) {
    return "5.0.107";
  }
  // Published are only that of 10.12, and that the others are between their neighbors.
  return version >= v10(13) ? "4.0.0" : version >= v10(12) ? "3.1.4" : "2.0.0";
}

std::span<const Route> routes()
{
  return route_table;
}

}  // namespace ur_simulator::robot_api
