#pragma once

#include "robot_api/routes.hpp"

namespace ur_simulator::robot_api {

// The operations of the Robot API (docs/internals/simulator_protocols.md lists them with the sources).

Answer change_robot_state(const Call & call);
Answer get_robot_mode(const Call & call);
Answer get_safety_mode(const Call & call);

Answer get_program_state(const Call & call);
Answer change_program_state(const Call & call);
Answer get_loaded_program(const Call & call);
Answer load_program(const Call & call);
/// The operation of 10.11: the field is `programName`.
Answer load_program_by_program_name(const Call & call);

Answer list_programs(const Call & call);
Answer download_program(const Call & call);
Answer upload_program(const Call & call);
Answer update_program(const Call & call);

Answer get_control_mode(const Call & call);
Answer get_operational_mode(const Call & call);
Answer get_information(const Call & call);
Answer get_versions(const Call & call);
Answer get_system_time(const Call & call);
Answer add_to_log(const Call & call);
Answer shut_down(const Call & call);

Answer open_popup(const Call & call);
Answer close_popup(const Call & call);
Answer close_safety_popup(const Call & call);

Answer generate_flight_report(const Call & call);
Answer download_support_files(const Call & call);

Answer get_openapi(const Call & call);

}  // namespace ur_simulator::robot_api
