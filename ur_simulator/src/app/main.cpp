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

void print_log_entry(const LogEntry & entry)
{
  fmt::print("{}\n", ur_simulator::to_string(entry));
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

/// Blocks SIGINT and SIGTERM, so that they are polled between control cycles instead of interrupting the
/// thread.
class TerminationSignals {
 public:
  TerminationSignals()
  {
    sigemptyset(&set_);
    sigaddset(&set_, SIGINT);
    sigaddset(&set_, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &set_, nullptr);
  }
  /// Returns whether a signal has been received since the last call.
  bool take_pending() const
  {
    constexpr timespec no_wait{0, 0};
    return sigtimedwait(&set_, nullptr, &no_wait) > 0;
  }

 private:
  sigset_t set_;
};

void run_simulator(const ur_simulator::AppOptions & options)
{
  const TerminationSignals signals;
  Controller controller(options.simulator);
  place_surfaces(controller, options.surface_heights);
  if (options.print_log) {
    controller.log().add_listener(print_log_entry);
  }
  constexpr int cycles_per_signal_poll = 10;
  controller.add_observer([&controller, &signals, cycle = 0]() mutable {
    if (++cycle % cycles_per_signal_poll == 0 && signals.take_pending()) {
      controller.stop();
    }
    return false;
  });
  print_ready(options, controller.ports());
  controller.run();
}

}  // namespace

int main(int argc, char ** argv)
{
  ur_simulator::AppOptions options;
  CLI::App app;
  ur_simulator::add_options(app, options);
  CLI11_PARSE(app, argc, argv);
  try {
    ur_simulator::parse_values(options);
    run_simulator(options);
    return 0;
  } catch (const std::exception & error) {
    fmt::print(stderr, "ur_simulator: {}\n", error.what());
    return 1;
  }
}
