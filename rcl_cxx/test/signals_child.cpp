// What test_signals.cpp sends signals to: a signal is for a whole process. Each byte on the standard output
// tells that a point is reached; the exit status is 0 when all went as it should.
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "../src/signals.hpp"
#include "rcl_cxx/rcl_cxx.hpp"

using rcl_cxx::Context;
using rcl_cxx::InitOptions;
using std::chrono::milliseconds;

namespace {
constexpr std::chrono::seconds kLimit{10};

void tell()
{
  if (::write(STDOUT_FILENO, "r", 1) != 1) {
    std::_Exit(2);
  }
}

bool spins_until(const std::string & signal)
{
  const auto context = std::make_shared<Context>(std::vector<std::string>{"test"});
  rcl_cxx::Executor executor(context);
  executor.post([] { tell(); });
  executor.spin();
  return context->shutdown_reason() == signal;
}

/// Signals that come while the watcher begins, at various moments.
bool hears_early_signals()
{
  for (int round = 0; round < 100; ++round) {
    std::promise<int> told;
    auto signal = told.get_future();
    const auto watcher = rcl_cxx::detail::SignalWatcher::instance();
    ::raise(SIGINT);
    std::this_thread::sleep_for(std::chrono::microseconds(10 * round));  // the moment is the variation
    watcher->add([&told](int number) { told.set_value(number); });
    if (signal.wait_for(kLimit) != std::future_status::ready || signal.get() != SIGINT) {
      return false;
    }
  }
  return true;
}

/// A shutdown that takes until its end is asked for by SIGUSR1, and reports its beginning.
bool shuts_down_slowly(milliseconds grace)
{
  // Blocked before any thread exists, so that only sigtimedwait takes it.
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGUSR1);
  ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
  InitOptions options;
  options.signal_grace = grace;
  const auto context = std::make_shared<Context>(std::vector<std::string>{"test"}, options);
  context->add_pre_shutdown_callback([&] {
    tell();
    const timespec limit{10, 0};
    while (::sigtimedwait(&set, nullptr, &limit) < 0 && errno == EINTR) {
      // The handler of one of the other signals ran in this thread.
    }
  });
  tell();
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
