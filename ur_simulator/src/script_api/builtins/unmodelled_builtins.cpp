#include "script_api/robot_context.hpp"

namespace ur_simulator::script_api {

namespace {

/// A builtin of the robot that the simulator does not model, with its parameters.
struct UnsupportedBuiltin {
  const char * name;
  std::vector<urscript::Parameter> parameters;
  std::size_t required;
};

const std::vector<UnsupportedBuiltin> & motions()
{
  static const std::vector<UnsupportedBuiltin> entries{
      {"set_pos", {"q"}, 1},
      {"path_offset_enable", {}, 0},
      {"path_offset_disable", {"a"}, 0},
      {"path_offset_get", {"type"}, 1},
      {"path_offset_set", {"offset", "type"}, 2},
      {"path_offset_set_alpha_filter", {"alpha"}, 1},
      {"path_offset_set_max_offset", {"transLimit", "rotLimit"}, 2},
      {"reset_revolution_counter", {"qNear"}, 0},
      {"position_deviation_warning", {"enabled", "threshold"}, 1},
      {"pause_on_error_code", {"code", "argument"}, 1},
  };
  return entries;
}

const std::vector<UnsupportedBuiltin> & conveyors()
{
  static const std::vector<UnsupportedBuiltin> entries{
      {"conveyor_pulse_decode", {"type", "A", "B"}, 2},
      {"encoder_enable_pulse_decode", {"encoder_index", "decoder_type", "A", "B"}, 4},
      {"encoder_enable_set_tick_count", {"encoder_index", "range_id"}, 2},
      {"encoder_get_tick_count", {"encoder_index"}, 1},
      {"encoder_set_tick_count", {"encoder_index", "count"}, 2},
      {"encoder_unwind_delta_tick_count", {"encoder_index", "delta_tick_count"}, 2},
      {"get_conveyor_tick_count", {}, 0},
      {"set_conveyor_tick_count", {"tick_count", "absolute_encoder_resolution"}, 1},
      {"stop_conveyor_tracking", {"a", "aRot"}, 0},
      {"track_conveyor_circular", {"center", "ticks_per_revolution", "rotate_tool", "encoder_index"}, 2},
      {"track_conveyor_linear", {"direction", "ticks_per_meter", "encoder_index"}, 2},
  };
  return entries;
}

const std::vector<UnsupportedBuiltin> & communication()
{
  static const std::vector<UnsupportedBuiltin> entries{
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
      {"rpc_factory", {"type", "url"}, 2},
      {"interpreter_mode", {"clearQueueOnEnter", "clearOnEnd"}, 0},
      {"end_interpreter", {}, 0},
      {"read_port_bit", {"address"}, 1},
      {"read_port_register", {"address"}, 1},
      {"write_port_bit", {"address", "value"}, 2},
      {"write_port_register", {"address", "value"}, 2},
      {"modbus_add_signal",
       {"IP", "slave_number", "signal_address", "signal_type", "signal_name", "sequential_mode"},
       5},
      {"modbus_delete_signal", {"signal_name"}, 1},
      {"modbus_get_signal_status", {"signal_name", "is_secondary_program"}, 1},
      {"modbus_send_custom_command", {"IP", "slave_number", "function_code", "data"}, 4},
      {"modbus_set_output_register", {"signal_name", "register_value", "is_secondary_program"}, 2},
      {"modbus_set_output_signal", {"signal_name", "digital_value", "is_secondary_program"}, 2},
      {"modbus_set_signal_update_frequency", {"signal_name", "update_frequency"}, 2},
      {"get_euromap_input", {"port_number"}, 1},
      {"get_euromap_output", {"port_number"}, 1},
      {"set_euromap_output", {"port_number", "signal_value"}, 2},
      {"set_tool_communication",
       {"enabled", "baud_rate", "parity", "stop_bits", "rx_idle_chars", "tx_idle_chars"},
       6},
      {"set_tool_output_mode", {"mode"}, 1},
      {"set_tool_digital_output_mode", {"n", "mode"}, 2},
  };
  return entries;
}

}  // namespace

void add_unmodelled_builtins(Library & library)
{
  for (const auto * group : {&motions(), &conveyors(), &communication()}) {
    for (const UnsupportedBuiltin & builtin : *group) {
      library.add(
          {builtin.name, builtin.parameters, builtin.required,
           [](CallContext &, Arguments) -> Outcome { return Failure{"not modelled by the simulator yet"}; }});
    }
  }
}

}  // namespace ur_simulator::script_api
