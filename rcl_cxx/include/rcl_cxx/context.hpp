#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace rcl_cxx {
namespace detail {
class ContextImpl;
}

struct InitOptions {
  /// SIGINT, SIGTERM and SIGHUP shut the context down, in a thread of its own. Several contexts may set this.
  /// A signal that arrives later than `signal_grace` after the first one has its default action, so that
  /// Ctrl-C ends a shutdown that hangs. An earlier one is logged and has no effect: a launcher and the
  /// terminal may both send SIGINT.
  bool shutdown_on_signal = true;
  std::chrono::milliseconds signal_grace{2000};
  /// Configure rcl logging from the arguments (--log-level, …). The first context of a process that sets this
  /// configures logging.
  bool auto_initialize_logging = true;
};

/// Arguments, ROS domain and shutdown of a process. Thread-safe.
///
/// Order of a shutdown: ok() becomes false; pre-shutdown callbacks run while communication still works (stop
/// the robot, end the goals with a reason); action servers abort the remaining goals; rcl is shut down;
/// on-shutdown callbacks run; wait_for_shutdown and Executor::spin return.
class Context {
 public:
  using SharedPtr = std::shared_ptr<Context>;
  using Callback = std::function<void()>;

  /// Arguments after --ros-args (-r remaps, -p and --params-file parameters, --log-level, --enclave, …) are
  /// for ROS.
  /// @throws Error that names a malformed or unknown ROS argument, or if rcl cannot start.
  Context(int argc, const char * const * argv, const InitOptions & options = {});
  /// The same; arguments[0] is the program's name.
  explicit Context(const std::vector<std::string> & arguments, const InitOptions & options = {});
  /// Shuts the context down.
  ~Context();
  Context(const Context &) = delete;
  Context & operator=(const Context &) = delete;

  /// True until a shutdown begins.
  bool ok() const noexcept;

  /// Shuts down, once. The first caller runs the callbacks and returns when all is done; further callers
  /// return false at once. May be called from any thread, and from a callback of an executor.
  bool shutdown(const std::string & reason);

  /// The reason of the shutdown ("SIGINT"); empty while ok().
  std::string shutdown_reason() const;

  /// Waits until a shutdown is complete. Returns false on timeout.
  bool wait_for_shutdown(std::chrono::nanoseconds timeout) const;
  /// Waits until a shutdown has begun. Returns false on timeout.
  bool wait_for_shutdown_begin(std::chrono::nanoseconds timeout) const;

  /// Runs `callback` when a shutdown begins, in order of registration, while communication still works.
  /// It must not block without a limit. An exception is logged. If a shutdown has begun already, the callback
  /// runs at once. Returns an id for remove_shutdown_callback().
  std::size_t add_pre_shutdown_callback(Callback callback);
  /// Runs `callback` at the end of a shutdown.
  std::size_t add_on_shutdown_callback(Callback callback);
  /// Waits for the callback if it is running in another thread. It does not run afterwards.
  void remove_shutdown_callback(std::size_t id);

  /// The arguments that are not for ROS, beginning with the program's name.
  const std::vector<std::string> & non_ros_arguments() const noexcept;

  const std::shared_ptr<detail::ContextImpl> & impl() const noexcept { return impl_; }

 private:
  std::shared_ptr<detail::ContextImpl> impl_;
};

}  // namespace rcl_cxx
