#pragma once

#include <fmt/core.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace rcl_cxx {
/// The values are the severities of rcutils.
enum class LogLevel { debug = 10, info = 20, warn = 30, error = 40, fatal = 50 };

/// The position of a log statement.
struct LogLocation {
  const char * function;
  const char * file;
  std::size_t line;
};

/// A named logger. Messages go to the console and the log file; those of a node's logger to /rosout, too.
/// While nobody reads the console (Ctrl-S, a full pipe), messages are counted instead, and no thread waits.
/// Cheap to copy, thread-safe. Use it through the RCL_CXX_… macros:
///
///     RCL_CXX_INFO(node->get_logger(), "connected to {} in {:.1f} s", host, seconds);
///     RCL_CXX_WARN_THROTTLE(logger, std::chrono::seconds(1), "{} packages lost", n);
class Logger {
 public:
  explicit Logger(std::string name);

  const std::string & get_name() const noexcept { return *name_; }

  bool is_enabled(LogLevel level) const noexcept;

  /// Writes `text` if the level is enabled. Never throws.
  void write(LogLevel level, const LogLocation & location, std::string_view text) const noexcept;
  /// Formats and writes. If formatting fails, its error is written instead. Never throws.
  void write_formatted(LogLevel level, const LogLocation & location, fmt::string_view format,
                       fmt::format_args arguments) const noexcept;

  template <typename... T>
  void log(LogLevel level, const LogLocation & location, fmt::format_string<T...> format,
           T &&... arguments) const noexcept
  {
    write_formatted(level, location, format, fmt::make_format_args(arguments...));
  }

 private:
  std::shared_ptr<const std::string> name_;
};

namespace detail {
/// Returns true at most once per `period` (steady clock), over all threads.
bool throttle_passes(std::atomic<std::int64_t> & last_ns, std::chrono::nanoseconds period) noexcept;
}  // namespace detail

}  // namespace rcl_cxx

#define RCL_CXX_LOG(level, logger, ...)                                                             \
  do {                                                                                              \
    const auto & rcl_cxx_logger = (logger);                                                         \
    if (rcl_cxx_logger.is_enabled(level)) {                                                         \
      rcl_cxx_logger.log(level, ::rcl_cxx::LogLocation{__func__, __FILE__, __LINE__}, __VA_ARGS__); \
    }                                                                                               \
  } while (false)

#define RCL_CXX_LOG_ONCE(level, logger, ...)      \
  do {                                            \
    static std::atomic<bool> rcl_cxx_done{false}; \
    if (!rcl_cxx_done.exchange(true)) {           \
      RCL_CXX_LOG(level, logger, __VA_ARGS__);    \
    }                                             \
  } while (false)

#define RCL_CXX_LOG_THROTTLE(level, logger, period, ...)              \
  do {                                                                \
    static std::atomic<std::int64_t> rcl_cxx_last{INT64_MIN};         \
    if (::rcl_cxx::detail::throttle_passes(rcl_cxx_last, (period))) { \
      RCL_CXX_LOG(level, logger, __VA_ARGS__);                        \
    }                                                                 \
  } while (false)

#define RCL_CXX_DEBUG(logger, ...) RCL_CXX_LOG(::rcl_cxx::LogLevel::debug, logger, __VA_ARGS__)
#define RCL_CXX_INFO(logger, ...) RCL_CXX_LOG(::rcl_cxx::LogLevel::info, logger, __VA_ARGS__)
#define RCL_CXX_WARN(logger, ...) RCL_CXX_LOG(::rcl_cxx::LogLevel::warn, logger, __VA_ARGS__)
#define RCL_CXX_ERROR(logger, ...) RCL_CXX_LOG(::rcl_cxx::LogLevel::error, logger, __VA_ARGS__)
#define RCL_CXX_FATAL(logger, ...) RCL_CXX_LOG(::rcl_cxx::LogLevel::fatal, logger, __VA_ARGS__)

#define RCL_CXX_WARN_ONCE(logger, ...) RCL_CXX_LOG_ONCE(::rcl_cxx::LogLevel::warn, logger, __VA_ARGS__)

/// `period` is a std::chrono duration.
#define RCL_CXX_WARN_THROTTLE(logger, period, ...) \
  RCL_CXX_LOG_THROTTLE(::rcl_cxx::LogLevel::warn, logger, period, __VA_ARGS__)
