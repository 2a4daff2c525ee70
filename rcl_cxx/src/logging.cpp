#include "rcl_cxx/logging.hpp"

#include <fmt/format.h>
#include <rcl/allocator.h>
#include <rcl/logging.h>
#include <rcutils/logging.h>

#include "logging_impl.hpp"
#include "rcl_compat.hpp"
#include "rcl_error.hpp"

namespace rcl_cxx {
namespace detail {
std::recursive_mutex & logging_mutex()
{
  // Never destroyed: threads may log while static objects are destroyed.
  static auto * const mutex = new std::recursive_mutex;
  return *mutex;
}

namespace {
void write_locked(const rcutils_log_location_t * location, int severity, const char * name,
                  rcutils_time_point_value_t timestamp, const char * format, va_list * arguments)
{
  const std::lock_guard lock(logging_mutex());
  rcl_logging_multiple_output_handler(location, severity, name, timestamp, format, arguments);
}

struct LoggingInUse {
  explicit LoggingInUse(const rcl_arguments_t & arguments)
  {
    const rcl_allocator_t allocator = rcl_get_default_allocator();
    configured =
        rcl_logging_configure_with_output_handler(&arguments, &allocator, &write_locked) == RCL_RET_OK;
    if (!configured) {
      // No folder for the log file, mostly. A robot can be driven without one: the console works anyway.
      rcutils_log(nullptr, RCUTILS_LOG_SEVERITY_WARN, "rcl_cxx", "only the console gets log messages: %s",
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

namespace {
/// The entry of a child logger in its node's /rosout.
struct RosoutChild {
  RosoutChild(std::string logger_name, std::string child_name)
      : logger(std::move(logger_name)), child(std::move(child_name))
  {
    const std::lock_guard lock(logging_mutex());
    registered = compat::rosout_add_child(logger.c_str(), child.c_str());
    rcl_reset_error();  // a logger of no node, or one whose node has no /rosout
  }
  ~RosoutChild()
  {
    const std::lock_guard lock(logging_mutex());
    if (registered) {
      ignore_rcl(compat::rosout_remove_child(logger.c_str(), child.c_str()));
    }
  }
  RosoutChild(const RosoutChild &) = delete;
  RosoutChild & operator=(const RosoutChild &) = delete;

  std::string logger;
  std::string child;
  bool registered = false;
};
}  // namespace
}  // namespace detail

Logger::Logger(std::string name) : name_(std::make_shared<const std::string>(std::move(name))) {}

Logger Logger::get_child(std::string_view suffix) const
{
  Logger logger(fmt::format("{}.{}", *name_, suffix));
  logger.registration_ = std::make_shared<const detail::RosoutChild>(*name_, std::string(suffix));
  return logger;
}

bool Logger::is_enabled(LogLevel level) const noexcept
{
  const std::lock_guard lock(detail::logging_mutex());
  return rcutils_logging_logger_is_enabled_for(name_->c_str(), static_cast<int>(level));
}

void Logger::set_level(LogLevel level) const
{
  const std::lock_guard lock(detail::logging_mutex());
  if (rcutils_logging_set_logger_level(name_->c_str(), static_cast<int>(level)) != RCUTILS_RET_OK) {
    throw Error(fmt::format("logger {}: level cannot be set ({})", *name_, detail::take_rcl_error()));
  }
}

void Logger::write(LogLevel level, const LogLocation & location, std::string_view text) const noexcept
{
  try {
    const std::string terminated(text);
    const rcutils_log_location_t place{location.function, location.file, location.line};
    const std::lock_guard lock(detail::logging_mutex());
    rcutils_log(&place, static_cast<int>(level), name_->c_str(), "%s", terminated.c_str());
  } catch (const std::exception &) {
    // out of memory: there is no way left to tell
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
