#include "app/robots.hpp"

#include <fmt/format.h>

#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/address_v4.hpp>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <utility>

namespace ur_simulator {
namespace {

void place_surfaces(Controller & controller, const std::vector<double> & heights)
{
  for (const double z : heights) {
    const nlohmann::json reply = controller.control({{"command", "place_surface"}, {"z", z}});
    if (!reply.at("ok").get<bool>()) {
      throw std::runtime_error("--surface: " + reply.at("error").get<std::string>());
    }
  }
}

/// Prints one line. Lines of different threads do not mix: stdio locks the stream.
void print_line(const std::string & line)
{
  std::fputs((line + "\n").c_str(), stdout);
  std::fflush(stdout);
}

}  // namespace

std::vector<std::string> consecutive_addresses(const std::string & first, unsigned count)
{
  if (count == 1) {
    return {first};
  }
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address_v4(first, error);
  if (error) {
    throw std::runtime_error(fmt::format("--count needs an IPv4 address: --address '{}' is none", first));
  }
  const auto start = address.to_uint();
  if (start > std::numeric_limits<std::uint32_t>::max() - (count - 1)) {
    throw std::runtime_error(
        fmt::format("there are not {} addresses from {} on (--address, --count)", count, first));
  }
  std::vector<std::string> addresses;
  for (unsigned i = 0; i < count; ++i) {
    addresses.push_back(boost::asio::ip::address_v4(start + i).to_string());
  }
  return addresses;
}

std::string exposure_warning(const std::string & address)
{
  boost::system::error_code error;
  const auto parsed = boost::asio::ip::make_address(address, error);
  if (error || parsed.is_loopback()) {
    return "";
  }
  return fmt::format(
      "other hosts can connect to {} (--address). Neither a robot nor this simulator asks for a password: "
      "every client can run programs, which open connections from this host, and inject faults through the "
      "control port. Use 127.0.0.1, or a firewall that admits your clients only",
      address);
}

Robots::Robots(const AppOptions & options) : shows_status_(options.show_status)
{
  SimulatorOptions simulator = options.simulator;
  if (!simulator.client_log.empty()) {
    client_log_.emplace(simulator.client_log);
  }
  for (const std::string & address : consecutive_addresses(options.simulator.address, options.count)) {
    simulator.address = address;
    add(options, simulator);
    ++simulator.seed;  // each robot has its own sensor noise
  }
  if (const std::string warning = exposure_warning(options.simulator.address); !warning.empty()) {
    fmt::print(stderr, "ur_simulator: warning: {}\n", warning);
  }
  print_ready(options);
  print_warnings();
}

Robots::~Robots()
{
  stop();
}

void Robots::add(const AppOptions & options, const SimulatorOptions & simulator)
{
  auto controller = std::make_unique<Controller>(simulator);
  place_surfaces(*controller, options.surface_heights);
  if (options.print_log) {
    const std::string prefix = options.count > 1 ? simulator.address + " " : "";
    controller->log().add_listener(
        [prefix](const LogEntry & entry) { print_line(prefix + to_string(entry)); });
  }
  if (client_log_) {
    controller->start_client_log(*client_log_, options.count > 1 ? simulator.address : "");
  }
  robots_.push_back({simulator.address, std::move(controller), {}});
}

void Robots::print_ready(const AppOptions & options) const
{
  if (options.quiet) {
    return;
  }
  for (const Robot & robot : robots_) {
    const Ports ports = robot.controller->ports();
    const std::string operator_port = ports.dashboard != 0   ? fmt::format("dashboard {}, ", ports.dashboard)
                                      : ports.robot_api != 0 ? fmt::format("Robot API {}, ", ports.robot_api)
                                                             : "";
    const std::string modbus_port = ports.modbus != 0 ? fmt::format("MODBUS {}, ", ports.modbus) : "";
    print_line(fmt::format("ready: {} on {}, {}primary {}, secondary {}, real-time {}, RTDE {}, {}control {}",
                           options.simulator.model, robot.address, operator_port, ports.primary,
                           ports.secondary, ports.realtime, ports.rtde, modbus_port, ports.control));
  }
}

void Robots::print_warnings() const
{
  // All robots have the same options.
  for (const LogEntry & entry : robots_.front().controller->log().entries()) {
    if (entry.level == LogLevel::warning) {
      fmt::print(stderr, "ur_simulator: warning: {}\n", entry.text);
    }
  }
}

void Robots::start()
{
  for (Robot & robot : robots_) {
    robot.thread = std::thread([controller = robot.controller.get()] { controller->run(); });
  }
  if (shows_status_) {
    std::vector<StatusDisplay::Robot> robots;
    for (const Robot & robot : robots_) {
      robots.push_back({robot.address, robot.controller.get()});
    }
    status_.emplace(robots);
  }
}

void Robots::stop()
{
  status_.reset();
  for (Robot & robot : robots_) {
    robot.controller->stop();
  }
  for (Robot & robot : robots_) {
    if (robot.thread.joinable()) {
      robot.thread.join();
    }
  }
}

}  // namespace ur_simulator
