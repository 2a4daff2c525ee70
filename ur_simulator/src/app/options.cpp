#include "app/options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace ur_simulator {
namespace {

/// Splits "name=value". Throws std::runtime_error if there is no '='.
std::pair<std::string, std::string> split_assignment(const std::string & text, std::string_view option,
                                                     std::string_view example)
{
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) {
    throw std::runtime_error(fmt::format("{} '{}' is invalid: give {}", option, text, example));
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

double parse_surface_height(const std::string & text)
{
  const auto [name, value] = split_assignment(text, "--surface", "z=0.1");
  std::size_t parsed = 0;
  double z = 0.0;
  try {
    z = std::stod(value, &parsed);
  } catch (const std::exception &) {
    parsed = 0;
  }
  if (name != "z" || parsed == 0 || parsed != value.size()) {
    throw std::runtime_error(fmt::format("--surface '{}' is invalid: give z=0.1 (m)", text));
  }
  return z;
}

void parse_port(Ports & ports, const std::string & text)
{
  const std::map<std::string, std::uint16_t Ports::*> names{
      {"primary", &Ports::primary},
      {"secondary", &Ports::secondary},
      {"realtime", &Ports::realtime},
      {"primary_read_only", &Ports::primary_read_only},
      {"secondary_read_only", &Ports::secondary_read_only},
      {"realtime_read_only", &Ports::realtime_read_only},
      {"interpreter", &Ports::interpreter},
      {"robotiq", &Ports::robotiq},
      {"rtde", &Ports::rtde},
      {"dashboard", &Ports::dashboard},
      {"robot_api", &Ports::robot_api},
      {"modbus", &Ports::modbus},
      {"control", &Ports::control}};
  const auto [name, value] = split_assignment(text, "--ports", "rtde=30004");
  const auto port = names.find(name);
  std::uint16_t number = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  if (port == names.end() || error != std::errc() || end != value.data() + value.size()) {
    throw std::runtime_error(fmt::format(
        "--ports '{}' is invalid: give primary, secondary, realtime, one of these with "
        "_read_only, interpreter, rtde, dashboard, robot_api, modbus, robotiq or control = 0..65535",
        text));
  }
  ports.*(port->second) = number;
}

}  // namespace

void add_options(CLI::App & app, AppOptions & options)
{
  SimulatorOptions & simulator = options.simulator;
  app.description(
      "Simulates a Universal Robots controller with RTDE, dashboard server, client interfaces and a JSON "
      "control port.");
  app.set_version_flag("--version", "ur_simulator " UR_SIMULATOR_VERSION);
  app.add_option("--address", simulator.address, "IP address to listen on")->capture_default_str();
  app.add_option("--count", options.count, "robots in this process, on consecutive addresses from --address")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  app.add_option("--model", simulator.model, "robot model, for example ur5e, ur10e, ur20 or ur10 (CB3)")
      ->capture_default_str();
  app.add_option("--polyscope", simulator.polyscope_version,
                 "PolyScope version, 10.x for PolyScope X (default: 5.25.1; 3.15.8 for CB3 models)");
  app.add_option(
         "--ports", options.port_texts,
         "port numbers as name=number with the names primary, secondary, realtime, primary_read_only, "
         "secondary_read_only, realtime_read_only, interpreter, rtde, dashboard, robot_api, modbus, robotiq "
         "and "
         "control; 0 selects a free port")
      ->delimiter(',');
  app.add_option("--joints", options.joints, "initial joint positions, rad")->expected(6)->delimiter(',');
  app.add_option("--surface", options.surface_texts, "horizontal elastic surface as z=height, m; repeatable");
  app.add_option("--world", simulator.world_file,
                 "YAML file with surfaces, boxes, springs, the load and a time line of events");
  app.add_option("--seed", simulator.seed, "seed of the sensor noise")->capture_default_str();
  app.add_option("--calibration-seed", simulator.calibration_seed,
                 "selects a random calibration of the arm; 0: nominal kinematics")
      ->capture_default_str();
  app.add_option("--urcap", simulator.urcaps,
                 "installed URCap: onrobot_soft_gripper or robotiq_gripper; repeatable");
  app.add_option("--digital-gripper", simulator.digital_gripper,
                 "pneumatic gripper at the digital outputs of the tool: single or double (acting)");
  app.add_option("--reports-folder", simulator.reports_folder,
                 "also write the dashboard's flight reports, support files and logs to this folder");
  app.add_option("--real-time-factor", simulator.real_time_factor,
                 "simulated seconds per second of the host, 0.01 to 1000; below 1 for slow hosts")
      ->capture_default_str();
  app.add_option(
         "--recovery-time-factor", simulator.recovery_time_factor,
         "scales the time of power on, brake release, the unlock delay of a protective stop and a restart of "
         "the safety system, 0.01 to 10")
      ->capture_default_str();
  app.add_flag("--powered-off", options.powered_off, "start with the arm powered off, as after boot");
  app.add_flag("--local-control", options.local_control, "start in local control");
  app.add_flag("--ignore-collisions", options.ignore_collisions,
               "let links pass through each other and through objects");
  app.add_flag("--realtime-priority", simulator.realtime_priority,
               "run the control loop with SCHED_FIFO if permitted");
  app.add_flag("--quiet", options.quiet, "do not print the ready message");
  app.add_flag("--log", options.print_log, "print the log of the controller");
  app.add_flag(
      "--status", options.show_status,
      "show modes, program, joints, clients and errors; if the standard output is no terminal, a line for "
      "each change");
  app.add_option(
         "--client-log", simulator.client_log,
         "write what clients and robots do to this file, as a Mermaid sequence diagram; default: standard "
         "output")
      ->expected(0, 1)
      ->default_str("-")
      ->type_name("[FILE]");
}

void parse_values(AppOptions & options)
{
  if (options.show_status && (options.print_log || options.simulator.client_log == "-")) {
    throw std::runtime_error(
        "--status, --log and --client-log without a file all write to the standard output: give --status "
        "alone or with --client-log FILE");
  }
  for (const std::string & text : options.port_texts) {
    parse_port(options.simulator.ports, text);
  }
  for (const std::string & text : options.surface_texts) {
    options.surface_heights.push_back(parse_surface_height(text));
  }
  if (!options.joints.empty()) {
    options.simulator.initial_joints.emplace();
    std::ranges::copy(options.joints, options.simulator.initial_joints->begin());
  }
  options.simulator.start_running = !options.powered_off;
  options.simulator.detect_collisions = !options.ignore_collisions;
  options.simulator.remote_control = !options.local_control;
}

}  // namespace ur_simulator
