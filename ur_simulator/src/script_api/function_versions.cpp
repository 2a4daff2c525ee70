#include "script_api/function_versions.hpp"

#include <fmt/format.h>

#include <iterator>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "script_api/function_reference.hpp"

namespace ur_simulator {

namespace {

constexpr PolyscopeVersion always = MinVersion::always;
constexpr PolyscopeVersion never = MinVersion::never;

/// Functions with the same first versions.
struct FunctionGroup {
  MinVersion since;
  const char * names;
};

// Each group with its evidence: UR's script manuals for 3.15.4, 5.11, 5.22 and 5.25; the version guards in
// ur_rtde's control script and in the external control program of UR's client library; the lists of a
// URScript extension for an editor. The manual for 3.15 is complete: what only manuals of PolyScope 5 list
// does not exist on CB3. Where the first version is not known exactly, it is the earliest one that the
// evidence permits. Functions that no manual lists (get_joint_positions, servoc, zero_ftsensor and
// force_mode_set_gain_scaling on CB3) exist in every version, because public clients run on robots with
// programs that name them.
constexpr FunctionGroup version_groups[] = {
    // ur_rtde
    {{always, {3, 5}}, "force_mode_set_damping"},
    // ur_rtde
    {{always, {3, 6}}, "get_tcp_offset"},
    // ur_rtde
    {{always, {3, 8}}, "protective_stop"},
    // manual for 3.15
    {{always, never},
     "end_screw_driving screw_driving modbus_request_update_now set_tool_communication "
     "set_tool_digital_output_mode set_tool_output_mode"},
    // ur_rtde; manual for 3.15
    {{{5, 3}, always}, "get_target_waypoint"},
    // ur_rtde; UR's external control program names them on CB3
    {{{5, 4}, always}, "get_actual_joint_positions_history tool_contact"},
    // UR, "Modify robot trajectory by overlaying custom motion"
    {{{5, 6}, never},
     "path_offset_disable path_offset_enable path_offset_get path_offset_set "
     "path_offset_set_alpha_filter path_offset_set_max_offset"},
    // reported by users of UR's simulator: 5.9.4 compiles it, 5.8.2 does not; ur_rtde needs 5.10 or 3.15
    {{{5, 9}, {3, 14}}, "get_inverse_kin_has_solution"},
    // UR's external control program
    {{{5, 9, 1}, {3, 14, 1}}, "ft_rtde_input_enable"},
    // UR, "Interpreter mode"
    {{{5, 10}, never}, "clear_interpreter end_interpreter interpreter_mode"},
    // ur_rtde, UR's external control program
    {{{5, 10}, never}, "get_freedrive_status get_target_payload_inertia set_target_payload"},
    // not in the manual for 5.11; in the editor's list of May 2022
    {{{5, 12}, never},
     "request_boolean_from_primary_client request_float_from_primary_client "
     "request_integer_from_primary_client request_string_from_primary_client"},
    // not in the manual for 5.11; in the editor's list for 5.15
    {{{5, 12}, never},
     "estimate_payload high_holding_torque_disable high_holding_torque_enable make_list "
     "modbus_add_rw_signal modbus_get_error modbus_get_time_since_signal_invalid "
     "modbus_reset_connection modbus_set_signal_watchdog set_base_acceleration set_baselight_iec "
     "set_baselight_off set_baselight_solid"},
    // not in the manual for 5.11; in the editor's list for 5.18
    {{{5, 12}, never}, "time"},
    // in the editor's list for 5.17, not in that for 5.15
    {{{5, 16}, never}, "get_base_acceleration get_gravity get_tool_temp"},
    // in the editor's list for 5.19, not in that for 5.17
    {{{5, 18}, never}, "tool_wrench_limit_disable tool_wrench_limit_set"},
    // in the manual for 5.25, not in the editor's list for 5.19
    {{{5, 20}, never},
     "add_frame attach_frame convert_pose delete_all_frames delete_frame frame_tracking_disable "
     "frame_tracking_enable get_children get_frame_parent get_pose is_frame move_frame "
     "reset_world_model set_mass_properties set_payload_from_attached_frames eip_reader_factory "
     "eip_writer_factory force_mode_get_damping force_mode_get_gain_scaling "
     "get_actual_joint_accelerations get_rtde_value jerk_gain_scaling_get jerk_gain_scaling_set"},
    // UR's external control program
    {{{5, 21}, never}, "optimovej optimovel"},
    // manual for 5.22
    {{{5, 22}, never}, "motion_version_get motion_version_set"},
    // ur_rtde, UR's external control program
    {{{5, 23}, never},
     "direct_torque get_coriolis_and_centrifugal_torques get_jacobian get_jacobian_time_derivative "
     "get_mass_matrix get_target_joint_accelerations"},
};

std::vector<std::string> names_of(const FunctionGroup & group)
{
  std::istringstream names(group.names);
  return {std::istream_iterator<std::string>(names), {}};
}

std::string version_text(const PolyscopeVersion & version)
{
  if (version == always) {
    return "all";
  }
  if (version == never) {
    return "none";
  }
  return version.bugfix == 0 ? fmt::format("{}.{}", version.major, version.minor)
                             : fmt::format("{}.{}.{}", version.major, version.minor, version.bugfix);
}

}  // namespace

std::shared_ptr<const urscript::Library> with_functions_of(const PolyscopeVersion & version,
                                                           const urscript::Library & library)
{
  auto reduced = std::make_shared<urscript::Library>(library);
  for (const FunctionGroup & group : version_groups) {
    if (!group.since.is_met_by(version)) {
      for (const std::string & name : names_of(group)) {
        reduced->hide(name);
      }
    }
  }
  return reduced;
}

std::string function_version_reference()
{
  std::string text = "| e-Series from | CB3 from | functions |\n|---|---|---|\n";
  for (const FunctionGroup & group : version_groups) {
    std::string versions =
        fmt::format("{} | {}", version_text(group.since.e_series), version_text(group.since.cb3));
    for (const std::string & cell : code_cells(names_of(group))) {
      text += fmt::format("| {} | {} |\n", std::exchange(versions, " | "), cell);
    }
  }
  return text;
}

}  // namespace ur_simulator
