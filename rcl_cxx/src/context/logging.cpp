#include "rcl_cxx/logging.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <rcl/allocator.h>
#include <rcl/logging.h>
#include <rcutils/logging.h>
#include <unistd.h>

#include <cstdlib>

#include "context/logging_impl.hpp"
#include "rcl_support/rcl_error.hpp"

namespace rcl_cxx {
namespace detail {
std::recursive_mutex & logging_mutex()
{
  // Never destroyed: threads may log while static objects are destroyed.
  static auto * const mutex = new std::recursive_mutex;
  return *mutex;
}

namespace {
/// The console blocks a writer while nobody reads it (Ctrl-S, a full pipe), and the lock then blocks every
/// other thread. So messages that it does not take are counted instead. Guarded by logging_mutex.
class Console {
 public:
  bool takes_a_message()
  {
    constexpr int patience = 20;  // ms, for a reader that is a little late
    pollfd entry{descriptor_, POLLOUT, 0};
    is_read_ = ::poll(&entry, 1, is_read_ ? patience : 0) != 0;
    lost_ += is_read_ ? 0 : 1;
    return is_read_;
  }
  unsigned take_lost() { return std::exchange(lost_, 0U); }

 private:
  static int choose()
  {
    const char * use_stdout = std::getenv("RCUTILS_LOGGING_USE_STDOUT");
    return use_stdout != nullptr && std::string_view(use_stdout) == "1" ? STDOUT_FILENO : STDERR_FILENO;
  }
  const int descriptor_ = choose();
  bool is_read_ = true;
  unsigned lost_ = 0;
};

void write_locked(const rcutils_log_location_t * location, int severity, const char * name,
                  rcutils_time_point_value_t timestamp, const char * format, va_list * arguments)
{
  static Console console;
  const std::lock_guard lock(logging_mutex());
  if (!console.takes_a_message()) {
    return;
  }
  if (const unsigned lost = console.take_lost(); lost != 0) {
    rcutils_log(nullptr, RCUTILS_LOG_SEVERITY_WARN, "rcl_cxx",
                "%u log messages were not written: nobody read the console", lost);
  }
  rcl_logging_multiple_output_handler(location, severity, name, timestamp, format, arguments);
}

struct LoggingInUse {
  explicit LoggingInUse(const rcl_arguments_t & arguments)
  {
    const rcl_allocator_t allocator = rcl_get_default_allocator();
    configured =
        rcl_logging_configure_with_output_handler(&arguments, &allocator, &write_locked) == RCL_RET_OK;
    if (!configured) {
      // For instance: the folder of the log file cannot be written. The console works without it.
      rcutils_log(nullptr, RCUTILS_LOG_SEVERITY_WARN, "rcl_cxx", "log messages go to the console only: %s",
                  take_rcl_error().c_str());
    }
  }
  ~LoggingInUse()
  {
    const std::lock_guard lock(logging_mutex());
    if (configured) {
      ignore_rcl(rcl_logging_fini());
    }
  }
  LoggingInUse(const LoggingInUse &) = delete;
  LoggingInUse & operator=(const LoggingInUse &) = delete;

  bool configured = false;
};
}  // namespace

std::shared_ptr<void> configure_logging(const rcl_arguments_t & arguments)
{
  static std::weak_ptr<LoggingInUse> in_use;  // guarded by logging_mutex
  const std::lock_guard lock(logging_mutex());
  std::shared_ptr<LoggingInUse> logging = in_use.lock();
  if (!logging) {
    logging = std::make_shared<LoggingInUse>(arguments);
    in_use = logging;
  }
  return logging;
}

bool throttle_passes(std::atomic<std::int64_t> & last_ns, std::chrono::nanoseconds period) noexcept
{
  const std::int64_t now = std::chrono::steady_clock::now().time_since_epoch().count();
  std::int64_t last = last_ns.load(std::memory_order_relaxed);
  if (last != INT64_MIN && now - last < period.count()) {
    return false;
  }
  return last_ns.compare_exchange_strong(last, now);
}

}  // namespace detail

Logger::Logger(std::string name) : name_(std::make_shared<const std::string>(std::move(name))) {}

bool Logger::is_enabled(LogLevel level) const noexcept
{
  const std::lock_guard lock(detail::logging_mutex());
  return rcutils_logging_logger_is_enabled_for(name_->c_str(), static_cast<int>(level));
}

void Logger::write(LogLevel level, const LogLocation & location, std::string_view text) const noexcept
{
  try {
    const std::string terminated(text);
    const rcutils_log_location_t place{location.function, location.file, location.line};
    const std::lock_guard lock(detail::logging_mutex());
    rcutils_log(&place, static_cast<int>(level), name_->c_str(), "%s", terminated.c_str());
  } catch (const std::exception &) {
    // out of memory
  }
}

void Logger::write_formatted(LogLevel level, const LogLocation & location, fmt::string_view format,
                             fmt::format_args arguments) const noexcept
{
  try {
    write(level, location, fmt::vformat(format, arguments));
  } catch (const std::exception & error) {
    write(level, location, error.what());
  }
}

}  // namespace rcl_cxx
