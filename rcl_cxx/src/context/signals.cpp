#include "context/signals.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>

#include "rcl_cxx/error.hpp"

namespace rcl_cxx::detail {
namespace {
constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};
constexpr unsigned char kQuit = 0;

// A signal handler may use lock-free atomics and write(2) only.
std::atomic<int> g_write_end{-1};
static_assert(std::atomic<int>::is_always_lock_free);

struct sigaction g_previous[std::size(kSignals)];

extern "C" void rcl_cxx_on_signal(int signal)
{
  const int saved_errno = errno;
  const auto byte = static_cast<unsigned char>(signal);
  const int fd = g_write_end.load();
  if (fd >= 0 && ::write(fd, &byte, 1) < 0) {
    // The pipe is full of signals that have not been handled yet.
  }
  errno = saved_errno;
}
}  // namespace

std::shared_ptr<SignalWatcher> SignalWatcher::instance()
{
  static std::mutex mutex;
  static std::weak_ptr<SignalWatcher> current;
  const std::lock_guard lock(mutex);
  std::shared_ptr<SignalWatcher> watcher = current.lock();
  if (!watcher) {
    watcher.reset(new SignalWatcher);
    current = watcher;
  }
  return watcher;
}

SignalWatcher::SignalWatcher()
{
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) {
    throw Error(std::string("signal pipe: ") + std::strerror(errno));
  }
  read_end_ = ends[0];
  write_end_ = ends[1];
  ::fcntl(write_end_, F_SETFL, O_NONBLOCK);
  thread_ = std::thread([this] { run(); });

  g_write_end = write_end_;
  struct sigaction action = {};
  action.sa_handler = &rcl_cxx_on_signal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < std::size(kSignals); ++i) {
    ::sigaction(kSignals[i], nullptr, &g_previous[i]);
    if (kSignals[i] != SIGHUP || g_previous[i].sa_handler != SIG_IGN) {  // nohup
      ::sigaction(kSignals[i], &action, nullptr);
    }
  }
}

SignalWatcher::~SignalWatcher()
{
  for (std::size_t i = 0; i < std::size(kSignals); ++i) {
    ::sigaction(kSignals[i], &g_previous[i], nullptr);
  }
  g_write_end = -1;
  // The pipe may be full of signals; the thread empties it.
  while (::write(write_end_, &kQuit, 1) < 0 && (errno == EAGAIN || errno == EINTR)) {
    std::this_thread::yield();
  }
  thread_.join();
  ::close(read_end_);
  ::close(write_end_);
}

std::size_t SignalWatcher::add(Callback callback)
{
  const std::lock_guard lock(mutex_);
  callbacks_.emplace(++next_id_, std::move(callback));
  if (undelivered_ != 0 && ::write(write_end_, &undelivered_, 1) == 1) {
    undelivered_ = 0;
  }
  return next_id_;
}

void SignalWatcher::remove(std::size_t id)
{
  const std::lock_guard lock(mutex_);
  callbacks_.erase(id);
}

void SignalWatcher::run()
{
  while (true) {
    unsigned char byte = kQuit;
    const ssize_t got = ::read(read_end_, &byte, 1);
    if (got < 0 && errno == EINTR) {
      continue;
    }
    if (got != 1 || byte == kQuit) {
      return;
    }
    const std::lock_guard lock(mutex_);
    if (callbacks_.empty()) {
      undelivered_ = byte;
    }
    for (const auto & [id, callback] : callbacks_) {
      try {
        callback(byte);
      } catch (const std::exception &) {  // for instance, no thread can be started
        take_default_action(byte);
      }
    }
  }
}

void take_default_action(int signal)
{
  struct sigaction action = {};
  action.sa_handler = SIG_DFL;
  sigemptyset(&action.sa_mask);
  ::sigaction(signal, &action, nullptr);
  ::kill(::getpid(), signal);
}

}  // namespace rcl_cxx::detail
