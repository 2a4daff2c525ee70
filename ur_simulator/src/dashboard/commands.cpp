#include "dashboard/commands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace ur_simulator::dashboard {
namespace {

using Text = std::string_view;

constexpr PolyscopeVersion v(std::uint32_t major, std::uint32_t minor)
{
  return {major, minor, 0, 0};
}

std::string failed(Text command)
{
  return fmt::format("Failed to execute: {}", command);
}

std::string either(const Pendant::Answer & answer, Text done, Text command)
{
  return answer ? std::string(done) : failed(command);
}

std::string program_name(const Pendant & pendant)
{
  return pendant.loaded_program().empty() ? "<unnamed>" : pendant.loaded_program();
}

// ---- programs

std::string load(Pendant & p, Text file)
{
  const auto loaded = p.load_program(std::string(file));
  if (loaded) {
    return fmt::format("Loading program: {}", file);
  }
  const bool missing = loaded.error() == Pendant::LoadError::not_found;
  return fmt::format("{}: {}", missing ? "File not found" : "Error while loading program", file);
}

std::string stop(Pendant & p, Text)
{
  p.stop();
  return "Stopped";
}

std::string pause(Pendant & p, Text)
{
  return either(p.pause(), "Pausing program", "pause");
}

std::string running(Pendant & p, Text)
{
  return fmt::format("Program running: {}", p.runner().running() && !p.runner().paused());
}

std::string get_loaded_program(Pendant & p, Text)
{
  return p.loaded_program().empty() ? "No program loaded" : "Loaded program: /programs/" + p.loaded_program();
}

std::string is_program_saved(Pendant & p, Text)
{
  return "True " + program_name(p);
}

std::string program_state(Pendant & p, Text)
{
  const Text state = !p.runner().running() ? "STOPPED" : p.runner().paused() ? "PAUSED" : "PLAYING";
  return fmt::format("{} {}", state, program_name(p));
}

std::string load_installation(Pendant & p, Text file)
{
  return fmt::format(
      "{}: {}", p.load_installation(std::string(file)) ? "Loading installation" : "File not found", file);
}

// ---- power and safety

std::string power_on(Pendant & p, Text)
{
  return either(p.power_on(), "Powering on", "power on");
}
std::string power_off(Pendant & p, Text)
{
  return either(p.power_off(), "Powering off", "power off");
}
std::string brake_release(Pendant & p, Text)
{
  return either(p.release_brakes(), "Brake releasing", "brake release");
}

std::string unlock_protective_stop(Pendant & p, Text)
{
  if (p.unlock_protective_stop()) {
    return "Protective stop releasing";
  }
  return p.state().safety_mode == SafetyMode::protective_stop
             ? "Cannot unlock protective stop until 5s after occurrence. Always inspect cause of protective "
               "stop before "
               "unlocking"
             : failed("unlock protective stop");
}

std::string close_safety_popup(Pendant & p, Text)
{
  p.close_safety_popup();
  return "closing safety popup";
}

std::string restart_safety(Pendant & p, Text)
{
  return either(p.restart_safety(), "Restarting safety", "restart safety");
}
std::string robotmode(Pendant & p, Text)
{
  return fmt::format("Robotmode: {}", to_string(p.state().robot_mode));
}
std::string safetymode(Pendant & p, Text)
{
  return fmt::format("Safetymode: {}", to_string(p.state().safety_mode));
}
std::string safetystatus(Pendant & p, Text)
{
  return fmt::format("Safetystatus: {}", to_string(p.state().safety_mode));
}

// ---- the pendant's screen

std::string popup(Pendant & p, Text text)
{
  urscript::Popup shown;
  shown.message = text;
  p.runner().show_popup(shown);
  return "showing popup";
}

std::string close_popup(Pendant & p, Text)
{
  p.runner().close_popup();
  return "closing popup";
}

std::string add_to_log(Pendant & p, Text text)
{
  if (text.empty()) {
    return "No log message to add";
  }
  p.log().info("dashboard", std::string(text));
  return "Added log message";
}

std::string upper(Text text)
{
  std::string result(text);
  std::ranges::transform(result, result.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return result;
}

std::string set_operational_mode(Pendant & p, Text mode)
{
  const std::string wanted = upper(mode);
  if (wanted != "MANUAL" && wanted != "AUTOMATIC") {
    return fmt::format("Failed setting operational mode: {}", mode);
  }
  p.operational_mode = wanted;
  return fmt::format("Operational mode '{}' is set", mode);
}

std::string get_operational_mode(Pendant & p, Text)
{
  return p.operational_mode.value_or("NONE");
}

std::string clear_operational_mode(Pendant & p, Text)
{
  const std::string mode = p.operational_mode.value_or("NONE");
  p.operational_mode.reset();
  return fmt::format("No longer controlling the operational mode. Current operational mode: '{}'.", mode);
}

std::string set_user_role(Pendant & p, Text role)
{
  constexpr std::array<Text, 5> roles{"PROGRAMMER", "OPERATOR", "NONE", "LOCKED", "RESTRICTED"};
  const std::string wanted = upper(role);
  if (std::ranges::find(roles, wanted) == roles.end()) {
    return fmt::format("Failed setting user role: {}", role);
  }
  p.user_role = wanted;
  return fmt::format("Setting user role: {}", role);
}

std::string get_user_role(Pendant & p, Text)
{
  return p.user_role;
}

// ---- about the robot

std::string polyscope_version(Pendant & p, Text)
{
  return fmt::format("URSoftware {} (simulated)", p.options().version.text());
}

std::string version(Pendant & p, Text)
{
  return p.options().version.text();
}
std::string is_in_remote_control(Pendant & p, Text)
{
  return p.remote_control() ? "true" : "false";
}
std::string get_serial_number(Pendant & p, Text)
{
  return p.options().serial_number;
}
std::string get_robot_model(Pendant & p, Text)
{
  return p.model().dashboard_name;
}

std::string shutdown(Pendant & p, Text)
{
  p.request_shutdown(true);
  return "Shutting down";
}

std::string quit(Pendant &, Text)
{
  return "Disconnected";
}

std::string save_log(Pendant & p, Text)
{
  return p.reports().save_log();
}

constexpr auto never = Since::never;
constexpr std::array table{
    Command{"load", {}, true, load},
    Command{"play", {}, true, nullptr, play},
    Command{"stop", {}, true, stop},
    Command{"pause", {}, true, pause},
    Command{"quit", {}, false, quit},
    Command{"shutdown", {}, true, shutdown},
    Command{"running", {}, false, running},
    Command{"robotmode", {}, false, robotmode},
    Command{"get loaded program", {}, false, get_loaded_program},
    Command{"popup", {}, true, popup},
    Command{"close popup", {}, true, close_popup},
    Command{"addToLog", {}, false, add_to_log},
    Command{"isProgramSaved", {}, false, is_program_saved},
    Command{"programState", {}, false, program_state},
    Command{"PolyscopeVersion", {}, false, polyscope_version},
    Command{"version", {v(5, 0), never}, false, version},
    Command{"setUserRole", {never, v(3, 1)}, false, set_user_role},
    Command{"getUserRole", {never, v(3, 1)}, false, get_user_role},
    Command{"set operational mode", {v(5, 0), never}, true, set_operational_mode},
    Command{"get operational mode", {v(5, 6), never}, false, get_operational_mode},
    Command{"clear operational mode", {v(5, 0), never}, true, clear_operational_mode},
    Command{"power on", {}, true, power_on},
    Command{"power off", {}, true, power_off},
    Command{"brake release", {}, true, brake_release},
    Command{"safetymode", {}, false, safetymode},
    Command{"safetystatus", {v(5, 4), v(3, 11)}, false, safetystatus},
    Command{"unlock protective stop", {v(5, 0), v(3, 1)}, true, unlock_protective_stop},
    Command{"close safety popup", {v(5, 0), v(3, 1)}, true, close_safety_popup},
    Command{"load installation", {v(5, 0), v(3, 2)}, true, load_installation},
    Command{"restart safety", {v(5, 1), v(3, 7)}, true, restart_safety},
    Command{"is in remote control", {v(5, 6), never}, false, is_in_remote_control},
    Command{"get serial number", {v(5, 6), v(3, 12)}, false, get_serial_number},
    Command{"get robot model", {v(5, 6), v(3, 12)}, false, get_robot_model},
    Command{"generate flight report", {v(5, 8), v(3, 13)}, false, nullptr, generate_flight_report},
    Command{"generate support file", {v(5, 8), v(3, 13)}, false, nullptr, generate_support_file},
    Command{"saveLog", {v(5, 8), v(3, 13)}, false, save_log},
};

bool begins_with(Text line, Text name)
{
  const auto same = [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); };
  const bool prefix = line.size() >= name.size() && std::equal(name.begin(), name.end(), line.begin(), same);
  return prefix && (line.size() == name.size() || line[name.size()] == ' ');
}

Text trim(Text text)
{
  const std::size_t first = text.find_first_not_of(" \t");
  const std::size_t last = text.find_last_not_of(" \t");
  return first == Text::npos ? Text() : text.substr(first, last - first + 1);
}

}  // namespace

std::span<const Command> commands()
{
  return table;
}

const Command * find_command(Text line, const PolyscopeVersion & version, Text & argument)
{
  line = trim(line);
  const Command * best = nullptr;
  for (const Command & command : table) {
    const bool longer = best == nullptr || command.name.size() > best->name.size();
    if (longer && command.since.holds_for(version) && begins_with(line, command.name)) {
      best = &command;
    }
  }
  if (best != nullptr) {
    argument = trim(line.substr(best->name.size()));
  }
  return best;
}

}  // namespace ur_simulator::dashboard
