#include <cstdlib>
#include <fstream>
#include <sstream>

#include "script_api/function_reference.hpp"
#include "script_api/function_versions.hpp"
#include "script_api/http_request.hpp"
#include "script_api/script_socket.hpp"
#include "script_fixture.hpp"

namespace ur_simulator {
namespace {

// The functions that the script manual of PolyScope 5.25 lists, and those that only manuals of 3.x have.
constexpr const char * manual_functions = R"(
servoc set_runstate_outputs set_runstate_gp_float_output_to_value set_runstate_gp_integer_output_to_value
acos add_frame asin atan atan2 attach_frame binary_list_to_integer ceil convert_pose
conveyor_pulse_decode cos d2r delete_all_frames delete_frame direct_torque enable_external_ft_sensor
encoder_enable_pulse_decode encoder_enable_set_tick_count encoder_get_tick_count encoder_set_tick_count
encoder_unwind_delta_tick_count end_force_mode end_freedrive_mode end_screw_driving end_teach_mode
estimate_payload floor force force_mode force_mode_get_damping force_mode_get_gain_scaling
force_mode_set_damping force_mode_set_gain_scaling frame_tracking_disable frame_tracking_enable
freedrive_mode freedrive_mode_no_incorrect_payload_check ft_rtde_input_enable
get_actual_joint_accelerations get_actual_joint_positions get_actual_joint_positions_history
get_actual_joint_speeds get_actual_tcp_pose get_actual_tcp_speed get_actual_tool_flange_pose
get_analog_in get_analog_out get_base_acceleration get_children get_configurable_digital_in
get_configurable_digital_out get_controller_temp get_conveyor_tick_count
get_coriolis_and_centrifugal_torques get_digital_in get_digital_out get_euromap_input get_euromap_output
get_flag get_forward_kin get_frame_parent get_freedrive_status get_gravity get_inverse_kin
get_inverse_kin_has_solution get_jacobian get_jacobian_time_derivative get_joint_temp get_joint_torques
get_list_length get_mass_matrix get_pose get_rtde_value get_standard_analog_in get_standard_analog_out
get_standard_digital_in get_standard_digital_out get_steptime get_target_joint_accelerations
get_target_joint_positions get_target_joint_speeds get_target_payload get_target_payload_cog
get_target_payload_inertia get_target_tcp_pose get_target_tcp_pose_along_path get_target_tcp_speed
get_target_tcp_speed_along_path get_target_waypoint get_tcp_force get_tcp_offset
get_tool_accelerometer_reading get_tool_analog_in get_tool_current get_tool_digital_in
get_tool_digital_out get_tool_temp high_holding_torque_disable high_holding_torque_enable
integer_to_binary_list interpolate_pose inv is_frame is_steady is_within_safety_limits
jerk_gain_scaling_get jerk_gain_scaling_set length log make_list modbus_add_rw_signal modbus_add_signal
modbus_delete_signal modbus_get_error modbus_get_signal_status modbus_get_time_since_signal_invalid
modbus_reset_connection modbus_send_custom_command modbus_set_digital_input_action
modbus_set_output_register modbus_set_output_signal modbus_set_runstate_dependent_choice
modbus_set_signal_update_frequency modbus_set_signal_watchdog motion_version_get motion_version_set
move_frame movec movej movel movep norm normalize optimovej optimovel path_offset_disable
path_offset_enable path_offset_get path_offset_set path_offset_set_alpha_filter
path_offset_set_max_offset pause_on_error_code point_dist popup pose_add pose_dist pose_inv pose_sub
pose_trans position_deviation_warning pow powerdown protective_stop r2d random
read_input_boolean_register read_input_float_register read_input_integer_register
read_output_boolean_register read_output_float_register read_output_integer_register read_port_bit
read_port_register request_boolean_from_primary_client request_float_from_primary_client
request_integer_from_primary_client request_string_from_primary_client reset_revolution_counter
reset_world_model rotvec2rpy rpc_factory rpy2rotvec rtde_set_watchdog screw_driving servoj
set_analog_inputrange set_analog_out set_analog_outputdomain set_base_acceleration set_baselight_iec
set_baselight_off set_baselight_solid set_configurable_digital_input_action set_configurable_digital_out
set_conveyor_tick_count set_digital_out set_euromap_output set_euromap_runstate_dependent_choice
set_flag set_gp_boolean_input_action set_gravity set_input_actions_to_default set_mass_properties
set_payload set_payload_cog set_payload_from_attached_frames set_payload_mass set_pos
set_runstate_configurable_digital_output_to_value set_runstate_gp_boolean_output_to_value
set_runstate_standard_analog_output_to_value set_runstate_standard_digital_output_to_value
set_runstate_tool_digital_output_to_value set_safety_mode_transition_hardness
set_standard_analog_input_domain set_standard_analog_out set_standard_digital_input_action
set_standard_digital_out set_target_payload set_tcp set_tool_analog_input_domain set_tool_communication
set_tool_digital_input_action set_tool_digital_out set_tool_digital_output_mode set_tool_output_mode
set_tool_voltage sin size sleep socket_close socket_get_var socket_open socket_read_ascii_float
socket_read_binary_integer socket_read_byte_list socket_read_line socket_read_string socket_send_byte
socket_send_int socket_send_line socket_send_string socket_set_var speedj speedl sqrt
stop_conveyor_tracking stopj stopl str_at str_cat str_empty str_find str_len str_sub sync tan teach_mode
textmsg time to_num to_str tool_contact tool_wrench_limit_disable tool_wrench_limit_set
track_conveyor_circular track_conveyor_linear transpose wrench_trans write_output_boolean_register
write_output_float_register write_output_integer_register write_port_bit write_port_register
zero_ftsensor
)";

std::shared_ptr<const urscript::Library> complete_library(const ScriptFixture & fixture)
{
  const auto library =
      with_sockets(*fixture.library, [](const std::string &, std::uint16_t) { return nullptr; });
  return with_xml_rpc(*library, [](const HttpAddress &, const std::string &) { return nullptr; });
}

TEST(FunctionReferenceTest, TheLibraryHasEveryFunctionOfTheManual)
{
  const ScriptFixture fixture;
  const auto library = complete_library(fixture);
  std::istringstream names(manual_functions);
  for (std::string name; names >> name;) {
    EXPECT_TRUE(library->find(name).has_value()) << name;
  }
}

TEST(FunctionReferenceTest, EveryDifferenceFromTheRobotHasANote)
{
  const ScriptFixture fixture;
  const auto library = complete_library(fixture);
  for (std::uint32_t i = 0; i < library->size(); ++i) {
    const urscript::Builtin & builtin = (*library)[i];
    EXPECT_EQ(builtin.support == urscript::Support::modelled, builtin.note.empty()) << builtin.name;
  }
}

// docs/use/urscript.md contains the texts between such lines. UPDATE_DOCS=1 writes them.
void expect_documented(const std::string & title, const std::string & reference)
{
  const std::string begin = "<!-- begin of the generated " + title + " -->\n\n";
  const std::string end = "\n<!-- end of the generated " + title + " -->\n";
  std::ifstream file(URSCRIPT_DOCUMENTATION);
  std::ostringstream buffer;
  buffer << file.rdbuf();
  std::string text = buffer.str();
  const std::size_t first = text.find(begin);
  ASSERT_NE(first, std::string::npos);
  const std::size_t start = first + begin.size();
  const std::size_t last = text.find(end, start);
  ASSERT_NE(last, std::string::npos);
  if (std::getenv("UPDATE_DOCS") != nullptr) {
    std::ofstream(URSCRIPT_DOCUMENTATION) << text.replace(start, last - start, reference);
    return;
  }
  EXPECT_EQ(text.substr(start, last - start), reference) << "run this test with UPDATE_DOCS=1";
}

TEST(FunctionReferenceTest, TheDocumentationIsUpToDate)
{
  const ScriptFixture fixture;
  expect_documented("function reference", function_reference(*complete_library(fixture)));
  expect_documented("version reference", function_version_reference());
}

std::string compile_error(const ScriptFixture & fixture, const char * version, const std::string & program)
{
  const auto library = with_functions_of(*PolyscopeVersion::parse(version), *complete_library(fixture));
  const auto compiled = urscript::compile(program, *library);
  return compiled ? "" : compiled.error().message;
}

// The names are those of the script manual for PolyScope 3.15.
TEST(FunctionVersionTest, Cb3HasTheFunctionsOfItsManualOnly)
{
  const ScriptFixture fixture;
  for (const char * call : {"get_target_tcp_pose_along_path()", "freedrive_mode_no_incorrect_payload_check()",
                            "get_euromap_input(0)", "encoder_get_tick_count(0)", "servoc(p[0,0,0,0,0,0])",
                            "ft_rtde_input_enable(False)"}) {
    EXPECT_EQ(compile_error(fixture, "3.15.8", call), "") << call;
  }
  for (const char * call :
       {"screw_driving(10, 0.1)", "path_offset_enable()", "set_target_payload(1, [0,0,0])",
        "interpreter_mode()", "optimovej([0,0,0,0,0,0])", "get_mass_matrix()"}) {
    EXPECT_NE(compile_error(fixture, "3.15.8", call).find("is not defined"), std::string::npos) << call;
    EXPECT_EQ(compile_error(fixture, "5.25.1", call), "") << call;
  }
}

TEST(FunctionVersionTest, FunctionsExistFromTheirFirstVersion)
{
  const ScriptFixture fixture;
  EXPECT_NE(compile_error(fixture, "5.20", "optimovel(p[0,0,0,0,0,0])"), "");
  EXPECT_EQ(compile_error(fixture, "5.21", "optimovel(p[0,0,0,0,0,0])"), "");
  EXPECT_NE(compile_error(fixture, "5.8.2", "get_inverse_kin_has_solution(p[0,0,0,0,0,0])"), "");
  EXPECT_EQ(compile_error(fixture, "5.9.4", "get_inverse_kin_has_solution(p[0,0,0,0,0,0])"), "");
  EXPECT_NE(compile_error(fixture, "5.9", "ft_rtde_input_enable(False)"), "");
  EXPECT_EQ(compile_error(fixture, "5.9.1", "ft_rtde_input_enable(False)"), "");
  EXPECT_NE(compile_error(fixture, "3.7", "protective_stop()"), "");
  EXPECT_EQ(compile_error(fixture, "3.8", "protective_stop()"), "");
}

}  // namespace
}  // namespace ur_simulator
