#include "app/options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <map>
#include <stdexcept>
#include <string_view>

namespace ur_simulator {
namespace {

/// "name=value" in two; throws when there is no '='.
std::pair<std::string, std::string> split(const std::string & text, std::string_view option,
                                          std::string_view example)
{
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) {
    throw std::runtime_error(fmt::format("{} '{}' is not understood: give {}", option, text, example));
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

double height(const std::string & text)
{
  const auto [name, value] = split(text, "--surface", "z=0.1");
  std::size_t used = 0;
  double z = 0.0;
  try {
    z = std::stod(value, &used);
  } catch (const std::exception &) {
    used = 0;
  }
  if (name != "z" || used == 0 || used != value.size()) {
    throw std::runtime_error(fmt::format("--surface '{}' is not understood: give z=0.1 (m)", text));
  }
  return z;
}

void set_port(Ports & ports, const std::string & text)
{
  const std::map<std::string, std::uint16_t Ports::*> names{
      {"primary", &Ports::primary}, {"secondary", &Ports::secondary}, {"realtime", &Ports::realtime},
      {"rtde", &Ports::rtde},       {"dashboard", &Ports::dashboard}, {"control", &Ports::control}};
  const auto [name, value] = split(text, "--ports", "rtde=30004");
  const auto port = names.find(name);
  std::uint16_t number = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  if (port == names.end() || error != std::errc() || end != value.data() + value.size()) {
    throw std::runtime_error(
        fmt::format("--ports '{}' is not understood: give primary, secondary, realtime, rtde, dashboard or "
                    "control = 0..65535",
                    text));
  }
  ports.*(port->second) = number;
}

}  // namespace

void declare(CLI::App & app, AppOptions & options)
{
  SimulatorOptions & simulator = options.simulator;
  app.description(
      "A simulated Universal Robots controller: RTDE, dashboard, script ports, and a JSON control port.");
  app.add_option("--address", simulator.address, "IP address to listen on")->capture_default_str();
  app.add_option("--model", simulator.model, "robot model, such as ur5e, ur10e, ur20, ur10 (CB3)")
      ->capture_default_str();
  app.add_option("--polyscope", simulator.polyscope_version,
                 "version of the controller's software (5.25.1; 3.15.8 for CB3)");
  app.add_option("--ports", options.port_texts, "other ports: name=number (0: any free one)")->delimiter(',');
  app.add_option("--joints", options.joints, "where the joints stand at first, rad")
      ->expected(6)
      ->delimiter(',');
  app.add_option("--surface", options.surface_texts, "a horizontal elastic surface: z=height in m");
  app.add_option("--seed", simulator.seed, "seed of the sensor noise")->capture_default_str();
  app.add_option("--urcap", simulator.urcaps, "an installed URCap: onrobot_soft_gripper");
  app.add_option("--reports-folder", simulator.reports_folder,
                 "where reports and support files of the dashboard are written too");
  app.add_option("--real-time-factor", simulator.real_time_factor,
                 "seconds of the robot for each of the host's (0.01 to 10): below 1 for a slow host")
      ->capture_default_str();
  app.add_option(
         "--recovery-time-factor", simulator.recovery_time_factor,
         "scales how long power on, brake release, the unlock delay of a protective stop and a restart of "
         "the safety system take (0.01 to 10)")
      ->capture_default_str();
  app.add_flag("--powered-off", options.powered_off, "start as after boot, powered off");
  app.add_flag("--local-control", options.local_control, "start in local control");
  app.add_flag("--realtime-priority", simulator.realtime_priority, "try SCHED_FIFO");
  app.add_flag("--quiet", options.quiet, "no ready line");
  app.add_flag("--log", options.log, "print what the robot's log shows");
}

void complete(AppOptions & options)
{
  for (const std::string & text : options.port_texts) {
    set_port(options.simulator.ports, text);
  }
  for (const std::string & text : options.surface_texts) {
    options.surfaces.push_back(height(text));
  }
  if (!options.joints.empty()) {
    options.simulator.initial_joints.emplace();
    std::ranges::copy(options.joints, options.simulator.initial_joints->begin());
  }
  options.simulator.start_running = !options.powered_off;
  options.simulator.remote_control = !options.local_control;
}

}  // namespace ur_simulator
