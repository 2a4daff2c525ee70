#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <boost/asio/signal_set.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "app/options.hpp"
#include "controller/controller.hpp"

namespace {

using ur_simulator::Controller;
using ur_simulator::LogEntry;

void print_ready(const ur_simulator::AppOptions & options, const ur_simulator::Ports & ports)
{
  if (options.quiet) {
    return;
  }
  fmt::print("ready: {} on {}, dashboard {}, primary {}, secondary {}, real-time {}, RTDE {}, control {}\n",
             options.simulator.model, options.simulator.address, ports.dashboard, ports.primary,
             ports.secondary, ports.realtime, ports.rtde, ports.control);
  std::fflush(stdout);
}

void print(const LogEntry & entry)
{
  fmt::print("{:10.3f} {:7} {:10} {}\n", entry.timestamp, ur_simulator::name(entry.level), entry.source,
             entry.text);
  std::fflush(stdout);
}

void place_surfaces(Controller & controller, const std::vector<double> & heights)
{
  for (const double z : heights) {
    const nlohmann::json reply = controller.control({{"command", "place_surface"}, {"z", z}});
    if (!reply.at("ok").get<bool>()) {
      throw std::runtime_error("--surface: " + reply.at("error").get<std::string>());
    }
  }
}

int simulate(const ur_simulator::AppOptions & options)
{
  Controller controller(options.simulator);
  place_surfaces(controller, options.surfaces);
  if (options.log) {
    controller.log().add_listener(print);
  }
  boost::asio::signal_set signals(controller.io(), SIGINT, SIGTERM);
  signals.async_wait([&controller](const boost::system::error_code & error, int) {
    if (!error) {
      controller.stop();
    }
  });
  print_ready(options, controller.ports());
  controller.run();
  return 0;
}

}  // namespace

int main(int argc, char ** argv)
{
  ur_simulator::AppOptions options;
  CLI::App app;
  ur_simulator::declare(app, options);
  CLI11_PARSE(app, argc, argv);
  try {
    ur_simulator::complete(options);
    return simulate(options);
  } catch (const std::exception & error) {
    fmt::print(stderr, "ur_simulator: {}\n", error.what());
    return 1;
  }
}
