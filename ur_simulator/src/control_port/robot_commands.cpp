#include <array>
#include <memory>

#include "control_port/commands.hpp"

namespace ur_simulator::control_port {
namespace {

using nlohmann::json;

json require_success(const Pendant::Result & result)
{
  if (!result) {
    throw RequestError(result.error());
  }
  return json::object();
}

Action unlock_protective_stop(RequestFields &)
{
  return [](ControlPortContext & context) -> json {
    return require_success(context.pendant.unlock_protective_stop());
  };
}

/// Executes a function of the pendant that has no arguments.
template <Pendant::Result (Pendant::*function)()>
Action call_pendant(RequestFields &)
{
  return [](ControlPortContext & context) -> json { return require_success((context.pendant.*function)()); };
}

Action protective_stop(RequestFields & fields)
{
  const std::string reason = fields.string("reason", "requested through the control port");
  return [=](ControlPortContext & context) -> json {
    context.safety.trigger_protective_stop(reason);
    return json::object();
  };
}

Action emergency_stop(RequestFields & fields)
{
  const bool pressed = fields.boolean("pressed", true);
  const bool system = fields.boolean("system", false);
  return [=](ControlPortContext & context) -> json {
    if (!pressed) {
      return require_success(context.safety.release_emergency_stop());
    }
    context.safety.press_emergency_stop(system);
    return json::object();
  };
}

Action safeguard(RequestFields & fields)
{
  const bool open = fields.boolean("open", true);
  return [=](ControlPortContext & context) -> json {
    if (!open) {
      return require_success(context.safety.reset_safeguard());
    }
    context.safety.open_safeguard();
    return json::object();
  };
}

Action reduced_mode(RequestFields & fields)
{
  const bool on = fields.boolean("on", true);
  return
      [=](ControlPortContext & context) -> json { return require_success(context.safety.set_reduced(on)); };
}

/// Triggers a violation or a fault of the safety system.
template <void (Safety::*trigger)(std::string_view reason)>
Action trigger_failure(RequestFields & fields)
{
  const std::string reason = fields.string("reason", "caused through the control port");
  return [=](ControlPortContext & context) -> json {
    (context.safety.*trigger)(reason);
    return json::object();
  };
}

Action power(RequestFields & fields)
{
  constexpr std::array<std::string_view, 4> targets{"off", "on", "release_brakes", "running"};
  const std::string to = fields.choice("to", targets);
  return [=](ControlPortContext & context) -> json {
    if (to == "running") {
      return require_success(context.safety.start_running(context.state));
    }
    return require_success(to == "off"  ? context.pendant.power_off()
                           : to == "on" ? context.pendant.power_on()
                                        : context.pendant.release_brakes());
  };
}

Action remote_control(RequestFields & fields)
{
  const bool on = fields.boolean("on", true);
  return [=](ControlPortContext & context) -> json {
    return require_success(context.pendant.set_remote_control(on));
  };
}

Action operational_mode(RequestFields & fields)
{
  constexpr std::array<std::string_view, 2> modes{"MANUAL", "AUTOMATIC"};
  const std::string mode = fields.choice("mode", modes);
  return [=](ControlPortContext & context) -> json {
    context.pendant.set_operational_mode(mode);
    return json::object();
  };
}

Action store_program(RequestFields & fields)
{
  const std::string name = fields.string("name");
  const std::string script = fields.string("script");
  const bool load = fields.boolean("load", false);
  if (name.empty()) {
    throw RequestError("field 'name' is empty: it must be a file name such as 'pick.urp'", "name");
  }
  return [=](ControlPortContext & context) -> json {
    context.pendant.store_program(name, {.script = script});
    if (load && !context.pendant.load_program(name)) {
      throw RequestError("field 'script' does not compile: the log contains the error");
    }
    return json::object();
  };
}

Action run_script(RequestFields & fields)
{
  const std::string script = fields.string("script");
  return [=](ControlPortContext & context) -> json {
    return require_success(context.pendant.run_script(script));
  };
}

Action play(RequestFields &)
{
  return [](ControlPortContext & context) -> json {
    // If the program is requested from a host, it starts later and errors are only logged.
    auto result = std::make_shared<Pendant::Result>();
    context.pendant.play([result](const Pendant::Result & play_result) { *result = play_result; });
    return require_success(*result);
  };
}

Action store_external_control(RequestFields & fields)
{
  const std::string name = fields.string("name", "external_control.urp");
  ProgramHost host;
  host.address = fields.string("host");
  host.port = static_cast<std::uint16_t>(fields.integer("port", 1, 65535, host.port));
  const std::string next = fields.string("next", "");
  const bool load = fields.boolean("load", true);
  return [=](ControlPortContext & context) -> json {
    context.pendant.store_program(name, {.script = next, .external_control = host});
    if (load && !context.pendant.load_program(name)) {
      throw RequestError("field 'name' is '" + name + "': it cannot be loaded");
    }
    return json::object();
  };
}

Action stop_program(RequestFields &)
{
  return [](ControlPortContext & context) -> json {
    const std::string_view before = to_string(context.state.runtime_state);
    context.pendant.stop();
    return {{"program", before}};
  };
}

Action kill_program(RequestFields &)
{
  return [](ControlPortContext & context) -> json {
    if (!context.pendant.runner().kill()) {
      throw RequestError("no program is running");
    }
    return json::object();
  };
}

Action speed_slider(RequestFields & fields)
{
  const double fraction = fields.number("fraction", {0.0, 1.0});
  return [=](ControlPortContext & context) -> json {
    context.state.speed_slider = fraction;
    return json::object();
  };
}

Action compile_time(RequestFields & fields)
{
  const double seconds = fields.number("seconds", {0.0, 60.0});
  return [=](ControlPortContext & context) -> json {
    context.pendant.set_compile_time(seconds);
    return json::object();
  };
}

Action close_popup(RequestFields &)
{
  return [](ControlPortContext & context) -> json {
    if (!context.pendant.runner().popup()) {
      throw RequestError("no popup is open");
    }
    context.pendant.runner().close_popup();
    return json::object();
  };
}

/// Reads the field `value` with the type that the program requests.
urscript::Value requested_value(RequestFields & fields, urscript::Type type)
{
  switch (type) {
    case urscript::Type::boolean:
      return urscript::Value(fields.boolean("value"));
    case urscript::Type::integer:
      return urscript::Value(static_cast<std::int32_t>(fields.integer("value", INT32_MIN, INT32_MAX)));
    case urscript::Type::floating:
      return urscript::Value(fields.number("value", {-1e300, 1e300}));
    default:
      return urscript::Value(fields.string("value"));
  }
}

Action answer_request(RequestFields & fields)
{
  return [request = json{{"value", fields.scalar("value")}}](ControlPortContext & context) -> json {
    ProgramRunner & runner = context.pendant.runner();
    if (runner.value_request() == nullptr) {
      throw RequestError("the program does not request a value");
    }
    RequestFields answer(request);
    runner.answer_request(requested_value(answer, runner.value_request()->type));
    return json::object();
  };
}

constexpr std::array robot_command_table{
    Command{"protective_stop", "reason", "Triggers a protective stop.", protective_stop},
    Command{"unlock_protective_stop", "",
            "Unlocks a protective stop like the button on the pendant, 5 s after the stop at the earliest.",
            unlock_protective_stop},
    Command{"emergency_stop", "pressed true|false (true); system true|false (false)",
            "Presses or releases the emergency stop button.", emergency_stop},
    Command{"safeguard", "open true|false (true)", "Opens the safeguard, or closes and resets it.",
            safeguard},
    Command{"reduced_mode", "on true|false (true)", "Switches reduced mode on or off.", reduced_mode},
    Command{"violation", "reason", "Triggers a safety violation.",
            trigger_failure<&Safety::trigger_violation>},
    Command{"fault", "reason", "Triggers a safety fault.", trigger_failure<&Safety::trigger_fault>},
    Command{"restart_safety", "", "Restarts the safety system after a violation or fault.",
            call_pendant<&Pendant::restart_safety>},
    Command{"power", "to off|on|release_brakes|running",
            "Switches the power of the arm; 'running' skips the delays of a real robot.", power},
    Command{"remote_control", "on true|false (true)", "Selects remote or local control.", remote_control},
    Command{"operational_mode", "mode MANUAL|AUTOMATIC",
            "Selects the operational mode. Manual mode ends remote control with PolyScope X.",
            operational_mode},
    Command{"store_program", "name; script; load true|false (false)",
            "Stores a program on the controller's disk.", store_program},
    Command{"store_external_control",
            "name (external_control.urp); host; port (50002); next (); load true|false (true)",
            "Stores a program of the External Control URCap, which requests the script of its node from the "
            "host; "
            "'next' is what follows the node.",
            store_external_control},
    Command{"run_script", "script", "Runs a script as if it had been sent to a client interface.",
            run_script},
    Command{"play", "", "Presses the play button of the pendant.", play},
    Command{"pause_program", "", "Presses the pause button of the pendant.", call_pendant<&Pendant::pause>},
    Command{"stop_program", "",
            "Presses the stop button of the pendant; returns the state that the program had.", stop_program},
    Command{"kill_program", "", "Ends the program within one control cycle, without a log entry or message.",
            kill_program},
    Command{"speed_slider", "fraction 0..1", "Sets the speed slider of the pendant.", speed_slider},
    Command{"compile_time", "seconds 0..60", "Lets scripts of the client interfaces begin after this time.",
            compile_time},
    Command{"close_popup", "", "Closes the open popup.", close_popup},
    Command{"answer_request", "value bool|number|string",
            "Enters the value that the program requests from the operator.", answer_request},
};

}  // namespace

std::span<const Command> robot_commands()
{
  return robot_command_table;
}

}  // namespace ur_simulator::control_port
