#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <exception>
#include <stdexcept>
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

/// Ctrl-C and termination, taken between two control cycles: no handler that could interrupt anything.
class Signals {
 public:
  Signals()
  {
    sigemptyset(&set_);
    sigaddset(&set_, SIGINT);
    sigaddset(&set_, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &set_, nullptr);
  }
  bool arrived() const
  {
    constexpr timespec at_once{0, 0};
    return sigtimedwait(&set_, nullptr, &at_once) > 0;
  }

 private:
  sigset_t set_;
};

int simulate(const ur_simulator::AppOptions & options)
{
  const Signals signals;
  Controller controller(options.simulator);
  place_surfaces(controller, options.surfaces);
  if (options.log) {
    controller.log().add_listener(print);
  }
  constexpr int cycles_between_looks = 10;
  controller.observe([&controller, &signals, cycle = 0]() mutable {
    if (++cycle % cycles_between_looks == 0 && signals.arrived()) {
      controller.stop();
    }
    return false;
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
