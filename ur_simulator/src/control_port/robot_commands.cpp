#include <array>

#include "control_port/commands.hpp"

namespace ur_simulator::control_port {
namespace {

using nlohmann::json;

json done(const Pendant::Answer & answer)
{
  if (!answer) {
    throw RequestError(answer.error());
  }
  return json::object();
}

json protective_stop(Bench & bench, Fields & fields)
{
  const std::string reason = fields.text("reason", "tripped through the control port");
  fields.finish();
  bench.safety.trip(reason);
  return json::object();
}

json unlock_protective_stop(Bench & bench, Fields & fields)
{
  fields.finish();
  return done(bench.pendant.unlock_protective_stop());
}

json emergency_stop(Bench & bench, Fields & fields)
{
  const bool pressed = fields.boolean("pressed", true);
  const bool system = fields.boolean("system", false);
  fields.finish();
  if (!pressed) {
    return done(bench.safety.release_emergency_stop());
  }
  bench.safety.press_emergency_stop(system);
  return json::object();
}

json safeguard(Bench & bench, Fields & fields)
{
  const bool open = fields.boolean("open", true);
  fields.finish();
  if (!open) {
    return done(bench.safety.reset_safeguard());
  }
  bench.safety.open_safeguard();
  return json::object();
}

json reduced_mode(Bench & bench, Fields & fields)
{
  const bool on = fields.boolean("on", true);
  fields.finish();
  return done(bench.safety.set_reduced(on));
}

json violation(Bench & bench, Fields & fields)
{
  const std::string reason = fields.text("reason", "caused through the control port");
  fields.finish();
  bench.safety.violate(reason);
  return json::object();
}

json fault(Bench & bench, Fields & fields)
{
  const std::string reason = fields.text("reason", "caused through the control port");
  fields.finish();
  bench.safety.fail(reason);
  return json::object();
}

json restart_safety(Bench & bench, Fields & fields)
{
  fields.finish();
  return done(bench.pendant.restart_safety());
}

json power(Bench & bench, Fields & fields)
{
  constexpr std::array<std::string_view, 4> targets{"off", "on", "release_brakes", "running"};
  const std::string to = fields.choice("to", targets);
  fields.finish();
  if (to == "running") {
    bench.safety.start_running(bench.state);
    return json::object();
  }
  return done(to == "off"  ? bench.pendant.power_off()
              : to == "on" ? bench.pendant.power_on()
                           : bench.pendant.release_brakes());
}

json remote_control(Bench & bench, Fields & fields)
{
  const bool on = fields.boolean("on", true);
  fields.finish();
  bench.pendant.set_remote_control(on);
  return json::object();
}

json store_program(Bench & bench, Fields & fields)
{
  const std::string name = fields.text("name");
  const std::string script = fields.text("script");
  const bool load = fields.boolean("load", false);
  fields.finish();
  if (name.empty()) {
    throw RequestError("field 'name' is empty: it must be a file name such as 'pick.urp'");
  }
  bench.pendant.store_program(name, script);
  if (load && !bench.pendant.load_program(name)) {
    throw RequestError("field 'script' is not a program: see the log");
  }
  return json::object();
}

json run_script(Bench & bench, Fields & fields)
{
  const std::string script = fields.text("script");
  fields.finish();
  return done(bench.pendant.run_script(script));
}

json play(Bench & bench, Fields & fields)
{
  fields.finish();
  Pendant::Answer answer;
  // A program that is fetched starts later, or leaves its reason in the log.
  auto waiting = std::make_shared<Pendant::Answer *>(&answer);
  bench.pendant.play([waiting](const Pendant::Answer & result) {
    if (*waiting != nullptr) {
      **waiting = result;
    }
  });
  *waiting = nullptr;
  return done(answer);
}

json store_external_control(Bench & bench, Fields & fields)
{
  const std::string name = fields.text("name", "external_control.urp");
  ProgramHost host;
  host.address = fields.text("host");
  host.port = static_cast<std::uint16_t>(fields.integer("port", 1, 65535, host.port));
  const bool load = fields.boolean("load", true);
  fields.finish();
  bench.pendant.store_external_control(name, host);
  if (load && !bench.pendant.load_program(name)) {
    throw RequestError("field 'name' is '" + name + "': it cannot be loaded");
  }
  return json::object();
}

json pause_program(Bench & bench, Fields & fields)
{
  fields.finish();
  return done(bench.pendant.pause());
}

json stop_program(Bench & bench, Fields & fields)
{
  fields.finish();
  bench.pendant.stop();
  return json::object();
}

json kill_program(Bench & bench, Fields & fields)
{
  fields.finish();
  if (!bench.pendant.runner().kill()) {
    throw RequestError("no program is running");
  }
  return json::object();
}

json speed_slider(Bench & bench, Fields & fields)
{
  const double fraction = fields.number("fraction", {0.0, 1.0});
  fields.finish();
  bench.state.speed_slider = fraction;
  return json::object();
}

json close_popup(Bench & bench, Fields & fields)
{
  fields.finish();
  if (!bench.pendant.runner().popup()) {
    throw RequestError("no popup is open");
  }
  bench.pendant.runner().close_popup();
  return json::object();
}

constexpr std::array robot_command_table{
    Command{"protective_stop", "reason", "Trips a protective stop.", protective_stop},
    Command{"unlock_protective_stop", "", "As the pendant's button, 5 s after the stop at the earliest.",
            unlock_protective_stop},
    Command{"emergency_stop", "pressed true|false (true); system true|false (false)",
            "Presses or releases the emergency stop button.", emergency_stop},
    Command{"safeguard", "open true|false (true)", "Opens the safeguard, or closes and resets it.",
            safeguard},
    Command{"reduced_mode", "on true|false (true)", "Switches reduced mode.", reduced_mode},
    Command{"violation", "reason", "Causes a safety violation.", violation},
    Command{"fault", "reason", "Causes a safety fault.", fault},
    Command{"restart_safety", "", "Leads out of violation and fault.", restart_safety},
    Command{"power", "to off|on|release_brakes|running",
            "Powers the arm; 'running' skips the delays of a real robot.", power},
    Command{"remote_control", "on true|false (true)", "Remote or local control.", remote_control},
    Command{"store_program", "name; script; load true|false (false)",
            "Puts a program on the controller's disk.", store_program},
    Command{
        "store_external_control", "name (external_control.urp); host; port (50002); load true|false (true)",
        "Puts a program of the External Control URCap on the disk, which asks that host for what it runs.",
        store_external_control},
    Command{"run_script", "script", "Runs a script as if it came through a script port.", run_script},
    Command{"play", "", "The pendant's play button.", play},
    Command{"pause_program", "", "The pendant's pause button.", pause_program},
    Command{"stop_program", "", "The pendant's stop button.", stop_program},
    Command{"kill_program", "",
            "The program is gone from one cycle to the next; neither the log nor any message says so.",
            kill_program},
    Command{"speed_slider", "fraction 0..1", "Moves the pendant's speed slider.", speed_slider},
    Command{"close_popup", "", "Answers the popup that is open.", close_popup},
};

}  // namespace

std::span<const Command> robot_commands()
{
  return robot_command_table;
}

}  // namespace ur_simulator::control_port
