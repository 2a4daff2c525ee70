#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace rcl_cxx {
namespace detail {
class ContextImpl;
}

struct InitOptions {
  /// Overrides the ROS_DOMAIN_ID environment variable. 0..101 is safe on every platform.
  std::optional<std::size_t> domain_id{};
  /// SIGINT and SIGTERM shut this context down (in a thread of its own, so callbacks may do anything).
  /// Several contexts may ask for it. A signal that comes later than `signal_grace` after the first one takes
  /// the default action: a shutdown that hangs can still be ended with Ctrl-C. An earlier one (a launcher and
  /// the terminal both sending SIGINT) is reported in the log and does not disturb the shutdown.
  bool shutdown_on_signal = true;
  std::chrono::milliseconds signal_grace{2000};
  /// Configure rcl logging from the arguments (--log-level, …). Once per process: the first context that
  /// asks.
  bool auto_initialize_logging = true;
};

/// One participation in ROS: arguments, domain, and the moment at which everything ends. Thread-safe.
///
/// Order of a shutdown: ok() turns false, callbacks of add_pre_shutdown_callback run while communication
/// still works (stop the robot, end the goals with a reason), action servers abort what is still running, rcl
/// is shut down, callbacks of add_on_shutdown_callback run, wait_for_shutdown and Executor::spin return.
class Context {
 public:
  using SharedPtr = std::shared_ptr<Context>;
  using Callback = std::function<void()>;

  /// `argv` as main got it; everything after --ros-args (-r remaps, -p and --params-file parameters,
  /// --log-level,
  /// --enclave, …) is for ROS.
  /// @throws Error for a malformed or an unknown ROS argument (named in the text), or if rcl cannot start.
  Context(int argc, const char * const * argv, const InitOptions & options = {});
  /// The same; arguments[0] is the program's name.
  explicit Context(const std::vector<std::string> & arguments, const InitOptions & options = {});
  /// Shuts down if that has not happened.
  ~Context();
  Context(const Context &) = delete;
  Context & operator=(const Context &) = delete;

  /// True until a shutdown begins.
  bool ok() const noexcept;

  /// Shuts down, once: the first caller runs the callbacks and returns when all is done, others return at
  /// once with false. Callable from any thread, also from a callback of an executor.
  bool shutdown(const std::string & reason);

  /// Why it was shut down ("SIGINT"); empty while ok().
  std::string shutdown_reason() const;

  /// Waits until a shutdown is complete; false if that takes longer than `timeout`.
  bool wait_for_shutdown(std::chrono::nanoseconds timeout) const;
  /// Waits until a shutdown has begun (ok() is false); false on timeout.
  bool wait_for_shutdown_begin(std::chrono::nanoseconds timeout) const;

  /// Runs `callback` at the start of a shutdown, communication still working. In order of registration; must
  /// not block without a limit. An exception is caught and logged. Registered after a shutdown began: runs at
  /// once. Returns an id for remove_shutdown_callback.
  std::size_t add_pre_shutdown_callback(Callback callback);
  /// Runs `callback` at the end of a shutdown.
  std::size_t add_on_shutdown_callback(Callback callback);
  /// Waits for the callback if it is running in another thread: after it, nothing it captured is used any
  /// more.
  void remove_shutdown_callback(std::size_t id);

  /// The arguments that are not for ROS, the program's name first.
  const std::vector<std::string> & non_ros_arguments() const noexcept;

  std::size_t get_domain_id() const;

  const std::shared_ptr<detail::ContextImpl> & impl() const noexcept { return impl_; }

 private:
  std::shared_ptr<detail::ContextImpl> impl_;
};

}  // namespace rcl_cxx
