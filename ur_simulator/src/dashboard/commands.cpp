#include "dashboard/commands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "common/trim.hpp"

namespace ur_simulator::dashboard {
namespace {

constexpr PolyscopeVersion v(std::uint32_t major, std::uint32_t minor)
{
  return {major, minor, 0, 0};
}

std::string failed_reply(std::string_view command)
{
  return fmt::format("Failed to execute: {}", command);
}

/// The file name of the loaded program, without its folder.
std::string program_file_name(const Pendant & pendant)
{
  const std::string & path = pendant.loaded_program();
  return path.empty() ? "<unnamed>" : path.substr(path.rfind('/') + 1);
}

// ---- programs

std::string load(Pendant & pendant, std::string_view file)
{
  const auto loaded = pendant.load_program(std::string(file));
  if (loaded) {
    return fmt::format("Loading program: {}", file);
  }
  const bool missing = loaded.error() == Pendant::LoadError::not_found;
  return fmt::format("{}: {}", missing ? "File not found" : "Error while loading program", file);
}

std::string running(Pendant & pendant, std::string_view)
{
  return fmt::format("Program running: {}", pendant.runner().running() && !pendant.runner().paused());
}

std::string get_loaded_program(Pendant & pendant, std::string_view)
{
  return pendant.loaded_program().empty() ? "No program loaded"
                                          : "Loaded program: /programs/" + pendant.loaded_program();
}

std::string is_program_saved(Pendant & pendant, std::string_view)
{
  // Loaded programs are never edited. The unnamed program has no file.
  return fmt::format("{} {}", !pendant.loaded_program().empty(), program_file_name(pendant));
}

std::string program_state(Pendant & pendant, std::string_view)
{
  const std::string_view state = !pendant.runner().running() ? "STOPPED"
                                 : pendant.runner().paused() ? "PAUSED"
                                                             : "PLAYING";
  return fmt::format("{} {}", state, program_file_name(pendant));
}

std::string load_installation(Pendant & pendant, std::string_view file)
{
  return fmt::format("{}: {}",
                     pendant.load_installation(std::string(file)) ? "Loading installation" : "File not found",
                     file);
}

// ---- power and safety

// These replies confirm the receipt of the command: the manual has no reply for a rejection. The log contains
// it.

std::string power_on(Pendant & pendant, std::string_view)
{
  pendant.power_on();
  return "Powering on";
}
std::string power_off(Pendant & pendant, std::string_view)
{
  pendant.power_off();
  return "Powering off";
}
std::string brake_release(Pendant & pendant, std::string_view)
{
  pendant.release_brakes();
  return "Brake releasing";
}
std::string restart_safety(Pendant & pendant, std::string_view)
{
  pendant.restart_safety();
  return "Restarting safety";
}

std::string unlock_protective_stop(Pendant & pendant, std::string_view)
{
  if (pendant.unlock_protective_stop()) {
    return "Protective stop releasing";
  }
  return pendant.state().safety_mode == SafetyMode::protective_stop
             ? "Cannot unlock protective stop until 5s after occurrence. Always inspect cause of protective "
               "stop before "
               "unlocking"
             : failed_reply("unlock protective stop");
}

std::string close_safety_popup(Pendant & pendant, std::string_view)
{
  pendant.close_safety_popup();
  return "closing safety popup";
}

std::string robotmode(Pendant & pendant, std::string_view)
{
  return fmt::format("Robotmode: {}", to_string(pendant.state().robot_mode));
}
std::string safetymode(Pendant & pendant, std::string_view)
{
  return fmt::format("Safetymode: {}", to_string(pendant.state().safety_mode));
}
std::string safetystatus(Pendant & pendant, std::string_view)
{
  return fmt::format("Safetystatus: {}", to_string(pendant.state().safety_mode));
}

// ---- the pendant's screen

std::string popup(Pendant & pendant, std::string_view text)
{
  urscript::Popup shown;
  shown.message = text;
  pendant.runner().show_popup(shown);
  return "showing popup";
}

std::string close_popup(Pendant & pendant, std::string_view)
{
  pendant.runner().close_popup();
  return "closing popup";
}

std::string add_to_log(Pendant & pendant, std::string_view text)
{
  if (text.empty()) {
    return "No log message to add";
  }
  pendant.log().info("dashboard", std::string(text));
  return "Added log message";
}

std::string upper(std::string_view text)
{
  std::string result(text);
  std::ranges::transform(result, result.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return result;
}

std::string set_operational_mode(Pendant & pendant, std::string_view mode)
{
  const std::string wanted = upper(mode);
  if (wanted != "MANUAL" && wanted != "AUTOMATIC") {
    return fmt::format("Failed setting operational mode: {}", mode);
  }
  pendant.set_operational_mode(wanted);
  return fmt::format("Operational mode '{}' is set", mode);
}

std::string get_operational_mode(Pendant & pendant, std::string_view)
{
  return pendant.operational_mode().value_or("NONE");
}

std::string clear_operational_mode(Pendant & pendant, std::string_view)
{
  const std::string mode = pendant.operational_mode().value_or("NONE");
  pendant.set_operational_mode(std::nullopt);
  return fmt::format("No longer controlling the operational mode. Current operational mode: '{}'.", mode);
}

std::string set_user_role(Pendant & pendant, std::string_view role)
{
  constexpr std::array<std::string_view, 5> roles{"PROGRAMMER", "OPERATOR", "NONE", "LOCKED", "RESTRICTED"};
  const std::string wanted = upper(role);
  if (std::ranges::find(roles, wanted) == roles.end()) {
    return fmt::format("Failed setting user role: {}", role);
  }
  pendant.user_role = wanted;
  return fmt::format("Setting user role: {}", role);
}

std::string get_user_role(Pendant & pendant, std::string_view)
{
  return pendant.user_role;
}

// ---- about the robot

std::string polyscope_version(Pendant & pendant, std::string_view)
{
  return fmt::format("URSoftware {} (simulated)", pendant.options().version.to_string());
}

std::string version(Pendant & pendant, std::string_view)
{
  return pendant.options().version.to_string();
}
std::string is_in_remote_control(Pendant & pendant, std::string_view)
{
  return pendant.remote_control() ? "true" : "false";
}
std::string get_serial_number(Pendant & pendant, std::string_view)
{
  return pendant.options().serial_number;
}
std::string get_robot_model(Pendant & pendant, std::string_view)
{
  return pendant.model().dashboard_name;
}

std::string shutdown(Pendant & pendant, std::string_view)
{
  pendant.request_shutdown();
  return "Shutting down";
}

std::string quit(Pendant &, std::string_view)
{
  return "Disconnected";
}

std::string save_log(Pendant & pendant, std::string_view)
{
  return pendant.reports().save_log();
}

constexpr auto never = MinVersion::never;
constexpr std::array command_table{
    Command{"load", {}, true, load},
    Command{"play", {}, true, nullptr, play},
    Command{"stop", {}, true, nullptr, stop},
    Command{"pause", {}, true, nullptr, pause},
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

bool starts_with_command(std::string_view line, std::string_view name)
{
  const auto same = [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); };
  const bool prefix = line.size() >= name.size() && std::equal(name.begin(), name.end(), line.begin(), same);
  return prefix && (line.size() == name.size() || line[name.size()] == ' ');
}

constexpr std::string_view blanks = " \t";

}  // namespace

std::string reply_to(const Pendant::Result & result, std::string_view done, std::string_view command)
{
  return result ? std::string(done) : failed_reply(command);
}

const Command * find_command(std::string_view line, const PolyscopeVersion & version,
                             std::string_view & argument)
{
  line = trim(line, blanks);
  const Command * longest = nullptr;
  for (const Command & command : command_table) {
    const bool longer = longest == nullptr || command.name.size() > longest->name.size();
    if (longer && command.min_version.is_met_by(version) && starts_with_command(line, command.name)) {
      longest = &command;
    }
  }
  if (longest != nullptr) {
    argument = trim(line.substr(longest->name.size()), blanks);
  }
  return longest;
}

}  // namespace ur_simulator::dashboard
