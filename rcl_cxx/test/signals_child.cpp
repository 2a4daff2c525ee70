// The process that test_signals.cpp sends signals to. Each byte on the standard output reports progress; the
// exit status is 0 on success.
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "context/signals.hpp"
#include "rcl_cxx/rcl_cxx.hpp"

using rcl_cxx::Context;
using rcl_cxx::InitOptions;
using std::chrono::milliseconds;

namespace {
constexpr std::chrono::seconds kLimit{10};

void report()
{
  if (::write(STDOUT_FILENO, "r", 1) != 1) {
    std::_Exit(2);
  }
}

bool spins_until(const std::string & signal)
{
  const auto context = std::make_shared<Context>(std::vector<std::string>{"test"});
  rcl_cxx::Executor executor(context);
  executor.post([] { report(); });
  executor.spin();
  return context->shutdown_reason() == signal;
}

/// Raises a signal before the watcher has a callback, with various delays.
bool hears_early_signals()
{
  for (int round = 0; round < 100; ++round) {
    std::promise<int> delivered;
    auto signal = delivered.get_future();
    const auto watcher = rcl_cxx::detail::SignalWatcher::instance();
    ::raise(SIGINT);
    std::this_thread::sleep_for(std::chrono::microseconds(10 * round));
    watcher->add([&delivered](int number) { delivered.set_value(number); });
    if (signal.wait_for(kLimit) != std::future_status::ready || signal.get() != SIGINT) {
      return false;
    }
  }
  return true;
}

/// Reports the begin of a shutdown, and ends it on SIGUSR1.
bool shuts_down_slowly(milliseconds grace)
{
  // Blocked before any thread exists, so that only sigtimedwait() receives it.
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGUSR1);
  ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
  InitOptions options;
  options.signal_grace = grace;
  const auto context = std::make_shared<Context>(std::vector<std::string>{"test"}, options);
  context->add_pre_shutdown_callback([&] {
    report();
    const timespec limit{10, 0};
    while (::sigtimedwait(&set, nullptr, &limit) < 0 && errno == EINTR) {
      // interrupted by the handler of another signal
    }
  });
  report();
  return context->wait_for_shutdown(kLimit);
}

bool act(const std::string & part, const std::string & argument)
{
  if (part == "spins_until") {
    return spins_until(argument);
  }
  if (part == "hears_early_signals") {
    return hears_early_signals();
  }
  return part == "shuts_down_slowly" && shuts_down_slowly(milliseconds(std::stoi(argument)));
}
}  // namespace

int main(int argc, char ** argv)
{
  return argc == 3 && act(argv[1], argv[2]) ? 0 : 1;
}
