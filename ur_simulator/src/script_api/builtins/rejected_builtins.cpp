#include "script_api/robot_context.hpp"

// Functions of the script manual that need hardware or features that the simulated robot does not have.

namespace ur_simulator::script_api {

namespace {

struct RejectedBuiltin {
  const char * name;
  std::vector<urscript::Parameter> parameters;
  std::size_t required;
};

struct RejectedGroup {
  const char * reason;
  std::vector<RejectedBuiltin> builtins;
};

RejectedGroup conveyor_tracking()
{
  return {
      "conveyor tracking is not modelled",
      {
          {"track_conveyor_circular", {"center", "ticks_per_revolution", "rotate_tool", "encoder_index"}, 2},
          {"track_conveyor_linear", {"direction", "ticks_per_meter", "encoder_index"}, 2},
      }};
}

RejectedGroup modbus_signals()
{
  return {"no MODBUS device is connected",
          {
              {"modbus_add_signal",
               {"IP", "slave_number", "signal_address", "signal_type", "signal_name", "sequential_mode",
                "register_count"},
               5},
              {"modbus_add_rw_signal",
               {"IP", "slave_number", "read_address", "read_register_count", "write_address",
                "write_register_count", "signal_name", "sequential_mode"},
               7},
              {"modbus_delete_signal", {"signal_name"}, 1},
              {"modbus_get_error", {"signal_name", "error_source"}, 1},
              {"modbus_get_signal_status", {"signal_name", "is_secondary_program"}, 1},
              {"modbus_get_time_since_signal_invalid", {"signal_name"}, 1},
              {"modbus_request_update_now", {"signal_name"}, 1},
              {"modbus_request_update_signal_value", {"signal_name"}, 1},
              {"modbus_reset_connection", {"connection_id", "is_blocking"}, 1},
              {"modbus_send_custom_command", {"IP", "slave_number", "function_code", "data"}, 4},
              {"modbus_set_digital_input_action", {"signal_name", "action"}, 2},
              {"modbus_set_output_register", {"signal_name", "register_value", "is_secondary_program"}, 2},
              {"modbus_set_output_signal", {"signal_name", "digital_value", "is_secondary_program"}, 2},
              {"modbus_set_runstate_dependent_choice", {"signal_name", "runstate_choice"}, 2},
              {"modbus_set_signal_update_frequency", {"signal_name", "update_frequency"}, 2},
              {"modbus_set_signal_watchdog", {"signal_name", "new_timeout_in_sec"}, 2},
          }};
}

RejectedGroup euromap()
{
  return {"no Euromap67 interface is installed",
          {
              {"get_euromap_input", {"port_number"}, 1},
              {"get_euromap_output", {"port_number"}, 1},
              {"set_euromap_output", {"port_number", "signal_value"}, 2},
              {"set_euromap_runstate_dependent_choice", {"port_number", "runstate_choice"}, 2},
          }};
}

RejectedGroup sockets()
{
  return {"the library has no sockets",
          {
              {"socket_open", {"address", "port", "socket_name"}, 2},
              {"socket_close", {"socket_name"}, 0},
              {"socket_get_var", {"name", "socket_name"}, 1},
              {"socket_set_var", {"name", "value", "socket_name"}, 2},
              {"socket_read_ascii_float", {"number", "socket_name", "timeout"}, 1},
              {"socket_read_binary_integer", {"number", "socket_name", "timeout"}, 1},
              {"socket_read_byte_list", {"number", "socket_name", "timeout"}, 1},
              {"socket_read_line", {"socket_name", "timeout"}, 0},
              {"socket_read_string", {"socket_name", "prefix", "suffix", "interpret_escape", "timeout"}, 0},
              {"socket_send_byte", {"value", "socket_name"}, 1},
              {"socket_send_int", {"value", "socket_name"}, 1},
              {"socket_send_line", {"str", "socket_name"}, 1},
              {"socket_send_string", {"str", "socket_name"}, 1},
          }};
}

RejectedGroup frame_tracking()
{
  return {"frames are not tracked",
          {
              {"frame_tracking_disable", {}, 0},
              {"frame_tracking_enable", {"frame_name"}, 1},
          }};
}

RejectedGroup frame_masses()
{
  return {"frames have no mass",
          {
              {"set_mass_properties", {"frame", "m", "cog", "inertia"}, 4},
              {"set_payload_from_attached_frames", {}, 0},
          }};
}

}  // namespace

void add_rejected_builtins(Library & library)
{
  for (const RejectedGroup & group :
       {conveyor_tracking(), modbus_signals(), euromap(), sockets(), frame_tracking(), frame_masses()}) {
    for (const RejectedBuiltin & builtin : group.builtins) {
      library.add_rejected(builtin.name, builtin.parameters, builtin.required, group.reason);
    }
  }
  for (const char * name : {"eip_reader_factory", "eip_writer_factory"}) {
    library.add_rejected(name, {"connection", "size"}, 2, "no EtherNet/IP scanner is connected");
  }
  library.add_rejected("rpc_factory", {"type", "url"}, 2, "the library has no connections");
  library.add_rejected("set_pos", {"q"}, 1, "only PolyScope's simulation mode places the arm");
}

}  // namespace ur_simulator::script_api
