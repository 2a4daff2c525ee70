#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>

#include "app/options.hpp"
#include "app/robots.hpp"

namespace {

/// Blocks SIGINT and SIGTERM in this thread and in those that it starts, so that wait() receives them.
class TerminationSignals {
 public:
  TerminationSignals()
  {
    sigemptyset(&set_);
    sigaddset(&set_, SIGINT);
    sigaddset(&set_, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &set_, nullptr);
  }
  void wait() const
  {
    int received = 0;
    sigwait(&set_, &received);
  }

 private:
  sigset_t set_;
};

void run_simulator(const ur_simulator::AppOptions & options)
{
  const TerminationSignals signals;
  ur_simulator::Robots robots(options);
  robots.start();
  signals.wait();
  robots.stop();
}

}  // namespace

int main(int argc, char ** argv)
{
  ur_simulator::AppOptions options;
  CLI::App app;
  ur_simulator::add_options(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError & error) {  // also of --help
    return app.exit(error) == 0 ? 0 : 1;
  }
  try {
    ur_simulator::parse_values(options);
    run_simulator(options);
    return 0;
  } catch (const std::exception & error) {
    fmt::print(stderr, "ur_simulator: {}\n", error.what());
    return 1;
  }
}
