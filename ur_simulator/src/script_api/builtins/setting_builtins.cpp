#include <limits>

#include "script_api/robot_context.hpp"

// Functions that configure what the simulator does not model. Their arguments are checked; they have no
// effect.

namespace ur_simulator::script_api {

namespace {

enum class ArgumentType { number, integer, boolean, string, list, pose };

struct SettingParameter {
  const char * name;
  ArgumentType type;
  double min = std::numeric_limits<double>::lowest();  ///< of a number or an integer
  double max = std::numeric_limits<double>::max();
};

struct Setting {
  const char * name;
  std::vector<SettingParameter> parameters;
  std::size_t required;
  const char * note;
};

void check_argument(ArgumentReader & reader, std::size_t i, const SettingParameter & parameter)
{
  switch (parameter.type) {
    case ArgumentType::number:
    case ArgumentType::integer: {
      const double value = parameter.type == ArgumentType::integer ? reader.integer(i, parameter.name)
                                                                   : reader.number(i, parameter.name);
      reader.require(
          value >= parameter.min && value <= parameter.max,
          fmt::format("{} must be in [{}, {}], is {}", parameter.name, parameter.min, parameter.max, value));
      return;
    }
    case ArgumentType::boolean:
      reader.boolean(i, parameter.name);
      return;
    case ArgumentType::string:
      reader.string(i, parameter.name);
      return;
    case ArgumentType::pose:
      reader.pose(i, parameter.name);
      return;
    case ArgumentType::list:
      reader.require(reader.value(i).is(urscript::Type::list),
                     fmt::format("the argument '{}' must be a list", parameter.name));
      return;
  }
}

void add_setting(Library & library, const Setting & setting)
{
  std::vector<urscript::Parameter> parameters;
  for (const SettingParameter & parameter : setting.parameters) {
    parameters.emplace_back(parameter.name);
  }
  library.add({setting.name, std::move(parameters), setting.required,
               [checks = setting.parameters](CallContext &, Arguments arguments) -> Outcome {
                 ArgumentReader reader(arguments);
                 for (std::size_t i = 0; i < checks.size(); ++i) {
                   if (reader.given(i)) {
                     check_argument(reader, i, checks[i]);
                   }
                 }
                 return reader ? Outcome(Value()) : reader.failure();
               }});
  library.simplify(setting.name, setting.note);
}

std::vector<Setting> io_settings()
{
  using enum ArgumentType;
  const char * const freedrive = "accepted; inputs do not start freedrive";
  const char * const runstate = "accepted; outputs keep their values when the program stops";
  return {
      {"set_standard_digital_input_action", {{"port", integer, 0, 7}, {"action", string}}, 2, freedrive},
      {"set_configurable_digital_input_action", {{"port", integer, 0, 7}, {"action", string}}, 2, freedrive},
      {"set_tool_digital_input_action", {{"port", integer, 0, 1}, {"action", string}}, 2, freedrive},
      {"set_gp_boolean_input_action", {{"port", integer, 0, 127}, {"action", string}}, 2, freedrive},
      {"set_input_actions_to_default", {}, 0, freedrive},
      {"set_runstate_standard_digital_output_to_value",
       {{"outputId", integer, 0, 7}, {"state", integer, 0, 3}},
       2,
       runstate},
      {"set_runstate_configurable_digital_output_to_value",
       {{"outputId", integer, 0, 7}, {"state", integer, 0, 3}},
       2,
       runstate},
      {"set_runstate_tool_digital_output_to_value",
       {{"outputId", integer, 0, 1}, {"state", integer, 0, 3}},
       2,
       runstate},
      {"set_runstate_gp_boolean_output_to_value",
       {{"outputId", integer, 0, 127}, {"state", integer, 0, 3}},
       2,
       runstate},
      {"set_runstate_gp_float_output_to_value",
       {{"outputId", integer, 0, 47}, {"state", integer, 0, 3}},
       2,
       runstate},
      {"set_runstate_gp_integer_output_to_value",
       {{"outputId", integer, 0, 47}, {"state", integer, 0, 3}},
       2,
       runstate},
      {"set_runstate_standard_analog_output_to_value",
       {{"outputId", integer, 0, 1}, {"state", integer, 0, 3}},
       2,
       runstate},
      {"set_analog_inputrange",
       {{"port", integer, 0, 3}, {"range", integer, 0, 4}},
       2,
       "accepted; inputs have one range, 0 to 10 V"},
      {"set_runstate_outputs", {{"outputs", list}}, 1, runstate},
  };
}

std::vector<Setting> robot_settings()
{
  using enum ArgumentType;
  const char * const light = "accepted; the arm has no base light";
  const char * const holding = "accepted; the brakes' holding torque is not modelled";
  const char * const wrench = "accepted; the wrench at the tool is not limited";
  return {
      {"set_baselight_off", {}, 0, light},
      {"set_baselight_iec", {}, 0, light},
      {"set_baselight_solid",
       {{"r", integer, 0, 255}, {"g", integer, 0, 255}, {"b", integer, 0, 255}},
       3,
       light},
      {"high_holding_torque_disable", {}, 0, holding},
      {"high_holding_torque_enable", {}, 0, holding},
      {"tool_wrench_limit_set",
       {{"frame_offset", pose},
        {"Fx", number, 0.0},
        {"Fy", number, 0.0},
        {"Fz", number, 0.0},
        {"Mx", number, 0.0},
        {"My", number, 0.0},
        {"Mz", number, 0.0}},
       1,
       wrench},
      {"tool_wrench_limit_disable", {}, 0, wrench},
      {"pause_on_error_code",
       {{"code", integer}, {"argument", integer}},
       1,
       "accepted; error codes do not pause the program"},
      {"position_deviation_warning",
       {{"enabled", boolean}, {"threshold", number, 0.0, 1.0}},
       1,
       "accepted; deviations are not logged"},
      {"reset_revolution_counter", {{"qNear", list}}, 0, "accepted; the joint positions are not changed"},
      {"set_safety_mode_transition_hardness",
       {{"type", integer, 0, 1}},
       1,
       "accepted; the transition has one hardness"},
  };
}

}  // namespace

void add_setting_builtins(Library & library)
{
  for (const Setting & setting : robot_settings()) {
    add_setting(library, setting);
  }
  for (const Setting & setting : io_settings()) {
    add_setting(library, setting);
  }
}

}  // namespace ur_simulator::script_api
